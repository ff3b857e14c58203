//! The least volumes that show something: a ball, a slab and a ramp of gel, each 64 voxels a side.

use crate::formats::{Loaded, Voxels};
use crate::shared::Shared;
use crate::volume::grid::{Grid, Scalars};

/// Wraps scalars on a grid of `spacing` centred on the world's origin.
pub fn centred(size: [usize; 3], spacing: [f64; 3], scalars: Scalars) -> Loaded {
    let origin = std::array::from_fn(|axis| -spacing[axis] * (size[axis] - 1) as f64 / 2.0);
    let grid = Grid::axis_aligned(size, spacing, origin)
        .expect("phantoms have sizes of 2 or more and spacings above 0");
    Loaded { grid, voxels: Voxels::Scalars(scalars), warnings: Vec::new() }
}

/// A value at each voxel of a grid of spacing 1, from the position of its centre in the world.
fn field(size: [usize; 3], value: impl Fn([f32; 3]) -> f32) -> Loaded {
    let size = size.map(|n| n.max(2));
    let mut values = Vec::with_capacity(size.iter().product());
    let at = |index: usize, n: usize| index as f32 - (n - 1) as f32 / 2.0;
    for z in 0..size[2] {
        for y in 0..size[1] {
            values.extend(
                (0..size[0]).map(|x| value([at(x, size[0]), at(y, size[1]), at(z, size[2])])),
            );
        }
    }
    centred(size, [1.0; 3], Scalars::F32(Shared::new(values)))
}

/// A smooth ball: 1 inside, 0 outside, falling linearly over 2 voxels about `radius` (voxels, where it is ½).
///
/// Spacing 1, centred on the world's origin; sizes under 2 are taken as 2.
#[must_use]
pub fn ball(size: [usize; 3], radius: f32) -> Loaded {
    field(size, |[x, y, z]| (0.5 + (radius - (x * x + y * y + z * z).sqrt()) / 2.0).clamp(0.0, 1.0))
}

/// A slab across z, 32 voxels thick: 1 inside, 0 outside, falling linearly over 2 voxels about each face.
pub fn slab() -> Loaded {
    field([64; 3], |[_, _, z]| (0.5 + (16.0 - z.abs()) / 2.0).clamp(0.0, 1.0))
}

/// Values that rise along x from 0 at the first voxel to 1 at the last: a gradient of 1/63 everywhere.
pub fn ramp() -> Loaded {
    field([64; 3], |[x, _, _]| (x + 31.5) / 63.0)
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "these values are exact")]
mod tests {
    use super::*;

    fn values(loaded: &Loaded) -> Vec<f32> {
        let Voxels::Scalars(Scalars::F32(values)) = &loaded.voxels else { unreachable!() };
        values.to_vec()
    }

    #[test]
    fn a_ball_is_half_full_at_its_radius_and_holds_its_volume() {
        let made = ball([65; 3], 20.0);
        assert_eq!(values(&made)[made.grid.offset([52, 32, 32])], 0.5);
        let sum: f64 = values(&made).iter().map(|&v| f64::from(v)).sum();
        let volume = 4.0 / 3.0 * std::f64::consts::PI * (8000.0 + 20.0);
        assert!((sum / volume - 1.0).abs() < 1e-3, "{sum} of {volume}");
    }

    #[test]
    fn a_ball_of_no_size_is_still_a_volume() {
        assert_eq!(ball([0, 1, 2], 1.0).grid.size, [2; 3]);
    }

    #[test]
    fn a_slab_is_thirty_two_voxels_thick_along_z() {
        let made = slab();
        let column: f32 = (0..64).map(|z| values(&made)[made.grid.offset([5, 9, z])]).sum();
        assert_eq!(column, 32.0);
    }

    #[test]
    fn a_ramp_rises_equally_along_x_only() {
        let made = ramp();
        let row = &values(&made)[made.grid.offset([0, 3, 4])..][..64];
        assert_eq!((row[0], row[63]), (0.0, 1.0));
        assert!(row.windows(2).all(|pair| (pair[1] - pair[0] - 1.0 / 63.0).abs() < 1e-6));
    }
}
