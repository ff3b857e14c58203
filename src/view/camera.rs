//! The frame of a view in the world: where rays of parallel light start and where they point (algorithm §1).

use glam::{DVec2, DVec3};

use super::extent::Extent;
use crate::components::View;

/// The frame of a parallel view: unit vectors, the focal point, and how large a pixel is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// To the right in the picture.
    pub right: DVec3,
    /// Upwards in the picture.
    pub up: DVec3,
    /// Along the rays, away from the observer.
    pub forward: DVec3,
    /// The world point in the middle of the window, where `t` is 0.
    pub focal: DVec3,
    /// The side of a pixel, world units.
    pub pixel: f64,
    /// Pixels across and down.
    pub size: [usize; 2],
}

impl Camera {
    /// The frame of `view` in a scene of extent `extent`.
    ///
    /// The observer stands towards `(sin a cos e, −cos a cos e, sin e)` from the focal point, view-up is +z; at an
    /// elevation of ±90° it is the limit from below. Quarter turns are exact.
    #[must_use]
    pub fn new(view: &View, extent: &Extent) -> Self {
        let ((sin_a, cos_a), (sin_e, cos_e)) = (sin_cos(view.azimuth), sin_cos(view.elevation));
        let forward = -DVec3::new(sin_a * cos_e, -cos_a * cos_e, sin_e);
        let right = DVec3::new(cos_a, sin_a, 0.0);
        let up = right.cross(forward);
        let (sin_r, cos_r) = sin_cos(view.roll);
        let focal = view.focal_point.map_or_else(|| extent.center(), DVec3::from);
        let height = view.height_mm.unwrap_or(2.0 * extent.radius());
        Self {
            right: right * cos_r - up * sin_r,
            up: up * cos_r + right * sin_r,
            forward,
            focal,
            pixel: height / f64::from(view.size[1]),
            size: view.size.map(|n| n as usize),
        }
    }

    /// The world point at depth 0 of the ray through window position `(x, y)`, in pixels from the top left corner.
    #[must_use]
    pub fn origin(&self, window: DVec2) -> DVec3 {
        let [width, height] = self.size.map(|n| n as f64);
        let (x, y) = (window.x - width / 2.0, height / 2.0 - window.y);
        self.focal + self.right * (x * self.pixel) + self.up * (y * self.pixel)
    }

    /// Window position in pixels and depth in world units of a world point.
    #[must_use]
    pub fn project(&self, point: DVec3) -> (DVec2, f64) {
        let [width, height] = self.size.map(|n| n as f64);
        let from = point - self.focal;
        let (x, y) = (self.right.dot(from) / self.pixel, self.up.dot(from) / self.pixel);
        (DVec2::new(x + width / 2.0, height / 2.0 - y), self.forward.dot(from))
    }
}

/// Sine and cosine of an angle in degrees, exact at quarter turns and the same on every machine.
#[must_use]
pub fn sin_cos(degrees: f64) -> (f64, f64) {
    let turn = degrees.rem_euclid(360.0);
    match turn {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => libm::sincos(turn.to_radians()),
    }
}

#[cfg(test)]
mod tests;
