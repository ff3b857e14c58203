//! The scalars as a field: value and gradient anywhere between voxels, in numbers of the scanner's own type.
//!
//! A filter is four weights along each axis, and its derivative four slopes, so that one walk over 4³ voxels gives all four
//! numbers: rows of four voxels at once, then columns, then slices. A product is rounded before it is added to, so that no
//! bit depends on the set of instructions.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::{Level, dispatch};
use glam::{Mat3, Vec3};

use super::filter::Taps;
use super::grid::{Grid, Scalar, Scalars};
use crate::components::Filter;
use crate::with_scalars;

/// Scalars on a grid, and what is between them.
#[derive(Clone, Copy)]
pub struct Field<'a> {
    scalars: &'a Scalars,
    size: [usize; 3],
    filter: Filter,
    /// From slopes per voxel to the world.
    to_world: Mat3,
}

/// A place in a grid: a cell by its first voxel, and how far it is through the cell on each axis, 0..=1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spot {
    /// The cell.
    pub cell: [usize; 3],
    /// The way through it.
    pub part: [f32; 3],
}

/// What a field is at a place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sampled {
    /// f; a NaN where a voxel that it is made of is no finite number.
    pub value: f32,
    /// ∇f in the world; zero where a voxel that it needs is no number.
    pub gradient: [f32; 3],
}

/// The four voxels of an axis that a place is made of: steps in the array, and what each counts.
struct Axis {
    at: [usize; 4],
    taps: Taps,
    /// Whether all four are there, one step after the other.
    whole: bool,
}

impl<'a> Field<'a> {
    /// The field of `scalars`, as many as `grid` has voxels; for [`Filter::Interpolating`] they are its coefficients.
    #[must_use]
    pub fn new(scalars: &'a Scalars, grid: &Grid, filter: Filter) -> Self {
        let to_world = grid.index_to_world.matrix3.inverse().transpose().as_mat3();
        Self { scalars, size: grid.size, filter, to_world }
    }

    /// Fills in what the field is at some spots, which count as the nearest inside the grid.
    pub fn sample(&self, level: Level, spots: &[Spot], made: &mut [Sampled]) {
        with_scalars!(self.scalars, values => {
            if self.filter == Filter::Linear {
                dispatch!(level, _simd => self.sample_all::<_, true>(values, spots, made));
            } else {
                dispatch!(level, _simd => self.sample_all::<_, false>(values, spots, made));
            }
        });
    }

    /// Fills in the values of the field at some spots, to the last bit those that [`sample`](Self::sample) finds.
    pub fn values(&self, level: Level, spots: &[Spot], made: &mut [f32]) {
        with_scalars!(self.scalars, values => {
            if self.filter == Filter::Linear {
                dispatch!(level, _simd => self.values_all::<_, true>(values, spots, made));
            } else {
                dispatch!(level, _simd => self.values_all::<_, false>(values, spots, made));
            }
        });
    }

    #[inline(always)]
    fn values_all<T: Scalar, const LINEAR: bool>(
        &self,
        values: &[T],
        spots: &[Spot],
        made: &mut [f32],
    ) {
        for (spot, made) in spots.iter().zip(made) {
            let x = self.axis::<LINEAR>(spot, 0, 1);
            let y = self.axis::<LINEAR>(spot, 1, self.size[0]);
            let z = self.axis::<LINEAR>(spot, 2, self.size[0] * self.size[1]);
            *made = gather_value::<T, LINEAR>(values, [&x, &y, &z]);
        }
    }

    #[inline(always)]
    fn sample_all<T: Scalar, const LINEAR: bool>(
        &self,
        values: &[T],
        spots: &[Spot],
        made: &mut [Sampled],
    ) {
        for (spot, made) in spots.iter().zip(made) {
            // One by one: an array of them that a closure makes is written in pieces and waited for as a whole.
            let x = self.axis::<LINEAR>(spot, 0, 1);
            let y = self.axis::<LINEAR>(spot, 1, self.size[0]);
            let z = self.axis::<LINEAR>(spot, 2, self.size[0] * self.size[1]);
            let (value, [x, y, z]) = gather::<T, LINEAR>(values, [&x, &y, &z]);
            let gradient = self.to_world.x_axis * x + self.to_world.y_axis * y;
            let gradient = gradient + self.to_world.z_axis * z;
            *made = Sampled { value, gradient: finite(gradient).to_array() };
        }
    }

    /// The voxels of an axis that a spot is made of, and whether they lie side by side.
    #[inline(always)]
    fn axis<const LINEAR: bool>(&self, spot: &Spot, axis: usize, stride: usize) -> Axis {
        let last = self.size[axis] - 1;
        // The last plane of voxels is the end of the last cell.
        let (cell, part) = if spot.cell[axis] >= last {
            (last - 1, 1.0)
        } else {
            (spot.cell[axis], spot.part[axis])
        };
        // Of a linear field nothing is asked of the filter at any sample.
        let taps = Taps::new(if LINEAR { Filter::Linear } else { self.filter }, part);
        let ends = [cell == 0, cell + 2 > last];
        if ends[0] || ends[1] {
            let before = cell.saturating_sub(1);
            let at = [before, cell, cell + 1, (cell + 2).min(last)].map(|voxel| voxel * stride);
            return Axis { at, taps: taps.ended(ends), whole: false };
        }
        let first = (cell - 1) * stride;
        let at = [first, first + stride, first + 2 * stride, first + 3 * stride];
        Axis { at, taps, whole: true }
    }
}

