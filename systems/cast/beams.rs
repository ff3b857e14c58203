//! Beams: small tiles of the picture. Which positions of rays a polygon may be met at, and so in which beams.

use glam::DVec2;

use crate::view::samples::{Layout, POSITIONS};

/// Pixels along a beam's side.
const PIXELS: usize = 4;
/// Positions of the sample array along a beam's side.
pub const SIDE: usize = PIXELS * POSITIONS;
/// How far outside the bounding box of a polygon a ray is sure to miss it, positions. The box rejects and never decides:
/// rounding there must not take from a polygon what its neighbour leaves to it.
const OUTSIDE: f64 = 1e-5;

/// How a sample array is cut into beams of 16 × 16 positions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beams {
    /// The positions of the array.
    pub layout: Layout,
    /// Rays are cast at every so manieth position at the most.
    pub finest: usize,
    /// Beams across and down.
    pub counts: [usize; 2],
}

/// Positions of a sample array: the first and the last of them, across and down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Patch {
    pub first: [u32; 2],
    pub last: [u32; 2],
}

impl Beams {
    /// The beams of a sample array whose rays are `finest` positions apart where they are closest.
    pub fn new(layout: Layout, finest: usize) -> Self {
        Self { layout, finest, counts: layout.positions().map(|n| n.div_ceil(SIDE)) }
    }

    /// The positions of rays that may lie between window coordinates `low` and `high` (pixels); `None` where no ray is cast.
    #[inline]
    pub fn patch(&self, [low, high]: [DVec2; 2]) -> Option<Patch> {
        if !low.cmple(high).all() {
            return None;
        }
        let (step, margin) = (self.finest as f64, self.layout.margin as f64);
        // Casts saturate and cut off: the first number not below one from 0 on, and the last not above it.
        let place = |window: f64| ((window - 0.5) * POSITIONS as f64 + margin) / step;
        let last = self.layout.positions().map(|n| ((n - 1) / self.finest) as f64);
        let ends = |low: f64, high: f64, last: f64| {
            let low = (place(low) - OUTSIDE).max(0.0);
            let first = low as u32 + u32::from(f64::from(low as u32) < low);
            let high = (place(high) + OUTSIDE).min(last);
            (high >= 0.0 && first <= high as u32).then_some([first, high as u32])
        };
        let across = ends(low.x, high.x, last[0])?;
        let down = ends(low.y, high.y, last[1])?;
        let [first, last] = [0, 1].map(|end| [across[end], down[end]]);
        let positions = |at: [u32; 2]| at.map(|n| n * self.finest as u32);
        Some(Patch { first: positions(first), last: positions(last) })
    }

    /// The place in the array of a position counted from the middle of pixel (0, 0).
    #[inline]
    pub fn place(&self, position: [i64; 2]) -> [usize; 2] {
        position.map(|n| (n + self.layout.margin as i64) as usize)
    }

    /// The number of the beam around a place in the array.
    #[inline]
    pub fn around(&self, [x, y]: [usize; 2]) -> usize {
        y / SIDE * self.counts[0] + x / SIDE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_patch_is_of_the_rays_that_lie_in_a_box() {
        let layout = Layout::new([20, 10], 8, 6);
        for (finest, low, high) in [
            (1, [0.5, 0.5], [0.5, 0.5]),
            (4, [0.5, 0.5], [0.5, 0.5]),
            (4, [0.6, 0.6], [1.4, 7.0]),
            (2, [-9.0, 2.01], [3.3, 2.9]),
            (1, [17.0, -1e300], [1e300, 40.0]),
            (1, [25.0, 1.0], [26.0, 2.0]),
            (1, [-30.0, 1.0], [-20.0, 2.0]),
        ] {
            let beams = Beams::new(layout, finest);
            let inside = |axis: usize| {
                let all = (0..layout.positions()[axis]).step_by(finest);
                let within = |at: &usize| {
                    let window = layout.window(*at);
                    low[axis] - 1e-9 <= window && window <= high[axis] + 1e-9
                };
                all.filter(within).map(|at| at as u32).collect::<Vec<_>>()
            };
            let [across, down] = [inside(0), inside(1)];
            let expected = across.first().zip(down.first()).map(|(x, y)| Patch {
                first: [*x, *y],
                last: [across[across.len() - 1], down[down.len() - 1]],
            });
            assert_eq!(beams.patch([low.into(), high.into()]), expected, "{finest} {low:?}");
        }
        let beams = Beams::new(layout, 1);
        assert_eq!(beams.patch([DVec2::INFINITY, DVec2::NEG_INFINITY]), None);
        assert_eq!(beams.patch([DVec2::NAN; 2]), None);
    }
}
