//! Surveys: the mean of many numbers, and between which bounds it lies, from a few of them that are drawn by chance.
//!
//! Items are drawn as often as they are large, by a size that is known of all: where the numbers go along with sizes, few
//! draws tell much (Hansen and Hurwitz 1943). A round draws one item from each of a few strata of equal size, neighbors in
//! their order, so that it is spread over all of them; rounds are independent, and how they differ tells how far their mean
//! may be off.

/// How often an item is drawn: in proportion to its size.
pub struct Survey {
    /// The sums of sizes up to each item and with it.
    sums: Vec<f64>,
}

/// An item that was drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drawn {
    /// Which.
    pub item: usize,
    /// What its number counts in the mean: over a round, the sum of `weight · number` is an estimate of the mean over all.
    pub weight: f64,
    /// A number from 0 up to 1 that says which part of the item was drawn, where it has parts of equal size.
    pub within: f64,
}

/// A mean and between which bounds it lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The estimate: unbiased.
    pub value: f64,
    /// The lower bound.
    pub low: f64,
    /// The upper bound.
    pub high: f64,
}

impl Survey {
    /// A survey of items of such sizes; `None` unless they are above 0 and finite, and there is one.
    #[must_use]
    pub fn new(sizes: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sum = 0.0;
        let mut sums = Vec::new();
        for size in sizes {
            if !(size > 0.0 && size.is_finite()) {
                return None;
            }
            sum += size;
            sums.push(sum);
        }
        (!sums.is_empty()).then_some(Self { sums })
    }

    /// A round of draws from `strata` strata: the same for the same seed.
    #[must_use]
    pub fn round(&self, strata: usize, seed: u64) -> Vec<Drawn> {
        let total = self.sums[self.sums.len() - 1];
        let items = self.sums.len() as f64;
        let drawn = |stratum: usize| {
            let at = (stratum as f64 + chance(seed, stratum as u64)) / strata as f64 * total;
            let item = self.sums.partition_point(|&sum| sum <= at).min(self.sums.len() - 1);
            let before = if item == 0 { 0.0 } else { self.sums[item - 1] };
            let size = self.sums[item] - before;
            let within = ((at - before) / size).clamp(0.0, 1.0 - f64::EPSILON);
            Drawn { item, weight: total / (size * items * strata as f64), within }
        };
        (0..strata).map(drawn).collect()
    }
}

/// How many times wider the interval reaches up and down than a normal distribution of the logarithm would have it, in nine
/// of ten cases. Squared errors have rare great ones: who has not drawn one believes too little, and believes so too firmly.
const REACH: [f64; 2] = [1.0, 2.0];

/// The mean of what rounds made of it, none below 0, and bounds that hold in nine of ten cases.
///
/// The bounds are symmetric in no scale: they reach further up than down, by as much as was found to hold the truth over
/// pictures of many kinds. All bounds are infinite with fewer than two rounds, and 0 where all rounds are 0.
#[must_use]
pub fn interval(rounds: &[f64]) -> Interval {
    let count = rounds.len() as f64;
    let value = rounds.iter().sum::<f64>() / count.max(1.0);
    if rounds.len() < 2 {
        return Interval { value, low: 0.0, high: f64::INFINITY };
    }
    if value <= 0.0 {
        return Interval { value: 0.0, low: 0.0, high: 0.0 };
    }
    let squares: f64 = rounds.iter().map(|round| (round - value).powi(2)).sum();
    let deviation = (squares / (count - 1.0) / count).sqrt() / value;
    let [down, up] = REACH.map(|reach| reach * student(count - 1.0) * deviation);
    Interval { value, low: value * libm::exp(-down), high: value * libm::exp(up) }
}

/// The quantile of Student's distribution that leaves one in twenty above it, by its expansion about the normal one (Fisher
/// and Cornish 1960); to 1 % from four degrees of freedom on.
fn student(freedom: f64) -> f64 {
    let z: f64 = 1.644_854;
    let terms = [
        (z.powi(3) + z) / 4.0,
        (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0,
        (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / 384.0,
    ];
    let powers = (1..).map(|power| freedom.powi(power));
    z + terms.iter().zip(powers).map(|(term, power)| term / power).sum::<f64>()
}

/// A number from 0 up to 1, the same for the same seed and place: SplitMix64.
fn chance(seed: u64, place: u64) -> f64 {
    let mut bits = seed;
    for _ in 0..2 {
        bits = bits.wrapping_add(place.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
    }
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten thousand squared errors, most of them small and a few in a hundred great, and sizes that tell half of the truth.
    fn errors() -> (Vec<f64>, Vec<f64>) {
        let number = |at: u64| {
            let rare = chance(7, at) > 0.98;
            let scale = if rare { 0.2 } else { 0.01 };
            (scale * chance(8, at)).powi(2)
        };
        let numbers: Vec<f64> = (0..10_000).map(number).collect();
        let sizes = numbers.iter().zip(0..).map(|(n, at)| 0.02 + n.sqrt() * chance(9, at));
        let sizes = sizes.collect();
        (numbers, sizes)
    }

    fn rounds(numbers: &[f64], survey: &Survey, count: u64, seed: u64) -> Vec<f64> {
        let estimate = |round: u64| {
            let drawn = survey.round(12, seed * count + round);
            drawn.iter().map(|drawn| drawn.weight * numbers[drawn.item]).sum()
        };
        (0..count).map(estimate).collect()
    }

    #[test]
    fn rounds_estimate_the_mean_without_a_bias() {
        let (numbers, sizes) = errors();
        let survey = Survey::new(sizes).unwrap();
        let truth = numbers.iter().sum::<f64>() / numbers.len() as f64;
        let found = interval(&rounds(&numbers, &survey, 4000, 1)).value;
        assert!((found / truth - 1.0).abs() < 0.05, "{found} for {truth}");
    }

    #[test]
    fn the_interval_holds_the_truth_in_nine_of_ten_surveys() {
        let (numbers, sizes) = errors();
        let survey = Survey::new(sizes).unwrap();
        let truth = numbers.iter().sum::<f64>() / numbers.len() as f64;
        let holds = |seed: &u64| {
            let found = interval(&rounds(&numbers, &survey, 16, *seed));
            found.low <= truth && truth <= found.high
        };
        let held = (0..300).filter(holds).count();
        println!("{held} of 300 intervals hold the truth");
        assert!(held >= 270, "{held}");
    }

    #[test]
    fn what_is_as_large_as_its_number_is_known_from_any_draw() {
        let numbers = [1.0, 2.0, 5.0, 4.0];
        let survey = Survey::new(numbers).unwrap();
        let found = interval(&rounds(&numbers, &survey, 3, 5));
        assert!((found.value - 3.0).abs() < 1e-12 && found.high - found.low < 1e-12, "{found:?}");
    }

    #[test]
    fn sizes_are_above_0() {
        assert!(Survey::new([]).is_none() && Survey::new([1.0, 0.0]).is_none());
        assert!(Survey::new([f64::NAN]).is_none());
        assert!(interval(&[1.0]).high.is_infinite());
        assert_eq!(interval(&[0.0; 9]), Interval { value: 0.0, low: 0.0, high: 0.0 });
    }

    #[test]
    fn quantiles_are_those_of_tables() {
        for (freedom, known) in [(4.0, 2.132), (9.0, 1.833), (30.0, 1.697), (1e9, 1.645)] {
            assert!((student(freedom) / known - 1.0).abs() < 0.01, "{freedom}");
        }
    }
}
