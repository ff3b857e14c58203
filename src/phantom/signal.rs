//! The signal by which Marschner and Lobb (1994) compared reconstructions: rings that 40³ voxels hold just so.

use std::f64::consts::PI;

use super::simple::centred;
use crate::formats::Loaded;
use crate::shared::Shared;
use crate::volume::grid::Scalars;

/// Voxels along each axis.
const VOXELS: usize = 40;

/// ρ at a point of −1..=1 on each axis, with f_M = 6 and α = 1/4; 0..=1. Its surface of 1/2 has six rings of ripples.
#[must_use]
pub fn marschner_lobb_at([x, y, z]: [f64; 3]) -> f64 {
    let ring = libm::cos(2.0 * PI * 6.0 * libm::cos(PI * libm::hypot(x, y) / 2.0));
    (1.0 - libm::sin(PI * z / 2.0) + 0.25 * (1.0 + ring)) / 2.5
}

/// The signal over −1..=1 on each axis in 40³ voxels of spacing 1, centred on the world's origin.
pub fn marschner_lobb() -> Loaded {
    let place = |n: usize| 2.0 * n as f64 / (VOXELS - 1) as f64 - 1.0;
    let of = |at: usize| {
        let index = [at % VOXELS, at / VOXELS % VOXELS, at / (VOXELS * VOXELS)];
        marschner_lobb_at(index.map(place)) as f32
    };
    let values = (0..VOXELS * VOXELS * VOXELS).map(of).collect();
    centred([VOXELS; 3], [1.0; 3], Scalars::F32(Shared::new(values)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_signal_falls_along_z_and_is_round_about_it() {
        // ρ = (1 − sin(π z / 2) + (1 + cos(12 π cos(π r / 2))) / 4) / 2.5, and at r = 0 or 1 the inner cosine is 1.
        for (p, expected) in [
            ([0.0, 0.0, -1.0], 1.0),
            ([0.0, 0.0, 0.0], 0.6),
            ([0.0, 0.0, 1.0], 0.2),
            ([1.0, 0.0, 1.0], 0.2),
            ([0.0, -1.0, 0.0], 0.6),
        ] {
            let found = marschner_lobb_at(p);
            assert!((found - expected).abs() < 1e-12, "{p:?}: {found}");
        }
        let found = [[0.3, 0.4, 0.1], [0.5, 0.0, 0.1], [-0.4, 0.3, 0.1]].map(marschner_lobb_at);
        assert!((found[0] - found[1]).abs() + (found[0] - found[2]).abs() < 1e-12);
    }
}
