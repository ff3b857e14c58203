//! Rays through the slices of one brick, four of a row at a time.
//!
//! Compiled anew for each set of instructions and each axis that slices lie across; a product is always rounded before it is
//! added to, so that no bit depends on which set it is.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use std::ops::Range;

use fearless_simd::f32x16;
use fearless_simd::prelude::*;
use glam::Vec4;

use super::fours::{TOGETHER, fours};
use super::shear::Slice;
use super::tile::{Tile, Window};
use crate::view::composite::{recolor, thicken_each};
use crate::view::four_colors::fourth;
use crate::view::samples::Counts;
use crate::volume::gel::{CELLS, ROW, TEXELS, Texel};

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

/// Of some slices: cells that are neither empty nor hidden from the rays of a phase, where these are in its tile, and what
/// each of the four voxels around them counts.
#[derive(Clone, Copy, Default)]
struct Found {
    cells: [u64; TOGETHER],
    /// The first ray of each slice's [`Window`].
    rays: [u16; TOGETHER],
    weights: [[f32; 4]; TOGETHER],
}

/// A brick that rays of a tile meet.
pub(super) struct Brick<'a, T> {
    pub texels: &'a [T; TEXELS],
    /// Which cells of its slices are not empty: bit `8 v + u`.
    pub cells: [u64; CELLS],
    /// Its first cell, counted along u and v from the tile's first ray as if that leaned nowhere.
    pub first: [i64; 2],
    /// Voxels between rows of rays.
    pub apart: usize,
    /// Whether some of its cells have no rays, though they may have gel: beyond the last voxels, or between the rows of a phase
    /// where another has some.
    pub is_parted: bool,
    /// What texels are multiplied by.
    pub scale: Vec4,
    /// A ray stops when no more than this comes through of what is behind.
    pub stop: f32,
    /// How thick slabs are against the opacity unit.
    pub ratio: f64,
}

