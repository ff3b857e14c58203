//! The scalars as a field: value and gradient anywhere between voxels, in numbers of the scanner's own type.
//!
//! A filter is four weights along each axis, and its derivative four slopes, so that one walk over 4³ voxels gives all four
//! numbers: rows of four voxels at once, then columns, then slices. A product is rounded before it is added to, so that no
//! bit depends on the set of instructions.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::{Level, Simd, SimdBase, dispatch, f32x4};
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
            dispatch!(level, simd => self.sample_all(simd, values, spots, made));
        });
    }

    #[inline(always)]
    fn sample_all<S: Simd, T: Scalar>(
        &self,
        simd: S,
        values: &[T],
        spots: &[Spot],
        made: &mut [Sampled],
    ) {
        for (spot, made) in spots.iter().zip(made) {
            let axes = self.axes(spot);
            let (value, slopes) = if self.filter == Filter::Linear {
                gather::<S, T, true>(simd, values, &axes)
            } else {
                gather::<S, T, false>(simd, values, &axes)
            };
            let [x, y, z] = slopes;
            let gradient = self.to_world.x_axis * x + self.to_world.y_axis * y;
            let gradient = gradient + self.to_world.z_axis * z;
            *made = Sampled { value, gradient: finite(gradient).to_array() };
        }
    }

    #[inline(always)]
    fn axes(&self, spot: &Spot) -> [Axis; 3] {
        let strides = [1, self.size[0], self.size[0] * self.size[1]];
        std::array::from_fn(|axis| {
            let (last, stride) = (self.size[axis] - 1, strides[axis]);
            // The last plane of voxels is the end of the last cell.
            let (cell, part) = if spot.cell[axis] >= last {
                (last - 1, 1.0)
            } else {
                (spot.cell[axis], spot.part[axis])
            };
            let ends = [cell == 0, cell + 2 > last];
            let taps = Taps::new(self.filter, part);
            let taps = if ends[0] || ends[1] { taps.ended(ends) } else { taps };
            let before = cell.saturating_sub(1);
            let at = [before, cell, cell + 1, (cell + 2).min(last)].map(|voxel| voxel * stride);
            Axis { at, taps }
        })
    }
}

/// The value, and the slopes per voxel. Of a linear field, what counts for nothing is not looked at.
#[inline(always)]
fn gather<S: Simd, T: Scalar, const LINEAR: bool>(
    simd: S,
    values: &[T],
    [x, y, z]: &[Axis; 3],
) -> (f32, [f32; 3]) {
    // Differences from a voxel of the cell: where nothing changes, no rounding makes a slope.
    let base = values[x.at[1] + y.at[1] + z.at[1]].value();
    let (zero, bases) = (f32x4::splat(simd, 0.0), f32x4::splat(simd, base));
    let inner = |tap: usize| !LINEAR || tap == 1 || tap == 2;
    let (mut sum, mut along_y, mut along_z) = (zero, zero, zero);
    for k in 0..4 {
        let (mut row_sum, mut row_slope) = (zero, zero);
        for j in 0..4 {
            if !inner(j) && !inner(k) {
                continue;
            }
            let row = f32x4::from_slice(simd, &row(values, z.at[k] + y.at[j], x.at)) - bases;
            if inner(j) {
                row_sum = row * y.taps.weights[j] + row_sum;
            }
            if inner(k) {
                row_slope = row * y.taps.slopes[j] + row_slope;
            }
        }
        if inner(k) {
            sum = row_sum * z.taps.weights[k] + sum;
            along_y = row_slope * z.taps.weights[k] + along_y;
        }
        along_z = row_sum * z.taps.slopes[k] + along_z;
    }
    let of = |row: f32x4<S>, taps: &[f32; 4], inner: bool| {
        let row = row.as_slice();
        let middle = row[1] * taps[1] + row[2] * taps[2];
        if inner { middle } else { (row[0] * taps[0] + row[3] * taps[3]) + middle }
    };
    let Taps { weights, slopes } = &x.taps;
    let gradient =
        [of(sum, slopes, false), of(along_y, weights, LINEAR), of(along_z, weights, LINEAR)];
    (base + of(sum, weights, LINEAR), gradient)
}

/// Four voxels of a row.
#[inline(always)]
fn row<T: Scalar>(values: &[T], first: usize, at: [usize; 4]) -> [f32; 4] {
    if at[3] - at[0] == 3 {
        let four = &values[first + at[0]..][..4];
        [four[0].value(), four[1].value(), four[2].value(), four[3].value()]
    } else {
        at.map(|at| values[first + at].value())
    }
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
