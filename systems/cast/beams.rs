//! Beams: small tiles of the picture, and where along each its rays can meet gel or polygons at all.
//!
//! Every occupied cell of the pyramid's level 2 (4³ voxels) is splatted into the beams that it may be seen through; a
//! ray starts where the first of its beam's starts and ends where the last one ends. Lossless: outside that interval
//! there is no interesting cell.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::view::camera::Camera;
use crate::view::samples::{Layout, POSITIONS};
use crate::volume::gel::{CELLS, EMPTY, Texel, Texels};
use crate::volume::grid::Grid;
use crate::volume::pyramid::Pyramid;

/// Pixels along a beam's side.
const PIXELS: usize = 4;
/// Cells along half a brick's edge: a cell of the pyramid's level 2.
const HALF: usize = CELLS / 2;
/// Parts of the table of bricks that are splatted side by side.
const PARTS: usize = 8;
/// Positions of the sample array along a beam's side.
pub const SIDE: usize = PIXELS * POSITIONS;

/// For each beam, x fastest: the numbers `[first, end)` of the samples that may lie in an occupied brick.
pub type Occupied = Vec<[i64; 2]>;

/// How a sample array is cut into beams of 16 × 16 positions.
#[derive(Debug, Clone, Copy)]
pub struct Beams {
    /// The positions of the array.
    pub layout: Layout,
    /// Beams across and down.
    pub counts: [usize; 2],
}

impl Beams {
    /// The beams of a sample array.
    pub fn new(layout: Layout) -> Self {
        Self { layout, counts: layout.positions().map(|n| n.div_ceil(SIDE)) }
    }

    /// The beams that positions between window coordinates `low` and `high` (pixels) may lie in, as half-open ranges
    /// across and down; empty outside the array.
    pub fn around(&self, low: DVec2, high: DVec2) -> [std::ops::Range<usize>; 2] {
        let position = |window: f64| (window - 0.5) * POSITIONS as f64 + self.layout.margin as f64;
        let range = |low: f64, high: f64, count: usize| {
            // A position's slack against rounding; casts saturate, NaN becomes 0.
            let first = ((position(low) - 0.01) / SIDE as f64).floor().max(0.0) as usize;
            let end = ((position(high) + 0.01) / SIDE as f64).floor() + 1.0;
            first.min(count)..(end.max(0.0) as usize).min(count)
        };
        [range(low.x, high.x, self.counts[0]), range(low.y, high.y, self.counts[1])]
    }

    /// Where the rays of each beam may meet gel.
    pub fn occupied<T: Texel>(
        &self,
        gel: &Texels<T>,
        pyramid: &Pyramid,
        grid: &Grid,
        camera: &Camera,
        distance: f64,
    ) -> Occupied {
        let none = || vec![[i64::MAX, i64::MIN]; self.counts[0] * self.counts[1]];
        let box_of = BoxOf::new(grid, camera);
        let [nx, ny, _] = gel.counts();
        // Parts enough for the threads, few enough that putting their ranges together costs nothing.
        let part = gel.table().len().div_ceil(PARTS);
        let splat = |(number, entries): (usize, &[u32])| {
            let mut ranges = none();
            for (at, &stored) in
                (number * part..).zip(entries).filter(|(_, entry)| **entry != EMPTY)
            {
                let brick = [at % nx, at / nx % ny, at / (nx * ny)].map(|b| b * CELLS);
                for half in occupied_halves(pyramid.slices().cells(stored)) {
                    let first = std::array::from_fn(|axis| brick[axis] + half[axis] * HALF);
                    let (low, high) = box_of.cells(first, grid.size);
                    self.splat(&mut ranges, low, high, distance);
                }
            }
            ranges
        };
        let both = |mut a: Occupied, b: Occupied| {
            for (a, b) in a.iter_mut().zip(b) {
                *a = [a[0].min(b[0]), a[1].max(b[1])];
            }
            a
        };
        gel.table().par_chunks(part).enumerate().map(splat).reduce(none, both)
    }

    /// Widens the ranges of the beams that a box in window coordinates and depth may be seen through.
    fn splat(&self, ranges: &mut Occupied, low: DVec3, high: DVec3, distance: f64) {
        let first = (low.z / distance - 0.5).floor() as i64 - 1;
        let end = (high.z / distance - 0.5).ceil() as i64 + 2;
        let [across, down] = self.around(low.truncate(), high.truncate());
        for y in down {
            for range in &mut ranges[y * self.counts[0]..][across.clone()] {
                *range = [range[0].min(first), range[1].max(end)];
            }
        }
    }
}

/// Which eighths of a brick hold an interesting cell, 0 or 1 along each axis.
fn occupied_halves(cells: &[u64; CELLS]) -> impl Iterator<Item = [usize; 3]> {
    (0..8_usize).map(|n| [n % 2, n / 2 % 2, n / 4]).filter(|&[x, y, z]| {
        let four = (0x0f0f_0f0f_u64 << (HALF * x)) << (CELLS * HALF * y);
        cells[HALF * z..][..HALF].iter().any(|word| word & four != 0)
    })
}

/// Bounding boxes in window coordinates (pixels) and depth (world units) of boxes in index space.
enum BoxOf<'a> {
    /// Rays are parallel: what a voxel index adds to window and depth is the same everywhere.
    Parallel { origin: DVec3, axes: [DVec3; 3] },
    /// Corners are projected one by one.
    Perspective { grid: &'a Grid, camera: &'a Camera },
}

impl<'a> BoxOf<'a> {
    fn new(grid: &'a Grid, camera: &'a Camera) -> Self {
        if camera.eye.is_some() {
            return Self::Perspective { grid, camera };
        }
        let seen = |point: DVec3| {
            let (window, depth) = camera.project(grid.index_to_world.transform_point3(point));
            window.extend(depth)
        };
        let origin = seen(DVec3::ZERO);
        Self::Parallel { origin, axes: DVec3::AXES.map(|axis| seen(axis) - origin) }
    }

    /// The box of 4³ cells from `first` on, cut off where the grid ends.
    fn cells(&self, first: [usize; 3], size: [usize; 3]) -> (DVec3, DVec3) {
        let end: [usize; 3] = std::array::from_fn(|axis| (first[axis] + HALF).min(size[axis] - 1));
        let ends = [first, end].map(|corner| DVec3::from(corner.map(|n| n as f64)));
        match self {
            Self::Parallel { origin, axes } => {
                let (mut low, mut high) = (*origin, *origin);
                for (axis, along) in axes.iter().enumerate() {
                    let ends = [*along * ends[0][axis], *along * ends[1][axis]];
                    low += ends[0].min(ends[1]);
                    high += ends[0].max(ends[1]);
                }
                (low, high)
            }
            Self::Perspective { grid, camera } => perspective_box(grid, camera, ends),
        }
    }
}

/// The box of a block of cells between two corners in index space, of which a part may lie behind the eye: then it may be
/// seen anywhere.
fn perspective_box(grid: &Grid, camera: &Camera, ends: [DVec3; 2]) -> (DVec3, DVec3) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for corner in 0..8_usize {
        let index = DVec3::from(std::array::from_fn(|axis| ends[corner >> axis & 1][axis]));
        let world = grid.index_to_world.transform_point3(index);
        let depth = camera.depth(world);
        let window = if depth > camera.nearest() {
            [camera.project(world).0; 2]
        } else {
            [DVec2::NEG_INFINITY, DVec2::INFINITY]
        };
        low = low.min(window[0].extend(depth));
        high = high.max(window[1].extend(depth));
    }
    (low, high)
}
