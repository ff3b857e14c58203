//! Between which scalars a brick of voxels lies, and how far apart they are: what rules out that any of it is seen.

use std::sync::Arc;

use rayon::prelude::*;

use super::bricks::EDGE;
use super::grid::{Scalar, Scalars};
use crate::schedule::{Product, Watch};
use crate::with_scalars;

/// The range of the scalars in and around each brick of a volume: a fiftieth of the bytes of its voxels, or less.
///
/// Depends on the scalars alone, so that it is kept over every edit of a classification. Equality is identity.
#[derive(Debug, Clone)]
pub struct Ranges(Arc<Found>);

impl Product for Ranges {}

impl PartialEq for Ranges {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

#[derive(Debug)]
struct Found {
    counts: [usize; 3],
    bricks: Vec<Range>,
    nan_voxels: u64,
}

/// Between which numbers the scalars of some voxels lie. A NaN does not count: of NaNs alone `low` is above `high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The smallest.
    pub low: f32,
    /// The largest.
    pub high: f32,
    /// How far they are apart, rounded once from the numbers in their own type; 0 of none.
    pub spread: f32,
}

impl Ranges {
    /// The ranges of scalars on a grid of `size` voxels, each of a brick and the voxels next to it: all that its gradients need.
    ///
    /// Stops early, with ranges of no meaning, if `watch` is told to.
    #[must_use]
    pub fn of(scalars: &Scalars, size: [usize; 3], watch: &Watch) -> Self {
        let counts = size.map(|n| n.div_ceil(EDGE));
        let nothing = Range { low: 0.0, high: 0.0, spread: 0.0 };
        let mut bricks = vec![nothing; counts.iter().product()];
        let nan_voxels = with_scalars!(scalars, values => {
            let rows = bricks.par_chunks_mut(counts[0]).enumerate();
            rows.map_init(|| Extremes::new(size[0]), |extremes, (row, made)| {
                if watch.check().is_err() {
                    return 0;
                }
                extremes.row_of_bricks(values, size, [row % counts[1], row / counts[1]], made)
            }).sum()
        });
        Self(Arc::new(Found { counts, bricks, nan_voxels }))
    }

    /// The range in and around a brick. Panics outside the grid.
    #[must_use]
    #[inline]
    pub fn around(&self, [x, y, z]: [usize; 3]) -> Range {
        let Found { counts, bricks, .. } = &*self.0;
        bricks[(z * counts[1] + y) * counts[0] + x]
    }

    /// How many voxels hold a NaN.
    #[must_use]
    pub fn nan_voxels(&self) -> u64 {
        self.0.nan_voxels
    }

    /// Whether every voxel holds a finite number.
    #[must_use]
    pub fn are_finite(&self) -> bool {
        let Found { bricks, nan_voxels, .. } = &*self.0;
        *nan_voxels == 0
            && bricks.iter().all(|range| range.low.is_finite() && range.high.is_finite())
    }

    /// Bytes that the ranges take.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        (self.0.bricks.len() * size_of::<Range>()) as u64
    }
}

/// The bytes that the ranges of a grid of `size` voxels take, for a plan.
#[must_use]
pub fn bytes(size: [usize; 3]) -> u64 {
    let bricks = size.iter().map(|n| n.div_ceil(EDGE) as u64);
    bricks.fold(size_of::<Range>() as u64, u64::saturating_mul)
}

/// The extremes of the columns of a row of bricks: of 10 × 10 lines of voxels, place by place along x.
struct Extremes<T> {
    least: Vec<T>,
    most: Vec<T>,
}

impl<T: Scalar> Extremes<T> {
    fn new(nx: usize) -> Self {
        Self { least: vec![T::ENDS[0]; nx], most: vec![T::ENDS[1]; nx] }
    }

    /// Fills in the ranges of the bricks `[.., y, z]`; how many voxels in them are NaN.
    fn row_of_bricks(
        &mut self,
        values: &[T],
        size: [usize; 3],
        yz: [usize; 2],
        made: &mut [Range],
    ) -> u64 {
        let [nx, ny, nz] = size;
        let [own_y, own_z] = [0, 1].map(|i| (yz[i] * EDGE)..((yz[i] + 1) * EDGE).min(size[i + 1]));
        let wider = |own: &std::ops::Range<usize>, n: usize| {
            own.start.saturating_sub(1)..(own.end + 1).min(n)
        };
        self.least.fill(T::ENDS[0]);
        self.most.fill(T::ENDS[1]);
        let mut nan_voxels = 0;
        for z in wider(&own_z, nz) {
            for y in wider(&own_y, ny) {
                let line = &values[(z * ny + y) * nx..][..nx];
                self.take(line);
                if T::HAS_NAN && own_z.contains(&z) && own_y.contains(&y) {
                    nan_voxels += line.iter().filter(|value| value.value().is_nan()).count() as u64;
                }
            }
        }
        for (x, range) in made.iter_mut().enumerate() {
            *range = self.range(wider(&(x * EDGE..((x + 1) * EDGE).min(nx)), nx));
        }
        nan_voxels
    }

