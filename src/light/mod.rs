//! Light: how voxels and polygons answer it, and how strong it still is in the volume.

pub(crate) mod lit_bricks;
pub mod shading;
pub(crate) mod side_by_side;
pub mod strength;
pub(crate) mod unlit;
