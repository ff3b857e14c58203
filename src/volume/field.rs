//! The scalars as a field: value and gradient anywhere between voxels, in numbers of the scanner's own type.
//!
//! A filter is four weights along each axis, and its derivative four slopes, so that one walk over 4³ voxels gives all four
//! numbers: rows of four voxels at once, of four places side by side, then columns, then slices. A product is rounded before it
//! is added to, so that no bit depends on the set of instructions.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

mod fours;
mod sampled;

use fearless_simd::{Level, dispatch};
use glam::Mat3;

use super::filter::Taps;
use super::grid::{Grid, Scalar, Scalars};
use crate::components::Filter;
use crate::with_scalars;
pub use sampled::{FOUR, Sampled, SampledFour, Spot};

/// Scalars on a grid, and what is between them.
#[derive(Clone, Copy)]
pub struct Field<'a> {
    scalars: &'a Scalars,
    size: [usize; 3],
    filter: Filter,
    /// From slopes per voxel to the world.
    to_world: Mat3,
}

/// The four voxels of an axis that a place is made of: steps in the array, and the way from the second to the third.
struct Axis {
    at: [usize; 4],
    part: f32,
    /// Whether the grid ends before the first or before the last of them.
    ends: [bool; 2],
}

impl Axis {
    /// What each of them counts.
    #[inline(always)]
    fn taps(&self, filter: Filter) -> Taps {
        let taps = Taps::new(filter, self.part);
        if self.ends == [false; 2] { taps } else { taps.ended(self.ends) }
    }
}

impl<'a> Field<'a> {
    /// The field of `scalars`, as many as `grid` has voxels; for [`Filter::Interpolating`] they are its coefficients.
    #[must_use]
    pub fn new(scalars: &'a Scalars, grid: &Grid, filter: Filter) -> Self {
        let to_world = grid.index_to_world.matrix3.inverse().transpose().as_mat3();
        Self { scalars, size: grid.size, filter, to_world }
    }

    /// Whether values are interpolated linearly: then a value is made of 8 voxels, and a gradient of 32.
    #[must_use]
    pub(crate) fn is_linear(&self) -> bool {
        self.filter == Filter::Linear
    }

    /// Fills in what the field is at some spots, which count as the nearest inside the grid.
    pub fn sample(&self, level: Level, spots: &[Spot], made: &mut [Sampled]) {
        for (spots, made) in spots.chunks(FOUR).zip(made.chunks_mut(FOUR)) {
            let mut four = [SampledFour::default()];
            self.sample_fours(level, spots, &mut four);
            made.iter_mut().enumerate().for_each(|(at, made)| *made = four[0].one(at));
        }
    }

    /// Fills in what the field is at some spots, four by four: to the last bit what [`sample`](Self::sample) finds. Behind the
    /// last of the spots its four are filled up with anything.
    pub fn sample_fours(&self, level: Level, spots: &[Spot], made: &mut [SampledFour]) {
        if self.filter == Filter::Linear {
            self.fours::<true>(level, spots, made);
        } else {
            self.fours::<false>(level, spots, made);
        }
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
            let [along_x, along_y, along_z] = self.strides();
            let x = self.axis(spot, 0, along_x);
            let y = self.axis(spot, 1, along_y);
            let z = self.axis(spot, 2, along_z);
            *made = gather_value::<T, LINEAR>(values, self.filter::<LINEAR>(), [&x, &y, &z]);
        }
    }

    /// The voxels of an axis that a spot is made of.
    #[inline(always)]
    fn axis(&self, spot: &Spot, axis: usize, stride: usize) -> Axis {
        let last = self.size[axis] - 1;
        // The last plane of voxels is the end of the last cell.
        let (cell, part) = if spot.cell[axis] >= last {
            (last - 1, 1.0)
        } else {
            (spot.cell[axis], spot.part[axis])
        };
        let ends = [cell == 0, cell + 2 > last];
        if ends[0] || ends[1] {
            let before = cell.saturating_sub(1);
            let at = [before, cell, cell + 1, (cell + 2).min(last)].map(|voxel| voxel * stride);
            return Axis { at, part, ends };
        }
        let first = (cell - 1) * stride;
        let at = [first, first + stride, first + 2 * stride, first + 3 * stride];
        Axis { at, part, ends }
    }

    /// Steps in the array from a voxel to the next on each axis.
    #[inline(always)]
    fn strides(&self) -> [usize; 3] {
        [1, self.size[0], self.size[0] * self.size[1]]
    }

    /// What is asked of the filter; of a linear field nothing at any sample.
    #[inline(always)]
    fn filter<const LINEAR: bool>(&self) -> Filter {
        if LINEAR { Filter::Linear } else { self.filter }
    }
}

/// Four voxels of the row that begins at `first`.
#[inline(always)]
fn row<T: Scalar>(values: &[T], x: &Axis, first: usize) -> [T; 4] {
    if x.ends == [false; 2] {
        let four = &values[first + x.at[0]..][..4];
        [four[0], four[1], four[2], four[3]]
    } else {
        ended_row(values, x, first)
    }
}

/// The same where the grid ends.
#[cold]
#[inline(never)]
fn ended_row<T: Scalar>(values: &[T], x: &Axis, first: usize) -> [T; 4] {
    x.at.map(|at| values[first + at])
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

/// The value alone.
#[inline(always)]
fn gather_value<T: Scalar, const LINEAR: bool>(
    values: &[T],
    filter: Filter,
    [x, y, z]: [&Axis; 3],
) -> f32 {
    let weights = [x.taps(filter).weights, y.taps(filter).weights, z.taps(filter).weights];
    let base = values[z.at[1] + y.at[1] + x.at[1]].value();
    let inner = |tap: usize| !LINEAR || is_inner(tap);
    let mut sum = [0.0; 4];
    for k in (0..4).filter(|&k| inner(k)) {
        let mut row_sum = [0.0; 4];
        for j in (0..4).filter(|&j| inner(j)) {
            let row = row(values, x, z.at[k] + y.at[j]).map(|value| value.value() - base);
            row_sum = add(row, weights[1][j], row_sum);
        }
        sum = add(row_sum, weights[2][k], sum);
    }
    base + across(sum, &weights[0], LINEAR)
}

/// A row of numbers, each by what it counts; of a linear field the two in the middle.
#[inline(always)]
fn across(row: [f32; 4], taps: &[f32; 4], inner: bool) -> f32 {
    let middle = row[1] * taps[1] + row[2] * taps[2];
    if inner { middle } else { (row[0] * taps[0] + row[3] * taps[3]) + middle }
}

#[cfg(test)]
pub(crate) mod tests;
