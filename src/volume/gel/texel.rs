//! The number types that gel is kept in.

use fearless_simd::{Bytes, Simd, SimdBase, SimdCvtFloat, f32x8, i32x8, u8x16, u16x8, u32x4};
use glam::Vec4;

/// Gel that is nowhere more opaque than this is kept in 32 bits, where that is left open.
pub const FAINT: f32 = 1.0 / 16.0;

/// A color may be above 1 by half a step of 16 bits, where that is left open: cut to 1 it is as near as any is rounded.
pub const BRIGHT: f32 = 1.0 + 0.5 / 65535.0;

/// A number type that four channels of the gel are kept in; colour and opacity in 0..=1.
pub trait Texel: Copy + Default + Send + Sync + 'static {
    /// The channels as stored numbers: 1 is `1 / SCALE`.
    fn load(self) -> Vec4;
    /// The nearest texel; integers clamp to 0..=1, and what is clear in them has no colour, however bright it was: cells
    /// without opacity are stepped over.
    fn store(channels: Vec4) -> Self;
    /// Whether an opacity is above 0 in these numbers.
    fn is_seen(alpha: f32) -> bool;
    /// The channels of two texels, as stored numbers.
    fn channels<S: Simd>(simd: S, pair: &[Self; 2]) -> f32x8<S>;
    /// What a stored number is multiplied by.
    const SCALE: f32;
}

impl Texel for [f32; 4] {
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn channels<S: Simd>(simd: S, pair: &[Self; 2]) -> f32x8<S> {
        f32x8::from_slice(simd, pair.as_flattened())
    }
    fn load(self) -> Vec4 {
        Vec4::from_array(self)
    }
    fn store(channels: Vec4) -> Self {
        channels.to_array()
    }
    fn is_seen(alpha: f32) -> bool {
        alpha > 0.0
    }
    const SCALE: f32 = 1.0;
}

impl Texel for [u16; 4] {
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn channels<S: Simd>(simd: S, pair: &[Self; 2]) -> f32x8<S> {
        to_floats(simd, simd.widen_u16x8(u16x8::from_slice(simd, pair.as_flattened())))
    }
    fn load(self) -> Vec4 {
        Vec4::from_array(self.map(f32::from))
    }
    fn store(channels: Vec4) -> Self {
        let texel = channels.to_array().map(|c| (c.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16);
        if texel[3] == 0 { Self::default() } else { texel }
    }
    fn is_seen(alpha: f32) -> bool {
        alpha * 65535.0 + 0.5 >= 1.0
    }
    const SCALE: f32 = 1.0 / 65535.0;
}

impl Texel for [u8; 4] {
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn channels<S: Simd>(simd: S, [a, b]: &[Self; 2]) -> f32x8<S> {
        let bytes = [a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3], 0, 0, 0, 0, 0, 0, 0, 0];
        let (low, _) = simd.widen_u8x16(u8x16::from_slice(simd, &bytes));
        to_floats(simd, simd.widen_u16x8(low))
    }
    fn load(self) -> Vec4 {
        Vec4::from_array(self.map(f32::from))
    }
    fn store(channels: Vec4) -> Self {
        let texel = channels.to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8);
        if texel[3] == 0 { Self::default() } else { texel }
    }
    fn is_seen(alpha: f32) -> bool {
        alpha * 255.0 + 0.5 >= 1.0
    }
    const SCALE: f32 = 1.0 / 255.0;
}

/// Eight whole numbers, below 2³¹, as floats.
#[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
#[inline(always)]
fn to_floats<S: Simd>(simd: S, (low, high): (u32x4<S>, u32x4<S>)) -> f32x8<S> {
    let whole: i32x8<S> = simd.combine_u32x4(low, high).bitcast();
    f32x8::float_from(whole)
}
