//! What sixteen rays see of the gel at one sample, in the cells that hold any.
//!
//! Compiled anew for each set of instructions; a product is always rounded before it is added to, so that no bit depends on
//! which set it is.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]
#![allow(clippy::needless_range_loop, reason = "sixteen lanes at once, by their number")]

use fearless_simd::{Simd, SimdBase, f32x4, f32x8};
use glam::Vec4;

use super::lanes::{LANES, Lanes, each};
use super::window::{Cells, Window};
use crate::view::walk::{FRACTION_BITS, PLACE_BITS, Tile};
use crate::volume::gel::{CELLS, ROW, Texel, TexelSlices};
use crate::volume::pyramid::PyramidSlices;

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

impl<'a, T: Texel> GelSlices<'a, T> {
    /// The cells that hold any.
    #[inline]
    pub fn cells(&self) -> Cells<'a> {
        let words = self.pyramid.map(PyramidSlices::all_words);
        Cells { counts: self.texels.counts(), table: self.texels.table(), words }
    }
}

/// Where sixteen rays are at a sample: on each axis, eight bits of voxel index and then the way through the cell.
struct Places([[u32; LANES]; 3]);

impl Places {
    #[inline(always)]
    fn at(tile: &Tile, k: i64) -> Self {
        let steps = k.wrapping_sub(tile.middle);
        let mut places = [[0; LANES]; 3];
        for axis in 0..3 {
            let (at, step) = (&tile.at[axis], &tile.step[axis]);
            for lane in 0..LANES {
                let place = at[lane].wrapping_add(step[lane].wrapping_mul(steps));
                places[axis][lane] = (place >> (FRACTION_BITS - PLACE_BITS)) as u32;
            }
        }
        Self(places)
    }

    /// Where the first texel of each ray's cell is in its brick.
    #[inline(always)]
    fn texels(&self) -> [u32; LANES] {
        let mut texels = [0; LANES];
        for lane in 0..LANES {
            let cell = |axis: usize| self.0[axis][lane] >> PLACE_BITS & (CELLS as u32 - 1);
            texels[lane] = (cell(2) * ROW as u32 + cell(1)) * ROW as u32 + cell(0);
        }
        texels
    }

    /// Where in its cell each ray is, 0..1, on one axis.
    #[inline(always)]
    fn parts(&self, axis: usize) -> [f32; LANES] {
        let mut parts = [0.0; LANES];
        for lane in 0..LANES {
            let part = self.0[axis][lane] & ((1 << PLACE_BITS) - 1);
            parts[lane] = part as i32 as f32 * (1.0 / (1_u32 << PLACE_BITS) as f32);
        }
        parts
    }
}

/// What `lanes` see at sample `k`, which was looked at: associated RGBA per opacity unit; of its reflected part `fade` is
/// left.
#[inline(always)]
pub fn meet<S: Simd, T: Texel>(
    simd: S,
    gel: &GelSlices<'_, T>,
    fade: Option<f32>,
    (tile, window): (&Tile, &Window),
    (k, lanes): (i64, Lanes),
    seen: &mut [Vec4; LANES],
) {
    let places = Places::at(tile, k);
    let first = places.texels();
    let parts = [places.parts(0), places.parts(1), places.parts(2)];
    for lane in each(lanes) {
        let part = [parts[0][lane], parts[1][lane], parts[2][lane]];
        let place = (window.brick(k, lane), first[lane] as usize, part);
        let lit = sample(simd, gel.texels, place);
        seen[lane] = match (fade, gel.ambient) {
            (Some(fade), Some(ambient)) => {
                let ambient = sample(simd, ambient, place);
                (lit.truncate() * fade + ambient.truncate()).extend(lit.w)
            }
            _ => lit,
        };
    }
}

/// From the first texel of a cell to its last, in a brick.
const CELL: usize = ROW * ROW + ROW + 2;

/// Tri-linear interpolation in the cell of a brick whose first texel is `first`: two texels at once, the axes y and z before x.
#[inline(always)]
fn sample<S: Simd, T: Texel>(
    simd: S,
    gel: TexelSlices<'_, T>,
    (brick, first, [x, y, z]): (u32, usize, [f32; 3]),
) -> Vec4 {
    // Every cell ends within its brick.
    let Some(texels) = gel.texels(brick).get(first..).and_then(<[T]>::first_chunk::<CELL>) else {
        return Vec4::ZERO;
    };
    let pair = |offset: usize| T::channels(simd, &[texels[offset], texels[offset + 1]]);
    let mix = |low: f32x8<S>, high: f32x8<S>, part: f32| (high - low) * part + low;
    let low = mix(pair(0), pair(ROW), y);
    let high = mix(pair(ROW * ROW), pair(ROW * ROW + ROW), y);
    let (low, high) = simd.split_f32x8(mix(low, high, z));
    let sample: f32x4<S> = (high - low) * x + low;
    Vec4::from_slice(sample.as_slice()) * gel.scale()
}
