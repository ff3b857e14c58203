//! Light: how voxels and polygons answer it, and how strong it still is in the volume.

pub mod shading;
pub mod strength;
