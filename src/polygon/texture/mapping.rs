//! From object space to texture definition space, as an affine map (paper §5, figure 2).

use glam::{DVec2, DVec3};

use super::Footprint;
use crate::components::Textured;
use crate::polygon::face::Face;
use crate::view::camera::Camera;
use crate::view::ray::Ray;

/// Sines under this count as 0: a view along a polygon, corners on one line.
const SLIGHT: f64 = 1e-6;

/// Where world points of a face's plane lie in its texture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mapping {
    /// A world point.
    origin: DVec3,
    /// Its (u, v): (0, 0) is the texture's top left corner.
    start: DVec2,
    /// How fast u grows in the world, in textures per world unit.
    u: DVec3,
    /// How fast v, which runs down, grows in the world.
    v: DVec3,
    /// The face's unit normal.
    normal: DVec3,
}

impl Mapping {
    /// The mapping that `textured` states for `face`.
    ///
    /// Corners out of the face's plane are met along the normal of their own plane. The error is a sentence without
    /// a subject, for the caller to put the entity's name before it: corners on one line, a texture that stands
    /// upright on the face, repeats that are not above 0.
    pub fn new(face: &Face, textured: &Textured) -> Result<Self, String> {
        let repeats = DVec2::from(textured.repeats);
        if !(repeats.is_finite() && repeats.min_element() > 0.0) {
            return Err(format!(
                "a texture repeated {repeats} times cannot be laid; state two numbers above 0 as `repeats`"
            ));
        }
        let [origin, right, below] = corners(face, textured)?;
        let (across, down) = (right - origin, below - origin);
        let upright = across.cross(down);
        if !upright.is_finite() || upright.length() <= SLIGHT * across.length() * down.length() {
            return Err(format!(
                "the texture's corners {origin}, {right} and {below} lie on one line; state `corners` that span a parallelogram: top left, top right and bottom left"
            ));
        }
        if upright.dot(face.normal).abs() <= SLIGHT * upright.length() {
            return Err(format!(
                "the texture's corners {origin}, {right} and {below} stand upright on the polygon and show it no texture; state `corners` in the polygon's plane"
            ));
        }
        let square = upright.length_squared();
        let u = down.cross(upright) / square * repeats.x;
        let v = upright.cross(across) / square * repeats.y;
        if !(u.is_finite() && v.is_finite()) {
            return Err(format!(
                "the texture's corners {origin}, {right} and {below} are too close together to divide by; state `corners` further apart"
            ));
        }
        Ok(Self { origin, start: DVec2::ZERO, u, v, normal: face.normal })
    }

    /// The mapping that has the corners of a triangle at `places` in the texture, times `repeats`.
    ///
    /// Places may be on one line or at one point: the triangle then has the texels there. `None` of a face that is no
    /// triangle, and of places or repeats that are no numbers.
    #[must_use]
    pub fn of_places(face: &Face, places: [DVec2; 3], repeats: [f64; 2]) -> Option<Self> {
        let [origin, right, below] = face.triangle()?;
        let [start, across, down] = places.map(|place| place * DVec2::from(repeats));
        let (b, c) = (right - origin, below - origin);
        let upright = b.cross(c);
        // A function that grows by `more_b` along b and by `more_c` along c, and not along the normal.
        let growth = |more_b: f64, more_c: f64| {
            (c.cross(upright) * more_b + upright.cross(b) * more_c) / upright.length_squared()
        };
        let (across, down) = (across - start, down - start);
        let (u, v) = (growth(across.x, down.x), growth(across.y, down.y));
        let finite = start.is_finite() && u.is_finite() && v.is_finite();
        finite.then_some(Self { origin, start, u, v, normal: face.normal })
    }

    /// The texture's (u, v) at a world point: (0, 0) at the top left corner, and `repeats` at the stated bottom right one.
    #[must_use]
    pub fn at(&self, world: DVec3) -> DVec2 {
        let from = world - self.origin;
        self.start + DVec2::new(self.u.dot(from), self.v.dot(from))
    }

    /// What a square of side `region_pixels` of the picture covers in the texture, carried along `ray` to its depth `depth`.
    ///
    /// In a parallel view it is the same all over a face. Of a face seen edge-on it is huge, but finite.
    #[must_use]
    pub fn footprint(
        &self,
        camera: &Camera,
        (ray, depth): (&Ray, f64),
        region_pixels: f64,
    ) -> Footprint {
        let facing = self.normal.dot(ray.along);
        let facing = facing.abs().max(SLIGHT).copysign(facing);
        let pixel = camera.pixel / camera.magnification(depth);
        let side = |direction: DVec3| {
            let along = ray.along * (self.normal.dot(direction) / facing);
            let on_plane = (direction - along) * (pixel * region_pixels);
            DVec2::new(self.u.dot(on_plane), self.v.dot(on_plane))
        };
        Footprint::new(side(camera.right), side(-camera.up))
    }
}

