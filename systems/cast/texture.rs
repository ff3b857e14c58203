//! Textures on the polygons of a view: where a ray meets one, the texture is filtered over the ray's footprint (paper §5).

use glam::Vec4;

use crate::polygon::face::Face;
use crate::polygon::texture::TexturedBy;
use crate::polygon::texture::{Footprint, MappedTexture, Mapping};
use crate::view::camera::Camera;
use crate::view::ray::Ray;
use crate::view::samples::POSITIONS;

/// A texture on a face, as a view sees it.
pub(crate) struct FaceTexture<'a> {
    texture: &'a MappedTexture,
    mapping: Mapping,
    camera: &'a Camera,
    /// What a ray stands for, in the texture: a pixel, half a pixel, a quarter. Where it is the same all over the face it
    /// may be found in advance; else it is where a ray meets it.
    footprints: Option<Box<[Footprint; 3]>>,
}

/// Sides in pixels of what a ray stands for: rays further apart than pixels stand for a pixel each.
const SIDES: [f64; 3] = [1.0, 0.5, 0.25];

impl<'a> FaceTexture<'a> {
    /// The texture as it lies on `face` of that number; `None` where it shows none of it on the face, such as
    /// upright on it.
    pub fn new(by: &'a TexturedBy, (at, face): (usize, &Face), camera: &'a Camera) -> Option<Self> {
        let texture = by.laid.on(at)?;
        Some(Self { texture, mapping: by.mapping(at, face)?, camera, footprints: None })
    }

    /// The same, with all found that is the same wherever it is met.
    pub fn in_advance(self) -> Self {
        let Self { mapping, camera, .. } = &self;
        let sight = Ray { origin: camera.focal, along: camera.forward };
        let footprint = |pixels| mapping.footprint(camera, (&sight, 0.0), pixels);
        let footprints = camera.eye.is_none().then(|| Box::new(SIDES.map(footprint)));
        Self { footprints, ..self }
    }

    /// Associated RGBA of the texture where a ray of the lattice of `step` positions meets the face, at `depth`.
    pub fn at(&self, ray: &Ray, depth: f64, step: usize) -> Vec4 {
        let size = if step >= POSITIONS { 0 } else { 3 - step };
        let footprint = self.footprints.as_ref().map_or_else(
            || self.mapping.footprint(self.camera, (ray, depth), SIDES[size]),
            |footprints| footprints[size],
        );
        self.texture.filtered(self.mapping.at(ray.at(depth)), &footprint)
    }
}
