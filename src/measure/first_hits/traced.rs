//! A polygon as the middles of pixels meet it.

use glam::{DAffine3, DVec3};

use super::tiles::Pixels;
use crate::polygon::face::Face;
use crate::polygon::outline::Rings;
use crate::view::camera::Camera;
use crate::view::ray::Ray;

/// How far beside where it is drawn a face is looked for, for what is rounded, pixels.
const ROOM: f64 = 0.25;

/// A polygon, with two axes of its plane.
pub(super) struct Traced {
    normal: DVec3,
    /// World points of it to vectors along the normal of what it stands for, where that is not flat.
    bent: Option<DAffine3>,
    center: DVec3,
    axes: [DVec3; 2],
    outlines: Rings<[f64; 2]>,
    /// Of no others does the middle meet it.
    pub pixels: Pixels,
    pub opacity: f64,
    pub entity: u32,
}

impl Traced {
    /// A face of an entity that no pixels meet but those; `bent` is as of
    /// [`over`](crate::polygon::smooth::CornerNormals::over).
    pub fn new(
        (face, bent): (&Face, Option<DAffine3>),
        pixels: Pixels,
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
        Self { normal, bent, center, axes: [axes.0, axes.1], outlines, pixels, opacity, entity }
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

/// The pixels whose middles may meet a face; `None` where there are none.
pub(super) fn pixels(face: &Face, camera: &Camera) -> Option<Pixels> {
    // Vertices may lie a little beside the plane, which is where rays meet it.
    let flattened = |vertex: DVec3| vertex - face.normal * face.normal.dot(vertex - face.center);
    let [columns, _] = drawn(face.outlines.vertices().map(flattened), camera);
    let [_, rows] = drawn(face.outlines.vertices(), camera);
    Pixels::between([columns, rows], camera.size)
}

/// Between which window positions a polygon lies, across and down, pixels; infinite where it reaches behind the eye.
fn drawn(vertices: impl Iterator<Item = DVec3>, camera: &Camera) -> [[f64; 2]; 2] {
    let mut found = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for vertex in vertices {
        let (window, depth) = camera.project(vertex);
        if depth < camera.nearest() {
            return [[f64::NEG_INFINITY, f64::INFINITY]; 2];
        }
        for ([low, high], place) in found.iter_mut().zip(window.to_array()) {
            (*low, *high) = (low.min(place - ROOM), high.max(place + ROOM));
        }
    }
    found
}
