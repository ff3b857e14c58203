//! How many times longer one of two takes, from runs in turn: a ratio and the interval that it lies in.

use serde::Serialize;

/// A ratio of two times, and between which bounds it lies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Ratio {
    /// The second over the first: above 1 where the second takes longer.
    pub ratio: f64,
    /// The interval's lower end.
    pub low: f64,
    /// The interval's upper end.
    pub high: f64,
}

impl Ratio {
    /// Whether a difference was found: 1 lies outside the interval.
    #[must_use]
    pub fn differs(&self) -> bool {
        !(self.low <= 1.0 && 1.0 <= self.high)
    }
}

/// In how many of all cases an interval may miss the truth.
const MISSED: f64 = 0.05;

/// The ratio of pairs `[first, second]` of seconds, above 0, that were measured side by side.
///
/// The Hodges–Lehmann estimate over logarithms, with the interval of Wilcoxon's signed ranks that holds the truth in 19 of
/// 20 cases. It asks nothing of the noise but that it is as likely to lengthen the first as the second; of fewer than six
/// pairs no interval says anything, and it is unbounded. `None` without a pair of positive numbers.
#[must_use]
pub fn ratio_of_pairs(pairs: &[[f64; 2]]) -> Option<Ratio> {
    ratio_among(pairs, 1)
}

/// The ratio of pairs that is one of `count` that are looked at together: the intervals of all of them hold the truth in 19
/// of 20 cases (Bonferroni), and are the wider for it.
#[must_use]
pub fn ratio_among(pairs: &[[f64; 2]], count: usize) -> Option<Ratio> {
    let normal = normal_quantile(MISSED / 2.0 / count.max(1) as f64);
    let sound = pairs.iter().filter(|pair| pair.iter().all(|s| s.is_finite() && *s > 0.0));
    let logs: Vec<f64> = sound.map(|[first, second]| libm::log(second / first)).collect();
    let n = logs.len();
    let mut means: Vec<f64> = (0..n)
        .flat_map(|i| (0..=i).map(move |j| (i, j)))
        .map(|(i, j)| f64::midpoint(logs[i], logs[j]))
        .collect();
    means.sort_by(f64::total_cmp);
    let all = means.len();
    let middle = f64::midpoint(*means.get(all.checked_sub(1)? / 2)?, means[all / 2]);
    let n = n as f64;
    let deviation = (n * (n + 1.0) * (2.0 * n + 1.0) / 24.0).sqrt();
    let cut = (n * (n + 1.0) / 4.0 - normal * deviation).floor();
    let ends = if n < 6.0 || cut < 0.0 {
        [f64::NEG_INFINITY, f64::INFINITY]
    } else {
        let cut = cut as usize;
        [means[cut], means[all - 1 - cut]]
    };
    let [low, high] = ends.map(libm::exp);
    Some(Ratio { ratio: libm::exp(middle), low, high })
}

/// What a number of the normal distribution exceeds with probability `tail`, 0..0.5; by halving, to 12 digits.
fn normal_quantile(tail: f64) -> f64 {
    let (mut low, mut high) = (0.0, 40.0);
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if libm::erfc(middle / std::f64::consts::SQRT_2) / 2.0 > tail {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_quantile_is_that_of_the_tables() {
        assert!((normal_quantile(0.025) - 1.959_963_985).abs() < 1e-9);
        assert!((normal_quantile(0.000_5) - 3.290_526_731).abs() < 1e-9);
    }

    #[test]
    fn of_eight_ratios_of_equals_that_are_looked_at_together_none_differs_in_19_of_20_tries() {
        let differs = |seed: u64| {
            let mut rows = (0..8).map(|row| pairs(1000 * row + seed, 1.0));
            rows.any(|pairs| ratio_among(&pairs, 8).unwrap().differs())
        };
        let found = (0..200).filter(|&seed| differs(seed)).count();
        println!("a difference of equals is found in {found} of 200 tries");
        assert!(found <= 20, "{found}");
    }

    /// Numbers between 0 and 1, the same ones for a seed: SplitMix64.
    fn random(seed: u64) -> impl Iterator<Item = f64> {
        (1..).map(move |at: u64| {
            let mut z = seed
                .wrapping_mul(0x2545_f491_4f6c_dd1d)
                .wrapping_add(at.wrapping_mul(0x9e37_79b9_7f4a_7c15));
            z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ z >> 31) >> 11) as f64 / (1_u64 << 53) as f64
        })
    }

    /// Pairs of noisy times; now and then something else takes the processor.
    fn pairs(seed: u64, slower: f64) -> Vec<[f64; 2]> {
        let mut numbers = random(seed);
        let mut time = |factor: f64| {
            let [noise, rare, long] = std::array::from_fn(|_| numbers.next().unwrap_or(0.5));
            factor * (1.0 + 0.04 * noise + if rare < 0.1 { long } else { 0.0 })
        };
        (0..30).map(|_| [time(1.0), time(slower)]).collect()
    }

    #[test]
    fn of_equal_programs_no_difference_is_found_in_19_of_20_tries() {
        let found = (0..400).filter(|&seed| ratio_of_pairs(&pairs(seed, 1.0)).unwrap().differs());
        let found = found.count();
        println!("a difference of equals is found in {found} of 400 tries");
        assert!(found <= 32, "{found}");
    }

    #[test]
    fn three_per_cent_are_found_in_noise_of_four() {
        let found = (0..100).filter(|&seed| ratio_of_pairs(&pairs(seed, 1.03)).unwrap().low > 1.0);
        let found = found.count();
        println!("3 % are found in {found} of 100 tries");
        assert!(found >= 90, "{found}");
    }

    #[test]
    fn few_pairs_say_nothing() {
        let few = ratio_of_pairs(&[[1.0, 2.0]; 5]).unwrap();
        assert!((few.ratio - 2.0).abs() < 1e-12 && !few.differs());
        assert!(ratio_of_pairs(&[[1.0, 2.0]; 6]).unwrap().differs());
        assert_eq!(ratio_of_pairs(&[[0.0, 1.0], [f64::NAN, 1.0]]), None);
    }
}
