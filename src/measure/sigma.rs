//! Mean and root-mean-square deviation of a volume: the unit in which densities of molecules are contoured.

use crate::volume::grid::Scalars;
use crate::with_scalars;

/// Mean of the values and the square root of their mean squared deviation from it, in the values' unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sigma {
    /// Mean of the values.
    pub mean: f64,
    /// Root-mean-square deviation from the mean, 0 or above.
    pub deviation: f64,
}

impl Sigma {
    /// The value that lies `multiples` deviations above the mean: the level of a contour such as `1.5sigma`.
    #[must_use]
    pub fn level(self, multiples: f64) -> f64 {
        self.mean + multiples * self.deviation
    }
}

/// The sigma of all voxels but those of NaN or infinity (`None` where there is no other), computed from the values in 64 bits (headers are often wrong).
///
/// Two passes in the voxels' order: no digits are lost to a large mean, and the result is the same on every machine.
#[must_use]
pub fn sigma(scalars: &Scalars) -> Option<Sigma> {
    #[allow(clippy::cast_lossless, reason = "one body for all types")]
    fn of(values: impl Iterator<Item = f64> + Clone) -> Option<Sigma> {
        let finite = values.filter(|value| value.is_finite());
        let mut count = 0_u64;
        let mut sum = 0.0;
        for value in finite.clone() {
            count += 1;
            sum += value;
        }
        let mean = sum / count as f64;
        let squares: f64 = finite.map(|value| (value - mean) * (value - mean)).sum();
        (count > 0).then(|| Sigma { mean, deviation: (squares / count as f64).sqrt() })
    }
    #[allow(clippy::cast_lossless, clippy::unnecessary_cast, reason = "one body for all types")]
    {
        with_scalars!(scalars, values => of(values.iter().map(|&value| value as f64)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::Shared;

    #[test]
    #[allow(clippy::float_cmp, reason = "these are exact")]
    fn nan_and_infinity_are_left_out() {
        let values = vec![2.0, f32::NAN, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0, f32::INFINITY];
        let found = sigma(&Scalars::F32(Shared::new(values))).unwrap();
        assert_eq!(found, Sigma { mean: 5.0, deviation: 2.0 });
        assert_eq!(found.level(1.5), 8.0);
    }

    #[test]
    fn a_large_mean_costs_no_digits() {
        let values = (0..1000).map(|i| 1_000_000_000_i64 + i % 2).collect();
        let found = sigma(&Scalars::I64(Shared::new(values))).unwrap();
        assert!((found.deviation - 0.5).abs() < 1e-12);
    }

    #[test]
    fn no_value_has_no_sigma() {
        assert_eq!(sigma(&Scalars::F64(Shared::new(vec![f64::NAN; 3]))), None);
    }
}
