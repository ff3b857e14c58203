//! A packet of rays as one thick ray: which cells it reaches, and how far it may leap.

use super::lanes::LANES;
use crate::view::walk::{FRACTION_BITS, Tile};
use crate::volume::pyramid::PyramidSlices;

/// A packet as a thick ray: all its rays lie within `radius` of its middle.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Bundle {
    /// Fixed-point voxel index at the tile's middle sample.
    at: [i64; 3],
    step: [i64; 3],
    /// Cells, along the axis that the rays are most spread on.
    pub radius: f64,
    /// Steps to a cell, along the axis that it goes fastest on.
    pub per_cell: f64,
    /// Which of the pyramid's bits answer for all of it, if some do.
    pub reaching: Option<usize>,
}

impl Bundle {
    /// That of a tile's rays; what is looked for of a volume reaches `reach` cells around them.
    pub fn of(tile: &Tile, pyramid: Option<PyramidSlices<'_>>, reach: f64) -> Self {
        let last = LANES - 1;
        // Places are affine over the tile: its middle is that of opposite corners, and the corners are farthest from it.
        let middle = |triples: &[[i64; LANES]; 3]| {
            std::array::from_fn(|axis| i64::midpoint(triples[axis][0], triples[axis][last]))
        };
        let (at, step): ([i64; 3], [i64; 3]) = (middle(&tile.at), middle(&tile.step));
        let spread = |k: i64| {
            let steps = k.wrapping_sub(tile.middle);
            let from = |axis: usize, lane: usize| {
                let middle = at[axis].wrapping_add(step[axis].wrapping_mul(steps));
                tile.place(axis, lane, k).wrapping_sub(middle).unsigned_abs()
            };
            (0..3).flat_map(|axis| [from(axis, 0), from(axis, 3)]).max().unwrap_or(0)
        };
        let unit = (1_u64 << FRACTION_BITS) as f64;
        let spread = spread(tile.some[0]).max(spread(tile.some[1]));
        let fastest = step.iter().map(|step| step.unsigned_abs()).max().unwrap_or(0).max(1);
        // Rounding moves each end by less than a unit, and by as much again with every step from the middle.
        let steps = tile.some.map(|k| k.abs_diff(tile.middle)).into_iter().max().unwrap_or(0);
        let radius = (spread.saturating_add(steps) + 8) as f64 / unit + reach;
        let reaching = pyramid.filter(|_| reach > 0.0).and(PyramidSlices::reaching(radius));
        Self { at, step, radius, per_cell: unit / fastest as f64, reaching }
    }

    /// The lowest and the highest cells that its rays lie in from one sample to another, by their steps from the middle.
    #[inline]
    pub fn reach(&self, steps: [i64; 2]) -> [[i64; 3]; 2] {
        let ends = steps.map(|steps| self.cell(steps));
        let around = self.radius.ceil() as i64;
        let low = std::array::from_fn(|axis| ends[0][axis].min(ends[1][axis]).wrapping_sub(around));
        let high =
            std::array::from_fn(|axis| ends[0][axis].max(ends[1][axis]).wrapping_add(around));
        [low, high]
    }

    /// The cell that its middle is in, so many steps from the tile's middle sample.
    #[inline]
    pub fn cell(&self, steps: i64) -> [i64; 3] {
        std::array::from_fn(|axis| {
            self.at[axis].wrapping_add(self.step[axis].wrapping_mul(steps)) >> FRACTION_BITS
        })
    }
}
