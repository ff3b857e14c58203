//! The layer of voxels that a polygon's optical depth is spread over.

/// How far the calibrated ball reaches along the normal, voxels; no ball reaches farther.
pub const REACH: f64 = 2.0;

/// w(h): the part of the optical depth that a voxel `height` voxels from the plane gets. Sums to 1 over voxels in a row.
pub(super) fn tent(height: f64) -> f64 {
    (REACH - height.abs()).max(0.0) / (REACH * REACH)
}
