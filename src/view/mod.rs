//! Views: the camera and the walk of its rays, the samples on them, how they are composited, and the picture.

pub(crate) mod axes;
pub mod camera;
pub mod composite;
pub mod extent;
pub(crate) mod four_colors;
pub mod lettering;
pub mod observer;
pub mod overlay;
pub mod picture;
mod powers;
pub mod ray;
pub mod resampling;
pub mod samples;
pub mod viewer;
pub mod voxel_rays;
mod voxel_resampling;
pub mod walk;
