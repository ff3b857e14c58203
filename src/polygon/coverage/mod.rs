//! What a polygon covers of the voxels near it: 3D scan-conversion with analytic filtering (paper §3, algorithm §8).
//!
//! A ball around a voxel is cut by the plane of a polygon in a disc; the part of the disc that the polygon covers is
//! exact ([`disc`]). How opaque the voxel is for that part, and for how far it lies from the plane, is the ball's
//! ([`ball`]). All of it is done in index space, where the ball is round; there a polygon is planar still ([`flat`]).

pub mod ball;
mod calibration;
pub mod covered;
pub mod disc;
pub mod flat;
mod layer;
mod sides;

pub use ball::Ball;
pub use covered::{Covered, Shares, Touched};
pub use disc::disc_area;
pub use flat::Flat;
pub use layer::REACH;
