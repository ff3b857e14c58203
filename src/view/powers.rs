//! `1 − (1 − α)^r` in 64 bits: alike on every machine, alone and side by side.
//!
//! A logarithm and an exponential of its own, in sums, products and quotients alone: those of any library are as near, and
//! take four times as long for one ray after the other as these for sixteen of them.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use std::f64::consts::LN_2;

/// The bits of √½: mantissas are taken from there to √2.
const ROOT_HALF: u64 = 0x3fe6_a09e_667f_3bcd;
/// The bits of a number's mantissa.
const MANTISSA: u64 = (1 << 52) - 1;
/// A number so great that what is added to it is rounded to a whole one, which its last bits are.
const WHOLE: f64 = 6_755_399_441_055_744.0;
/// ln 2 in so few bits that times a small whole number it is exact, and what is left of it.
const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
/// No lesser exponent makes a difference.
const LEAST: f64 = -60.0;

/// 1/21, 1/19, … 1/3.
const ODD: [f64; 10] = {
    let (mut parts, mut n) = ([0.0; 10], 0);
    while n < parts.len() {
        parts[n] = 1.0 / (21 - 2 * n) as f64;
        n += 1;
    }
    parts
};
/// 1/13!, 1/12!, … 1/2!.
const FACTORIALS: [f64; 12] = {
    let (mut parts, mut n, mut product) = ([0.0; 12], 2, 1.0);
    while n <= 13 {
        product *= n as f64;
        parts[13 - n] = 1.0 / product;
        n += 1;
    }
    parts
};

/// `1 − (1 − α)^r`, for α in 0..1 and r above 0: relatively within a few ulp of it, however small.
#[must_use]
#[inline(always)]
pub(super) fn one_minus_power(alpha: f64, r: f64) -> f64 {
    let exponent = r * log_one_minus(alpha);
    -exp_minus_one(if exponent > LEAST { exponent } else { LEAST })
}

/// `ln (1 − α)` for α in 0..1.
#[inline(always)]
fn log_one_minus(alpha: f64) -> f64 {
    let left = 1.0 - alpha;
    let bits = left.to_bits().wrapping_add(0x3ff0_0000_0000_0000 - ROOT_HALF);
    let twos = (bits >> 52) as i32 - 1023;
    let mantissa = f64::from_bits((bits & MANTISSA) + ROOT_HALF);
    // ln m = 2 artanh ((m − 1) / (m + 1)); of what is nearly clear nothing is lost to 1.
    let (over, under) =
        if twos == 0 { (-alpha, 2.0 - alpha) } else { (mantissa - 1.0, mantissa + 1.0) };
    let s = over / under;
    let square = s * s;
    let mut sum = 0.0;
    for part in ODD {
        sum = sum * square + part;
    }
    f64::from(twos) * LN_2 + (2.0 * s + 2.0 * s * (square * sum))
}

/// `e^y − 1` for y from [`LEAST`] to 0.
#[inline(always)]
fn exp_minus_one(y: f64) -> f64 {
    let whole = y * (1.0 / LN_2) + WHOLE;
    let twos = whole - WHOLE;
    let power = f64::from_bits(whole.to_bits().wrapping_add(1023) << 52);
    let rest = (y - twos * LN_2_HIGH) - twos * LN_2_LOW;
    let mut sum = 0.0;
    for part in FACTORIALS {
        sum = sum * rest + part;
    }
    let own = sum * (rest * rest) + rest;
    power * own + (power - 1.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn exact(alpha: f64, r: f64) -> f64 {
        -libm::expm1(r * libm::log1p(-alpha))
    }

    proptest! {
        #[test]
        fn powers_are_those_of_a_library(
            alpha in prop_oneof![0.0..1.0, (1.0_f64..60.0).prop_map(|n| 0.5_f64.powf(n)),
                (1.0_f64..53.0).prop_map(|n| 1.0 - 0.5_f64.powf(n))],
            r in prop_oneof![0.0..4.0, (-40.0_f64..10.0).prop_map(f64::exp2)],
        ) {
            let (made, exact) = (one_minus_power(alpha, r), exact(alpha, r));
            prop_assert!((made - exact).abs() <= 4.0 * f64::EPSILON * exact, "{made} {exact}");
            prop_assert!((0.0..=1.0).contains(&made));
        }
    }

    #[test]
    fn the_ends_are_what_they_are() {
        assert_eq!(one_minus_power(0.0, 0.3), 0.0);
        assert_eq!(one_minus_power(1.0 - f64::EPSILON / 2.0, 1e6), 1.0);
        for (alpha, r) in [(1e-300, 0.7), (f64::MIN_POSITIVE, 1e-10), (0.3, 1e-300)] {
            let (made, exact) = (one_minus_power(alpha, r), exact(alpha, r));
            assert!((made - exact).abs() <= 4.0 * f64::EPSILON * exact, "{alpha} {r}");
        }
    }
}
