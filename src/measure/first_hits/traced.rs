//! A polygon as the middles of pixels meet it.

use glam::{DAffine3, DVec3};

use crate::polygon::face::Face;
use crate::polygon::outline::Rings;
use crate::view::camera::Camera;
use crate::view::ray::Ray;

/// A polygon, with two axes of its plane.
pub(super) struct Traced {
    normal: DVec3,
    /// World points of it to vectors along the normal of what it stands for, where that is not flat.
    bent: Option<DAffine3>,
    center: DVec3,
    axes: [DVec3; 2],
    outlines: Rings<[f64; 2]>,
    /// The rows of pixels that it lies in, from the first to the last; infinite where it reaches behind the eye.
    rows: [f64; 2],
    pub opacity: f64,
    pub entity: u32,
}

impl Traced {
    /// A face of an entity on a view; `bent` is as of [`over`](crate::polygon::smooth::CornerNormals::over).
    pub fn new(
        (face, bent): (&Face, Option<DAffine3>),
        camera: &Camera,
        opacity: f64,
        entity: u32,
    ) -> Self {
        let axes = face.normal.any_orthonormal_pair();
        let flat = |vertex: DVec3| {
            let from = vertex - face.center;
            [from.dot(axes.0), from.dot(axes.1)]
        };
        let outlines = face.outlines.map(flat);
        let Face { normal, center, .. } = *face;
        let rows = rows(face, camera);
        Self { normal, bent, center, axes: [axes.0, axes.1], outlines, rows, opacity, entity }
    }

    /// Whether the middles of a row of pixels may meet it.
    pub fn is_near(&self, y: usize) -> bool {
        let middle = y as f64 + 0.5;
        self.rows[0] <= middle && middle <= self.rows[1]
    }

    /// How deep a ray meets it.
    pub fn depth(&self, ray: &Ray) -> Option<f64> {
        let depth = self.normal.dot(self.center - ray.origin) / self.normal.dot(ray.along);
        let from = ray.at(depth) - self.center;
        let [x, y] = self.axes.map(|axis| axis.dot(from));
        let crosses = |([ax, ay], [bx, by]): ([f64; 2], [f64; 2])| {
            (ay <= y) != (by <= y) && x < ax + (y - ay) / (by - ay) * (bx - ax)
        };
        let edges = self.outlines.edges();
        let inside = edges.filter(|edge| crosses(*edge)).count() % 2 == 1;
        (depth.is_finite() && inside).then_some(depth)
    }
}

impl Traced {
    /// Its unit normal where a ray meets it at a depth, on the side that is seen.
    pub fn normal_seen(&self, ray: &Ray, depth: f64) -> DVec3 {
        let facing = |normal: DVec3, toward: DVec3| {
            if normal.dot(toward) < 0.0 { -normal } else { normal }
        };
        let flat = facing(self.normal, -ray.along);
        let bent = self.bent.and_then(|bent| bent.transform_point3(ray.at(depth)).try_normalize());
        bent.map_or(flat, |bent| facing(bent, flat))
    }
}

/// Between which heights in the window a face lies, pixels, with room for what is rounded.
fn rows(face: &Face, camera: &Camera) -> [f64; 2] {
    let vertices = || face.outlines.vertices();
    if vertices().any(|vertex| camera.depth(vertex) < camera.nearest()) {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let heights = vertices().map(|vertex| camera.project(vertex).0.y);
    let [low, high] = heights
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)]);
    [low - 0.25, high + 0.25]
}
