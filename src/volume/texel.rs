//! The number types that gel is kept in.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, f32x16, i32x8, i32x16, u8x16, u16x8, u16x16, u32x4, u32x8, u32x16};
use glam::Vec4;

/// Cells along one edge of a brick.
pub const CELLS: usize = 8;

/// Texels along one edge of a brick.
pub(crate) const ROW: usize = CELLS + 1;

/// Texels of a brick.
pub const TEXELS: usize = ROW * ROW * ROW;

/// Texels of a brick's three first faces, with each edge twice.
pub(crate) const FACES: usize = 3 * CELLS * CELLS;

/// The table's entry for a brick that is not stored.
pub const EMPTY: u32 = u32::MAX;

/// Gel that is nowhere more opaque than this is kept in 32 bits, where that is left open.
pub const FAINT: f32 = 1.0 / 16.0;

/// Gel that may be brighter than this is kept in 32 bits, where that is left open: in 16 its colors are kept in parts of the
/// brightest, and their steps would be seen.
pub const BRIGHT: f32 = 4.0;

/// A number type that four channels of the gel are kept in; colour and opacity in 0..=1.
pub trait Texel: Copy + Default + Send + Sync + 'static {
    /// The channels as stored numbers: 1 is `1 / SCALE`.
    fn load(self) -> Vec4;
    /// The nearest texels to eight voxels in a row, channel by channel; integers clamp to 0..=1, and what is clear in them has
    /// no colour, however bright it was: cells without opacity are stepped over.
    fn store_row<S: Simd>(simd: S, channels: &[[f32; CELLS]; 4]) -> [Self; CELLS];
    /// Whether an opacity is above 0 in these numbers.
    fn is_seen(alpha: f32) -> bool;
    /// The channels of two texels, as stored numbers.
    fn channels<S: Simd>(simd: S, pair: &[Self; 2]) -> f32x8<S>;
    /// The channels of four texels, as stored numbers.
    fn four<S: Simd>(simd: S, row: &[Self; 4]) -> f32x16<S>;
    /// What a stored number is multiplied by; 1 of floats, which alone may be above 1.
    const SCALE: f32;
}

impl Texel for [f32; 4] {
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn channels<S: Simd>(simd: S, pair: &[Self; 2]) -> f32x8<S> {
        f32x8::from_slice(simd, pair.as_flattened())
    }
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn four<S: Simd>(simd: S, row: &[Self; 4]) -> f32x16<S> {
        f32x16::from_slice(simd, row.as_flattened())
    }
    fn load(self) -> Vec4 {
        Vec4::from_array(self)
    }
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn store_row<S: Simd>(_: S, [r, g, b, a]: &[[f32; CELLS]; 4]) -> [Self; CELLS] {
        std::array::from_fn(|x| [r[x], g[x], b[x], a[x]])
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
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn four<S: Simd>(simd: S, row: &[Self; 4]) -> f32x16<S> {
        let row = u16x16::from_slice(simd, row.as_flattened());
        sixteen_floats(simd.widen_u16x32(simd.combine_u16x16(row, row)).0)
    }
    fn load(self) -> Vec4 {
        Vec4::from_array(self.map(f32::from))
    }
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn store_row<S: Simd>(simd: S, channels: &[[f32; CELLS]; 4]) -> [Self; CELLS] {
        let [r, g, b, a] = stored_row(simd, channels, 65535.0);
        let (low, high) = (r | (g << 16), b | (a << 16));
        let words = [low.zip_low(high), low.zip_high(high)];
        let mut row = [Self::default(); CELLS];
        for (at, texel) in row.iter_mut().enumerate() {
            let word = &words[at / 4].as_slice()[at % 4 * 2..][..2];
            *texel =
                [word[0] as u16, (word[0] >> 16) as u16, word[1] as u16, (word[1] >> 16) as u16];
        }
        row
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
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn four<S: Simd>(simd: S, row: &[Self; 4]) -> f32x16<S> {
        let (low, high) = simd.widen_u8x16(u8x16::from_slice(simd, row.as_flattened()));
        let row = simd.combine_u16x8(low, high);
        sixteen_floats(simd.widen_u16x32(simd.combine_u16x16(row, row)).0)
    }
    fn load(self) -> Vec4 {
        Vec4::from_array(self.map(f32::from))
    }
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn store_row<S: Simd>(simd: S, channels: &[[f32; CELLS]; 4]) -> [Self; CELLS] {
        let [r, g, b, a] = stored_row(simd, channels, 255.0);
        let words = r | (g << 8) | (b << 16) | (a << 24);
        std::array::from_fn(|x| words.as_slice()[x].to_le_bytes())
    }
    fn is_seen(alpha: f32) -> bool {
        alpha * 255.0 + 0.5 >= 1.0
    }
    const SCALE: f32 = 1.0 / 255.0;
}

/// The nearest numbers in 0..=`most` to the channels of eight voxels in a row; what is clear has no color.
#[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
#[inline(always)]
fn stored_row<S: Simd>(simd: S, channels: &[[f32; CELLS]; 4], most: f32) -> [u32x8<S>; 4] {
    // One after the other: what a closure does would be compiled by itself.
    let alpha = stored_channel(simd, &channels[3], most);
    let (seen, clear) = (alpha.simd_gt(0), u32x8::splat(simd, 0));
    let red = seen.select(stored_channel(simd, &channels[0], most), clear);
    let green = seen.select(stored_channel(simd, &channels[1], most), clear);
    let blue = seen.select(stored_channel(simd, &channels[2], most), clear);
    [red, green, blue, alpha]
}

#[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
#[inline(always)]
fn stored_channel<S: Simd>(simd: S, row: &[f32; CELLS], most: f32) -> u32x8<S> {
    i32x8::truncate_from(f32x8::from_slice(simd, row).max(0.0).min(1.0) * most + 0.5).bitcast()
}

/// Eight whole numbers, below 2³¹, as floats.
#[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
#[inline(always)]
fn to_floats<S: Simd>(simd: S, (low, high): (u32x4<S>, u32x4<S>)) -> f32x8<S> {
    let whole: i32x8<S> = simd.combine_u32x4(low, high).bitcast();
    f32x8::float_from(whole)
}

/// Sixteen whole numbers, below 2³¹, as floats.
#[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
#[inline(always)]
fn sixteen_floats<S: Simd>(numbers: u32x16<S>) -> f32x16<S> {
    let whole: i32x16<S> = numbers.bitcast();
    f32x16::float_from(whole)
}
