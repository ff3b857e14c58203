//! A field at four places side by side: a vector is a row of four voxels of each, so that what is done to a row is done to four.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::{Level, Simd, SimdBase, SimdSplit, dispatch, f32x4, f32x16};

use super::super::filter::Taps;
use super::super::grid::Scalar;
use super::{Axis, FOUR, Field, SampledFour, Spot, is_inner, row};
use crate::components::Filter;
use crate::with_scalars;

/// The numbers of a vector: a row of four for each of four places.
const WIDE: usize = 16;
/// Which voxel of its row each number is of.
const TAP: [f32; WIDE] =
    [0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0];

/// The 4³ voxels around each of four places, and where these are in their cells.
struct VoxelsOfFour {
    /// Slices of rows along x.
    rows: [[[f32; WIDE]; 4]; 4],
    /// The first voxel of each cell.
    base: [f32; FOUR],
    places: PlacesOfFour,
}

/// Where four places are in their cells.
struct PlacesOfFour {
    /// The way through the cell on each axis.
    parts: [[f32; FOUR]; 3],
    /// Where the grid ends, on each axis.
    ends: [[[bool; 2]; FOUR]; 3],
}

impl Field<'_> {
    /// What the field is at some spots, four by four.
    #[inline]
    pub(super) fn fours<const LINEAR: bool>(
        &self,
        level: Level,
        spots: &[Spot],
        made: &mut [SampledFour],
    ) {
        let mut around = VoxelsOfFour {
            rows: [[[0.0; WIDE]; 4]; 4],
            base: [0.0; FOUR],
            places: PlacesOfFour { parts: [[0.0; FOUR]; 3], ends: [[[false; 2]; FOUR]; 3] },
        };
        for (spots, made) in spots.chunks(FOUR).zip(made) {
            with_scalars!(self.scalars, values => {
                dispatch!(level, _simd => self.look_up::<_, LINEAR>(values, spots, &mut around));
            });
            dispatch!(level, simd => self.gathered::<_, LINEAR>(simd, &around, made));
        }
    }

    /// The voxels around some of the four spots. Of a linear field, those that count for nothing are not looked at.
    #[inline(always)]
    fn look_up<T: Scalar, const LINEAR: bool>(
        &self,
        values: &[T],
        spots: &[Spot],
        around: &mut VoxelsOfFour,
    ) {
        let [along_x, along_y, along_z] = self.strides();
        for (spot, at) in spots.iter().zip(0..FOUR) {
            let x = self.axis(spot, 0, along_x);
            let y = self.axis(spot, 1, along_y);
            let z = self.axis(spot, 2, along_z);
            around.base[at] = values[z.at[1] + y.at[1] + x.at[1]].value();
            for k in 0..4 {
                for j in 0..4 {
                    if LINEAR && !is_inner(j) && !is_inner(k) {
                        continue;
                    }
                    let first = z.at[k] + y.at[j];
                    let made = &mut around.rows[k][j][FOUR * at..][..4];
                    // All of them before the first is written: a widening load.
                    let [a, b, c, d] = row(values, &x, first);
                    made.copy_from_slice(&[a.value(), b.value(), c.value(), d.value()]);
                }
            }
            for (axis, Axis { part, ends, .. }) in [x, y, z].into_iter().enumerate() {
                around.places.parts[axis][at] = part;
                around.places.ends[axis][at] = ends;
            }
        }
    }

    /// The value and the slopes, brought to the world.
    #[inline(always)]
    fn gathered<S: Simd, const LINEAR: bool>(
        &self,
        simd: S,
        around: &VoxelsOfFour,
        made: &mut SampledFour,
    ) {
        let PlacesOfFour { parts, ends } = &around.places;
        let filter = self.filter::<LINEAR>();
        let x = taps(simd, filter, &parts[0], &ends[0]);
        let y = taps(simd, filter, &parts[1], &ends[1]);
        let z = taps(simd, filter, &parts[2], &ends[2]);
        // Differences from a voxel of the cell: where nothing changes, no rounding makes a slope.
        let base = repeated(simd, &around.base);
        let zero = f32x16::splat(simd, 0.0);
        let (mut sum, mut along_y, mut along_z) = (zero, zero, zero);
        // Written out, and no loop: then nothing of it is in memory.
        macro_rules! row {
            ($k:literal, $j:literal, $row_sum:ident, $row_slope:ident) => {
                if !LINEAR || is_inner($j) || is_inner($k) {
                    let row = f32x16::from_slice(simd, &around.rows[$k][$j]) - base;
                    if !LINEAR || is_inner($j) {
                        $row_sum = row * y.weights[$j] + $row_sum;
                    }
                    if !LINEAR || is_inner($k) {
                        $row_slope = row * y.slopes[$j] + $row_slope;
                    }
                }
            };
        }
        macro_rules! slice {
            ($k:literal) => {
                let (mut row_sum, mut row_slope) = (zero, zero);
                row!($k, 0, row_sum, row_slope);
                row!($k, 1, row_sum, row_slope);
                row!($k, 2, row_sum, row_slope);
                row!($k, 3, row_sum, row_slope);
                if !LINEAR || is_inner($k) {
                    sum = row_sum * z.weights[$k] + sum;
                    along_y = row_slope * z.weights[$k] + along_y;
                }
                along_z = row_sum * z.slopes[$k] + along_z;
            };
        }
        slice!(0);
        slice!(1);
        slice!(2);
        slice!(3);
        let (weights, slopes) = (along_rows(simd, x.weights), along_rows(simd, x.slopes));
        let products = [sum * weights, sum * slopes, along_y * weights, along_z * weights];
        let (low, high) = across::<S, LINEAR>(simd, products).split();
        let ((value, x), (y, z)) = (low.split(), high.split());
        (f32x4::from_slice(simd, &around.base) + value).store_slice(&mut made.values);
        self.in_world(simd, [x, y, z], &mut made.gradients);
    }

    /// Gradients in the world; zero where they are no numbers.
    #[inline(always)]
    fn in_world<S: Simd>(&self, simd: S, [x, y, z]: [f32x4<S>; 3], made: &mut [[f32; FOUR]; 3]) {
        let [of_x, of_y, of_z] = self.to_world.to_cols_array_2d();
        let along_x = x * of_x[0] + y * of_y[0] + z * of_z[0];
        let along_y = x * of_x[1] + y * of_y[1] + z * of_z[1];
        let along_z = x * of_x[2] + y * of_y[2] + z * of_z[2];
        // One test for all three: 0 times a number is 0, times anything else NaN.
        let probe = along_x * 0.0 + along_y * 0.0 + along_z * 0.0;
        let zero = f32x4::splat(simd, 0.0);
        let is_finite = simd.simd_eq_f32x4(probe, zero);
        simd.select_f32x4(is_finite, along_x, zero).store_slice(&mut made[0]);
        simd.select_f32x4(is_finite, along_y, zero).store_slice(&mut made[1]);
        simd.select_f32x4(is_finite, along_z, zero).store_slice(&mut made[2]);
    }
}

