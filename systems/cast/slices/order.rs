//! The bricks of a layer that the rays of tiles may meet: along each of its axes those that rays come to first go before those
//! that they leave to.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use super::occupied::Occupied;
use super::shear::{Shear, Slice};
use super::tile::Tile;
use crate::volume::gel::CELLS;

/// Voxels along a brick.
const EDGE: i64 = CELLS as i64;

/// The first ray of a tile, U and V, and rays across and down.
pub(super) type Place = ([i64; 2], [usize; 2]);

/// The slices within one layer of bricks, and how far rays move along u and v among them.
pub(super) struct Layer {
    pub number: i64,
    pub slices: std::ops::Range<usize>,
    least: [i64; 2],
    most: [i64; 2],
}

impl Layer {
    /// The layer of bricks that slice `first` is the first in.
    pub fn of(shear: &Shear, slices: &[Slice], first: usize) -> Self {
        let number = slices[first].cell / EDGE;
        let more = slices[first..].iter().take_while(|slice| slice.cell / EDGE == number);
        let end = first + more.count();
        let ends = [slices[first].shift, slices[end - 1].shift];
        let least = [0, 1].map(|axis| ends[0][axis].min(ends[1][axis]));
        // Rays of other phases may be as many cells further as those of one are apart.
        let apart = [1, shear.apart as i64];
        let other = [0, 1].map(|axis| if shear.parts[axis] > 1 { apart[axis] } else { 0 });
        let most = [0, 1].map(|axis| ends[0][axis].max(ends[1][axis]) + other[axis]);
        Self { number, slices: first..end, least, most }
    }
}

/// A brick, and which rays of a tile may meet it.
#[derive(Clone, Copy)]
pub(super) struct Next {
    /// Where it is along u and v, in bricks.
    pub at: [i64; 2],
    /// The rows of rays, `[from, to)`, and bits of the columns.
    pub rows: [usize; 2],
    pub columns: u64,
}

/// Those that are still to come.
pub(super) struct Order<'a> {
    shear: &'a Shear,
    occupied: &'a Occupied,
    layer: &'a Layer,
    place: Place,
    /// The first and the last brick along u and v.
    low: [i64; 2],
    high: [i64; 2],
    /// Rows of bricks that were begun, and the bricks of the last one that are left, the first of `low` being bit 0.
    begun: i64,
    bricks: u64,
    /// Where that row is along v.
    v: i64,
    /// The rays of the tile that this row may be met by, and bits of the columns where some had not stopped.
    rows: [usize; 2],
    open: u64,
}

impl<'a> Order<'a> {
    /// Of a grid of so many bricks along u and v.
    #[inline(always)]
    pub fn new(
        (shear, occupied): (&'a Shear, &'a Occupied),
        bricks: [usize; 2],
        place: Place,
        layer: &'a Layer,
    ) -> Self {
        let (first, size) = place;
        let apart = [1, shear.apart as i64];
        let low = [0, 1].map(|axis| (first[axis] + layer.least[axis]).div_euclid(EDGE).max(0));
        let high = [0, 1].map(|axis| {
            let last = first[axis] + apart[axis] * (size[axis] as i64 - 1) + layer.most[axis];
            last.div_euclid(EDGE).min(bricks[axis] as i64 - 1)
        });
        let (begun, bricks, v, rows, open) = (0, 0, 0, [0; 2], 0);
        Self { shear, occupied, layer, place, low, high, begun, bricks, v, rows, open }
    }

    /// The next that rays of tiles may meet which have not stopped yet.
    #[inline(always)]
    pub fn next(&mut self, tiles: &[Tile]) -> Option<Next> {
        let u_ahead = self.shear.ahead[0];
        loop {
            while self.bricks != 0 {
                let behind =
                    if u_ahead { self.bricks.trailing_zeros() } else { self.bricks.ilog2() };
                self.bricks &= !(1 << behind);
                let u = self.low[0] + i64::from(behind);
                let columns = self.reached(0, u);
                if columns[0] < columns[1] && self.open & Tile::columns(columns) != 0 {
                    let columns = Tile::columns(columns);
                    return Some(Next { at: [u, self.v], rows: self.rows, columns });
                }
            }
            if self.low[0] > self.high[0] || self.begun > self.high[1] - self.low[1] {
                return None;
            }
            self.begin(tiles);
        }
    }

    /// Begins the next row of bricks.
    #[inline(always)]
    fn begin(&mut self, tiles: &[Tile]) {
        let [low, high] = [self.low[1] + self.begun, self.high[1] - self.begun];
        self.v = if self.shear.ahead[1] { low } else { high };
        self.begun += 1;
        self.rows = self.reached(1, self.v);
        if self.rows[0] < self.rows[1] {
            let along = [self.low[0], self.high[0]].map(|u| u as usize);
            self.bricks =
                self.occupied.among(along, [self.v, self.layer.number].map(|at| at as usize));
            self.open = tiles.iter().fold(0, |any, tile| any | tile.open_in(self.rows));
        }
    }

    /// The rays of a tile that a brick may be met by, `[from, to)` along one axis.
    #[inline(always)]
    fn reached(&self, axis: usize, brick: i64) -> [usize; 2] {
        let (first, size) = self.place;
        let apart = if axis == 1 { self.shear.apart } else { 1 };
        let from = EDGE * brick - first[axis];
        let [from, to] = [from - self.layer.most[axis], from + EDGE - self.layer.least[axis]];
        let [from, to] = [from, to].map(|at| at.max(0) as usize);
        [from / apart, to.div_ceil(apart)].map(|at| at.min(size[axis]))
    }
}
