//! The frame of a view in the world: where its rays go through the focal plane and where they point (algorithm §1).
//!
//! Depth is measured along `forward` in parallel and in perspective alike, from the focal plane on: what lies at one depth
//! lies in one plane across the line of sight. In perspective the eye stands before the focal plane, at a negative depth.

use glam::{DVec2, DVec3};

use super::extent::Extent;
use super::ray::Ray;
use super::samples::POSITIONS;
use crate::components::View;

/// The frame of a view: unit vectors, the focal point, how large a pixel is there, and where the eye is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// To the right in the picture.
    pub right: DVec3,
    /// Upwards in the picture.
    pub up: DVec3,
    /// Along the line of sight, away from the observer; along every ray of a parallel view.
    pub forward: DVec3,
    /// The world point in the middle of the window, where `t` is 0.
    pub focal: DVec3,
    /// The side of a pixel in the focal plane, world units.
    pub pixel: f64,
    /// Pixels across and down.
    pub size: [usize; 2],
    /// How far before the focal plane the eye is, world units; `None`: infinitely far, and rays are parallel.
    pub eye: Option<f64>,
}

/// What lies nearer to the eye than this part of the distance from it to the focal plane is not drawn.
const NEAREST: f64 = 1e-6;

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
        let (right, up) = (right * cos_r - up * sin_r, up * cos_r + right * sin_r);
        let height =
            view.height_mm.unwrap_or_else(|| fitted(view, extent, focal, [right, up, forward]));
        Self {
            right,
            up,
            forward,
            focal,
            pixel: height / f64::from(view.size[1]),
            size: view.size.map(|n| n as usize),
            eye: view
                .field_of_view
                .map(|degrees| height / 2.0 / libm::tan(degrees.to_radians() / 2.0)),
        }
    }

    /// The window position, in pixels, of a position of the sample array, counted from the middle of pixel (0, 0).
    #[must_use]
    #[inline]
    pub fn window(position: [i64; 2]) -> DVec2 {
        let [x, y] = position.map(|n| n as f64 / POSITIONS as f64 + 0.5);
        DVec2::new(x, y)
    }

    /// The ray through window position `(x, y)`, in pixels from the top left corner.
    #[must_use]
    #[inline]
    pub fn ray(&self, window: DVec2) -> Ray {
        let origin = self.origin(window);
        let along = match self.eye {
            None => self.forward,
            Some(eye) => self.forward + (origin - self.focal) / eye,
        };
        Ray { origin, along }
    }

    /// The depth from which on things are seen; minus infinity in a parallel view.
    #[must_use]
    pub fn nearest(&self) -> f64 {
        self.eye.map_or(f64::NEG_INFINITY, |eye| eye * (NEAREST - 1.0))
    }

    /// How large things in the plane of that depth are drawn, against those in the focal plane: above 0 for what is seen.
    #[must_use]
    #[inline]
    pub(crate) fn magnification(&self, depth: f64) -> f64 {
        self.eye.map_or(1.0, |eye| eye / (eye + depth))
    }

    /// The world point at depth 0 of the ray through window position `(x, y)`, in pixels from the top left corner.
    #[must_use]
    pub fn origin(&self, window: DVec2) -> DVec3 {
        let [width, height] = self.size.map(|n| n as f64);
        let (x, y) = (window.x - width / 2.0, height / 2.0 - window.y);
        self.focal + self.right * (x * self.pixel) + self.up * (y * self.pixel)
    }

    /// The depth of a world point, world units.
    #[must_use]
    #[inline]
    pub fn depth(&self, point: DVec3) -> f64 {
        self.forward.dot(point - self.focal)
    }

    /// Window position in pixels and depth in world units of a world point, which is not at the depth of the eye.
    #[must_use]
    #[inline]
    pub fn project(&self, point: DVec3) -> (DVec2, f64) {
        let [width, height] = self.size.map(|n| n as f64);
        let from = point - self.focal;
        let depth = self.depth(point);
        let drawn = from * self.magnification(depth);
        let (x, y) = (self.right.dot(drawn) / self.pixel, self.up.dot(drawn) / self.pixel);
        (DVec2::new(x + width / 2.0, height / 2.0 - y), depth)
    }
}

/// The part of the window's height, or of its width, that is left free on each side of what a default view shows.
const MARGIN: f64 = 0.05;

/// The height of a window that the silhouette of the scene's box just fits, but for [`MARGIN`].
///
/// In perspective the eye goes back with the height h by `k h`: a corner at `y` above the axis and at depth d is drawn at
/// `y k h / (k h + d)`, which is within the part m of h from `h = y / m − d / k` on.
fn fitted(view: &View, extent: &Extent, focal: DVec3, [right, up, forward]: [DVec3; 3]) -> f64 {
    let [width, height] = view.size.map(f64::from);
    let half = 0.5 - MARGIN;
    let backward =
        view.field_of_view.map_or(0.0, |degrees| 2.0 * libm::tan(degrees.to_radians() / 2.0));
    let needed = extent.corners().into_iter().map(|corner| {
        let from = corner - focal;
        let (x, y) = (from.dot(right).abs() * height / width, from.dot(up).abs());
        x.max(y) / half - from.dot(forward) * backward
    });
    let fitted = needed.fold(0.0, f64::max);
    if fitted > 0.0 { fitted } else { 2.0 * extent.radius() }
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
