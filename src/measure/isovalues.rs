//! Isovalues worth a contour: between materials, where the values of neighbouring voxels differ most.
//!
//! For each value v, N(v) counts the pairs of neighbours along a row that lie on either side of v (the area of its
//! contour), and S(v) sums their differences. S / √N (the mean difference times the root of the area) peaks where
//! materials meet; it is a discrete relative of the gradient integral of Pekar, Wiemker and Hempel, "Fast detection of
//! meaningful isosurfaces for volume data visualization", 2001. The peaks part the voxels that resemble a neighbour into
//! materials, and the value suggested is as many standard deviations above the one material as below the other: soft
//! tissue, which varies little, beside bone, which varies much, draws the contour of bone to itself, as thin bone wants.

use std::ops::Range;

use rayon::prelude::*;

use super::histogram::Bins;
use crate::volume::grid::{Scalar, Scalars};
use crate::with_scalars;

/// Bins of values, and places where a contour is tried.
const BINS: usize = 256;

/// Pairs of voxels that one job counts.
const CHUNK: usize = 1 << 16;

/// Values suggested at most.
const MOST: usize = 4;

/// A peak counts if the score falls under this part of it on the way to any higher one.
const PROMINENT: f64 = 0.8;

/// A peak counts if its score is this part of the highest.
const STRONG: f64 = 0.2;

/// Bins added to each standard deviation: 3% of the range, so that a material without any noise (the air of a phantom)
/// does not draw the contour onto itself.
const FLOOR: f64 = 8.0;

/// Isovalues worth a contour, the most striking first, at most 4; none for a volume of one value or of none.
///
/// The same for any number of threads.
#[must_use]
pub fn suggested_isovalues(scalars: &Scalars) -> Vec<f32> {
    with_scalars!(scalars, values => suggest(values))
}

fn suggest<T: Scalar>(values: &[T]) -> Vec<f32> {
    let Some(bins) = Bins::over(values, BINS).filter(|bins| bins.low < bins.high) else {
        return Vec::new();
    };
    let crossings = crossings(values, bins);
    let scores = crossings.scores();
    let mut peaks = peaks(&scores);
    peaks.insert(0, 0);
    peaks.push(BINS);
    let found = peaks.windows(3).map(|part| {
        let border = between(&crossings.flat, [part[0], part[1], part[2]]);
        (scores[part[1]], bins.at(border))
    });
    let mut found: Vec<(f64, f32)> = found.collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.total_cmp(&b.1)));
    found.into_iter().take(MOST).map(|(_, value)| value).collect()
}

/// Per border between bins (border i is below bin i): pairs of neighbours across it, and the bins they span in all.
struct Crossings {
    pairs: Vec<i64>,
    spans: Vec<i64>,
    /// Per bin: pairs that stay within it.
    flat: Vec<i64>,
}

impl Crossings {
    fn none() -> Self {
        Self { pairs: vec![0; BINS + 1], spans: vec![0; BINS + 1], flat: vec![0; BINS] }
    }

    fn plus(mut self, other: &Self) -> Self {
        self.pairs.iter_mut().zip(&other.pairs).for_each(|(a, b)| *a += b);
        self.spans.iter_mut().zip(&other.spans).for_each(|(a, b)| *a += b);
        self.flat.iter_mut().zip(&other.flat).for_each(|(a, b)| *a += b);
        self
    }

    /// S / √N at each border. Pairs that stay within a bin beside it count to N: there a contour would be everywhere.
    fn scores(&self) -> Vec<f64> {
        let flat = |bin: usize| self.flat.get(bin).copied().unwrap_or(0);
        let score = |border: usize| {
            let beside = flat(border) + border.checked_sub(1).map_or(0, flat);
            self.spans[border] as f64 / ((self.pairs[border] + beside).max(1) as f64).sqrt()
        };
        (0..=BINS).map(score).collect()
    }
}

/// Counts the pairs in whole numbers, so that the order of the sums is of no account.
fn crossings<T: Scalar>(values: &[T], bins: Bins) -> Crossings {
    let jobs = values.len().div_ceil(CHUNK);
    let job = |job: usize| {
        let end = values.len().min((job + 1) * CHUNK + 1);
        steps(&values[job * CHUNK..end], bins)
    };
    let mut total = (0..jobs).into_par_iter().map(job).reduce(Crossings::none, |a, b| a.plus(&b));
    for border in 1..=BINS {
        total.pairs[border] += total.pairs[border - 1];
        total.spans[border] += total.spans[border - 1];
    }
    total
}

/// Where the counts of a run of voxels rise and fall: summed from the first border on, they are the crossings.
fn steps<T: Scalar>(values: &[T], bins: Bins) -> Crossings {
    let mut steps = Crossings::none();
    let mut last: Option<usize> = None;
    for value in values.iter().map(|v| v.value()) {
        let here = value.is_finite().then(|| bins.of(value));
        if let (Some(a), Some(b)) = (last, here) {
            if a == b {
                steps.flat[a] += 1;
                continue;
            }
            let (low, high) = (a.min(b), a.max(b));
            let span = (high - low) as i64;
            steps.pairs[low + 1] += 1;
            steps.spans[low + 1] += span;
            steps.pairs[high + 1] -= 1;
            steps.spans[high + 1] -= span;
        }
        last = here;
    }
    steps
}

