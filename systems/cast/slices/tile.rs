//! A tile of rays of one phase: what each has gathered, and which may still gather.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::prelude::*;
use fearless_simd::{f32x16, u8x64, u64x8};

use crate::view::four_colors::fourth;

/// Rays across a tile; with eight more on either side their bits are a word.
pub(super) const WIDE: usize = 48;
/// Rays down.
pub(super) const HIGH: usize = 32;
/// Bits before those of the first ray of a row, and places of the rows of a slice that begins before the tile.
const BEFORE: usize = 8;
/// Rays of a row that are kept, with those beside the tile, which gather nothing.
const PITCH: usize = WIDE + 2 * BEFORE;
/// Rays of a slice of a brick along each axis.
pub(super) const SIDE: usize = 8;

/// Bytes of a tile.
pub(super) const BYTES: usize = (HIGH + 2 * BEFORE) * PITCH * size_of::<[f32; 4]>();

/// Rays, a row after the other.
#[derive(Clone)]
pub(super) struct Tile {
    /// Associated colour and what still comes through of what is behind; 0 beside the tile, where nothing is gathered.
    gathered: Vec<[[f32; 4]; PITCH]>,
    /// Bits of the rays that have not stopped, row by row.
    open: [u64; HIGH + 2 * BEFORE],
    size: [usize; 2],
    is_met: bool,
}

impl Default for Tile {
    fn default() -> Self {
        let gathered = vec![[[0.0; 4]; PITCH]; HIGH + 2 * BEFORE];
        Self { gathered, open: [0; HIGH + 2 * BEFORE], size: [0; 2], is_met: false }
    }
}

/// Where the rays of a slice of a brick are in a tile, which some may be beside.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Window {
    /// The first, counted along rows from [`BEFORE`] the tile.
    pub first: u16,
    /// Which rows of cells have rays: all, or every second from the first or the second on.
    rows: u8,
}

impl Window {
    /// The cells from `[u, v]` on, counted from the tile's first ray, whose rows are so many cells `apart`; `None` where none of
    /// their rays is in a tile.
    #[inline(always)]
    pub fn new([u, v]: [i64; 2], apart: usize) -> Option<Self> {
        let odd = if apart == 2 { v & 1 } else { 0 };
        let row = if apart == 2 { (v + odd) >> 1 } else { v };
        let side = SIDE as i64;
        let inside = (1 - side..WIDE as i64).contains(&u) && (1 - side..HIGH as i64).contains(&row);
        let [column, row] = [u, row].map(|n| n + BEFORE as i64);
        let first = (row * PITCH as i64 + column) as u16;
        inside.then_some(Self { first, rows: (apart as i64 - 1 + odd) as u8 })
    }
}

impl Tile {
    /// Begins anew with so many rays across and down.
    pub fn open(&mut self, size: [usize; 2]) {
        self.open.fill(0);
        self.open[BEFORE..][..size[1]].fill(((1 << size[0]) - 1) << BEFORE);
        (self.size, self.is_met) = (size, false);
    }

    /// Whether any of its rays met a brick.
    pub fn is_met(&self) -> bool {
        self.is_met
    }

    /// That rays of it meet a brick: nothing is gathered yet at the first.
    #[inline(always)]
    pub fn meet(&mut self) {
        if !self.is_met {
            self.is_met = true;
            for row in &mut self.gathered[BEFORE..BEFORE + HIGH] {
                *row = [[0.0; 4]; PITCH];
                row[BEFORE..][..self.size[0]].fill([0.0, 0.0, 0.0, 1.0]);
            }
        }
    }

    /// Bits of the columns in which rays of some rows have not stopped.
    #[inline(always)]
    pub fn open_in(&self, rows: [usize; 2]) -> u64 {
        let rows = &self.open[BEFORE + rows[0]..BEFORE + rows[1]];
        rows.iter().fold(0, |any, row| any | row)
    }

    /// The bits of some columns, `[from, to)`, of which there are at least one and at most [`WIDE`].
    #[inline(always)]
    pub fn columns([from, to]: [usize; 2]) -> u64 {
        (u64::MAX >> (64 - (to - from))) << (from + BEFORE)
    }

    /// In which cells of a slice a ray has not stopped: bit `8 v + u`.
    #[inline(always)]
    pub fn left<S: Simd>(&self, simd: S, at: Window) -> u64 {
        let (row, column) = (usize::from(at.first) / PITCH, u32::from(at.first) % PITCH as u32);
        let Some(rows) = self.open.get(row..).and_then(<[u64]>::first_chunk::<SIDE>) else {
            return 0;
        };
        let (bytes, cells) = &ROWS[usize::from(at.rows) % ROWS.len()];
        let rows = u64x8::from_slice(simd, rows) >> column;
        let rows: u8x64<S> = rows.bitcast();
        let rows: u64x8<S> = rows.swizzle_dyn(u8x64::from_slice(simd, bytes)).bitcast();
        rows.as_slice()[0] & cells
    }

    /// From the first ray of a window to that of the cell `[u, v]` of its slice, whose rows of rays are so many cells `apart`.
    #[inline(always)]
    pub fn way([u, v]: [usize; 2], apart: usize) -> usize {
        (v >> (apart - 1)) * PITCH + u
    }