impl<T: Texel> Brick<'_, T> {
    /// Takes the rays of tiles, a phase each, through the slices `within` a layer of bricks: as many phases together as there is
    /// code for.
    #[inline(always)]
    pub fn pass<S: Simd, const W: usize>(
        &self,
        simd: S,
        mut tiles: &mut [Tile],
        (mut phases, within): (&[Vec<Slice>], &Range<usize>),
        counts: &mut Counts,
    ) {
        macro_rules! together {
            ($($number:literal)*) => {$(
                let (some, left) = tiles.as_chunks_mut::<$number>();
                let (of_some, of_left) = phases.as_chunks::<$number>();
                for (tiles, phases) in some.iter_mut().zip(of_some) {
                    let mut slices = [&[][..]; $number];
                    for phase in 0..$number {
                        tiles[phase].meet();
                        slices[phase] = &phases[phase][within.clone()];
                    }
                    self.together::<S, W, $number>(simd, tiles, slices, counts);
                }
                (tiles, phases) = (left, of_left);
            )*};
        }
        together!(8 4 2 1);
        debug_assert!(tiles.is_empty() && phases.is_empty(), "each phase has a tile");
    }

    /// Takes the rays of tiles, a phase each, through their slices, the nearest first, which lie across axis `W`.
    ///
    /// The slices of all phases lie on the same planes: what is there between two planes of voxels is found once for all.
    #[inline(always)]
    fn together<S: Simd, const W: usize, const P: usize>(
        &self,
        simd: S,
        tiles: &mut [Tile; P],
        slices: [&[Slice]; P],
        counts: &mut Counts,
    ) {
        for first in (0..slices[0].len()).step_by(TOGETHER) {
            // What is hidden or empty is found of all at first: a branch for each would be a guess.
            let (mut found, mut any) = ([Found::default(); P], [0; TOGETHER]);
            for phase in 0..P {
                let found = &mut found[phase];
                for (n, slice) in slices[phase][first..].iter().take(TOGETHER).enumerate() {
                    let cells = self.cells[slice.cell as usize % CELLS];
                    if let Some(window) = self.window(slice) {
                        let cells = cells & tiles[phase].left(simd, window);
                        (found.cells[n], found.rays[n]) = (cells, window.first);
                        found.weights[n] = slice.weights;
                        any[n] |= cells;
                    }
                }
            }
            for (n, mut fours) in fours(simd, &any).into_iter().enumerate() {
                while fours != 0 {
                    let bit = fours.trailing_zeros() as usize;
                    fours &= fours - 1;
                    let (n, four) = ((4 * n + bit / 16) % TOGETHER, bit % 16);
                    let Some(slice) = slices[0].get(first + n) else { continue };
                    let at = [4 * (four % 2), four / 2];
                    let way = Tile::way(at, self.apart);
                    let (mut rays, mut here, mut any) = ([0; P], [0; P], 0);
                    for phase in 0..P {
                        rays[phase] = usize::from(found[phase].rays[n]) + way;
                        let left = tiles[phase].four(rays[phase]);
                        here[phase] = found[phase].cells[n] >> (4 * four) & left;
                        any |= here[phase];
                        counts.samples += u64::from(here[phase].count_ones());
                    }
                    if any == 0 {
                        continue;
                    }
                    let corners = self.corners::<S, W>(simd, at, slice);
                    let mut slabs = [f32x16::splat(simd, 0.0); P];
                    for phase in 0..P {
                        slabs[phase] = between(corners, &found[phase].weights[n]);
                    }
                    let slabs = self.slabs(simd, slabs, here);
                    let mut told = [0; 2];
                    for phase in 0..P {
                        let stopped =
                            tiles[phase].under(simd, rays[phase], slabs[phase], self.stop);
                        told[phase / 4] |= stopped << (16 * (phase % 4));
                    }
                    // Without a branch: whether a ray stops is no guess, and is known late.
                    let stopped = [Tile::stopped(told[0]), Tile::stopped(told[1])];
                    for phase in 0..P {
                        let stopped = stopped[phase / 4] >> (16 * (phase % 4)) & 0xf;
                        tiles[phase].stop(rays[phase], stopped);
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

    /// What is on a slice at the corners of the cells of four rays, the first in the cell `[u, v]` of it, u fastest:
    /// associated colour and, below 0, opacity.
    #[inline(always)]
    fn corners<S: Simd, const W: usize>(
        &self,
        simd: S,
        [u, v]: [usize; 2],
        slice: &Slice,
    ) -> [f32x16<S>; 4] {
        let layer = slice.cell as usize % CELLS;
        let texels = match W {
            2 => self.along::<S, W>(simd, layer * ROW * ROW + v * ROW + u),
            1 => self.along::<S, W>(simd, layer * ROW + v * ROW * ROW + u),
            _ => self.across(simd, layer + v * ROW * ROW + u * ROW),
        };
        let Some([a, b, c, d, e, f, g, h]) = texels else { return [f32x16::splat(simd, 0.0); 4] };
        let scale = [self.scale.x, self.scale.y, self.scale.z, -self.scale.w];
        let scale = f32x16::from_slice(simd, [scale; 4].as_flattened());
        let [near, far] = [scale * slice.planes[0], scale * slice.planes[1]];
        [a * near + e * far, b * near + f * far, c * near + g * far, d * near + h * far]
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

    /// The slabs of four rays of each phase: clear where a ray is not `here`, for its cell is, or lies beyond the last voxels.
    #[inline(always)]
    fn slabs<S: Simd, const P: usize>(
        &self,
        simd: S,
        mut slabs: [f32x16<S>; P],
        here: [u64; P],
    ) -> [f32x16<S>; P] {
        if self.is_parted {
            for phase in 0..P {
                let here = HERE[here[phase] as usize & 0xf].as_flattened();
                slabs[phase] *= f32x16::from_slice(simd, here);
            }
        }
        if self.ratio != 1.0 {
            for slabs in &mut slabs {
                *slabs = self.thickened(simd, *slabs);
            }
        }
        slabs
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
        slabs * f32x16::from_slice(simd, parts(simd, &alone, self.ratio).as_flattened())
    }
}

/// What slabs of such opacities are multiplied by to be so many times as thick, in all four channels.
///
/// A function of its own: few scenes take it, and it would stand in each of those that rays are passed with.
#[inline(never)]
fn parts<S: Simd>(simd: S, alone: &[f64; 4], ratio: f64) -> [[f32; 4]; 4] {
    simd.vectorize(
        #[inline(always)]
        || {
            let thick = thicken_each(alone, &[ratio; 4]);
            let mut parts = [[0.0; 4]; 4];
            for ray in 0..4 {
                parts[ray] = [recolor(alone[ray], thick[ray], ratio) as f32; 4];
            }
            parts
        },
    )
}

/// What is between the corners of the cells of four rays.
#[inline(always)]
fn between<S: Simd>([a, b, c, d]: [f32x16<S>; 4], weights: &[f32; 4]) -> f32x16<S> {
    a * weights[0] + b * weights[1] + (c * weights[2] + d * weights[3])
}
