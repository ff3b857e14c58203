//! Triples of numbers that are affine over the picture, in fixed point: alike however positions are put together.

use glam::{DVec2, DVec3, I64Vec3};

use super::places::{LANES, SIDE, TilePlaces};
use crate::view::samples::POSITIONS;

/// Bits of a voxel index behind the point.
pub(crate) const FRACTION_BITS: u32 = 40;
/// 1 in fixed point.
pub(super) const UNIT: f64 = (1_u64 << FRACTION_BITS) as f64;
/// How far beside the picture positions may lie, pixels.
const BESIDE: f64 = 64.0;

/// Fixed-point triples that are affine over positions of the picture, with more bits behind the point than are read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Affine {
    /// At the middle of pixel (0, 0).
    at: I64Vec3,
    /// From each position to the one right of it.
    across: I64Vec3,
    /// And to the one below.
    down: I64Vec3,
    /// Bits more than `FRACTION_BITS`.
    shift: u32,
}

impl Affine {
    /// The triples that `of` gives at window positions (pixels); `None` if some are too great to be told apart there.
    pub fn new(of: impl Fn(DVec2) -> DVec3, size: [usize; 2]) -> Option<Self> {
        let [width, height] = size.map(|n| n as f64);
        let corners = [
            (-BESIDE, -BESIDE),
            (width + BESIDE, -BESIDE),
            (-BESIDE, height + BESIDE),
            (width + BESIDE, height + BESIDE),
        ];
        let most = corners.map(|(x, y)| of(DVec2::new(x, y)).abs().max_element());
        let most = most.into_iter().fold(1e-9, f64::max);
        let whole = most.log2().floor() as i64 + 1;
        let bits = (61 - whole).min(80);
        let shift = bits - i64::from(FRACTION_BITS);
        if !most.is_finite() || shift < 0 {
            return None;
        }
        let unit = 2.0_f64.powi(bits as i32);
        let fixed = |index: DVec3| (index * unit).round().as_i64vec3();
        let middle = DVec2::splat(0.5);
        // Over the whole picture and not from one position to the next: those may differ by less than rounding.
        let slope =
            |along: DVec2, n: f64| (of(middle + along * n) - of(middle)) / (n * POSITIONS as f64);
        let (across, down) = (slope(DVec2::X, width), slope(DVec2::Y, height));
        let (at, across, down) = (fixed(of(middle)), fixed(across), fixed(down));
        Some(Self { at, across, down, shift: shift as u32 })
    }

    /// The same triple everywhere.
    pub fn constant(triple: DVec3) -> Self {
        let at = (triple * UNIT).round().as_i64vec3();
        Self { at, across: I64Vec3::ZERO, down: I64Vec3::ZERO, shift: 0 }
    }

    /// Puts those of single places into `triples`, axis by axis: to the last bit those of a lattice that they are on.
    pub fn scatter(&self, places: &TilePlaces, triples: &mut [[i64; LANES]; 3]) {
        let half = if self.shift > 0 { 1_i64 << (self.shift - 1) } else { 0 };
        for lane in 0..LANES {
            let [i, j] = places.position(lane);
            for (axis, triples) in triples.iter_mut().enumerate() {
                let place = self.at[axis] + self.across[axis] * i + self.down[axis] * j + half;
                triples[lane] = place >> self.shift;
            }
        }
    }

    /// Puts those of a tile into `triples`, axis by axis.
    #[inline]
    pub fn tile(&self, [i, j]: [i64; 2], step: i64, triples: &mut [[i64; LANES]; 3]) {
        let half = if self.shift > 0 { 1_i64 << (self.shift - 1) } else { 0 };
        for (axis, triples) in triples.iter_mut().enumerate() {
            let (across, down) = (self.across[axis], self.down[axis]);
            let first = self.at[axis] + across * i + down * j + half;
            for (y, row) in triples.chunks_exact_mut(SIDE).enumerate() {
                let first = first + down * (y as i64 * step);
                for (x, triple) in row.iter_mut().enumerate() {
                    *triple = (first + across * (x as i64 * step)) >> self.shift;
                }
            }
        }
    }
}
