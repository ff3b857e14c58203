//! Sixteen rays at one sample: which of them lie in interesting cells, and what those see of the gel.
//!
//! Compiled anew for each set of instructions; a product is always rounded before it is added to, so that no bit depends on
//! which set it is.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]
#![allow(clippy::needless_range_loop, reason = "sixteen lanes at once, by their number")]

use fearless_simd::{Simd, SimdBase, SimdMask, f32x4, f32x8, u32x16};
use glam::Vec4;

use super::lanes::{LANES, Lanes, each};
use crate::view::walk::{FRACTION_BITS, PLACE_BITS, Tile};
use crate::volume::gel::{CELLS, EMPTY, ROW, TEXELS, Texel, TexelSlices};
use crate::volume::pyramid::PyramidSlices;

/// Bits of a place in a brick.
const BRICK_BITS: u32 = CELLS.trailing_zeros();

/// What rays sample.
#[derive(Clone, Copy)]
pub(crate) struct GelSlices<'a, T> {
    /// The gel.
    pub texels: TexelSlices<'a, T>,
    /// The ambient part of its colour, where it is apart.
    pub ambient: Option<TexelSlices<'a, T>>,
    /// Which cells are interesting; `None`: all.
    pub pyramid: Option<PyramidSlices<'a>>,
}

/// Where sixteen rays are at a sample.
struct Places {
    /// In their bricks, three bits of cell and then the way through it, on each axis.
    within: [[u32; LANES]; 3],
    /// The entries of their bricks in the table; of a ray outside the grid, any.
    entries: [u32; LANES],
}

impl Places {
    #[inline(always)]
    fn at(tile: &Tile, k: i64, counts: [usize; 3]) -> Self {
        let steps = k.wrapping_sub(tile.middle);
        let (mut within, mut bricks) = ([[0; LANES]; 3], [[0; LANES]; 3]);
        for axis in 0..3 {
            let (at, step) = (&tile.at[axis], &tile.step[axis]);
            for lane in 0..LANES {
                let place = at[lane].wrapping_add(step[lane].wrapping_mul(steps));
                within[axis][lane] = (place >> (FRACTION_BITS - PLACE_BITS)) as u32;
                bricks[axis][lane] = (place >> (FRACTION_BITS + BRICK_BITS)) as u32;
            }
        }
        let [x, y, _] = counts.map(|n| n as u32);
        let mut entries = [0; LANES];
        for lane in 0..LANES {
            let plane = bricks[2][lane].wrapping_mul(y).wrapping_add(bricks[1][lane]);
            entries[lane] = plane.wrapping_mul(x).wrapping_add(bricks[0][lane]);
        }
        Self { within, entries }
    }

    /// Of rows of `row` places and slices of `slice` of them, the place of each ray's cell in its brick.
    #[inline(always)]
    fn cells(&self, row: u32, slice: u32) -> [u32; LANES] {
        let mut cells = [0; LANES];
        for lane in 0..LANES {
            let cell = |axis: usize| self.within[axis][lane] >> PLACE_BITS & (CELLS as u32 - 1);
            cells[lane] = cell(2) * slice + cell(1) * row + cell(0);
        }
        cells
    }

    /// Where in its cell each ray is, 0..1, on one axis.
    #[inline(always)]
    fn parts(&self, axis: usize) -> [f32; LANES] {
        let mut parts = [0.0; LANES];
        for lane in 0..LANES {
            let part = self.within[axis][lane] & ((1 << PLACE_BITS) - 1);
            parts[lane] = part as i32 as f32 * (1.0 / (1_u32 << PLACE_BITS) as f32);
        }
        parts
    }
}

/// Which of `lanes` (all inside the grid) lie in interesting cells at sample `k`, and what those see: associated RGBA per
/// opacity unit; of its reflected part `fade` is left.
#[inline(always)]
pub fn meet<S: Simd, T: Texel>(
    simd: S,
    gel: GelSlices<'_, T>,
    fade: Option<f32>,
    tile: &Tile,
    (k, lanes): (i64, Lanes),
    seen: &mut [Vec4; LANES],
) -> Lanes {
    let places = Places::at(tile, k, gel.texels.counts());
    let cells = places.cells(CELLS as u32, (CELLS * CELLS) as u32);
    let (mut met, mut stored) = (0, [EMPTY; LANES]);
    // Neighbours lie in one brick or in few.
    let entries = u32x16::from_slice(simd, &places.entries);
    let mut left = lanes;
    while left != 0 {
        let entry = places.entries[left.trailing_zeros() as usize];
        let same = entries.simd_eq(u32x16::splat(simd, entry)).to_bitmask() as Lanes & left;
        left &= !same;
        let brick = gel.texels.stored(entry);
        let here = match gel.pyramid.map(|pyramid| pyramid.words(brick)) {
            Some(Some(words)) => same & interesting(words, &cells),
            Some(None) => 0,
            None => same,
        };
        each(here).for_each(|lane| stored[lane] = brick);
        met |= here;
    }
    if met == 0 {
        return met;
    }
    let first = places.cells(ROW as u32, (ROW * ROW) as u32);
    let parts = [places.parts(0), places.parts(1), places.parts(2)];
    for lane in each(met) {
        let part = [parts[0][lane], parts[1][lane], parts[2][lane]];
        let first = first[lane] as usize;
        let lit = sample(simd, gel.texels.texels(stored[lane]), first, part);
        seen[lane] = match (fade, gel.ambient) {
            (Some(fade), Some(ambient)) => {
                let ambient = sample(simd, ambient.texels(stored[lane]), first, part);
                (lit.truncate() * fade + ambient.truncate()).extend(lit.w)
            }
            _ => lit,
        };
    }
    met
}

/// Which of sixteen cells of a brick are interesting, by its words; a cell is counted `(z · 8 + y) · 8 + x`.
#[inline(always)]
fn interesting(words: &[u64; CELLS], cells: &[u32; LANES]) -> Lanes {
    let mut set = 0;
    for (lane, cell) in cells.iter().enumerate() {
        let word = words[(cell >> 6) as usize % CELLS];
        set |= ((word >> (cell & 63)) as u32 & 1) << lane;
    }
    set as Lanes
}

/// Tri-linear interpolation in the cell whose first texel is `first`: two texels at once, the axes y and z before x.
#[inline(always)]
fn sample<S: Simd, T: Texel>(
    simd: S,
    texels: &[T; TEXELS],
    first: usize,
    [x, y, z]: [f32; 3],
) -> Vec4 {
    let texels = &texels[first..][..ROW * ROW + ROW + 2];
    let pair = |offset: usize| {
        let pair = &texels[offset..][..2];
        f32x8::from_slice(simd, &T::channels([pair[0], pair[1]]))
    };
    let mix = |low: f32x8<S>, high: f32x8<S>, part: f32| (high - low) * part + low;
    let low = mix(pair(0), pair(ROW), y);
    let high = mix(pair(ROW * ROW), pair(ROW * ROW + ROW), y);
    let (low, high) = simd.split_f32x8(mix(low, high, z));
    let sample: f32x4<S> = ((high - low) * x + low) * T::SCALE;
    Vec4::from_slice(sample.as_slice())
}
