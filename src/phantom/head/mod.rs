//! The head: a phantom with the numbers of a CT scan (Hounsfield + 1024) on 256 × 256 × 113 voxels, 1 × 1 × 2 mm.
//!
//! A voxel starts as air; tissue after tissue is painted over it by the part of the voxel that the tissue's solid
//! fills. Tables of shapes hold the anatomy, a file a region, in millimetres about the world's origin: +x is the
//! patient's left, +y the back, +z the top.

mod brain;
mod jaw;
mod skin;
mod skull;

use std::ops::Range;

use rayon::prelude::*;

use super::shapes::{FAR, Slice, Solid, coverage};
use super::simple::centred;
use crate::formats::Loaded;
use crate::grid::{Scalars, Shared};

const SIZE: [usize; 3] = [256, 256, 113];
const SPACING: [f64; 3] = [1.0, 1.0, 2.0];

/// Slices 1 mm apart from z = −114 mm, of which the slices are made.
const THIN_SLICES: usize = 2 * SIZE[2] + 3;

/// Width of the ramp at an edge, mm: two voxels, so that a contour of it has no stairs.
const EDGE: f32 = 2.4;

const AIR: f32 = 25.0;

/// The head; see the module.
pub fn head() -> Loaded {
    let anatomy = Anatomy::new();
    let area = SIZE[0] * SIZE[1];
    let mut slices = vec![0_u16; area * THIN_SLICES];
    slices.par_chunks_mut(area).enumerate().for_each(|(k, slice)| anatomy.slice(k, slice));
    let mut voxels = vec![0_u16; area * SIZE[2]];
    voxels.par_chunks_mut(area).enumerate().for_each(|(k, slice)| thicken(&slices, k, slice));
    centred(SIZE, SPACING, Scalars::U16(Shared::new(voxels)))
}

/// Slice k: the weighted mean of five thin ones, as a scanner's slices have thickness; so edges are smooth along z too.
fn thicken(slices: &[u16], k: usize, out: &mut [u16]) {
    let [a, b, c, d, e] = std::array::from_fn(|i| &slices[(2 * k + i) * out.len()..][..out.len()]);
    for (i, voxel) in out.iter_mut().enumerate() {
        // Values stay under 4096, so that eight of them fit 16 bits.
        *voxel = (a[i] + 2 * (b[i] + c[i] + d[i]) + e[i] + 4) / 8;
    }
}

/// Where the voxels of a row are, and the values painted so far.
struct Row<'a> {
    x: &'a [f32],
    y: f32,
    z: f32,
    values: &'a mut [f32],
    distances: &'a mut [f32],
}

impl Row<'_> {
    /// Paints a solid with one value.
    fn paint(&mut self, solid: &Slice, value: f32, width: f32) {
        let range = self.lay(solid);
        self.blend(range, width, |_, _| value);
    }

    /// The distances to a solid, in the range of voxels that it comes near.
    fn lay(&mut self, solid: &Slice) -> Range<usize> {
        self.distances.fill(FAR);
        solid.lay(self.x, self.y, self.distances)
    }

    /// Paints the voxels of a range with a value by position and distance, as far as each is covered.
    fn blend(&mut self, range: Range<usize>, width: f32, value: impl Fn(f32, f32) -> f32) {
        let voxels = self.values[range.clone()].iter_mut().zip(&self.x[range.clone()]);
        for ((v, &x), &d) in voxels.zip(&self.distances[range]) {
            *v += (value(x, d) - *v) * coverage(d, width);
        }
    }
}

/// Every region of the head, ready for slices.
struct Anatomy {
    x: Vec<f32>,
    skin: Solid,
    skull: skull::Skull,
    brain: brain::Brain,
    jaw: jaw::Jaw,
}

impl Anatomy {
    fn new() -> Self {
        Self {
            x: (0..SIZE[0]).map(|i| i as f32 - 127.5).collect(),
            skin: Solid::new(skin::SKIN),
            skull: skull::Skull::new(),
            brain: brain::Brain::new(),
            jaw: jaw::Jaw::new(),
        }
    }

    /// Thin slice k, painted from the outside inwards.
    fn slice(&self, k: usize, out: &mut [u16]) {
        let z = k as f32 - 114.0;
        let skin = self.skin.slice(z);
        let brain = self.brain.slice(k, z);
        let skull = self.skull.slice(z);
        let jaw = self.jaw.slice(z);
        let (mut values, mut distances) = (vec![AIR; SIZE[0]], vec![FAR; SIZE[0]]);
        for (j, line) in out.chunks_mut(SIZE[0]).enumerate() {
            values.fill(AIR);
            let y = j as f32 - 127.5;
            let (values, distances) = (&mut values[..], &mut distances[..]);
            let mut row = Row { x: &self.x, y, z, values, distances };
            let range = row.lay(&skin);
            if !range.is_empty() {
                row.blend(range, EDGE, skin::tissue(y, z));
                skull.paint(&mut row, &brain, j);
                jaw.paint(&mut row);
            }
            for (voxel, &value) in line.iter_mut().zip(&*row.values) {
                *voxel = (value + 0.5) as u16;
            }
        }
    }
}
