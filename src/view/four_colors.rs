//! Four colors side by side, each with its opacity as the fourth of four channels.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x16, u8x64};

/// The last channel of each of four, in all four of its channels.
#[inline(always)]
pub(crate) fn fourth<S: Simd>(simd: S, channels: f32x16<S>) -> f32x16<S> {
    const LAST: [u8; 64] = {
        let (mut bytes, mut n) = ([0; 64], 0);
        while n < 64 {
            bytes[n] = 12 + (n as u8 & 3);
            n += 1;
        }
        bytes
    };
    channels.swizzle_dyn_within_blocks(u8x64::from_slice(simd, &LAST))
}

/// Each of four numbers in all four channels of a color.
#[inline(always)]
pub(crate) fn spread<S: Simd>(simd: S, numbers: f32x4<S>) -> f32x16<S> {
    const EACH: [u8; 64] = {
        let (mut bytes, mut n) = ([0; 64], 0);
        while n < 64 {
            bytes[n] = (4 * (n / 16) + n % 4) as u8;
            n += 1;
        }
        bytes
    };
    let twice = simd.combine_f32x4(numbers, numbers);
    simd.combine_f32x8(twice, twice).swizzle_dyn_within_blocks(u8x64::from_slice(simd, &EACH))
}

/// The sum of four colors.
#[inline(always)]
pub(crate) fn sum<S: Simd>(simd: S, colors: f32x16<S>) -> f32x4<S> {
    let (first, last) = simd.split_f32x16(colors);
    let (even, odd) = simd.split_f32x8(first + last);
    even + odd
}
