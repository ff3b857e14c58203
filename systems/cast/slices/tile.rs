//! A tile of rays of one phase: what each has gathered, and which may still gather.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::prelude::*;
use fearless_simd::{f32x16, u8x64, u64x8};
use glam::Vec3;

use crate::view::composite::Gathered;
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
pub(super) const BYTES: usize = HIGH * PITCH * size_of::<[f32; 4]>();

/// Rays, a row after the other.
#[derive(Clone)]
pub(super) struct Tile {
    /// Associated colour and what still comes through of what is behind; 0 beside the tile.
    gathered: Vec<[[f32; 4]; PITCH]>,
    /// Bits of the rays that have not stopped, row by row.
    open: [u64; HIGH + 2 * BEFORE],
    size: [usize; 2],
    is_met: bool,
}

impl Default for Tile {
    fn default() -> Self {
        let gathered = vec![[[0.0; 4]; PITCH]; HIGH];
        Self { gathered, open: [0; HIGH + 2 * BEFORE], size: [0; 2], is_met: false }
    }
}

/// Where the rays of a slice of a brick are in a tile, which some may be beside.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Window {
    /// Of the first, counted from [`BEFORE`] the tile.
    column: u8,
    row: u8,
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
        let [column, row] = [u, row].map(|n| (n + BEFORE as i64) as u8);
        inside.then_some(Self { column, row, rows: (apart as i64 - 1 + odd) as u8 })
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
            for row in &mut self.gathered {
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
        let first = usize::from(at.row);
        let Some(rows) = self.open.get(first..).and_then(<[u64]>::first_chunk::<SIDE>) else {
            return 0;
        };
        let (bytes, cells) = &ROWS[usize::from(at.rows) % ROWS.len()];
        let rows = u64x8::from_slice(simd, rows) >> u32::from(at.column);
        let rows: u8x64<S> = rows.bitcast();
        let rows: u64x8<S> = rows.swizzle_dyn(u8x64::from_slice(simd, bytes)).bitcast();
        rows.as_slice()[0] & cells
    }

    /// The rays of a slice in the cell `[u, v]` and three on; `None` where they are beside the tile.
    #[inline(always)]
    pub fn four(&mut self, at: Window, [u, v]: [usize; 2]) -> Option<Four<'_>> {
        let column = usize::from(at.column) + u;
        let row = usize::from(at.row) + (v >> u32::from(at.rows > 0));
        let gathered = self.gathered.get_mut(row.wrapping_sub(BEFORE))?.get_mut(column..)?;
        let gathered = gathered.as_flattened_mut().first_chunk_mut()?;
        Some(Four { gathered, open: self.open.get_mut(row)?, column: column as u32 })
    }

    /// C of the first rays of a row, linear associated RGBA; `None` of those that met nothing.
    pub fn colors(
        &self,
        row: usize,
        across: usize,
        stop: f32,
    ) -> impl Iterator<Item = Option<[f32; 4]>> {
        self.gathered[row][BEFORE..][..across].iter().map(move |&[r, g, b, through]| {
            let color = Vec3::new(r, g, b).as_dvec3();
            // Interpolation may leave an opacity a hair above 1.
            let ray = Gathered { color, through: f64::from(through.max(0.0)) };
            (through < 1.0).then(|| ray.rgba(f64::from(stop)))
        })
    }
}

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

/// Four rays of a row.
pub(super) struct Four<'t> {
    gathered: &'t mut [f32; 16],
    open: &'t mut u64,
    column: u32,
}

impl Four<'_> {
    /// Bits of those that have not stopped.
    #[inline(always)]
    pub fn left(&self) -> u64 {
        *self.open >> self.column & 0xf
    }

    /// Puts slabs behind what they gathered: associated colour and, below 0, opacity. A ray stops when no more than `stop`
    /// comes through.
    #[inline(always)]
    pub fn under<S: Simd>(&mut self, simd: S, slabs: f32x16<S>, stop: f32) {
        let before = f32x16::from_slice(simd, self.gathered);
        let through = fourth(simd, before);
        let through = through.simd_gt(stop).select(through, f32x16::splat(simd, 0.0));
        let after = through * slabs + before;
        after.store_slice(self.gathered);
        // Without a branch: whether a ray stops is no guess, and is known late.
        let stopped = after.simd_le(stop).to_bitmask() >> 3 & 0x1111;
        let stopped = (stopped | stopped >> 3 | stopped >> 6 | stopped >> 9) & 0xf;
        *self.open &= !(stopped << self.column);
    }
}
