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
            dispatch!(level, _simd => self.sample_all(values, spots, made));
        });
    }

    #[inline(always)]
    fn sample_all<T: Scalar>(&self, values: &[T], spots: &[Spot], made: &mut [Sampled]) {
        for (spot, made) in spots.iter().zip(made) {
            // One by one: an array of them that a closure makes is written in pieces and waited for as a whole.
            let (x, y) = (self.axis(spot, 0, 1), self.axis(spot, 1, self.size[0]));
            let z = self.axis(spot, 2, self.size[0] * self.size[1]);
            let axes = [&x, &y, &z];
            let (value, slopes) = if self.filter == Filter::Linear {
                gather::<T, true>(values, axes)
            } else {
                gather::<T, false>(values, axes)
            };
            let [x, y, z] = slopes;
            let gradient = self.to_world.x_axis * x + self.to_world.y_axis * y;
            let gradient = gradient + self.to_world.z_axis * z;
            *made = Sampled { value, gradient: finite(gradient).to_array() };
        }
    }

    /// The voxels of an axis that a spot is made of, and whether they lie side by side.
    #[inline(always)]
    fn axis(&self, spot: &Spot, axis: usize, stride: usize) -> Axis {
        let last = self.size[axis] - 1;
        // The last plane of voxels is the end of the last cell.
        let (cell, part) = if spot.cell[axis] >= last {
            (last - 1, 1.0)
        } else {
            (spot.cell[axis], spot.part[axis])
        };
        let taps = Taps::new(self.filter, part);
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
        for (j, row) in slice.iter_mut().enumerate() {
            if LINEAR && !is_inner(j) && !is_inner(k) {
                continue;
            }
            let first = z.at[k] + y.at[j];
            if x.whole {
                let four = &values[first + x.at[0]..][..4];
                *row = [four[0].value(), four[1].value(), four[2].value(), four[3].value()];
            } else {
                *row = x.at.map(|at| values[first + at].value());
            }
        }
    }
    block
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
    let of = |row: [f32; 4], taps: &[f32; 4], inner: bool| {
        let middle = row[1] * taps[1] + row[2] * taps[2];
        if inner { middle } else { (row[0] * taps[0] + row[3] * taps[3]) + middle }
    };
    let Taps { weights, slopes } = &x.taps;
    let gradient =
        [of(sum, slopes, false), of(along_y, weights, LINEAR), of(along_z, weights, LINEAR)];
    (base + of(sum, weights, LINEAR), gradient)
}

#[inline(always)]
fn finite(gradient: Vec3) -> Vec3 {
    // One test for all three: 0 times a number is 0, times anything else NaN.
    let probe = gradient * 0.0;
    if probe.x + probe.y + probe.z == 0.0 { gradient } else { Vec3::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Filter; 4] =
        [Filter::Linear, Filter::Cubic, Filter::CatmullRom, Filter::Interpolating];

    fn levels() -> Vec<Level> {
        let best = Level::new();
        let mut levels = vec![best, Level::baseline()];
        #[cfg(target_arch = "x86_64")]
        {
            levels.extend(best.as_avx2().map(Level::Avx2));
            levels.extend(best.as_sse4_2().map(Level::Sse4_2));
        }
        levels
    }

    /// Spots all over a grid, on its borders and on voxels too.
    fn spots(size: [usize; 3]) -> Vec<Spot> {
        let all = 0..4 * size.iter().product::<usize>();
        let part = |n: usize| (n % 5) as f32 / 4.0;
        let spot = |at: usize| {
            let cell = [at % size[0], at / size[0] % size[1], at / (size[0] * size[1]) % size[2]];
            Spot { cell, part: [part(at), part(at / 3), part(at * 7 / 5)] }
        };
        all.map(spot).collect()
    }

    fn sampled(field: &Field, level: Level, spots: &[Spot]) -> Vec<Sampled> {
        let mut made = vec![Sampled::default(); spots.len()];
        field.sample(level, spots, &mut made);
        made
    }

    #[test]
    fn a_linear_field_and_its_gradient_are_exact_in_every_filter_up_to_the_borders() {
        let grid = Grid::axis_aligned([5, 2, 3], [0.5, 2.0, -1.0], [0.0; 3]).unwrap();
        let value = |x: usize, y: usize, z: usize| (3 * x + 8 * y + 5 * z) as u16;
        let voxels: Vec<u16> = (0..30).map(|at| value(at % 5, at / 5 % 2, at / 10)).collect();
        let scalars = Scalars::from(voxels);
        for filter in ALL {
            let field = Field::new(&scalars, &grid, filter);
            for spot in spots(grid.size) {
                let inside = (0..3).all(|axis| spot.cell[axis] + 1 < grid.size[axis]);
                let place: [f32; 3] =
                    std::array::from_fn(|axis| spot.cell[axis] as f32 + spot.part[axis]);
                let Sampled { value, gradient } = sampled(&field, Level::new(), &[spot])[0];
                let expected = 3.0 * place[0] + 8.0 * place[1] + 5.0 * place[2];
                assert!(!inside || (value - expected).abs() < 1e-4, "{filter:?} {spot:?} {value}");
                let [x, y, z] = gradient;
                let slope = (x - 6.0).abs().max((y - 4.0).abs()).max((z + 5.0).abs());
                assert!(slope < 1e-4, "{filter:?} {spot:?} {gradient:?}");
            }
        }
    }

    #[test]
    fn no_bit_depends_on_the_set_of_instructions() {
        let grid = Grid::axis_aligned([7, 6, 5], [0.7, 1.1, 0.9], [0.0; 3]).unwrap();
        let voxels: Vec<f32> = (0..210).map(|at| (at * at % 97) as f32 / 7.0).collect();
        let scalars = Scalars::from(voxels);
        for filter in ALL {
            let field = Field::new(&scalars, &grid, filter);
            let spots = spots(grid.size);
            let best = sampled(&field, Level::new(), &spots);
            for level in levels() {
                assert_eq!(sampled(&field, level, &spots), best, "{filter:?} {level:?}");
            }
        }
    }

    #[test]
    fn what_is_no_number_is_told_and_where_nothing_changes_there_is_no_gradient() {
        let grid = Grid::axis_aligned([6; 3], [0.7, 1.1, 0.9], [0.0; 3]).unwrap();
        let mut voxels = vec![0.3_f32; 216];
        let constant = Scalars::from(&voxels);
        voxels[0] = f32::NAN;
        let holed = Scalars::from(voxels);
        for filter in ALL {
            let same = sampled(&Field::new(&constant, &grid, filter), Level::new(), &spots([6; 3]));
            assert!(same.iter().all(|s| *s == Sampled { value: 0.3, gradient: [0.0; 3] }));
            let field = Field::new(&holed, &grid, filter);
            let near = Spot { cell: [0; 3], part: [0.5; 3] };
            let far = Spot { cell: [3; 3], part: [0.5; 3] };
            let made = sampled(&field, Level::new(), &[near, far]);
            assert!(made[0].value.is_nan() && made[0].gradient == [0.0; 3]);
            assert_eq!(made[1], Sampled { value: 0.3, gradient: [0.0; 3] });
        }
    }
}
