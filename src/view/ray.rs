//! A ray of a view, parametrized by depth: samples of all rays lie in the same planes, in perspective too.

use glam::DVec3;

/// The line of world points that one window position shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// The world point at depth 0: where it goes through the focal plane.
    pub origin: DVec3,
    /// The way in the world for each unit of depth; of length 1 on the line of sight and longer beside it.
    pub along: DVec3,
}

impl Ray {
    /// The world point at a depth.
    #[must_use]
    #[inline]
    pub fn at(&self, depth: f64) -> DVec3 {
        self.origin + self.along * depth
    }
}
