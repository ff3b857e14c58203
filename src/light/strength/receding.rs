//! How a light falls off over the voxels of a grid.

use glam::DVec3;

use super::Falloff;
use crate::volume::grid::Grid;

/// The divisor of equation 3 at every voxel of a grid: distances along a light are affine over them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Receding {
    falloff: Falloff,
    /// The distance of voxel (0, 0, 0), and from each voxel to the next along every axis.
    first: f64,
    per: [f64; 3],
}

impl Receding {
    /// Nowhere.
    pub const NONE: Self = Self { falloff: Falloff::NONE, first: 0.0, per: [0.0; 3] };

    /// Of a light of some `falloff` over `grid`, at points that lie `way` from the voxels, in the world.
    #[must_use]
    pub fn new(falloff: Falloff, grid: &Grid, way: DVec3) -> Self {
        let at = |voxel: DVec3| falloff.distance(grid.index_to_world.transform_point3(voxel) + way);
        let first = at(DVec3::ZERO);
        let per = DVec3::AXES.map(|axis| at(axis) - first);
        Self { falloff, first, per }
    }

    /// `k_1 + k_2 d` at a voxel, above 0.
    #[must_use]
    #[inline]
    pub fn divisor(&self, [x, y, z]: [usize; 3]) -> f64 {
        let [px, py, pz] = self.per;
        self.falloff.divisor(self.first + x as f64 * px + y as f64 * py + z as f64 * pz)
    }

    /// Whether the light does not fall off: then every divisor is 1.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.falloff.is_none()
    }

    /// The least divisor of any voxel.
    #[must_use]
    pub fn least(&self) -> f64 {
        self.falloff.least()
    }
}