/// Top left, top right and bottom left: as stated, or the face's first, second and last vertex.
fn corners(face: &Face, textured: &Textured) -> Result<[DVec3; 3], String> {
    if let Some(stated) = textured.corners {
        return Ok(stated.map(DVec3::from));
    }
    match face.outlines.iter().next() {
        Some([first, second, .., last]) => Ok([*first, *second, *last]),
        _ => Err(
            "a polygon of fewer than 3 vertices has no place for a texture; state its `corners`"
                .to_owned(),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::components::{TextureFilter, Wrap};

    fn face() -> Face {
        let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)];
        Face::new(vec![square.map(|(x, z)| DVec3::new(x, 1.0, 2.0 - z)).to_vec()]).unwrap()
    }

    fn textured(corners: Option<[[f64; 3]; 3]>, repeats: [f64; 2]) -> Textured {
        let (wrap, filter) = (Wrap::Repeat, TextureFilter::Ellipse);
        Textured { texture: "checker".to_owned(), corners, repeats, wrap, filter }
    }

    fn camera(forward: DVec3) -> Camera {
        let right = forward.any_orthonormal_vector();
        let (focal, size) = (DVec3::new(0.3, 0.2, 0.1), [100, 80]);
        Camera { right, up: right.cross(forward), forward, focal, pixel: 0.125, size, eye: None }
    }

    #[test]
    fn the_first_second_and_last_vertex_are_top_left_top_right_and_bottom_left() {
        let mapping = Mapping::new(&face(), &textured(None, [1.0, 3.0])).unwrap();
        for (world, uv) in [
            ([0.0, 1.0, 2.0], [0.0, 0.0]),
            ([4.0, 1.0, 2.0], [1.0, 0.0]),
            ([0.0, 1.0, 0.0], [0.0, 3.0]),
            ([2.0, 1.0, 1.0], [0.5, 1.5]),
        ] {
            assert!(mapping.at(DVec3::from(world)).abs_diff_eq(DVec2::from(uv), 1e-12));
        }
    }

    #[test]
    fn skewed_corners_span_a_parallelogram() {
        let corners = [[1.0, 1.0, 1.0], [3.0, 1.0, 1.5], [0.5, 1.0, 0.0]];
        let mapping = Mapping::new(&face(), &textured(Some(corners), [1.0, 1.0])).unwrap();
        let [origin, right, below] = corners.map(DVec3::from);
        let place = origin + 0.25 * (right - origin) + 1.75 * (below - origin);
        assert!(mapping.at(place).abs_diff_eq(DVec2::new(0.25, 1.75), 1e-12));
    }

    #[test]
    fn a_footprint_is_how_far_apart_the_rays_of_a_region_meet_the_plane_in_the_texture() {
        let mapping = Mapping::new(&face(), &textured(None, [2.0, 1.0])).unwrap();
        for forward in [[0.0, 1.0, 0.0], [0.3, -0.7, 0.4], [-0.9, 0.1, 0.2]] {
            let camera = camera(DVec3::from(forward).normalize());
            let uv = |x: f64, y: f64| {
                let ray = camera.origin(DVec2::new(x, y));
                mapping.at(ray + camera.forward * ((1.0 - ray.y) / camera.forward.y))
            };
            let sides = mapping.footprint(&camera, (&camera.ray(DVec2::ZERO), 0.0), 0.5).sides();
            assert!(sides.x_axis.abs_diff_eq(uv(7.5, 3.0) - uv(7.0, 3.0), 1e-12));
            assert!(sides.y_axis.abs_diff_eq(uv(7.0, 3.5) - uv(7.0, 3.0), 1e-12));
        }
    }

    #[test]
    fn a_face_seen_edge_on_has_a_footprint_that_is_huge_and_finite() {
        let mapping = Mapping::new(&face(), &textured(None, [1.0, 1.0])).unwrap();
        let camera = camera(DVec3::X);
        let sides = mapping.footprint(&camera, (&camera.ray(DVec2::ZERO), 0.0), 1.0).sides();
        assert!(sides.is_finite());
        assert!(sides.x_axis.length().max(sides.y_axis.length()) > 1e3);
    }

    #[test]
    fn the_corners_of_a_triangle_lie_in_the_texture_where_they_say() {
        let corners = [[1.0, 2.0, 3.0], [4.0, 2.0, 5.0], [0.0, 7.0, 1.0]].map(DVec3::from);
        let triangle = Face::new(vec![corners.to_vec()]).unwrap();
        let line = [DVec2::ZERO, DVec2::ONE, DVec2::splat(3.0)];
        for places in
            [[[0.25, 0.5], [0.75, 0.125], [3.5, -2.0]].map(DVec2::from), line, [DVec2::ONE; 3]]
        {
            let mapping = Mapping::of_places(&triangle, places, [2.0, 3.0]).unwrap();
            for (corner, place) in corners.into_iter().zip(places) {
                let expected = place * DVec2::new(2.0, 3.0);
                assert!(mapping.at(corner).abs_diff_eq(expected, 1e-12));
                assert!(mapping.at(corner + triangle.normal).abs_diff_eq(expected, 1e-12));
            }
        }
        assert_eq!(Mapping::of_places(&triangle, [DVec2::NAN; 3], [1.0; 2]), None);
        assert_eq!(Mapping::of_places(&face(), line, [1.0; 2]), None);
    }

    #[test]
    fn corners_that_span_nothing_and_repeats_of_nothing_are_refused_with_a_remedy() {
        let refused =
            |corners, repeats| Mapping::new(&face(), &textured(corners, repeats)).unwrap_err();
        let line = [[0.0, 1.0, 0.0], [1.0, 1.0, 1.0], [2.0, 1.0, 2.0]];
        let upright = [[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]];
        let nowhere = [[0.0, 1.0, 0.0], [f64::NAN, 1.0, 0.0], [0.0, 1.0, f64::INFINITY]];
        for corners in [line, [[1.0; 3]; 3], nowhere, upright] {
            assert!(refused(Some(corners), [1.0, 1.0]).contains("state `corners`"));
        }
        for repeats in [[0.0, 1.0], [1.0, -2.0], [f64::NAN, 1.0]] {
            assert!(refused(None, repeats).contains("above 0"));
        }
    }
}
