//! Reconstruction along one axis: what each of four voxels counts for a value between them, and for its slope.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use std::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::{Simd, f32x16};

use crate::components::Filter;

/// A number, or several side by side.
pub(crate) trait Amount:
    Copy
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
    + Div<f32, Output = Self>
{
}

impl Amount for f32 {}

impl<S: Simd> Amount for f32x16<S> {}

/// What the voxels before, at, behind and two behind the first of a cell count at a place in the cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Taps<V = f32> {
    /// For the value.
    pub weights: [V; 4],
    /// For its slope, per voxel.
    pub slopes: [V; 4],
}

impl<V: Amount> Taps<V> {
    /// Those of a filter at `t` of the way through a cell, 0..=1.
    ///
    /// The slopes are those of the weights, but for linear reconstruction: there they interpolate the central differences
    /// at the voxels, as the paper's gradients are.
    #[must_use]
    #[inline(always)]
    pub fn new(filter: Filter, t: V) -> Self {
        let s = -t + 1.0;
        match filter {
            Filter::Linear => {
                let zero = t * 0.0;
                Self { weights: [zero, s, t, zero], slopes: [s * -0.5, t * -0.5, s * 0.5, t * 0.5] }
            }
            Filter::Cubic | Filter::Interpolating => {
                let (tt, ss) = (t * t, s * s);
                Self {
                    weights: [
                        ss * s / 6.0,
                        tt * (t * 0.5 - 1.0) + 2.0 / 3.0,
                        ss * (s * 0.5 - 1.0) + 2.0 / 3.0,
                        tt * t / 6.0,
                    ],
                    slopes: [ss * -0.5, tt * 1.5 - t * 2.0, -(ss * 1.5 - s * 2.0), tt * 0.5],
                }
            }
            Filter::CatmullRom => {
                let (tt, ss) = (t * t, s * s);
                Self {
                    weights: [
                        t * -0.5 * ss,
                        (t * 1.5 - 2.5) * tt + 1.0,
                        (s * 1.5 - 2.5) * ss + 1.0,
                        s * -0.5 * tt,
                    ],
                    slopes: [
                        -((s * 1.5 - 1.0) * s),
                        (t * 4.5 - 5.0) * t,
                        -((s * 4.5 - 5.0) * s),
                        (t * 1.5 - 1.0) * t,
                    ],
                }
            }
        }
    }
}

impl Taps {
    /// Those where the grid ends: a voxel that is not there continues its two neighbours in a straight line.
    #[must_use]
    #[inline]
    pub fn ended(mut self, [before, behind]: [bool; 2]) -> Self {
        for of in [&mut self.weights, &mut self.slopes] {
            if before {
                *of = [0.0, of[1] + 2.0 * of[0], of[2] - of[0], of[3]];
            }
            if behind {
                *of = [of[0], of[1] - of[3], of[2] + 2.0 * of[3], 0.0];
            }
        }
        self
    }
}

/// How far reconstructed values may leave the range of the voxels that they are made of: so many times half of its width
/// from its middle, over all three axes; 1 where they never do.
#[must_use]
pub(crate) fn overshoot(filter: Filter) -> f32 {
    match filter {
        Filter::CatmullRom => 1.25 * 1.25 * 1.25,
        _ => 1.0,
    }
}

/// How much steeper than a central difference a slope may be, of voxels that are equally far apart.
#[must_use]
pub(crate) fn steepness(filter: Filter) -> f32 {
    match filter {
        Filter::Linear => 1.0,
        Filter::Cubic | Filter::Interpolating => 1.5,
        Filter::CatmullRom => 3.0 * 1.25 * 1.25,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Filter; 4] =
        [Filter::Linear, Filter::Cubic, Filter::CatmullRom, Filter::Interpolating];

    fn places() -> impl Iterator<Item = f32> {
        (0..=32_u8).map(|n| f32::from(n) / 32.0)
    }

    #[test]
    fn every_filter_keeps_constants_and_straight_lines_and_their_slopes_at_ends_too() {
        for (filter, t) in ALL.into_iter().flat_map(|filter| places().map(move |t| (filter, t))) {
            for ends in [[false; 2], [true, false], [false, true], [true; 2]] {
                let Taps { weights, slopes } = Taps::new(filter, t).ended(ends);
                let of = |taps: [f32; 4], field: [f32; 4]| {
                    taps.iter().zip(field).map(|(tap, value)| tap * value).sum::<f32>()
                };
                let line = [-1.0, 0.0, 1.0, 2.0];
                assert!((of(weights, [1.0; 4]) - 1.0).abs() < 1e-6, "{filter:?} {t}");
                assert!(of(slopes, [1.0; 4]).abs() < 1e-6, "{filter:?} {t}");
                assert!((of(weights, line) - t).abs() < 1e-6, "{filter:?} {t} {ends:?}");
                assert!((of(slopes, line) - 1.0).abs() < 1e-6, "{filter:?} {t} {ends:?}");
            }
        }
    }

    #[test]
    fn slopes_are_the_derivatives_of_weights() {
        for filter in [Filter::Cubic, Filter::CatmullRom] {
            for t in places().filter(|t| (0.1..0.9).contains(t)) {
                let at = |t: f32| Taps::new(filter, t).weights;
                let (low, high) = (at(t - 1.0 / 128.0), at(t + 1.0 / 128.0));
                for (tap, slope) in Taps::new(filter, t).slopes.into_iter().enumerate() {
                    assert!(((high[tap] - low[tap]) * 64.0 - slope).abs() < 1e-3, "{filter:?} {t}");
                }
            }
        }
    }

    #[test]
    fn values_and_slopes_stay_within_what_is_said_of_a_filter() {
        for (filter, t) in ALL.into_iter().flat_map(|filter| places().map(move |t| (filter, t))) {
            let Taps { weights, slopes } = Taps::new(filter, t);
            let whole: f32 = weights.iter().map(|w| w.abs()).sum();
            assert!(whole <= overshoot(filter).cbrt() + 1e-6, "{filter:?} {t}");
            let rise: f32 = slopes.iter().map(|s| s.max(0.0)).sum();
            assert!(rise * whole * whole <= 0.5 * steepness(filter) + 1e-6, "{filter:?} {t}");
        }
    }
}