    /// Of four rays, from one counted like [`Window::first`] on, bits of those that have not stopped.
    #[inline(always)]
    pub fn four(&self, ray: usize) -> u64 {
        self.open.get(ray / PITCH).map_or(0, |open| open >> (ray % PITCH) & 0xf)
    }

    /// Puts slabs behind what four rays gathered: associated colour and, below 0, opacity. Sixteen bits, of which every fourth
    /// tells that a ray is to [`stop`](Self::stop): no more than `stop` comes through.
    #[inline(always)]
    pub fn under<S: Simd>(&mut self, simd: S, ray: usize, slabs: f32x16<S>, stop: f32) -> u64 {
        let gathered = self.gathered.as_flattened_mut().get_mut(ray..);
        let Some(gathered) = gathered.and_then(<[[f32; 4]]>::first_chunk_mut::<4>) else {
            return 0;
        };
        let gathered = gathered.as_flattened_mut();
        let before = f32x16::from_slice(simd, gathered);
        let through = fourth(simd, before);
        let through = through.simd_gt(stop).select(through, f32x16::splat(simd, 0.0));
        let after = through * slabs + before;
        after.store_slice(gathered);
        after.simd_le(stop).to_bitmask()
    }

    /// Of what [`under`](Self::under) told of four tiles, each sixteen bits further, the bits of those that stop: four of each
    /// sixteen.
    #[inline(always)]
    pub fn stopped(told: u64) -> u64 {
        let stopped = told >> 3 & 0x1111_1111_1111_1111;
        (stopped | stopped >> 3 | stopped >> 6 | stopped >> 9) & 0x000f_000f_000f_000f
    }

    /// Stops those of four rays whose bits are set.
    #[inline(always)]
    pub fn stop(&mut self, ray: usize, stopped: u64) {
        if let Some(open) = self.open.get_mut(ray / PITCH) {
            *open &= !(stopped << (ray % PITCH));
        }
    }

    /// C of the first rays of a row, linear associated RGBA, into every so manyth of `written`; which of them met anything, first
    /// and one past the last, and by how much the brightest is above its opacity, 0 if none is.
    ///
    /// A ray that stopped is taken as opaque: the colour gathered so far stands for the rest too.
    #[inline(always)]
    pub fn write<S: Simd>(
        &self,
        simd: S,
        row: usize,
        stop: f32,
        (written, every): (&mut [[f32; 4]], usize),
    ) -> ([usize; 2], f32) {
        let gathered = &self.gathered[BEFORE + row][BEFORE..BEFORE + WIDE];
        let mut met = [usize::MAX, 0];
        let mut most = f32x16::splat(simd, 0.0);
        let fours = self.size[0].div_ceil(4);
        for (four, gathered) in gathered.as_chunks::<4>().0.iter().take(fours).enumerate() {
            let gathered = f32x16::from_slice(simd, gathered.as_flattened());
            // Interpolation may leave an opacity a hair above 1.
            let through = fourth(simd, gathered).max(0.0);
            let inside = (1_u64 << (4 * (self.size[0] - 4 * four).min(4))) - 1;
            let here = through.simd_lt(1.0).to_bitmask() & inside;
            if here == 0 {
                continue;
            }
            let opacity = 1.0 - through;
            let is_stopped = through.simd_le(stop) & through.simd_gt(0.0);
            let colors = is_stopped.select(gathered / opacity, gathered);
            let opacity = is_stopped.select(f32x16::splat(simd, 1.0), opacity);
            let colors = colors * f32x16::from_slice(simd, COLOR.as_flattened())
                + opacity * f32x16::from_slice(simd, OPACITY.as_flattened());
            most = most.max(colors - opacity);
            met[0] = met[0].min(4 * four + here.trailing_zeros() as usize / 4);
            met[1] = 4 * four + here.ilog2() as usize / 4 + 1;
            let colors = colors.as_slice().as_chunks::<4>().0;
            for (color, ray) in colors.iter().zip(4 * four..) {
                if let Some(slot) = written.get_mut(ray * every) {
                    *slot = *color;
                }
            }
        }
        let most = most.as_slice().iter().fold(0.0_f32, |most, above| most.max(*above));
        (met, most)
    }
}

/// Channels of four rays.
static COLOR: [[f32; 4]; 4] = [[1.0, 1.0, 1.0, 0.0]; 4];
static OPACITY: [[f32; 4]; 4] = [[0.0, 0.0, 0.0, 1.0]; 4];

/// By the rows of cells that have rays: which byte of eight words is in which row, and the cells of those rows.
static ROWS: [([u8; 64], u64); 3] = [
    (rows(0, 1), u64::MAX),
    (rows(0, 2), 0x00ff_00ff_00ff_00ff),
    (rows(1, 2), 0xff00_ff00_ff00_ff00),
];

const fn rows(first: usize, apart: usize) -> [u8; 64] {
    let (mut bytes, mut word) = ([0; 64], 0);
    while first + apart * word < SIDE {
        bytes[first + apart * word] = (8 * word) as u8;
        word += 1;
    }
    bytes
}
