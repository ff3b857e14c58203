//! The histogram of a volume: how many voxels have a value in each of some equal bins.

use rayon::prelude::*;

use crate::volume::grid::{Scalar, Scalars};
use crate::with_scalars;

pub use super::isovalues::suggested_isovalues;

/// Voxels that one job counts.
const CHUNK: usize = 1 << 16;

/// Counts of voxels by value, and of voxels that have none.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// The least finite value; 0 if there is none.
    pub low: f32,
    /// The greatest finite value; 0 if there is none.
    pub high: f32,
    /// Voxels in each bin; the bins divide `low..=high` equally.
    pub counts: Vec<u64>,
    /// Voxels that are not a number.
    pub nan: u64,
    /// Voxels that are infinite, of either sign.
    pub infinite: u64,
}

/// Counts the voxels of a volume in `bins` equal bins between its least and greatest finite values.
///
/// No bins are taken as one. A volume of one value has all its voxels in bin 0. The counts are the same for any number
/// of threads.
#[must_use]
pub fn histogram(scalars: &Scalars, bins: usize) -> Histogram {
    with_scalars!(scalars, values => count(values, bins.max(1)))
}

fn count<T: Scalar>(values: &[T], bins: usize) -> Histogram {
    let bin = Bins::over(values, bins).unwrap_or(Bins { low: 0.0, high: 0.0, number: bins });
    let Bins { low, high, .. } = bin;
    let empty = || Histogram { low, high, counts: vec![0; bins], nan: 0, infinite: 0 };
    let part = |chunk: &[T]| {
        let mut part = empty();
        for &value in chunk {
            match value.value() {
                value if value.is_nan() => part.nan += 1,
                value if value.is_infinite() => part.infinite += 1,
                value => part.counts[bin.of(value)] += 1,
            }
        }
        part
    };
    values.par_chunks(CHUNK).map(part).reduce(empty, |a, b| a.plus(&b))
}

/// Equal bins between two finite values.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bins {
    pub low: f32,
    pub high: f32,
    pub number: usize,
}

impl Bins {
    /// Bins from the least to the greatest finite value; `None` if there is none.
    pub fn over<T: Scalar>(values: &[T], number: usize) -> Option<Self> {
        let nothing = (f32::INFINITY, f32::NEG_INFINITY);
        let wider = |(low, high): (f32, f32), (a, b): (f32, f32)| (low.min(a), high.max(b));
        let range = |chunk: &[T]| {
            let finite = chunk.iter().map(|v| v.value()).filter(|v| v.is_finite());
            finite.fold(nothing, |range, v| wider(range, (v, v)))
        };
        let (low, high) = values.par_chunks(CHUNK).map(range).reduce(|| nothing, wider);
        (low <= high).then_some(Self { low, high, number })
    }

    /// The value at a border between bins (bin i lies from i to i + 1).
    pub fn at(&self, border: f64) -> f32 {
        let part = border / self.number as f64;
        (f64::from(self.low) * (1.0 - part) + f64::from(self.high) * part) as f32
    }

    /// The bin of a finite value, the nearest for values out of the range. In 64 bits: a range of 32 may overflow.
    pub fn of(&self, value: f32) -> usize {
        let range = f64::from(self.high) - f64::from(self.low);
        let part = (f64::from(value) - f64::from(self.low)) / range;
        // A range of 0 gives NaN, which becomes bin 0.
        ((part * self.number as f64) as usize).min(self.number - 1)
    }
}

impl Histogram {
    /// The value in the middle of a bin.
    #[must_use]
    pub fn center(&self, bin: usize) -> f32 {
        let bins = Bins { low: self.low, high: self.high, number: self.counts.len() };
        bins.at(bin as f64 + 0.5)
    }

    /// The value that `part` (0..=1) of the finite voxels lie below, to within a bin; 0 where there is none.
    #[must_use]
    pub fn quantile(&self, part: f64) -> f32 {
        let finite: u64 = self.counts.iter().sum();
        let mut left = part * finite as f64;
        for (bin, &count) in self.counts.iter().enumerate() {
            if count as f64 >= left && count > 0 {
                let bins = Bins { low: self.low, high: self.high, number: self.counts.len() };
                return bins.at(bin as f64 + left / count as f64);
            }
            left -= count as f64;
        }
        self.high
    }

    fn plus(mut self, other: &Self) -> Self {
        self.counts.iter_mut().zip(&other.counts).for_each(|(a, b)| *a += b);
        self.nan += other.nan;
        self.infinite += other.infinite;
        self
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "these values are exact")]
mod tests {
    use super::*;
    use crate::shared::Shared;

    #[test]
    fn every_voxel_is_counted_once() {
        let values: Vec<f32> = (0..50_000_u16)
            .map(|i| if i % 10 == 0 { f32::NAN } else { f32::from(i % 64) })
            .collect();
        let made = histogram(&Scalars::F32(Shared::new(values)), 64);
        assert_eq!((made.low, made.high, made.nan), (0.0, 63.0, 5_000));
        assert_eq!(made.counts.iter().sum::<u64>(), 45_000);
    }

    #[test]
    fn the_ends_of_the_range_fall_into_the_first_and_last_bin() {
        let made = histogram(&Scalars::I16(Shared::new(vec![-1000, 0, 0, 3000])), 4);
        assert_eq!(made.counts, [1, 2, 0, 1]);
        assert_eq!(made.center(0), -500.0);
    }

    #[test]
    fn a_volume_without_a_finite_value_counts_what_it_has() {
        let values = vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
        let made = histogram(&Scalars::F32(Shared::new(values)), 0);
        assert_eq!((made.counts, made.nan, made.infinite), (vec![0], 1, 2));
    }

    #[test]
    fn quantiles_part_the_voxels_and_leave_out_those_of_no_value() {
        let values: Vec<f32> = (0..1000_u16).map(f32::from).chain([f32::NAN; 50]).collect();
        let made = histogram(&Scalars::F32(Shared::new(values)), 100);
        for part in [0.0, 0.01, 0.25, 0.5, 0.99, 1.0] {
            assert!((f64::from(made.quantile(part)) - 999.0 * part).abs() < 1.5, "{part}");
        }
        assert_eq!(histogram(&Scalars::F32(Shared::new(vec![f32::NAN])), 4).quantile(0.5), 0.0);
    }

    #[test]
    fn a_range_wider_than_a_float_holds_is_no_overflow() {
        let made = histogram(&Scalars::F32(Shared::new(vec![f32::MIN, 0.0, f32::MAX])), 3);
        assert_eq!(made.counts, [1, 1, 1]);
    }
}