    fn take(&mut self, line: &[T]) {
        for ((least, most), value) in self.least.iter_mut().zip(&mut self.most).zip(line) {
            *least = least.least(*value);
            *most = most.most(*value);
        }
    }

    fn range(&self, columns: std::ops::Range<usize>) -> Range {
        let least = self.least[columns.clone()].iter().fold(T::ENDS[0], |a, b| a.least(*b));
        let most = self.most[columns].iter().fold(T::ENDS[1], |a, b| a.most(*b));
        let (low, high) = (least.value(), most.value());
        // Of equal infinities, and of numbers of which one is infinite, nothing is known: they count as far apart.
        let spread = if low > high { 0.0 } else { most.minus(least) };
        Range { low, high, spread: if spread.is_nan() { f32::INFINITY } else { spread } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::Shared;

    fn check(scalars: &Scalars, size: [usize; 3]) -> Ranges {
        let ranges = Ranges::of(scalars, size, &Watch::default());
        let counts = size.map(|n| n.div_ceil(EDGE));
        for at in 0..counts.iter().product() {
            let brick = [at % counts[0], at / counts[0] % counts[1], at / (counts[0] * counts[1])];
            let near = |voxel: [usize; 3]| {
                (0..3).all(|a| voxel[a] + 1 >= brick[a] * EDGE && voxel[a] <= (brick[a] + 1) * EDGE)
            };
            let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
            for at in 0..scalars.len() {
                if near([at % size[0], at / size[0] % size[1], at / (size[0] * size[1])]) {
                    low = low.min(scalars.value(at));
                    high = high.max(scalars.value(at));
                }
            }
            let Range { low: l, high: h, spread } = ranges.around(brick);
            assert_eq!([l, h], [low, high], "{brick:?}");
            assert!(low > high && spread == 0.0 || spread >= high - low || spread == f32::INFINITY);
        }
        assert_eq!(ranges.bytes(), bytes(size));
        ranges
    }

    #[test]
    fn a_range_is_that_of_a_brick_and_the_voxels_next_to_it() {
        for size in [[8, 8, 8], [9, 17, 7], [2, 3, 25]] {
            let n: usize = size.iter().product();
            let value = |at: usize| at * at % 251;
            check(&Scalars::U8(Shared::new((0..n).map(|at| value(at) as u8).collect())), size);
            check(
                &Scalars::I16(Shared::new((0..n).map(|at| value(at) as i16 - 99).collect())),
                size,
            );
            check(
                &Scalars::F64(Shared::new((0..n).map(|at| value(at) as f64 / 3.0).collect())),
                size,
            );
        }
    }

    #[test]
    fn a_nan_is_counted_and_no_part_of_a_range_and_infinities_are_far_apart() {
        let mut values = vec![f32::NAN; 24 * 24 * 24];
        values[0] = 3.0;
        values[23] = f32::INFINITY;
        let ranges = check(&Scalars::F32(Shared::new(values)), [24; 3]);
        assert_eq!(ranges.nan_voxels(), 24 * 24 * 24 - 2);
        assert_eq!(ranges.around([0; 3]), Range { low: 3.0, high: 3.0, spread: 0.0 });
        assert_eq!(ranges.around([2, 0, 0]).spread, f32::INFINITY);
        assert_eq!(ranges.around([1; 3]).spread, 0.0);
        assert!(!ranges.are_finite());
        let infinite =
            Scalars::F32(Shared::new(vec![0.0, f32::INFINITY, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        assert!(!check(&infinite, [2; 3]).are_finite());
    }

    #[test]
    fn a_spread_is_known_where_numbers_of_32_bits_are_alike() {
        let values = (0..512).map(|at| (1_u64 << 60) + at).collect();
        let ranges = check(&Scalars::U64(Shared::new(values)), [8; 3]);
        assert!(ranges.are_finite());
        let Range { low, high, spread } = ranges.around([0; 3]);
        assert!(low == high && spread == 511.0);
    }
}
