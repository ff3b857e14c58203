//! From columns to voxels: the one resampling of strengths, at points that are the bias nearer to the light (paper §4).

use rayon::prelude::*;

use super::columns::Columns;
use crate::bricks::{Bricks, EDGE};
use crate::strength::{Falloff, Shear, quantize};

/// The strengths at interesting voxels, gathered slice by slice.
pub(super) struct Voxels<'a> {
    opacity: &'a Bricks<f32>,
    falloff: &'a Falloff,
    /// In slices.
    bias: f64,
    full: f32,
    /// For each slice and each row of bricks in it.
    slices: Vec<Vec<Lit>>,
}

/// The strengths of one slice in one row of bricks, x fastest in each brick.
struct Lit {
    /// Where each brick's strengths start.
    starts: Vec<u32>,
    strengths: Vec<u16>,
}

impl<'a> Voxels<'a> {
    pub fn new(opacity: &'a Bricks<f32>, falloff: &'a Falloff, bias: f64, full: f32) -> Self {
        Self { opacity, falloff, bias, full, slices: Vec::new() }
    }

    /// Lights the interesting voxels of the slice that the columns have come to.
    pub fn light(&mut self, slice: usize, columns: &Columns<'_>) {
        let rows = columns.shear.size[1].div_ceil(EDGE);
        let rows = (0..rows).into_par_iter().map(|row| self.row(slice, row, columns));
        let rows = rows.collect();
        self.slices.push(rows);
    }

    fn row(&self, slice: usize, row: usize, columns: &Columns<'_>) -> Lit {
        let shear = &columns.shear;
        let bricks = shear.size[0].div_ceil(EDGE);
        let mut lit = Lit { starts: Vec::with_capacity(bricks), strengths: Vec::new() };
        for brick in 0..bricks {
            lit.starts.push(lit.strengths.len() as u32);
            let Some(opacities) = self.opacity.brick(place(shear, [brick, row], slice)) else {
                continue;
            };
            for (at, within) in offsets(shear, slice) {
                if opacities[within] > 0.0 {
                    let voxel = [brick * EDGE + at[0], row * EDGE + at[1]].map(|v| v as f64);
                    lit.strengths.push(self.voxel(voxel, slice as f64, columns));
                }
            }
        }
        lit.strengths.shrink_to_fit();
        lit
    }

    /// β at a voxel of a slice.
    fn voxel(&self, voxel: [f64; 2], slice: f64, columns: &Columns<'_>) -> u16 {
        let (shear, place) = (&columns.shear, slice - self.bias);
        let strength = columns.strength(shear.column(voxel, slice), place);
        let distance = self.falloff.distance(shear.world([voxel[0], voxel[1], slice]));
        let divisor = self.falloff.divisor(distance - self.bias * shear.distance);
        quantize(strength / divisor, f64::from(self.full))
    }

    /// Puts the strengths into the bricks of what is relit.
    pub fn gather(self, shear: &Shear) -> Bricks<u16> {
        self.opacity.map(|bricks, opacities, made| {
            let [column, row, along] = shear.axes.map(|axis| bricks.brick[axis]);
            let first = along * EDGE;
            for along in first..(first + EDGE).min(shear.size[2]) {
                let slice = shear.flip(along);
                let lit = &self.slices[slice][row];
                let mut strengths = lit.strengths[lit.starts[column] as usize..].iter();
                for (_, within) in offsets(shear, slice) {
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

/// The voxels of a brick in a slice: across and down, and the place in the brick.
///
/// Voxels beyond the grid are among them; no brick holds an opacity there.
fn offsets(shear: &Shear, slice: usize) -> impl Iterator<Item = ([usize; 2], usize)> {
    let [across, down, along] = shear.axes.map(|axis| EDGE.pow(axis as u32));
    let first = (shear.flip(slice) % EDGE) * along;
    (0..EDGE * EDGE).map(move |at| {
        let (x, y) = (at % EDGE, at / EDGE);
        ([x, y], first + x * across + y * down)
    })
}
