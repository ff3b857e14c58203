//! The greatest, the least and the mean of the scalars at the samples of one ray.

use crate::view::samples::Counts;
use crate::view::walk::{self, FRACTION_BITS, Tile};
use crate::volume::bricks::EDGE;
use crate::volume::grid::Scalar;

/// A ray of a tile in a volume, from the first sample inside on.
pub(crate) struct Sought<'a> {
    /// The tile.
    pub tile: &'a Tile,
    /// The number of the ray in it.
    pub lane: usize,
    /// Voxels on each axis.
    pub size: [usize; 3],
    /// The first sample inside.
    pub first: i64,
}

/// What was found along a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Found {
    /// The value that is shown.
    pub value: f32,
    /// The number of its sample; between two numbers where it lies between two samples.
    pub sample: f64,
    /// The sum of the densities of all samples, where these have any, each times the samples' distances that it stands for.
    pub sum: f64,
}

impl Sought<'_> {
    /// The value that is `better` than all before it, and the sum of all densities, which are 0 or above; bricks that have a bound,
    /// and no better one than what was found, are leapt over. `holds` says whether a sample is to be looked at, `is_kept` whether its
    /// value counts.
    pub fn best<T: Scalar>(
        &self,
        (values, holds, is_kept): (&[T], impl Fn(i64) -> bool, impl Fn(i64) -> bool),
        (better, density): (impl Fn(f32, f32) -> bool, impl Fn(f32) -> f64),
        bound: impl Fn([usize; 3]) -> Option<f32>,
        counts: &mut Counts,
    ) -> Option<Found> {
        let (mut found, mut k): (Option<(f32, i64)>, i64) = (None, self.first);
        let mut sum = 0.0;
        let mut bounded = ([usize::MAX; 3], None);
        while holds(k) {
            let place = self.place(k);
            let cell = self.cell(place);
            let brick = cell.map(|n| n / EDGE);
            if brick != bounded.0 {
                bounded = (brick, bound(brick));
            }
            let surpassed = |best: f32| bounded.1.is_some_and(|bound| !better(bound, best));
            if found.is_some_and(|(best, _)| surpassed(best)) {
                counts.cells_skipped += 1;
                k += self.steps_within(place, brick) + 1;
                continue;
            }
            counts.samples += 1;
            let value = self.value(values, place, cell);
            let surpasses = found.map_or(!value.is_nan(), |(best, _)| better(value, best));
            let density = density(value);
            if (surpasses || density > 0.0) && is_kept(k) {
                sum += density;
                found = if surpasses { Some((value, k)) } else { found };
            }
            k += 1;
        }
        found.map(|(value, sample)| Found { value, sample: sample as f64, sum })
    }

    /// The value at a place that no sample need lie on, a number of a sample or between two; its density counts for so many
    /// samples' distances.
    pub fn between<T: Scalar>(
        &self,
        values: &[T],
        (sample, way): (f64, f64),
        density: impl Fn(f32) -> f64,
        counts: &mut Counts,
    ) -> Option<Found> {
        counts.samples += 1;
        let place = std::array::from_fn(|axis| {
            let last = ((self.size[axis] - 1) as i64) << FRACTION_BITS;
            self.tile.place_between(axis, self.lane, sample).clamp(0, last)
        });
        let value = self.value(values, place, self.cell(place));
        let found = Found { value, sample, sum: density(value) * way };
        value.is_finite().then_some(found)
    }

    /// The mean of all values that count, and the number of the last sample.
    pub fn mean<T: Scalar>(
        &self,
        (values, holds, is_kept): (&[T], impl Fn(i64) -> bool, impl Fn(i64) -> bool),
        counts: &mut Counts,
    ) -> Option<Found> {
        let (mut sum, mut number, mut last) = (0.0_f64, 0_u64, self.first);
        let mut k = self.first;
        while holds(k) {
            counts.samples += 1;
            let place = self.place(k);
            let value = self.value(values, place, self.cell(place));
            if value.is_finite() && is_kept(k) {
                sum += f64::from(value);
                number += 1;
                last = k;
            }
            k += 1;
        }
        let value = (sum / number as f64) as f32;
        (number > 0).then_some(Found { value, sample: last as f64, sum: 0.0 })
    }

    fn place(&self, k: i64) -> [i64; 3] {
        std::array::from_fn(|axis| self.tile.place(axis, self.lane, k))
    }

    /// The cell around a place; the last plane of voxels belongs to the cells before it.
    fn cell(&self, place: [i64; 3]) -> [usize; 3] {
        std::array::from_fn(|axis| {
            ((place[axis] >> FRACTION_BITS).max(0) as usize).min(self.size[axis] - 2)
        })
    }

    /// How many steps from `place` on stay within a brick.
    fn steps_within(&self, place: [i64; 3], brick: [usize; 3]) -> i64 {
        let axis = |axis: usize| {
            let step = self.tile.step[axis][self.lane];
            let low = ((brick[axis] * EDGE) as i64) << FRACTION_BITS;
            let high = (((brick[axis] + 1) * EDGE) as i64) << FRACTION_BITS;
            match step {
                0 => i64::MAX,
                1.. => (high - 1 - place[axis]) / step,
                _ => (place[axis] - low) / -step,
            }
        };
        // Not at all where the place is on the last plane of voxels, which is beyond the brick.
        (0..3).map(axis).min().unwrap_or(0).clamp(0, 1 << 40)
    }

    /// Tri-linear interpolation, never outside the voxels that it is between: what rounding adds is taken off again. A NaN
    /// counts as what is beside it.
    fn value<T: Scalar>(&self, values: &[T], place: [i64; 3], cell: [usize; 3]) -> f32 {
        let [nx, ny, _] = self.size;
        let part: [f32; 3] = std::array::from_fn(|axis| {
            walk::part(place[axis] - ((cell[axis] as i64) << FRACTION_BITS))
        });
        let first = (cell[2] * ny + cell[1]) * nx + cell[0];
        let row = |offset: usize| {
            let pair = &values[first + offset..][..2];
            between(pair[0].value(), pair[1].value(), part[0])
        };
        let slice = |offset: usize| between(row(offset), row(offset + nx), part[1]);
        between(slice(0), slice(nx * ny), part[2])
    }
}

#[inline]
fn between(low: f32, high: f32, part: f32) -> f32 {
    (low + (high - low) * part).max(low.min(high)).min(low.max(high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_between_two_values_is_never_outside_them() {
        for (low, high) in [(0.1, 0.3), (0.3, 0.1), (7.0, 7.0), (-1e30, 1e-30), (16_777_215.0, 1.0)]
        {
            for n in 0..=100 {
                let value = between(low, high, n as f32 / 100.0);
                assert!(value >= low.min(high) && value <= low.max(high), "{low} {high} {n}");
            }
        }
        assert_eq!(between(f32::NAN, 3.0, 0.25), 3.0);
        assert!(between(f32::NAN, f32::NAN, 0.5).is_nan());
    }
}
