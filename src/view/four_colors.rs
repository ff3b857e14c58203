//! Four colors side by side, each with its opacity as the fourth of four channels.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::prelude::*;
use fearless_simd::{f32x16, u8x64};

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
