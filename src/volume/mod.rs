//! Volumes: where voxels are and what they hold, how they are classified, and the gel that rays meet.

pub mod arrays;
pub mod bricks;
pub(crate) mod buried;
mod cells;
pub mod classification;
pub mod clipping;
pub mod coefficients;
mod digits;
pub mod field;
pub mod filter;
pub mod gel;
pub mod gradients;
pub mod grid;
mod hull;
pub(crate) mod interest;
pub mod labels;
pub mod layer;
pub mod opacities;
pub mod painting;
pub mod pyramid;
pub mod ranges;
pub mod scene_volumes;
pub mod seen;
pub mod texel;
pub mod texels;
pub mod voxel_colors;
