//! Sixteen rays at their next four samples: which of the sixty-four places lie in interesting cells (level 0 of the paper's
//! pyramid, §6).
//!
//! Places near one another lie in one brick or in few, and the cells of a brick are the bits of sixty-four bytes: for each
//! brick, all its places are looked up at once.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]
#![allow(clippy::needless_range_loop, reason = "sixteen lanes at once, by their number")]

use fearless_simd::{Simd, SimdBase, SimdMask, u8x16, u8x64};

use super::lanes::{LANES, Lanes};
use crate::view::walk::{FRACTION_BITS, Tile};
use crate::volume::gel::{CELLS, EMPTY};

/// Samples that are looked at together.
pub(crate) const SAMPLES: usize = 4;
/// Places that are.
const PLACES: usize = SAMPLES * LANES;
/// Bits of a fixed-point voxel index within its brick.
const WITHIN: u32 = FRACTION_BITS + CELLS.trailing_zeros();
/// Bricks along each axis that one look reaches over.
const REACH: i64 = 4;
/// Bit n at n, for each of eight cells of a row; twice.
const BIT: [u8; 16] = [1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128];

/// Which cells of a volume are interesting.
#[derive(Clone, Copy)]
pub(crate) struct Cells<'a> {
    /// Bricks on each axis.
    pub counts: [usize; 3],
    /// For each brick of the grid, x fastest: its number among those that are stored, or [`EMPTY`].
    pub table: &'a [u32],
    /// Of each stored brick, bit `8 y + x` of word `z`; `None`: all cells, stored or not.
    pub words: Option<&'a [[u64; CELLS]]>,
}

impl Cells<'_> {
    /// The number of a brick among the stored ones; [`EMPTY`] outside the grid too.
    #[inline(always)]
    fn stored(&self, brick: [i64; 3]) -> u32 {
        let [x, y, z] = brick.map(|n| n as u64);
        let [nx, ny, nz] = self.counts.map(|n| n as u64);
        if x >= nx || y >= ny || z >= nz {
            return EMPTY;
        }
        self.table.get(((z * ny + y) * nx + x) as usize).copied().unwrap_or(EMPTY)
    }

    /// The cells of a stored brick, a byte a row; `None` for one that has none.
    #[inline(always)]
    fn rows(&self, brick: u32) -> Option<[[u8; CELLS]; CELLS]> {
        let words = self.words.map_or(Some(&[u64::MAX; CELLS]), |words| words.get(brick as usize));
        words.map(|words| words.map(u64::to_le_bytes))
    }
}

/// The place of the brick around a cell; also of cells before the first.
#[inline(always)]
fn brick_of([x, y, z]: [i64; 3]) -> [i64; 3] {
    let by = CELLS.trailing_zeros();
    [x >> by, y >> by, z >> by]
}

/// Some samples of a packet, looked at.
#[derive(Debug, Clone)]
pub(crate) struct Window {
    /// The samples `[first, end)`.
    first: i64,
    end: i64,
    /// Which rays lie in interesting cells: sixteen bits a sample.
    met: u64,
    /// For each place, which of the bricks that were reached it lies in.
    within: [u8; PLACES],
    /// The numbers of those bricks among the stored ones.
    bricks: [u32; PLACES],
}

impl Default for Window {
    /// No sample.
    fn default() -> Self {
        let (within, bricks) = ([0; PLACES], [EMPTY; PLACES]);
        Self { first: i64::MIN, end: i64::MIN, met: 0, within, bricks }
    }
}

/// Places that a packet is looked for among.
pub(crate) struct Sight {
    /// The lowest and the highest cell on each axis, at the samples of one look.
    pub cells: [[i64; 3]; 2],
    /// Which of the places, sixteen bits a sample, are in the grid.
    pub held: u64,
}

impl Window {
    /// Forgets what was seen.
    pub fn forget(&mut self) {
        (self.first, self.end) = (i64::MIN, i64::MIN);
    }

    /// Whether a sample was looked at.
    #[inline]
    pub fn holds(&self, k: i64) -> bool {
        self.first <= k && k < self.end
    }

    /// One past the last sample that was looked at.
    #[inline]
    pub fn end(&self) -> i64 {
        self.end
    }

