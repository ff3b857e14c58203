//! From columns to voxels: the one resampling of strengths, at points that are the bias nearer to the light (paper §4).

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::columns::Columns;
use crate::light::strength::{Buffer, Place, Shear, quantize};
use crate::volume::bricks::{Bricks, EDGE};

/// Slices whose voxels are lit together: each time all threads are waited for.
pub(super) const TOGETHER: usize = EDGE;

/// The strengths at interesting voxels, gathered slice by slice.
pub(super) struct Voxels<'a> {
    opacity: &'a Bricks<f32>,
    /// In slices, and as the way towards the light in the world.
    bias: (f64, DVec3),
    full: f32,
    /// What other volumes let through.
    others: &'a [&'a Buffer],
    /// For each slice, one after the other, each row of bricks in it.
    rows: Vec<Lit>,
}

/// The strengths of one slice in one row of bricks, x fastest in each brick.
struct Lit {
    /// Where each brick's strengths start.
    starts: Vec<u32>,
    strengths: Vec<u16>,
}

/// The beams of light to the voxels of a slice: all are alike but for whole columns.
struct Beams<'a> {
    columns: &'a Columns<'a>,
    slice: usize,
    /// Where the strength for voxel (0, 0) is read.
    place: Option<Place>,
}

impl Beams<'_> {
    /// β_0 · T at a voxel of the slice.
    #[inline]
    fn through(&self, voxel: [usize; 2]) -> f64 {
        let column = self.columns.shear.column(voxel.map(|v| v as f64), self.slice as f64);
        let place = self.place.map(|place| place.moved(voxel));
        self.columns.strength(place.as_ref(), column)
    }

    /// β_0 · T at the voxels of a brick's row, the first of them at `voxel`; where none is looked for, it may be anything.
    #[inline]
    fn along(&self, voxel: [usize; 2], is_looked_for: impl Fn(usize) -> bool) -> [f64; EDGE] {
        let row = self.place.and_then(|place| self.columns.strengths(&place.moved(voxel)));
        row.unwrap_or_else(|| {
            let through = |x: usize| self.through([voxel[0] + x, voxel[1]]);
            std::array::from_fn(|x| if is_looked_for(x) { through(x) } else { 0.0 })
        })
    }
}

impl<'a> Voxels<'a> {
    pub fn new(
        opacity: &'a Bricks<f32>,
        bias: (f64, DVec3),
        full: f32,
        others: &'a [&'a Buffer],
    ) -> Self {
        Self { opacity, bias, full, others, rows: Vec::new() }
    }

    /// What the other volumes let through to a voxel of the slice.
    fn through(&self, shear: &Shear, [x, y]: [usize; 2], slice: usize) -> f64 {
        if self.others.is_empty() {
            return 1.0;
        }
        let world = shear.world([x as f64, y as f64, slice as f64]) + self.bias.1;
        self.others.iter().map(|other| f64::from(other.at(world))).product()
    }

    /// Lights the interesting voxels of the next slices, the last of which the columns have come to; at most [`TOGETHER`].
    pub fn light(&mut self, slices: Range<usize>, columns: &Columns<'_>) {
        let shear = columns.shear;
        let down = shear.size[1].div_ceil(EDGE);
        let lit = |at: usize| {
            let (slice, row) = (at / down, at % down);
            let from = shear.column([0.0; 2], slice as f64);
            let place = shear.place(from, slice as f64 - self.bias.0);
            self.row(row, &Beams { columns, slice, place })
        };
        let lit: Vec<_> =
            (slices.start * down..slices.end * down).into_par_iter().map(lit).collect();
        self.rows.extend(lit);
    }

    fn row(&self, row: usize, beams: &Beams<'_>) -> Lit {
        let (shear, slice) = (beams.columns.shear, beams.slice);
        let bricks = shear.size[0].div_ceil(EDGE);
        let mut lit = Lit { starts: Vec::with_capacity(bricks), strengths: Vec::new() };
        for brick in 0..bricks {
            lit.starts.push(lit.strengths.len() as u32);
            let Some(opacities) = self.opacity.brick(place(shear, [brick, row], slice)) else {
                continue;
            };
            let (first, [across, down]) = offsets(shear, slice);
            for y in 0..EDGE {
                let is_lit = |x: usize| opacities[first + x * across + y * down] > 0.0;
                if !(0..EDGE).any(is_lit) {
                    continue;
                }
                let voxel = [brick * EDGE, row * EDGE + y];
                let beams = beams.along(voxel, is_lit);
                for x in (0..EDGE).filter(|&x| is_lit(x)) {
                    let through = beams[x] * self.through(shear, [voxel[0] + x, voxel[1]], slice);
                    lit.strengths.push(quantize(through, f64::from(self.full)));
                }
            }
        }
        lit.strengths.shrink_to_fit();
        lit
    }

    /// Puts the strengths into the bricks of what is relit.
    pub(crate) fn gather(self, shear: &Shear) -> Bricks<u16> {
        let down = shear.size[1].div_ceil(EDGE);
        self.opacity.map(|bricks, opacities, made| {
            let [column, row, along] = shear.axes.map(|axis| bricks.brick[axis]);
            let first = along * EDGE;
            for along in first..(first + EDGE).min(shear.size[2]) {
                let slice = shear.flip(along);
                let lit = &self.rows[slice * down + row];
                let mut strengths = lit.strengths[lit.starts[column] as usize..].iter();
                let (first, [across, down]) = offsets(shear, slice);
                for (x, y) in (0..EDGE).flat_map(|y| (0..EDGE).map(move |x| (x, y))) {
                    let within = first + x * across + y * down;
                    if opacities[within] > 0.0
                        && let Some(&strength) = strengths.next()
                    {
                        made[within] = strength;
                    }
                }
            }
        })
    }
}

/// The brick at a place of a slice.
fn place(shear: &Shear, [x, y]: [usize; 2], slice: usize) -> [usize; 3] {
    let mut place = [0; 3];
    for (axis, brick) in shear.axes.into_iter().zip([x, y, shear.flip(slice) / EDGE]) {
        place[axis] = brick;
    }
    place
}

/// Where the voxels of a brick in a slice are in the brick: the first, and the way to the next across and down.
///
/// Voxels beyond the grid are among them; no brick holds an opacity there.
fn offsets(shear: &Shear, slice: usize) -> (usize, [usize; 2]) {
    let [across, down, along] = shear.axes.map(|axis| EDGE.pow(axis as u32));
    ((shear.flip(slice) % EDGE) * along, [across, down])
}
