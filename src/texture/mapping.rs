//! From object space to texture definition space, as an affine map (paper §5, figure 2).

use glam::{DVec2, DVec3};

use super::Footprint;
use crate::components::Textured;
use crate::face::Face;
use crate::ray::Camera;

/// Sines under this count as 0: a view along a polygon, corners on one line.
const SLIGHT: f64 = 1e-6;

/// Where world points of a face's plane lie in its texture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mapping {
    /// The world point at (0, 0) of the texture: its top left corner.
    origin: DVec3,
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
        Ok(Self { origin, u, v, normal: face.normal })
    }

    /// The texture's (u, v) at a world point: (0, 0) at the top left corner, `repeats` at the bottom right one.
    #[must_use]
    pub fn at(&self, world: DVec3) -> DVec2 {
        let from = world - self.origin;
        DVec2::new(self.u.dot(from), self.v.dot(from))
    }

    /// What a square of side `region_pixels` of the picture covers in the texture, carried along the parallel rays.
    ///
    /// It is the same all over a face in a view. Of a face seen edge-on it is huge, but finite.
    #[must_use]
    pub fn footprint(&self, camera: &Camera, region_pixels: f64) -> Footprint {
        let facing = self.normal.dot(camera.forward);
        let facing = facing.abs().max(SLIGHT).copysign(facing);
        let side = |direction: DVec3| {
            let along = camera.forward * (self.normal.dot(direction) / facing);
            let on_plane = (direction - along) * (camera.pixel * region_pixels);
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
    match face.outlines.first().map(Vec::as_slice) {
        Some([first, second, .., last]) => Ok([*first, *second, *last]),
        _ => Err(
            "a polygon of fewer than 3 vertices has no place for a texture; state its `corners`"
                .to_owned(),
        ),
    }
}
