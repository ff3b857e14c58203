//! Polygons: checked faces, the textures that are mapped onto them, and what they cover of the voxels near them.

pub mod arrays;
pub mod coverage;
pub mod enclosed;
pub mod face;
pub(crate) mod matted;
pub mod may_hold;
pub(crate) mod outline;
pub(crate) mod shape;
mod simple;
pub mod smooth;
pub mod texture;
mod welded;