/// Four numbers, each for a row of four.
#[inline(always)]
fn repeated<S: Simd>(simd: S, four: &[f32; FOUR]) -> f32x16<S> {
    let mut made = [0.0; WIDE];
    for n in 0..WIDE {
        made[n] = four[n / FOUR];
    }
    f32x16::from_slice(simd, &made)
}

/// What the voxels of an axis count at four places, for each number of a row.
#[inline(always)]
fn taps<S: Simd>(
    simd: S,
    filter: Filter,
    parts: &[f32; FOUR],
    ends: &[[bool; 2]; FOUR],
) -> Taps<f32x16<S>> {
    let mut taps = Taps::new(filter, repeated(simd, parts));
    if *ends != [[false; 2]; FOUR] {
        let ended = ended(filter, parts, *ends);
        for tap in 0..4 {
            taps.weights[tap] = f32x16::from_slice(simd, &ended.weights[tap]);
            taps.slopes[tap] = f32x16::from_slice(simd, &ended.slopes[tap]);
        }
    }
    taps
}

/// The same where the grid ends beside some of the places.
#[cold]
#[inline(never)]
fn ended(filter: Filter, parts: &[f32; FOUR], ends: [[bool; 2]; FOUR]) -> Taps<[f32; WIDE]> {
    let mut made = Taps { weights: [[0.0; WIDE]; 4], slopes: [[0.0; WIDE]; 4] };
    for n in 0..WIDE {
        let mut taps = Taps::new(filter, parts[n / FOUR]);
        if ends[n / FOUR] != [false; 2] {
            taps = taps.ended(ends[n / FOUR]);
        }
        for tap in 0..4 {
            made.weights[tap][n] = taps.weights[tap];
            made.slopes[tap][n] = taps.slopes[tap];
        }
    }
    made
}

/// Of what the four voxels of a row count, each number's own.
#[inline(always)]
fn along_rows<S: Simd>(simd: S, [first, second, third, fourth]: [f32x16<S>; 4]) -> f32x16<S> {
    let tap = f32x16::from_slice(simd, &TAP);
    let low = simd.select_f32x16(simd.simd_lt_f32x16(tap, f32x16::splat(simd, 1.0)), first, second);
    let high =
        simd.select_f32x16(simd.simd_lt_f32x16(tap, f32x16::splat(simd, 3.0)), third, fourth);
    simd.select_f32x16(simd.simd_lt_f32x16(tap, f32x16::splat(simd, 2.0)), low, high)
}

/// The sums of four vectors' rows, a vector after the other; of a linear field, of all but the second the two in the middle.
#[inline(always)]
fn across<S: Simd, const LINEAR: bool>(simd: S, [a, b, c, d]: [f32x16<S>; 4]) -> f32x16<S> {
    let even = [a.unzip_low(b), c.unzip_low(d)];
    let odd = [a.unzip_high(b), c.unzip_high(d)];
    let (first, third) = (even[0].unzip_low(even[1]), even[0].unzip_high(even[1]));
    let (second, fourth) = (odd[0].unzip_low(odd[1]), odd[0].unzip_high(odd[1]));
    let middle = second + third;
    let whole = (first + fourth) + middle;
    if !LINEAR {
        return whole;
    }
    let mut is_second = [0.0; WIDE];
    is_second[4..8].copy_from_slice(&[1.0; 4]);
    let is_second = f32x16::from_slice(simd, &is_second);
    simd.select_f32x16(simd.simd_eq_f32x16(is_second, f32x16::splat(simd, 1.0)), whole, middle)
}
