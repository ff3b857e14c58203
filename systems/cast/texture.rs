//! Textures on the polygons of a view: where a ray meets one, the texture is filtered over the ray's footprint (paper §5).

use glam::Vec4;

use crate::polygon::face::Face;
use crate::polygon::texture::TexturedBy;
use crate::polygon::texture::{Footprint, MappedTexture, Mapping};
use crate::view::camera::Camera;
use crate::view::ray::Ray;
use crate::view::samples::POSITIONS;

/// A texture on a face, as a view sees it.
pub(crate) struct FaceTexture {
    texture: MappedTexture,
    mapping: Mapping,
    camera: Camera,
    /// What a ray stands for, in the texture: a pixel, half a pixel, a quarter. The same all over the face, or in
    /// perspective found where a ray meets it.
    footprints: Option<[Footprint; 3]>,
}

/// Sides in pixels of what a ray stands for: rays further apart than pixels stand for a pixel each.
const SIDES: [f64; 3] = [1.0, 0.5, 0.25];

impl FaceTexture {
    /// The texture as it lies on `face` of that number; `None` where it shows none of it on the face, such as
    /// upright on it.
    pub fn new(by: &TexturedBy, (at, face): (usize, &Face), camera: &Camera) -> Option<Self> {
        let texture = by.laid.on(at)?.clone();
        let mapping = by.mapping(at, face)?;
        let sight = Ray { origin: camera.focal, along: camera.forward };
        let footprints = camera
            .eye
            .is_none()
            .then(|| SIDES.map(|pixels| mapping.footprint(camera, (&sight, 0.0), pixels)));
        Some(Self { texture, mapping, camera: *camera, footprints })
    }

    /// Associated RGBA of the texture where a ray of the lattice of `step` positions meets the face, at `depth`.
    pub fn at(&self, ray: &Ray, depth: f64, step: usize) -> Vec4 {
        let size = if step >= POSITIONS { 0 } else { 3 - step };
        let footprint = self.footprints.map_or_else(
            || self.mapping.footprint(&self.camera, (ray, depth), SIDES[size]),
            |footprints| footprints[size],
        );
        self.texture.filtered(self.mapping.at(ray.at(depth)), &footprint)
    }
}
