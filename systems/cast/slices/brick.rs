//! Rays through the slices of one brick, four of a row at a time.
//!
//! Compiled anew for each set of instructions and each axis that slices lie across; a product is always rounded before it is
//! added to, so that no bit depends on which set it is.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::prelude::*;
use fearless_simd::{f32x16, u64x8};
use glam::Vec4;

use super::shear::Slice;
use super::tile::{Tile, Window};
use crate::view::composite::{recolor, thicken_each};
use crate::view::four_colors::fourth;
use crate::view::samples::Counts;
use crate::volume::gel::{CELLS, ROW, TEXELS, Texel};

/// Slices that are looked at together.
const TOGETHER: usize = 16;
/// From the first texel of four rays to their last, in a brick whose rows lie along u: of the two rows of two layers.
const ALONG: usize = ROW * ROW + ROW + 4 + 1;
/// The same where rows lie along w.
const ACROSS: usize = ROW * ROW + 4 * ROW + 2;

/// By bits of four rays: 1 in the channels of those that are set.
static HERE: [[[f32; 4]; 4]; 16] = {
    let (mut here, mut n) = ([[[0.0; 4]; 4]; 16], 0);
    while n < 64 {
        if ((n / 4) >> (n % 4)) & 1 == 1 {
            here[n / 4][n % 4] = [1.0; 4];
        }
        n += 1;
    }
    here
};

/// A brick that rays of a tile meet.
pub(super) struct Brick<'a, T> {
    pub texels: &'a [T; TEXELS],
    /// Which cells of its slices are not empty: bit `8 v + u`.
    pub cells: &'a [u64; CELLS],
    /// Its first cell, counted along u and v from the tile's first ray as if that leaned nowhere.
    pub first: [i64; 2],
    /// Voxels between rows of rays.
    pub apart: usize,
    /// Whether some of its cells lie beyond the last voxels.
    pub is_last: bool,
    /// What texels are multiplied by.
    pub scale: Vec4,
    /// A ray stops when no more than this comes through of what is behind.
    pub stop: f32,
    /// How thick slabs are against the opacity unit.
    pub ratio: f64,
}

