//! What scalars of more than 24 bits lose: they are classified as 32-bit floats.

use rayon::prelude::*;

use super::grid::Scalars;

/// Steps that the values of a volume should have at the least, for its gradients to mean something.
const STEPS: f64 = 4096.0;

/// Voxels that one job looks through.
const CHUNK: usize = 1 << 16;

impl Scalars {
    /// A sentence without a subject where the values lose digits that tell them apart; `None` where they do not.
    #[must_use]
    pub(crate) fn lost_digits(&self) -> Option<String> {
        let [low, high] = match self {
            Self::U32(values) => range(values, |v| f64::from(*v)),
            Self::I32(values) => range(values, |v| f64::from(*v)),
            Self::U64(values) => range(values, |v| *v as f64),
            Self::I64(values) => range(values, |v| *v as f64),
            Self::F64(values) => range(values, |v| *v),
            _ => return None,
        };
        let largest = low.abs().max(high.abs());
        if largest.is_finite() && largest > f64::from(f32::MAX) {
            return Some(format!(
                "its values reach {largest:.3e} and are taken as 32-bit floats, whose largest is 3.4e38: beyond it they are infinite; scale them"
            ));
        }
        let step = largest * f64::from(f32::EPSILON) / 2.0;
        (low < high && step * STEPS > high - low).then(|| {
            format!(
                "its values from {low} to {high} are taken as 32-bit floats, which are {step:.3} apart there: take their least value off before saving them"
            )
        })
    }
}

/// The least and the greatest finite value.
fn range<T: Sync>(values: &[T], value: impl Fn(&T) -> f64 + Sync) -> [f64; 2] {
    let nothing = || [f64::INFINITY, f64::NEG_INFINITY];
    let wider = |[a, b]: [f64; 2], [low, high]: [f64; 2]| [a.min(low), b.max(high)];
    let part = |chunk: &[T]| {
        let finite = chunk.iter().map(&value).filter(|v| v.is_finite());
        finite.fold(nothing(), |range, v| wider(range, [v, v]))
    };
    values.par_chunks(CHUNK).map(part).reduce(nothing, wider)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::Shared;

    #[test]
    fn values_that_floats_cannot_tell_apart_are_told_and_others_are_not() {
        let said = |scalars: Scalars| scalars.lost_digits().unwrap_or_default();
        let around =
            |middle: i32| Scalars::I32(Shared::new((0..100).map(|i| middle + i).collect()));
        assert!(said(around(100_000_000)).contains("from 100000000 to 100000099"));
        assert_eq!([said(around(0)), said(around(-50))], ["", ""]);
        assert!(said(Scalars::F64(Shared::new(vec![-1e300, 1e300]))).contains("1.000e300"));
        assert_eq!(said(Scalars::F64(Shared::new(vec![0.1, 0.3, f64::NAN]))), "");
        assert_eq!(said(Scalars::U32(Shared::new(vec![4_000_000_000; 8]))), "");
    }
}
