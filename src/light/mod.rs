//! Light: how voxels and polygons answer it, and how strong it still is in the volume.

pub mod observer;
pub mod shading;
pub mod strength;