/// The prominent peaks of the scores, rising; the middle of a flat one.
fn peaks(scores: &[f64]) -> Vec<usize> {
    let highest = scores.iter().copied().fold(0.0, f64::max);
    let mut found = Vec::new();
    let mut candidate: Option<usize> = None;
    let mut valley = 0.0;
    for (border, &score) in scores.iter().enumerate() {
        match candidate {
            // The way down from a candidate: it counts as soon as the fall is deep enough.
            Some(peak) if score < PROMINENT * scores[peak] => {
                found.push(peak);
                (candidate, valley) = (None, score);
            }
            Some(peak) if score > scores[peak] => candidate = Some(border),
            Some(_) => {}
            None if score * PROMINENT > valley => candidate = Some(border),
            None => valley = valley.min(score),
        }
    }
    found.extend(candidate);
    found.retain(|&peak| scores[peak] >= STRONG * highest);
    found.into_iter().map(|peak| flat_middle(scores, peak)).collect()
}

fn flat_middle(scores: &[f64], first: usize) -> usize {
    let level = scores[first..].iter().take_while(|&&score| score >= scores[first]).count();
    first + level / 2
}

/// The border, between bins, as many standard deviations above the voxels of bins `a..b` as below those of `b..c`.
fn between(flat: &[i64], [a, b, c]: [usize; 3]) -> f64 {
    let (below, above) = (spread(flat, a..b), spread(flat, b..c));
    let part = below.1 / (below.1 + above.1);
    below.0 + (above.0 - below.0) * part
}

/// Mean and standard deviation, in bins, of the counts in a range of bins, the latter widened by [`FLOOR`].
fn spread(counts: &[i64], bins: Range<usize>) -> (f64, f64) {
    let moment = |weight: fn(f64) -> f64| -> f64 {
        let term = |bin: usize| counts[bin] as f64 * weight(bin as f64 + 0.5);
        bins.clone().map(term).sum()
    };
    let voxels = moment(|_| 1.0);
    if voxels == 0.0 {
        return ((bins.start + bins.end) as f64 / 2.0, FLOOR);
    }
    let mean = moment(|at| at) / voxels;
    (mean, (moment(|at| at * at) / voxels - mean * mean).max(0.0).sqrt() + FLOOR)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::Voxels;
    use crate::phantom::{ball, phantom};
    use crate::shared::Shared;

    fn of(values: Vec<f32>) -> Vec<f32> {
        suggested_isovalues(&Scalars::F32(Shared::new(values)))
    }

    /// Runs of one value after another, as rows through bodies of several materials.
    fn bodies(materials: &[f32]) -> Vec<f32> {
        materials.iter().flat_map(|&value| [value; 50]).cycle().take(100_000).collect()
    }

    #[test]
    fn two_values_are_parted_at_their_midpoint() {
        assert_eq!(of(bodies(&[-100.0, 300.0])), [100.0]);
        assert_eq!(of(vec![f32::MIN, f32::MAX]), [0.0]);
    }

    #[test]
    fn three_materials_have_a_value_between_each_two() {
        let mut found = of(bodies(&[0.0, 100.0, 300.0, 100.0]));
        found.sort_by(f32::total_cmp);
        assert_eq!(found.len(), 2);
        assert!((found[0] - 50.0).abs() < 2.0 && (found[1] - 200.0).abs() < 2.0, "{found:?}");
    }

    #[test]
    fn the_edge_of_a_smooth_ball_is_suggested() {
        let Voxels::Scalars(scalars) = ball([64; 3], 24.0).voxels else { unreachable!() };
        let found = suggested_isovalues(&scalars);
        assert!(found.len() == 1 && (0.35..0.65).contains(&found[0]), "{found:?}");
    }

    #[test]
    fn a_volume_of_one_value_of_none_or_of_nan_suggests_nothing() {
        assert!(of(vec![7.0; 100]).is_empty());
        assert!(of(Vec::new()).is_empty());
        assert!(of(vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::NAN]).is_empty());
        assert!(of(vec![f32::NAN, 1.0, f32::INFINITY]).is_empty());
    }

    #[test]
    fn never_more_than_four_are_suggested_and_all_lie_within_the_values() {
        let many: Vec<f32> = (0..9_u8).map(|i| f32::from(i) * 10.0).collect();
        let found = of(bodies(&many));
        assert!(found.len() <= MOST && found.iter().all(|v| (0.0..=80.0).contains(v)), "{found:?}");
    }

    #[test]
    fn skin_and_bone_are_found_in_the_head_with_one_thread_as_with_two() {
        let Voxels::Scalars(scalars) = phantom("head").unwrap().voxels else { unreachable!() };
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| suggested_isovalues(&scalars))
        };
        let found = with(2);
        assert_eq!(found, with(1));
        assert!(found.iter().any(|v| (400.0..800.0).contains(v)), "{found:?}");
        assert!(found.iter().any(|v| (1150.0..1500.0).contains(v)), "{found:?}");
    }
}
