//! Rays through the slices of one brick, a row of eight at a time.
//!
//! Compiled anew for each set of instructions and each axis that slices lie across; a product is always rounded before it is
//! added to, so that no bit depends on which set it is.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::f32x16;
use fearless_simd::prelude::*;
use glam::Vec4;

use super::shear::Slice;
use super::tile::{SIDE, Tile, Window, fourth};
use crate::view::composite::{recolor, thicken_each};
use crate::view::samples::Counts;
use crate::volume::gel::{CELLS, ROW, TEXELS, Texel};

/// Slices that are looked at together.
const TOGETHER: usize = 16;
/// From a row's first texel to its last, in a brick whose rows lie along u: of the two rows of two layers.
const ALONG: usize = ROW * ROW + ROW + SIDE + 1;
/// From the first texel of four rays to their last, where rows lie along w.
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
            let (mut found, mut left) = ([0; TOGETHER], 0_u32);
            for (n, slice) in slices.iter().enumerate() {
                let cells = self.cells[slice.cell as usize % CELLS];
                let open = self.window(slice).map_or(0, |window| tile.left(simd, window));
                found[n] = cells & open;
                left |= u32::from(found[n] != 0) << n;
            }
            while left != 0 {
                let n = left.trailing_zeros() as usize;
                left &= left - 1;
                if let Some(window) = self.window(&slices[n]) {
                    self.slice::<S, W>(simd, &slices[n], (window, found[n]), tile, counts);
                }
            }
        }
    }

    #[inline(always)]
    fn window(&self, slice: &Slice) -> Option<Window> {
        Window::new([self.first[0] - slice.shift[0], self.first[1] - slice.shift[1]])
    }

    /// Takes rays through one slice, in those `cells`.
    #[inline(always)]
    fn slice<S: Simd, const W: usize>(
        &self,
        simd: S,
        slice: &Slice,
        (window, mut cells): (Window, u64),
        tile: &mut Tile,
        counts: &mut Counts,
    ) {
        let layer = slice.cell as usize % CELLS;
        while cells != 0 {
            let v = cells.trailing_zeros() as usize / SIDE;
            let here = cells >> (SIDE * v) & 0xff;
            cells &= !(0xff << (SIDE * v));
            let Some(mut row) = tile.row(window, v) else { continue };
            let here = here & row.left();
            if here == 0 {
                continue;
            }
            counts.samples += u64::from(here.count_ones());
            if W == 0 {
                self.row_across(simd, layer + v * ROW * ROW, (slice, here), &mut row);
            } else {
                let [next_v, next_w] = if W == 2 { [ROW, ROW * ROW] } else { [ROW * ROW, ROW] };
                let first = layer * next_w + v * next_v;
                self.row_along::<S, W>(simd, first, (slice, here), &mut row);
            }
        }
    }

    /// Of a brick whose rows of texels lie along u, from its texel `first` on.
    #[inline(always)]
    fn row_along<S: Simd, const W: usize>(
        &self,
        simd: S,
        first: usize,
        (slice, here): (&Slice, u64),
        row: &mut super::tile::Row<'_>,
    ) {
        let Some(texels) = self.texels.get(first..).and_then(<[T]>::first_chunk::<ALONG>) else {
            return;
        };
        macro_rules! eight {
            ($first:expr) => {
                match texels[$first..].first_chunk() {
                    Some(eight) => T::eight(simd, eight),
                    None => return,
                }
            };
        }
        let (v, w) = if W == 2 { (ROW, ROW * ROW) } else { (ROW * ROW, ROW) };
        let [a, b, c, d] = [eight!(0), eight!(1), eight!(v), eight!(v + 1)];
        let [e, f, g, h] = [eight!(w), eight!(w + 1), eight!(v + w), eight!(v + w + 1)];
        if here & 0x0f != 0 {
            let corners = [a.0, b.0, c.0, d.0, e.0, f.0, g.0, h.0];
            let slabs = self.slabs(simd, corners, (&slice.weights, here));
            row.under(simd, false, slabs, self.stop);
        }
        if here & 0xf0 != 0 {
            let corners = [a.1, b.1, c.1, d.1, e.1, f.1, g.1, h.1];
            let slabs = self.slabs(simd, corners, (&slice.weights, here >> 4));
            row.under(simd, true, slabs, self.stop);
        }
    }

    /// Of a brick whose rows of texels lie along w.
    #[inline(always)]
    fn row_across<S: Simd>(
        &self,
        simd: S,
        first: usize,
        (slice, here): (&Slice, u64),
        row: &mut super::tile::Row<'_>,
    ) {
        for last in [false, true] {
            let here = if last { here >> 4 } else { here & 0xf };
            if here == 0 {
                continue;
            }
            let first = first + if last { 4 * ROW } else { 0 };
            let Some(texels) = self.texels.get(first..).and_then(<[T]>::first_chunk::<ACROSS>)
            else {
                return;
            };
            let none = T::default();
            macro_rules! four {
                ($first:expr) => {{
                    let [a, b] = [texels[$first], texels[$first + ROW]];
                    let [c, d] = [texels[$first + 2 * ROW], texels[$first + 3 * ROW]];
                    T::eight(simd, &[a, b, c, d, none, none, none, none]).0
                }};
            }
            let (u, v) = (ROW, ROW * ROW);
            let near = [four!(0), four!(u), four!(v), four!(u + v)];
            let far = [four!(1), four!(u + 1), four!(v + 1), four!(u + v + 1)];
            let corners = [near[0], near[1], near[2], near[3], far[0], far[1], far[2], far[3]];
            let slabs = self.slabs(simd, corners, (&slice.weights, here));
            row.under(simd, last, slabs, self.stop);
        }
    }

    /// The slabs of four rays by the texels around them: associated colour and, below 0, opacity. Of rays that are not `here`
    /// they are clear, for their cells are, or lie beyond the last voxels.
    #[inline(always)]
    fn slabs<S: Simd>(
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
