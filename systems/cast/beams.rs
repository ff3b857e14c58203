//! Beams: small tiles of the picture, and which polygons may be met in each.

use glam::DVec2;

use crate::view::samples::{Layout, POSITIONS};

/// Pixels along a beam's side.
const PIXELS: usize = 4;
/// Positions of the sample array along a beam's side.
pub const SIDE: usize = PIXELS * POSITIONS;

/// How a sample array is cut into beams of 16 × 16 positions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beams {
    /// The positions of the array.
    pub layout: Layout,
    /// Beams across and down.
    pub counts: [usize; 2],
}

impl Beams {
    /// The beams of a sample array.
    pub fn new(layout: Layout) -> Self {
        Self { layout, counts: layout.positions().map(|n| n.div_ceil(SIDE)) }
    }

    /// The beams that positions between window coordinates `low` and `high` (pixels) may lie in, as half-open ranges
    /// across and down; empty outside the array.
    pub fn around(&self, low: DVec2, high: DVec2) -> [std::ops::Range<usize>; 2] {
        let position = |window: f64| (window - 0.5) * POSITIONS as f64 + self.layout.margin as f64;
        let range = |low: f64, high: f64, count: usize| {
            // A position's slack against rounding; casts saturate, NaN becomes 0.
            let first = ((position(low) - 0.01) / SIDE as f64).floor().max(0.0) as usize;
            let end = ((position(high) + 0.01) / SIDE as f64).floor() + 1.0;
            first.min(count)..(end.max(0.0) as usize).min(count)
        };
        [range(low.x, high.x, self.counts[0]), range(low.y, high.y, self.counts[1])]
    }

    /// The number of the beam around a position, counted from the middle of pixel (0, 0).
    pub(crate) fn around_position(&self, position: [i64; 2]) -> usize {
        let [x, y] = position.map(|n| (n + self.layout.margin as i64) as usize / SIDE);
        y * self.counts[0] + x
    }
}
