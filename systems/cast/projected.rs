//! A polygon projected to the picture of one view: which rays meet it, and how deep (algorithm §4).
//!
//! A ray meets a polygon where its window position lies in the projected outline. The depth there is affine in that
//! position; in perspective the inverse of the distance from the eye is. Whether a position lies on this or that side of an
//! edge is computed from the edge's ends in one order, whichever polygon asks: an edge that two polygons share is met
//! exactly once. A polygon in the plane of the rays, or of the eye, is missed.

use glam::{BVec2, DVec2, DVec3, Vec3};

use super::beams::Patch;
use crate::polygon::face::Face;
use crate::polygon::outline::{Rings, edges};
use crate::view::camera::Camera;

/// A sine under this is 0: then the polygon is seen edge-on.
const EDGE_ON: f64 = 1e-9;

/// A polygon of the scene on one view.
pub(crate) struct ProjectedFace {
    /// The outlines in window coordinates, pixels; holes as the rest: a position inside an odd number of them is in.
    outlines: Rings<DVec2>,
    plane: Plane,
    /// Its unit normal in the world, which is looked at wherever it is met.
    pub normal: Vec3,
    /// The number of its entity among those that are traced, and its own among the faces of that.
    pub of: [u32; 2],
}

/// A polygon is thin whose area is less than this for each pixel of half its outline: a strip as wide, a square twice as wide.
const THIN: f64 = 1.0;

/// The depth of a face's plane at a window position (x, y): `x · dx + y · dy + d`, and with an eye `above` divided by that,
/// from the eye on.
struct Plane {
    above: f64,
    below: DVec3,
}

impl ProjectedFace {
    /// A face on a view, which is number `of` of its entity and of all, and the positions that rays may meet it at; `None` if
    /// there are none, or it is seen edge-on or lies behind the eye.
    #[inline]
    pub fn new(
        face: &Face,
        of: [u32; 2],
        camera: &Camera,
        patch: impl Fn([DVec2; 2]) -> Option<Patch>,
    ) -> Option<(Patch, Self)> {
        let outlines = projected(&face.outlines, camera);
        let patch = patch(match &outlines {
            Rings::Triangle([a, b, c]) => [a.min(*b).min(*c), a.max(*b).max(*c)],
            Rings::Many(_) => {
                let nothing = [DVec2::INFINITY, DVec2::NEG_INFINITY];
                outlines.vertices().fold(nothing, |[low, high], v| [low.min(v), high.max(v)])
            }
        })?;
        let plane = Plane::of(face, camera)?;
        Some((patch, Self { outlines, plane, normal: face.normal.as_vec3(), of }))
    }

    /// Its outlines in window coordinates.
    pub fn outlines(&self) -> &Rings<DVec2> {
        &self.outlines
    }

    /// Whether rays a pixel apart may miss it: what its outlines enclose is less than [`THIN`] wide.
    pub fn is_thin(&self) -> bool {
        let (mut area, mut length) = (0.0, 0.0);
        for (p, q) in self.outlines.edges() {
            area += p.perp_dot(q - p) / 2.0;
            length += p.distance(q);
        }
        area.abs() < THIN * length / 2.0
    }

    /// Whether a window position lies in the polygon: inside an odd number of outlines, borders to one side.
    #[inline]
    pub fn holds(&self, at: DVec2) -> bool {
        let odd = |inside: bool, outline: &[DVec2]| {
            let mut inside = inside;
            let mut from = outline.last().copied().unwrap_or_default();
            for to in outline {
                inside ^= crosses(from, *to, at);
                from = *to;
            }
            inside
        };
        match &self.outlines {
            Rings::Triangle(corners) => odd(false, corners),
            Rings::Many(outlines) => outlines.iter().fold(false, |inside, o| odd(inside, o)),
        }
    }

    /// The depth of its plane at a window position, world units, on a view of that camera.
    #[inline]
    pub fn depth(&self, at: DVec2, camera: &Camera) -> f64 {
        let Plane { above, below } = &self.plane;
        let along = below.dot(at.extend(1.0));
        camera.eye.map_or(along, |eye| above / along - eye)
    }
}

impl Plane {
    #[inline]
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
            let below = DVec3::new(dx, dy, middle - dx * center.x - dy * center.y);
            return Some(Self { above: 1.0, below });
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
        Some(Self { above, below })
    }
}

/// Outlines in window coordinates, without what is nearer to the eye than is drawn.
#[inline]
fn projected(outlines: &Rings<DVec3>, camera: &Camera) -> Rings<DVec2> {
    let nearest = camera.nearest();
    if camera.eye.is_none() || outlines.vertices().all(|p| camera.depth(p) - nearest >= 0.0) {
        return outlines.map(|p| camera.project(p).0);
    }
    Rings::Many(outlines.iter().map(|outline| drawn(outline, camera)).collect())
}

/// What is drawn of an outline, in window coordinates.
fn drawn(outline: &[DVec3], camera: &Camera) -> Vec<DVec2> {
    let ahead = |p: &DVec3| camera.depth(*p) - camera.nearest();
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

/// Whether the edge from `p` to `q` passes to the right of `at`, its lower end counted and its upper end not; the same
/// for (q, p).
#[inline]
fn crosses(p: DVec2, q: DVec2, at: DVec2) -> bool {
    // No branches: which way an edge goes is as good as random from one to the next.
    let passes = (p.y <= at.y) != (q.y <= at.y);
    let rises = BVec2::splat(p.y <= q.y);
    let (low, high) = (DVec2::select(rises, p, q), DVec2::select(rises, q, p));
    passes & ((high - low).perp_dot(at - low) > 0.0)
}
