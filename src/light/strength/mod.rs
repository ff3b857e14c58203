//! How strong a light still is, in the volume (paper §4).
//!
//! `β(d) = β_0 · T(d) / (k_1 + k_2 d)` at distance `d` along the light, with `T` what the opacities on the way let
//! through. Equation 3 as printed divides by `k_1 + k_2 d` at every sample, which compounds with their number; divided
//! once, the strength does not depend on how finely a volume is sampled.

mod buffer;
mod falloff;
mod receding;
mod shear;
mod slide;

use glam::DVec3;
use hecs::Entity;

use crate::schedule::Product;
use crate::volume::bricks::{Bricks, EDGE};
pub use buffer::Buffer;
pub use falloff::Falloff;
pub use receding::Receding;
pub use shear::{Place, Shear, Window};
pub use slide::{ProjectedBy, Slide};

/// β of one light: at every interesting voxel, and anywhere where something asks for that.
#[derive(Debug, Clone, PartialEq)]
pub struct LightStrength {
    /// β in each volume, in the order of the scene.
    pub volumes: Vec<(Entity, VoxelStrength)>,
    /// Whose product is β anywhere in space, where something asks for it: hybrid polygons that receive shadows, or a shaft
    /// of light. One for each volume; empty where nothing asks.
    pub buffers: Vec<Buffer>,
}

/// β of one light at every interesting voxel of a volume: what comes through to it, 0 ..= 65535 for 0..=1 times `full`, over
/// the divisor of its distance. Kept apart, so that near a light that falls off steeply no bits are spent which those far
/// from it want.
#[derive(Debug, Clone, PartialEq)]
pub struct VoxelStrength {
    /// What comes through, in the bricks of what is lit; 0 where a voxel of such a brick is not interesting.
    pub voxels: Bricks<u16>,
    /// What 65535 stands for: finite and above 0.
    pub full: f32,
    /// `k_1 + k_2 d` of the voxels.
    pub receding: Receding,
}

impl VoxelStrength {
    /// No β is more.
    #[must_use]
    pub fn most(&self) -> f32 {
        (f64::from(self.full) / self.receding.least()) as f32
    }

    /// β of a voxel, of which `kept` is in the bricks.
    #[must_use]
    #[inline]
    pub fn beta(&self, kept: u16, voxel: [usize; 3]) -> f32 {
        let through = f32::from(kept) / 65535.0 * self.full;
        (f64::from(through) / self.receding.divisor(voxel)) as f32
    }

    /// β of the eight voxels of a brick's row, y before z: 0 where nothing is stored, and 1 without a strength.
    #[must_use]
    pub(crate) fn row(of: Option<&Self>, brick: [usize; 3], row: usize) -> [f32; EDGE] {
        let Some(strength) = of else { return [1.0; EDGE] };
        let Some(stored) = strength.voxels.brick(brick) else { return [0.0; EDGE] };
        let stored = &stored.as_chunks::<EDGE>().0[row];
        if strength.receding.is_none() {
            // Divided by 1 in 64 bits they would be the same.
            return stored.map(|kept| f32::from(kept) / 65535.0 * strength.full);
        }
        let [x, y, z] = brick.map(|brick| brick * EDGE);
        let [y, z] = [y + row % EDGE, z + row / EDGE];
        std::array::from_fn(|at| strength.beta(stored[at], [x + at, y, z]))
    }
}

impl Product for LightStrength {}

impl LightStrength {
    /// β in a volume; `None` where the light was not swept through it.
    #[must_use]
    pub fn of(&self, volume: Entity) -> Option<&VoxelStrength> {
        self.volumes.iter().find(|(entity, _)| *entity == volume).map(|(_, strength)| strength)
    }

    /// β at a world point, without a bias: what comes through one volume, and through the next, and …; 1 without buffers.
    #[must_use]
    pub fn at(&self, world: DVec3) -> f32 {
        self.buffers.iter().map(|buffer| buffer.at(world)).product()
    }

    /// How much nearer to the light the point is whose strength is used at a point, world units.
    #[must_use]
    pub fn bias(&self) -> f64 {
        self.buffers.iter().map(|buffer| buffer.bias().length()).fold(0.0, f64::max)
    }

    /// Bytes that the product takes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let voxels = self.volumes.iter().map(|(_, strength)| strength.voxels.bytes());
        voxels.chain(self.buffers.iter().map(Buffer::bytes)).sum()
    }
}

/// A strength in 16 bits: 65535 stands for `full`, which is above 0; more than that, and less than 0, are clamped.
#[must_use]
#[inline]
pub(crate) fn quantize(strength: f64, full: f64) -> u16 {
    (strength / full * 65535.0 + 0.5) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::grid::Grid;

    #[test]
    fn a_row_is_what_its_voxels_are_alone_whether_the_light_falls_off_or_not() {
        let grid = Grid::axis_aligned([16, 9, 8], [1.0; 3], [0.0; 3]).unwrap();
        let voxels = Bricks::make(grid.size, |place, made| {
            place.voxels().for_each(|(at, [x, y, z])| made[at] = (4001 * x + 977 * y + z) as u16);
            place.brick[0] == 1
        });
        for [k1, k2] in [[1.0, 0.0], [0.5, 0.0], [1.0, 0.25]] {
            let falloff = Falloff::new(&[grid], DVec3::Z, k1, k2).unwrap();
            let receding = Receding::new(falloff, &grid, DVec3::ZERO);
            let strength = VoxelStrength { voxels: voxels.clone(), full: 0.7, receding };
            for (row, at) in (0..64).flat_map(|row| (0..EDGE).map(move |at| (row, at))) {
                let [y, z] = [row % EDGE, row / EDGE];
                let voxel = [EDGE + at, y, z];
                let alone = strength.beta(voxels.value(voxel), voxel);
                let betas = VoxelStrength::row(Some(&strength), [1, 0, 0], row);
                assert_eq!(betas[at].to_bits(), alone.to_bits(), "{k1} {k2} {voxel:?}");
            }
        }
    }
}