/// The 4³ voxels around a spot, x fastest.
type Block = [[[f32; 4]; 4]; 4];

/// The voxels that a spot is made of. Of a linear field, those that count for nothing are not looked at.
///
/// In plain arrays: a row then is one widening load, where vector types are put together from pieces.
#[inline(always)]
fn block<T: Scalar, const LINEAR: bool>(values: &[T], [x, y, z]: [&Axis; 3]) -> Block {
    let mut block = [[[0.0; 4]; 4]; 4];
    for (k, slice) in block.iter_mut().enumerate() {
        for (j, made) in slice.iter_mut().enumerate() {
            if !LINEAR || is_inner(j) || is_inner(k) {
                *made = row(values, x, z.at[k] + y.at[j]);
            }
        }
    }
    block
}

/// Four voxels of the row that begins at `first`.
#[inline(always)]
fn row<T: Scalar>(values: &[T], x: &Axis, first: usize) -> [f32; 4] {
    if x.whole {
        let four = &values[first + x.at[0]..][..4];
        [four[0].value(), four[1].value(), four[2].value(), four[3].value()]
    } else {
        x.at.map(|at| values[first + at].value())
    }
}

/// Whether a voxel of an axis is one of the two that the spot lies between.
#[inline(always)]
fn is_inner(tap: usize) -> bool {
    tap == 1 || tap == 2
}

/// `row · weight + sum`, the product rounded first.
#[inline(always)]
fn add(row: [f32; 4], weight: f32, sum: [f32; 4]) -> [f32; 4] {
    let mut made = [0.0; 4];
    for n in 0..4 {
        made[n] = row[n] * weight + sum[n];
    }
    made
}

/// The value, and the slopes per voxel.
#[inline(always)]
fn gather<T: Scalar, const LINEAR: bool>(values: &[T], axes: [&Axis; 3]) -> (f32, [f32; 3]) {
    let (block, [x, y, z]) = (block::<T, LINEAR>(values, axes), axes);
    // Differences from a voxel of the cell: where nothing changes, no rounding makes a slope.
    let base = block[1][1][1];
    let inner = |tap: usize| !LINEAR || is_inner(tap);
    let (mut sum, mut along_y, mut along_z) = ([0.0; 4], [0.0; 4], [0.0; 4]);
    for (k, slice) in block.iter().enumerate() {
        let (mut row_sum, mut row_slope) = ([0.0; 4], [0.0; 4]);
        for (j, row) in slice.iter().enumerate() {
            let row = row.map(|value| value - base);
            if inner(j) {
                row_sum = add(row, y.taps.weights[j], row_sum);
            }
            if inner(k) {
                row_slope = add(row, y.taps.slopes[j], row_slope);
            }
        }
        if inner(k) {
            sum = add(row_sum, z.taps.weights[k], sum);
            along_y = add(row_slope, z.taps.weights[k], along_y);
        }
        along_z = add(row_sum, z.taps.slopes[k], along_z);
    }
    let Taps { weights, slopes } = &x.taps;
    let gradient = [
        across(sum, slopes, false),
        across(along_y, weights, LINEAR),
        across(along_z, weights, LINEAR),
    ];
    (base + across(sum, weights, LINEAR), gradient)
}

/// The value alone.
#[inline(always)]
fn gather_value<T: Scalar, const LINEAR: bool>(values: &[T], [x, y, z]: [&Axis; 3]) -> f32 {
    let base = values[z.at[1] + y.at[1] + x.at[1]].value();
    let inner = |tap: usize| !LINEAR || is_inner(tap);
    let mut sum = [0.0; 4];
    for k in (0..4).filter(|&k| inner(k)) {
        let mut row_sum = [0.0; 4];
        for j in (0..4).filter(|&j| inner(j)) {
            let row = row(values, x, z.at[k] + y.at[j]).map(|value| value - base);
            row_sum = add(row, y.taps.weights[j], row_sum);
        }
        sum = add(row_sum, z.taps.weights[k], sum);
    }
    base + across(sum, &x.taps.weights, LINEAR)
}

/// A row of numbers, each by what it counts; of a linear field the two in the middle.
#[inline(always)]
fn across(row: [f32; 4], taps: &[f32; 4], inner: bool) -> f32 {
    let middle = row[1] * taps[1] + row[2] * taps[2];
    if inner { middle } else { (row[0] * taps[0] + row[3] * taps[3]) + middle }
}

#[inline(always)]
fn finite(gradient: Vec3) -> Vec3 {
    // One test for all three: 0 times a number is 0, times anything else NaN.
    let probe = gradient * 0.0;
    if probe.x + probe.y + probe.z == 0.0 { gradient } else { Vec3::ZERO }
}

#[cfg(test)]
pub(crate) mod tests;
