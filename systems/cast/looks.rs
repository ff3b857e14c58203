//! How the faces of a scene's polygons look on a view: of few it is known before a ray is cast, of the facets of a mesh it is
//! found where one is met.

use glam::Vec3;

use super::appearance::{Answer, Appearance, Pointing};
use super::inputs::{Inputs, TracedPolygons};
use super::texture::FaceTexture;
use crate::polygon::face::{FaceColors, FaceOpacities};
use crate::polygon::texture::Lies;
use crate::view::camera::Camera;

/// More faces than these are facets of a mesh: each is small, and what they cover is not.
pub(super) const FEW: usize = 256;

/// How the faces of one entity look.
pub(crate) struct Look<'a> {
    traced: &'a TracedPolygons,
    answer: Answer<'a>,
    camera: &'a Camera,
    /// The appearance of each face, where all are found in advance; else none.
    known: Vec<Appearance<'a>>,
}

impl<'a> Look<'a> {
    /// How the polygons of one entity look, which are among those of `inputs`.
    pub fn new(traced: &'a TracedPolygons, inputs: &'a Inputs, camera: &'a Camera) -> Self {
        let answer = Answer {
            how: (&traced.surface).into(),
            lamps: &inputs.lamps,
            strengths: &inputs.strengths,
            grid: traced.grid.as_ref(),
        };
        let mut look = Self { traced, answer, camera, known: Vec::new() };
        // Where a texture lies by the corners that are stated takes room to find.
        let laid = traced.textured.as_ref().is_some_and(|by| matches!(by.lies, Lies::Corners(_)));
        if traced.faces.0.len() <= FEW || laid {
            let all = 0..traced.faces.0.len();
            let known = |at: usize| {
                let normal = traced.faces.0[at].normal.as_vec3();
                look.appearance(at, normal).in_advance()
            };
            look.known = all.map(known).collect();
        }
        look
    }

    #[inline]
    fn appearance(&self, at: usize, normal: Vec3) -> Appearance<'a> {
        let TracedPolygons { faces, surface, colors, opacities, normals, textured, .. } =
            self.traced;
        let face = &faces.0[at];
        let texture =
            textured.as_ref().and_then(|by| FaceTexture::new(by, (at, face), self.camera));
        let color: Vec3 = FaceColors::of(colors.as_ref(), at).unwrap_or(surface.color).0;
        let opacity = surface.opacity * FaceOpacities::of(opacities.as_ref(), at);
        let bent = normals.as_ref().and_then(|normals| normals.over(at, face));
        let pointing = bent.map_or(Pointing::Flat(normal), Pointing::Bent);
        Appearance::new(self.answer, (color, opacity), (face, pointing), texture)
    }

    /// Does something with the appearance of the face of that number, whose unit normal is `normal`.
    #[inline]
    pub fn with<R>(&self, (at, normal): (usize, Vec3), to: impl FnOnce(&Appearance<'_>) -> R) -> R {
        match self.known.get(at) {
            Some(known) => to(known),
            None => to(&self.appearance(at, normal)),
        }
    }

    /// How many faces the entity has.
    pub fn faces(&self) -> usize {
        self.traced.faces.0.len()
    }
}
