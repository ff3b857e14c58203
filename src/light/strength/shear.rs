//! Index space sheared so that columns run along a light: strengths never leave their column (algorithm §9).
//!
//! Slices are planes of voxels across the volume's axis nearest to the light, numbered from the light on. Columns are a
//! voxel apart in every slice; from slice to slice they shift by the light's slope, at most one voxel. Column (i, j) goes
//! through voxel (i, j) of slice 0. Of all columns only those over the volume are kept, in a window that moves along.
//! The slope is rounded to 2⁻³² voxels a slice: then every position below is exact, and a window never drifts.

mod place;

use std::ops::Range;

use glam::{DAffine3, DVec3};

use crate::volume::grid::Grid;
pub use place::Place;

const SLOPES: f64 = (1_u64 << 32) as f64;

/// The columns of a light through a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shear {
    /// The index axes that run across a slice, down a slice, and from slice to slice.
    pub axes: [usize; 3],
    /// Voxels across a slice, down a slice, and the number of slices.
    pub size: [usize; 3],
    /// Δ: the world distance between slices along the light.
    pub distance: f64,
    /// Voxels that columns shift from a slice to the next, across and down: each in −1..=1.
    slope: [f64; 2],
    /// Whether the light enters at the last index of its axis.
    reversed: bool,
    index_to_world: DAffine3,
    world_to_index: DAffine3,
}

/// The columns that are kept of one slice: the first of them, and how far before voxel 0 it goes through the slice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Number of the first column, across and down.
    pub low: [i64; 2],
    /// Column `low + c` meets the slice at voxel index `c − phase`; in 0..1.
    pub phase: [f64; 2],
}

impl Shear {
    /// The columns of a light towards `toward` (unit vector) through `grid`; `None` if the light has no direction.
    #[must_use]
    pub fn new(grid: &Grid, toward: DVec3) -> Option<Self> {
        let world_to_index = grid.world_to_index();
        let along = world_to_index.transform_vector3(-toward).to_array();
        let last = (0..3).max_by(|&p, &q| along[p].abs().total_cmp(&along[q].abs()))?;
        let most = along[last].abs();
        if !(most.is_normal() && (1.0 / most).is_normal()) {
            return None;
        }
        let axes = [usize::from(last == 0), if last == 2 { 1 } else { 2 }, last];
        let slope = [axes[0], axes[1]].map(|axis| (along[axis] / most * SLOPES).round() / SLOPES);
        let size = axes.map(|axis| grid.size[axis]);
        let reversed = along[last] < 0.0;
        let index_to_world = grid.index_to_world;
        let distance = 1.0 / most;
        Some(Self { axes, size, distance, slope, reversed, index_to_world, world_to_index })
    }

    /// The way from a column to its neighbour across and down, in the world.
    #[must_use]
    pub fn spacings(&self) -> [DVec3; 2] {
        let matrix = self.index_to_world.matrix3;
        [self.axes[0], self.axes[1]].map(|axis| matrix.col(axis))
    }

    /// The world point of a place in a slice: continuous, across, down and the slice's number.
    #[must_use]
    pub fn world(&self, place: [f64; 3]) -> DVec3 {
        self.index_to_world.transform_point3(self.index(place))
    }

    /// Columns kept of a slice, across and down.
    #[must_use]
    pub fn width(&self) -> [usize; 2] {
        std::array::from_fn(|axis| self.size[axis] + usize::from(self.slope[axis] != 0.0))
    }

    /// The columns kept of slice `slice`.
    #[must_use]
    pub fn window(&self, slice: usize) -> Window {
        let start = self.slope.map(|slope| -slope * slice as f64);
        let low = start.map(f64::floor);
        Window { low: low.map(|l| l as i64), phase: [start[0] - low[0], start[1] - low[1]] }
    }

    /// The kept columns of `slice` that are in the volume, or less than a voxel past the side where they leave it.
    ///
    /// What they meet out there is the volume's border again, so that interpolation up to the border sees no jump.
    #[must_use]
    pub fn entered(&self, slice: usize) -> [Range<usize>; 2] {
        let (width, phase) = (self.width(), self.window(slice).phase);
        std::array::from_fn(|axis| match self.slope[axis] {
            slope if slope > 0.0 => usize::from(phase[axis] > 0.0)..width[axis],
            slope if slope < 0.0 => 0..self.size[axis],
            _ => 0..width[axis],
        })
    }

    /// How far inside the volume kept column `at` of `slice` is, counted in slices along it; at most 1.
    #[must_use]
    pub fn depth(&self, slice: usize, at: [usize; 2]) -> f64 {
        let phase = self.window(slice).phase;
        (0..2).fold((slice as f64).min(1.0), |depth, axis| {
            let (slope, voxel) = (self.slope[axis], at[axis] as f64 - phase[axis]);
            let left = if slope < 0.0 { (self.size[axis] - 1) as f64 - voxel } else { voxel };
            if slope == 0.0 { depth } else { depth.min(left.max(0.0) / slope.abs()) }
        })
    }

    /// The voxel index of a place in a slice: continuous, across, down and the slice's number.
    #[must_use]
    fn index(&self, place: [f64; 3]) -> DVec3 {
        let mut index = [0.0; 3];
        let along = if self.reversed { (self.size[2] - 1) as f64 - place[2] } else { place[2] };
        for (axis, value) in self.axes.into_iter().zip([place[0], place[1], along]) {
            index[axis] = value;
        }
        DVec3::from(index)
    }

    /// The index along the slices' axis of a slice; also the slice of such an index.
    #[must_use]
    pub fn flip(&self, slice: usize) -> usize {
        if self.reversed { self.size[2] - 1 - slice } else { slice }
    }

    /// The column through voxel (x, y) of a slice, continuous.
    #[must_use]
    #[inline]
    pub fn column(&self, [x, y]: [f64; 2], slice: f64) -> [f64; 2] {
        [x - self.slope[0] * slice, y - self.slope[1] * slice]
    }

    /// The column through a world point and its place along it, in slices; continuous, in the volume or not.
    #[must_use]
    pub(crate) fn locate(&self, world: DVec3) -> ([f64; 2], f64) {
        let index = self.world_to_index.transform_point3(world);
        let along = index[self.axes[2]];
        let slice = if self.reversed { (self.size[2] - 1) as f64 - along } else { along };
        (self.column([index[self.axes[0]], index[self.axes[1]]], slice), slice)
    }

    /// Where a column is in the volume's domain, in slices: empty (from above to) if it misses it.
    #[must_use]
    pub fn span(&self, column: [f64; 2]) -> [f64; 2] {
        let mut span = [0.0, (self.size[2] - 1) as f64];
        for (axis, &start) in column.iter().enumerate() {
            let (slope, last) = (self.slope[axis], (self.size[axis] - 1) as f64);
            if slope == 0.0 {
                if !(0.0..=last).contains(&start) {
                    return [1.0, 0.0];
                }
            } else {
                let (p, q) = (-start / slope, (last - start) / slope);
                span = [span[0].max(p.min(q)), span[1].min(p.max(q))];
            }
        }
        span
    }
}

#[cfg(test)]
mod tests;
