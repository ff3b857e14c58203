//! How strong a light still is, in the volume (paper §4).

use crate::bricks::Bricks;

/// β of one light at every interesting voxel: 0 ..= 65535 stands for 0..=1 times `full`.
#[derive(Debug, Clone, PartialEq)]
pub struct LightStrength {
    /// The strengths, in the bricks of what is relit.
    pub voxels: Bricks<u16>,
    /// The strength that 65535 stands for.
    pub full: f32,
}
