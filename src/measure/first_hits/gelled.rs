//! A volume as gel, asked at points.

use glam::{DAffine3, DVec3};

use crate::volume::gel::{CELLS, GelBricks};
use crate::volume::grid::Grid;
use crate::with_texels;

/// The gel of a volume.
pub(super) struct Gelled {
    gel: GelBricks,
    size: [usize; 3],
    to_index: DAffine3,
}

impl Gelled {
    /// The gel of a volume on a grid.
    pub fn new(gel: GelBricks, grid: &Grid) -> Self {
        Self { gel, size: grid.size, to_index: grid.world_to_index() }
    }

    /// The opacity at a world point, per opacity unit; 0 outside.
    pub fn opacity(&self, world: DVec3) -> f64 {
        let index = self.to_index.transform_point3(world).to_array();
        let last = self.size.map(|n| n as f64 - 1.0);
        if (0..3).any(|a| !(0.0..=last[a]).contains(&index[a])) {
            return 0.0;
        }
        let cell = index.map(|n| n as usize);
        let within = DVec3::from_array(std::array::from_fn(|a| index[a] - cell[a] as f64));
        with_texels!(&self.gel, texels => {
            let slices = texels.slices();
            let brick = slices.stored(texels.entry(cell));
            f64::from(slices.sample(brick, cell.map(|n| n % CELLS), within.as_vec3()).w)
        })
    }

    /// Where the opacity falls, world: minus its gradient.
    pub fn slope(&self, world: DVec3) -> DVec3 {
        let to_world = self.to_index.inverse().matrix3;
        let differences = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
            let step = to_world * axis;
            self.opacity(world + step) - self.opacity(world - step)
        });
        -(self.to_index.matrix3.transpose() * DVec3::from(differences))
    }
}
