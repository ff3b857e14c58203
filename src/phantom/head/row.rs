//! A row of the head's voxels, on which one tissue after another is painted.

use std::ops::Range;

use crate::phantom::solid::{FAR, Slice, coverage};

/// Voxels of the head on each axis.
pub(super) const SIZE: [usize; 3] = [256, 256, 113];

/// Width of the ramp at an edge, mm: two voxels, so that a contour of it has no stairs.
pub(super) const EDGE: f32 = 2.0;

/// The value of air.
pub(super) const AIR: f32 = 25.0;

/// Where the voxels of a row are, and the values painted so far.
pub(super) struct Row<'a> {
    pub x: &'a [f32],
    pub y: f32,
    pub z: f32,
    pub values: &'a mut [f32],
    pub distances: &'a mut [f32],
}

impl Row<'_> {
    /// Paints a solid with one value.
    pub fn paint(&mut self, solid: &Slice, value: f32, width: f32) {
        let range = self.lay(solid);
        self.blend(range, width, |_, _| value);
    }

    /// The distances to a solid, in the range of voxels that it comes near.
    pub fn lay(&mut self, solid: &Slice) -> Range<usize> {
        self.distances.fill(FAR);
        solid.lay(self.x, self.y, self.distances)
    }

    /// Paints the voxels of a range with a value by position and distance, as far as each is covered.
    pub fn blend(&mut self, range: Range<usize>, width: f32, value: impl Fn(f32, f32) -> f32) {
        let voxels = self.values[range.clone()].iter_mut().zip(&self.x[range.clone()]);
        for ((v, &x), &d) in voxels.zip(&self.distances[range]) {
            *v += (value(x, d) - *v) * coverage(d, width);
        }
    }
}
