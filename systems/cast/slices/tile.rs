//! A tile of rays of one phase: what each has gathered, and which may still gather.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::prelude::*;
use fearless_simd::{f32x16, u8x64, u64x8};
use glam::Vec3;

use crate::view::composite::Gathered;

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

/// Where a slice of a brick's rays are in a tile: some may be beside it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    column: i64,
    row: i64,
}

impl Window {
    /// The first of them at that column and row; `None` where none is in a tile.
    #[inline(always)]
    pub fn new([column, row]: [i64; 2]) -> Option<Self> {
        let side = SIDE as i64;
        let inside =
            (1 - side..WIDE as i64).contains(&column) && (1 - side..HIGH as i64).contains(&row);
        inside.then_some(Self { column, row })
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

    /// Which rays of a slice have not stopped: bit `8 v + u`.
    #[inline(always)]
    pub fn left<S: Simd>(&self, simd: S, at: Window) -> u64 {
        const FIRST: [u8; 64] = {
            let (mut bytes, mut n) = ([0; 64], 0);
            while n < SIDE {
                bytes[n] = (8 * n) as u8;
                n += 1;
            }
            bytes
        };
        let first = (at.row + BEFORE as i64) as usize;
        let Some(rows) = self.open.get(first..).and_then(<[u64]>::first_chunk::<SIDE>) else {
            return 0;
        };
        let rows = u64x8::from_slice(simd, rows) >> ((at.column + BEFORE as i64) as u32);
        let bytes: u8x64<S> = rows.bitcast();
        let bytes: u64x8<S> = bytes.swizzle_dyn(u8x64::from_slice(simd, &FIRST)).bitcast();
        bytes.as_slice()[0]
    }

    /// Which of eight rays of a row of a slice have not stopped, and what they gathered; `None` where the row is beside the tile.
    #[inline(always)]
    pub fn row(&mut self, at: Window, row: usize) -> Option<Row<'_>> {
        let right = (at.column + BEFORE as i64) as usize;
        let row = at.row + row as i64;
        let gathered = self.gathered.get_mut(row as usize)?.get_mut(right..)?;
        let gathered = gathered.as_flattened_mut().first_chunk_mut()?;
        let open = self.open.get_mut((row + BEFORE as i64) as usize)?;
        Some(Row { gathered, open, right })
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

/// Eight rays of a row.
pub(super) struct Row<'t> {
    gathered: &'t mut [f32; 4 * SIDE],
    open: &'t mut u64,
    right: usize,
}

impl Row<'_> {
    /// Bits of those that have not stopped.
    #[inline(always)]
    pub fn left(&self) -> u64 {
        *self.open >> self.right & 0xff
    }

    /// Puts slabs behind what four of them gathered, the first or the last: associated colour and, below 0, opacity. A ray stops
    /// when no more than `stop` comes through.
    #[inline(always)]
    pub fn under<S: Simd>(&mut self, simd: S, last: bool, slabs: f32x16<S>, stop: f32) {
        let [first, half] = [if last { 16 } else { 0 }, if last { 4 } else { 0 }];
        let gathered = &mut self.gathered[first..][..16];
        let before = f32x16::from_slice(simd, gathered);
        let through = fourth(simd, before);
        let through = through.simd_gt(stop).select(through, f32x16::splat(simd, 0.0));
        let after = through * slabs + before;
        after.store_slice(gathered);
        let stopped = after.simd_le(stop).to_bitmask() >> 3 & 0x1111;
        if stopped != 0 {
            let stopped = (stopped | stopped >> 3 | stopped >> 6 | stopped >> 9) & 0xf;
            *self.open &= !(stopped << half << self.right);
        }
    }
}

/// The last channel of each of four, in all four of its channels.
#[inline(always)]
pub(super) fn fourth<S: Simd>(simd: S, channels: f32x16<S>) -> f32x16<S> {
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
