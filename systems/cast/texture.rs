//! Textures on the polygons of a view: where a ray meets one, the texture is filtered over the ray's footprint (paper §5).

use glam::{DVec3, Vec4};

use crate::components::Textured;
use crate::polygon::face::Face;
use crate::polygon::texture::TexturedBy;
use crate::polygon::texture::{Footprint, Mapping, Texture};
use crate::view::camera::Camera;
use crate::view::samples::POSITIONS;

/// A texture laid on a face and seen in a view.
pub struct Laid {
    texture: Texture,
    mapping: Mapping,
    /// What a ray stands for, in the texture: a pixel, half a pixel, a quarter.
    footprints: [Footprint; 3],
}

impl Laid {
    /// The texture as it lies on `face`; `None` where it stands upright on the face and shows it nothing.
    pub fn new(by: &TexturedBy, face: &Face, camera: &Camera) -> Option<Self> {
        let corners = Some(by.corners.map(|corner| corner.to_array()));
        let mapping = Mapping::new(face, &Textured { corners, ..by.textured.clone() }).ok()?;
        let footprints = [1.0, 0.5, 0.25].map(|pixels| mapping.footprint(camera, pixels));
        Some(Self { texture: by.texture.clone(), mapping, footprints })
    }

    /// Associated RGBA of the texture at a world point of the face, for a ray of the lattice of `step` positions. Rays
    /// further apart than pixels stand for a pixel each.
    pub fn at(&self, world: DVec3, step: usize) -> Vec4 {
        let size = if step >= POSITIONS { 0 } else { 3 - step };
        self.texture.filtered(self.mapping.at(world), &self.footprints[size])
    }
}
