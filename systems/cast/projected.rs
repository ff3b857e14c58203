//! A polygon projected to the picture of one view: which rays meet it, and how deep (algorithm §4).
//!
//! A ray meets a polygon where its window position lies in the projected outline. The depth there is affine in that
//! position; in perspective the inverse of the distance from the eye is. Whether a position lies on this or that side of an
//! edge is computed from the edge's ends in one order, whichever polygon asks: an edge that two polygons share is met
//! exactly once. A polygon in the plane of the rays, or of the eye, is missed.

use glam::{DVec2, DVec3};

use super::appearance::Appearance;
use crate::polygon::face::Face;
use crate::polygon::outline::edges;
use crate::view::camera::Camera;

/// How far outside the bounding box of a polygon a ray is sure to miss it, pixels.
const OUTSIDE: f64 = 1e-6;
/// A sine under this is 0: then the polygon is seen edge-on.
const EDGE_ON: f64 = 1e-9;

/// A polygon of the scene on one view.
pub(crate) struct ProjectedFace {
    /// The outlines in window coordinates, pixels; holes as the rest: a position inside an odd number of them is in.
    outlines: Vec<Vec<DVec2>>,
    low: DVec2,
    high: DVec2,
    plane: Plane,
    appearance: Appearance,
    thin: bool,
}

/// A polygon is thin whose area is less than this for each pixel of half its outline: a strip as wide, a square twice as wide.
const THIN: f64 = 1.0;
/// More faces than these are facets of a mesh: each is small, and what they cover is not.
const FEW: usize = 256;

/// The depth of a face's plane at a window position (x, y).
enum Plane {
    /// `x · dx + y · dy + d`.
    Parallel(DVec3),
    /// `above / (x · dx + y · dy + d) − eye`.
    Perspective { above: f64, below: DVec3, eye: f64 },
}

impl ProjectedFace {
    /// A face on a view; `None` if it is seen edge-on or lies behind the eye. It is one of `faces`
    /// of its entity.
    pub fn new(face: &Face, camera: &Camera, appearance: Appearance, faces: usize) -> Option<Self> {
        let plane = Plane::of(face, camera)?;
        let outlines: Vec<Vec<DVec2>> =
            face.outlines.iter().map(|outline| projected(outline, camera)).collect();
        let corners = outlines.iter().flatten();
        let (low, high) = corners
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &v| {
                (low.min(v), high.max(v))
            });
        let thin = faces <= FEW && is_thin(&outlines);
        // The box rejects and never decides: rounding there must not take from a polygon what its neighbour leaves to it.
        let (low, high) = (low - OUTSIDE, high + OUTSIDE);
        low.cmple(high).all().then_some(Self { outlines, low, high, plane, appearance, thin })
    }

    /// The window positions, least and greatest, outside which a ray is sure to miss it.
    pub fn bounds(&self) -> [DVec2; 2] {
        [self.low, self.high]
    }

    /// Its outlines in window coordinates.
    pub fn outlines(&self) -> &[Vec<DVec2>] {
        &self.outlines
    }

    /// Whether rays a pixel apart may miss it.
    pub fn is_thin(&self) -> bool {
        self.thin
    }

    /// How it looks.
    pub(crate) fn appearance(&self) -> &Appearance {
        &self.appearance
    }

    /// Whether a window position lies in the polygon: inside an odd number of outlines, borders to one side.
    pub fn holds(&self, at: DVec2) -> bool {
        if at.cmplt(self.low).any() || at.cmpgt(self.high).any() {
            return false;
        }
        let mut inside = false;
        for outline in &self.outlines {
            let mut from = outline.last().copied().unwrap_or_default();
            for to in outline {
                inside ^= crosses(from, *to, at);
                from = *to;
            }
        }
        inside
    }

    /// The depth of its plane at a window position, world units.
    pub fn depth(&self, at: DVec2) -> f64 {
        match &self.plane {
            Plane::Parallel(depth) => depth.dot(at.extend(1.0)),
            Plane::Perspective { above, below, eye } => above / below.dot(at.extend(1.0)) - eye,
        }
    }
}

impl Plane {
    fn of(face: &Face, camera: &Camera) -> Option<Self> {
        let facing = face.normal.dot(camera.forward);
        // A step of the window to the right and down, in the focal plane, along the normal.
        let across = |window: DVec2| {
            let world =
                camera.right * (window.x * camera.pixel) - camera.up * (window.y * camera.pixel);
            face.normal.dot(world)
        };
        let (right, down) = (across(DVec2::X), across(DVec2::Y));
        let Some(eye) = camera.eye else {
            if facing.abs() < EDGE_ON {
                return None;
            }
            let (dx, dy) = (-right / facing, -down / facing);
            let (center, middle) = camera.project(face.center);
            return Some(Self::Parallel(DVec3::new(
                dx,
                dy,
                middle - dx * center.x - dy * center.y,
            )));
        };
        // The distance from the eye along the line of sight: its part along the normal is the same for every ray.
        let from = face.center - (camera.focal - camera.forward * eye);
        let above = face.normal.dot(from);
        if above.abs() < EDGE_ON * from.length() {
            return None;
        }
        let middle = DVec2::from(camera.size.map(|n| n as f64 / 2.0));
        let (dx, dy) = (right / eye, down / eye);
        let below = DVec3::new(dx, dy, facing - dx * middle.x - dy * middle.y);
        Some(Self::Perspective { above, below, eye })
    }
}

/// An outline in window coordinates, without what is nearer to the eye than is drawn.
fn projected(outline: &[DVec3], camera: &Camera) -> Vec<DVec2> {
    let ahead = |p: &DVec3| camera.depth(*p) - camera.nearest();
    if camera.eye.is_none() || outline.iter().all(|p| ahead(p) >= 0.0) {
        return outline.iter().map(|p| camera.project(*p).0).collect();
    }
    let mut kept = Vec::with_capacity(outline.len() + 2);
    for (p, q) in edges(outline) {
        if ahead(&p) >= 0.0 {
            kept.push(camera.project(p).0);
        }
        if (ahead(&p) >= 0.0) != (ahead(&q) >= 0.0) {
            // From the end that is kept, whichever way the edge runs: polygons that share it cut it at the same point.
            let (near, far) = if ahead(&p) >= 0.0 { (q, p) } else { (p, q) };
            let part = ahead(&far) / (ahead(&far) - ahead(&near));
            kept.push(camera.project(far.lerp(near, part)).0);
        }
    }
    kept
}

/// Whether what outlines enclose, in pixels, is less than [`THIN`] wide.
fn is_thin(outlines: &[Vec<DVec2>]) -> bool {
    let (mut area, mut length) = (0.0, 0.0);
    for outline in outlines {
        for (p, q) in edges(outline) {
            area += p.perp_dot(q - p) / 2.0;
            length += p.distance(q);
        }
    }
    area.abs() < THIN * length / 2.0
}

/// Whether the edge from `p` to `q` passes to the right of `at`, its lower end counted and its upper end not; the same
/// for (q, p).
fn crosses(p: DVec2, q: DVec2, at: DVec2) -> bool {
    if (p.y <= at.y) == (q.y <= at.y) {
        return false;
    }
    let (low, high) = if p.y <= q.y { (p, q) } else { (q, p) };
    (high - low).perp_dot(at - low) > 0.0
}