impl<T: Texel> Brick<'_, T> {
    /// Takes the rays of a tile through its slices, the nearest first, which lie across axis `W`.
    #[inline(always)]
    pub fn pass<S: Simd, const W: usize>(
        &self,
        simd: S,
        slices: &[Slice],
        tile: &mut Tile,
        counts: &mut Counts,
    ) {
        for slices in slices.chunks(TOGETHER) {
            // What is hidden or empty is found of all at first: a branch for each would be a guess.
            let (mut found, mut windows) = ([0; TOGETHER], [Window::default(); TOGETHER]);
            for (n, slice) in slices.iter().enumerate() {
                let cells = self.cells[slice.cell as usize % CELLS];
                if let Some(window) = self.window(slice) {
                    found[n] = cells & tile.left(simd, window);
                    windows[n] = window;
                }
            }
            for (n, mut fours) in fours(simd, &found).into_iter().enumerate() {
                while fours != 0 {
                    let bit = fours.trailing_zeros() as usize;
                    fours &= fours - 1;
                    let (n, four) = (4 * n + bit / 16, bit % 16);
                    let Some(slice) = slices.get(n) else { continue };
                    let at = [4 * (four % 2), four / 2];
                    let Some(mut rays) = tile.four(windows[n], at) else { continue };
                    let here = found[n] >> (4 * four) & rays.left();
                    if here != 0 {
                        counts.samples += u64::from(here.count_ones());
                        let slabs = self.slabs::<S, W>(simd, at, (slice, here));
                        rays.under(simd, slabs, self.stop);
                    }
                }
            }
        }
    }

    /// Where its rays on a slice are in a tile.
    #[inline(always)]
    fn window(&self, slice: &Slice) -> Option<Window> {
        let [u, v] = [self.first[0] - slice.shift[0], self.first[1] - slice.shift[1]];
        Window::new([u, v], self.apart)
    }

    /// The slabs of four rays on a slice, the first in the cell `[u, v]` of it: associated colour and, below 0, opacity. Of
    /// those that are not `here` they are clear, for their cells are, or lie beyond the last voxels.
    #[inline(always)]
    fn slabs<S: Simd, const W: usize>(
        &self,
        simd: S,
        [u, v]: [usize; 2],
        (slice, here): (&Slice, u64),
    ) -> f32x16<S> {
        let layer = slice.cell as usize % CELLS;
        let corners = match W {
            2 => self.along::<S, W>(simd, layer * ROW * ROW + v * ROW + u),
            1 => self.along::<S, W>(simd, layer * ROW + v * ROW * ROW + u),
            _ => self.across(simd, layer + v * ROW * ROW + u * ROW),
        };
        match corners {
            Some(corners) => self.between(simd, corners, (&slice.weights, here)),
            None => f32x16::splat(simd, 0.0),
        }
    }

    /// The texels around four rays, u fastest, of a brick whose rows of texels lie along u, from its texel `first` on.
    #[inline(always)]
    fn along<S: Simd, const W: usize>(&self, simd: S, first: usize) -> Option<[f32x16<S>; 8]> {
        let texels: &[T; ALONG] = self.texels.get(first..)?.first_chunk()?;
        macro_rules! four {
            ($first:expr) => {
                T::four(simd, texels[$first..].first_chunk()?)
            };
        }
        let (v, w) = if W == 2 { (ROW, ROW * ROW) } else { (ROW * ROW, ROW) };
        let [a, b, c, d] = [four!(0), four!(1), four!(v), four!(v + 1)];
        Some([a, b, c, d, four!(w), four!(w + 1), four!(v + w), four!(v + w + 1)])
    }

    /// Those of a brick whose rows of texels lie along w.
    #[inline(always)]
    fn across<S: Simd>(&self, simd: S, first: usize) -> Option<[f32x16<S>; 8]> {
        let texels: &[T; ACROSS] = self.texels.get(first..)?.first_chunk()?;
        macro_rules! four {
            ($first:expr) => {{
                let [a, b] = [texels[$first], texels[$first + ROW]];
                T::four(simd, &[a, b, texels[$first + 2 * ROW], texels[$first + 3 * ROW]])
            }};
        }
        let (u, v) = (ROW, ROW * ROW);
        let [a, b, c, d] = [four!(0), four!(u), four!(v), four!(u + v)];
        Some([a, b, c, d, four!(1), four!(u + 1), four!(v + 1), four!(u + v + 1)])
    }

    /// The slabs of four rays between the texels around them.
    #[inline(always)]
    fn between<S: Simd>(
        &self,
        simd: S,
        [a, b, c, d, e, f, g, h]: [f32x16<S>; 8],
        (weights, here): (&[f32; 8], u64),
    ) -> f32x16<S> {
        let near = a * weights[0] + b * weights[1] + (c * weights[2] + d * weights[3]);
        let far = e * weights[4] + f * weights[5] + (g * weights[6] + h * weights[7]);
        let scale = [self.scale.x, self.scale.y, self.scale.z, -self.scale.w];
        let mut slabs = (near + far) * f32x16::from_slice(simd, [scale; 4].as_flattened());
        if self.is_last {
            let here = HERE[here as usize & 0xf].as_flattened();
            slabs *= f32x16::from_slice(simd, here);
        }
        if self.ratio == 1.0 { slabs } else { self.thickened(simd, slabs) }
    }

    /// Slabs of another thickness than the opacity unit (equations 2a and 2b).
    #[inline(always)]
    fn thickened<S: Simd>(&self, simd: S, slabs: f32x16<S>) -> f32x16<S> {
        let opacities = fourth(simd, slabs);
        if self.ratio == 2.0 {
            return slabs * (opacities + 2.0);
        }
        if self.ratio == 0.5 {
            // Interpolation may leave an opacity a hair above 1.
            return slabs / ((opacities + 1.0).max(0.0).sqrt() + 1.0);
        }
        let opacities = opacities.as_slice();
        let mut alone = [0.0; 4];
        for ray in 0..4 {
            alone[ray] = f64::from(-opacities[4 * ray]).clamp(0.0, 1.0);
        }
        let thick = thicken_each(&alone, &[self.ratio; 4]);
        let mut parts = [[0.0; 4]; 4];
        for ray in 0..4 {
            parts[ray] = [recolor(alone[ray], thick[ray], self.ratio) as f32; 4];
        }
        slabs * f32x16::from_slice(simd, parts.as_flattened())
    }
}

/// Which fours of the bits of each word have any set: 16 bits a word, four words in one.
#[inline(always)]
fn fours<S: Simd>(simd: S, words: &[u64; TOGETHER]) -> [u64; TOGETHER / 4] {
    let mut fours = [0; TOGETHER / 4];
    for (n, eight) in words.chunks_exact(8).enumerate() {
        let mut word = u64x8::from_slice(simd, eight);
        word = word | (word >> 1);
        word = (word | (word >> 2)) & 0x1111_1111_1111_1111;
        word = (word | (word >> 3)) & 0x0303_0303_0303_0303;
        word = (word | (word >> 6)) & 0x000f_000f_000f_000f;
        word = (word | (word >> 12)) & 0x0000_00ff_0000_00ff;
        word = (word | (word >> 24)) & 0xffff;
        for (k, word) in word.as_slice().iter().enumerate() {
            fours[2 * n + k / 4] |= word << (16 * (k % 4));
        }
    }
    fours
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::field::tests::levels;
    use fearless_simd::dispatch;

    #[test]
    fn fours_of_bits_are_found_wherever_one_is_set() {
        let seed = |n: usize| (n as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let words: [u64; TOGETHER] = std::array::from_fn(|n| seed(n) & seed(n).rotate_left(23));
        for level in levels() {
            let found = dispatch!(level, simd => fours(simd, &words));
            for (n, word) in words.iter().enumerate() {
                for four in 0..16 {
                    let any = found[n / 4] >> (16 * (n % 4) + four) & 1 == 1;
                    assert_eq!(any, word >> (4 * four) & 0xf != 0, "{level:?} {n} {four}");
                }
            }
        }
    }
}
