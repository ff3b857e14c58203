//! How cost grows: the exponent of a power law, fitted with its uncertainty.

/// An exponent, and between which bounds it lies in 19 of 20 cases.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth {
    /// Cost goes as this power of the size: 1 is in proportion, 0 not at all.
    pub exponent: f64,
    /// The lower bound.
    pub low: f64,
    /// The upper bound.
    pub high: f64,
}

impl Growth {
    /// Whether an exponent lies within the bounds.
    #[must_use]
    pub fn holds(&self, exponent: f64) -> bool {
        (self.low..=self.high).contains(&exponent)
    }
}

/// The exponent of cost over size, of points `[size, cost]` above 0: a line through their logarithms by least squares.
///
/// The bounds are Student's, for noise that is a factor. They tell of scatter about a power law; where cost is none, as a
/// fixed part beside what grows, look at [`steps`] too. `None` of fewer than three sizes.
#[must_use]
pub fn growth(points: &[[f64; 2]]) -> Option<Growth> {
    let sound = points.iter().filter(|point| point.iter().all(|n| n.is_finite() && *n > 0.0));
    let logs: Vec<[f64; 2]> = sound.map(|point| point.map(libm::log)).collect();
    let count = logs.len() as f64;
    let mean = |axis: usize| logs.iter().map(|log| log[axis]).sum::<f64>() / count;
    let middle = [mean(0), mean(1)];
    let sum = |a: usize, b: usize| -> f64 {
        logs.iter().map(|log| (log[a] - middle[a]) * (log[b] - middle[b])).sum()
    };
    let spread = sum(0, 0);
    if logs.len() < 3 || spread <= 0.0 {
        return None;
    }
    let exponent = sum(0, 1) / spread;
    let left = (sum(1, 1) - exponent * sum(0, 1)).max(0.0);
    let reach = quantile(logs.len() - 2) * (left / (count - 2.0) / spread).sqrt();
    Some(Growth { exponent, low: exponent - reach, high: exponent + reach })
}

/// The exponent from each point to the next: where they rise or fall along the sizes, cost is no power law.
#[must_use]
pub fn steps(points: &[[f64; 2]]) -> Vec<f64> {
    let step =
        |pair: &[[f64; 2]]| libm::log(pair[1][1] / pair[0][1]) / libm::log(pair[1][0] / pair[0][0]);
    points.windows(2).map(step).collect()
}

/// The quantile of Student's distribution that leaves one in forty above it.
fn quantile(freedom: usize) -> f64 {
    const KNOWN: [f64; 10] =
        [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228];
    let known = KNOWN.get(freedom.saturating_sub(1)).copied();
    known.unwrap_or_else(|| 1.96 + 2.4 / freedom as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(exponent: f64, noise: impl Fn(usize) -> f64) -> Vec<[f64; 2]> {
        let point = |at: usize| {
            let size = 2.0_f64.powi(at as i32);
            [size, 3.0 * size.powf(exponent) * noise(at)]
        };
        (0..6).map(point).collect()
    }

    #[test]
    fn a_power_law_has_its_exponent() {
        for exponent in [0.0, 1.0 / 3.0, 1.0, 2.0, 3.0] {
            let found = growth(&law(exponent, |_| 1.0)).unwrap();
            assert!((found.exponent - exponent).abs() < 1e-12, "{found:?}");
            assert!(found.high - found.low < 1e-6, "{found:?}");
        }
    }

    #[test]
    fn bounds_hold_the_exponent_in_19_of_20_cases() {
        // Noise of a tenth, by a fixed sequence.
        let noise = |seed: usize, at: usize| {
            let mut bits = (seed * 97 + at * 13 + 1) as u64;
            let sum: f64 = (0..12)
                .map(|_| {
                    bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_041);
                    (bits >> 11) as f64 / (1_u64 << 53) as f64
                })
                .sum();
            1.0 + 0.1 * (sum - 6.0)
        };
        let holds =
            |seed: &usize| growth(&law(1.0, |at| noise(*seed, at))).is_some_and(|g| g.holds(1.0));
        let held = (0..400).filter(holds).count();
        println!("{held} of 400 intervals hold the exponent");
        assert!(held >= 372, "{held}");
    }

    #[test]
    fn a_fixed_part_shows_in_the_steps() {
        let points: Vec<_> = law(1.0, |_| 1.0).into_iter().map(|[n, c]| [n, c + 20.0]).collect();
        let steps = steps(&points);
        assert!(steps.windows(2).all(|pair| pair[1] > pair[0]), "{steps:?}");
    }

    #[test]
    fn two_sizes_tell_no_exponent() {
        assert!(growth(&[[1.0, 1.0], [2.0, 2.0]]).is_none());
        assert!(growth(&[[1.0, 1.0]; 5]).is_none());
        assert!(growth(&[[1.0, f64::NAN], [2.0, 2.0], [0.0, 4.0]]).is_none());
    }
}
