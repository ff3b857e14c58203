//! Places on a lattice of rays in fixed point: those of pixels, one after the other, without rounding on the way.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use glam::DVec2;

/// Bits of a place between two rays.
pub(super) const FRACTION_BITS: u32 = 32;
/// A ray's distance to the next in such places.
const UNIT: f64 = (1_u64 << FRACTION_BITS) as f64;
/// Of which so many are looked at: exact in an f32.
const PLACE_BITS: u32 = 24;
/// Those that are not.
pub(super) const UNSEEN_BITS: u32 = FRACTION_BITS - PLACE_BITS;
/// The least part of the way to the next ray.
pub(super) const LEAST_PART: f32 = 1.0 / (1_u32 << PLACE_BITS) as f32;

/// A place, or a step, along one axis.
pub(super) fn fixed(place: f64) -> i64 {
    (place * UNIT) as i64
}

/// The ray before a place, and how far it is behind that.
#[inline(always)]
pub(super) fn divided(at: i64) -> (i64, f32) {
    let part = (at >> UNSEEN_BITS) & ((1 << PLACE_BITS) - 1);
    (at >> FRACTION_BITS, part as i32 as f32 * LEAST_PART)
}

/// A place on the lattice, and those one pixel after the other to its right.
pub(super) struct LatticeWalk {
    at: [i64; 2],
    step: [i64; 2],
}

impl LatticeWalk {
    pub fn from(start: DVec2, right: DVec2) -> Self {
        let along = |place: DVec2| [fixed(place.x), fixed(place.y)];
        Self { at: along(start), step: along(right) }
    }

    /// The ray before it along both axes, and how far it is behind that.
    #[inline(always)]
    pub fn next(&mut self) -> ([i64; 2], [f32; 2]) {
        let [(i, x), (j, y)] = self.at.map(divided);
        self.at = [self.at[0] + self.step[0], self.at[1] + self.step[1]];
        ([i, j], [x, y])
    }
}
