//! The mean and the standard deviation of a volume: the units in which crystallographers contour their maps.

use crate::grid::{Scalar, Scalars};
use crate::with_scalars;

/// Mean and standard deviation (root of the mean square distance from the mean) of all voxels that are finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sigma {
    /// Mean, in the units of the scalars.
    pub mean: f64,
    /// Standard deviation of the whole population, 0 or above, in the units of the scalars.
    pub deviation: f64,
}

/// Mean and deviation of a volume in two passes; `None` where no voxel is finite. Not finite voxels count for nothing.
#[must_use]
pub fn sigma(scalars: &Scalars) -> Option<Sigma> {
    with_scalars!(scalars, values => moments(values))
}

fn moments<T: Scalar>(values: &[T]) -> Option<Sigma> {
    let finite = || values.iter().map(|v| f64::from(v.value())).filter(|v| v.is_finite());
    let (count, sum) = finite().fold((0_u64, 0.0), |(n, sum), v| (n + 1, sum + v));
    if count == 0 {
        return None;
    }
    let mean = sum / count as f64;
    let squares: f64 = finite().map(|v| (v - mean) * (v - mean)).sum();
    Some(Sigma { mean, deviation: (squares / count as f64).sqrt() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Shared;

    #[test]
    fn one_to_five_have_mean_three_and_deviation_root_two() {
        let values = Scalars::U8(Shared::new(vec![1, 2, 3, 4, 5]));
        let Sigma { mean, deviation } = sigma(&values).unwrap();
        assert!((mean - 3.0).abs() < 1e-15 && (deviation - 2.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn voxels_that_are_not_finite_count_for_nothing() {
        let values = Scalars::F32(Shared::new(vec![f32::NAN, 2.0, f32::INFINITY, 2.0]));
        assert_eq!(sigma(&values), Some(Sigma { mean: 2.0, deviation: 0.0 }));
        assert_eq!(sigma(&Scalars::F32(Shared::new(vec![f32::NAN]))), None);
    }
}