    /// The first sample from `k` on, which was looked at, that some of `lanes` lie in an interesting cell at.
    #[inline]
    pub fn next(&self, k: i64, lanes: Lanes) -> Option<i64> {
        let all = u64::from(lanes) * 0x0001_0001_0001_0001;
        let left = (self.met & all) >> (LANES as i64 * (k - self.first));
        (left != 0).then(|| k + i64::from(left.trailing_zeros()) / LANES as i64)
    }

    /// Which rays lie in interesting cells at a sample that was looked at.
    #[inline]
    pub fn at(&self, k: i64) -> Lanes {
        (self.met >> (LANES as i64 * (k - self.first))) as Lanes
    }

    /// The number of the stored brick that a ray lies in at such a sample.
    #[inline(always)]
    pub fn brick(&self, k: i64, lane: usize) -> u32 {
        let place = (LANES as i64 * (k - self.first)) as usize + lane;
        self.bricks[usize::from(self.within[place % PLACES]) % PLACES]
    }

    /// How many of the places that were looked at are empty, of those `held` in the grid; and at how many samples.
    pub fn looked(&self, held: u64) -> [u64; 2] {
        let samples = (self.end - self.first) as u64;
        let looked = if samples == 1 { u64::from(Lanes::MAX) } else { u64::MAX };
        [u64::from((held & looked & !self.met).count_ones()), samples]
    }

    /// Looks at the samples from `k` on.
    #[inline(always)]
    pub fn look<S: Simd>(&mut self, simd: S, cells: Cells<'_>, tile: &Tile, k: i64, sight: &Sight) {
        let [low, high] = [brick_of(sight.cells[0]), brick_of(sight.cells[1])];
        if (0..3).any(|axis| high[axis].wrapping_sub(low[axis]) >= REACH) {
            self.look_apart(cells, tile, k, sight.held as Lanes);
            return;
        }
        (self.first, self.end) = (k, k + SAMPLES as i64);
        let steps = k.wrapping_sub(tile.middle);
        let mut places = [[0; PLACES]; 3];
        for axis in 0..3 {
            let (at, step) = (&tile.at[axis], &tile.step[axis]);
            let mut from = [0; LANES];
            for lane in 0..LANES {
                let place = at[lane].wrapping_add(step[lane].wrapping_mul(steps));
                from[lane] = place.wrapping_sub(low[axis] << WITHIN);
            }
            for sample in 0..SAMPLES {
                for lane in 0..LANES {
                    places[axis][LANES * sample + lane] = (from[lane] >> FRACTION_BITS) as u8;
                    from[lane] = from[lane].wrapping_add(step[lane]);
                }
            }
        }
        let [x, y, z] = places.map(|places| u8x64::from_slice(simd, &places));
        let within = ((x >> 3) & 0b11) | ((y >> 1) & 0b1100) | ((z & 0b1_1000) << 1);
        let row = (y & 0b111) | ((z & 0b111) << 3);
        let bit =
            u8x64::block_splat(u8x16::from_slice(simd, &BIT)).swizzle_dyn_within_blocks(x & 0b111);
        self.within.copy_from_slice(within.as_slice());
        let (mut left, mut met) = (sight.held, 0);
        while left != 0 {
            let one = self.within[left.trailing_zeros() as usize];
            let same = within.simd_eq(one).to_bitmask() & left;
            left &= !same;
            let apart = [one & 3, one >> 2 & 3, one >> 4].map(i64::from);
            let brick = cells.stored(std::array::from_fn(|axis| low[axis] + apart[axis]));
            self.bricks[usize::from(one) % PLACES] = brick;
            if let Some(rows) = cells.rows(brick) {
                let rows = u8x64::from_slice(simd, rows.as_flattened());
                let empty = (rows.swizzle_dyn(row) & bit).simd_eq(0);
                met |= same & !empty.to_bitmask();
            }
        }
        self.met = met;
    }

    /// Looks at one sample, of rays far from one another.
    #[cold]
    fn look_apart(&mut self, cells: Cells<'_>, tile: &Tile, k: i64, held: Lanes) {
        (self.first, self.end, self.met) = (k, k + 1, 0);
        for lane in super::lanes::each(held) {
            let cell = tile.at_sample(lane, k).map(|place| place >> FRACTION_BITS);
            let brick = cells.stored(brick_of(cell));
            self.within[lane] = lane as u8;
            self.bricks[lane] = brick;
            let [x, y, z] = cell.map(|n| n as usize % CELLS);
            let interesting = cells.rows(brick).is_some_and(|rows| rows[z][y] >> x & 1 == 1);
            self.met |= u64::from(interesting) << lane;
        }
    }
}
