//! How a polygon looks under the lights of a scene, as far as it is the same all over it (algorithm §3).

use glam::{DVec3, Vec3};

use super::bent::Bent;
use super::texture::FaceTexture;
use crate::components::Surface;
use crate::light::shading::{Lamps, Reflectance};

/// How a polygon of one orientation and surface looks under the lights of a scene: constant over it, but for the cue,
/// textures, shadows and what is bent.
pub(crate) struct Appearance {
    /// α_P.
    pub opacity: f64,
    /// c_P k_a.
    pub ambient: DVec3,
    /// What it reflects of the lights that cast no shadow.
    pub reflected: DVec3,
    /// What it reflects of each light that does, unshadowed.
    pub shadowed: Vec<DVec3>,
    /// For each of those lights, the way from a point of it to the one whose strength it gets; empty without strengths.
    pub shadow_offsets: Vec<DVec3>,
    /// How it answers light where its normal is not the same all over it.
    pub bent: Option<Box<Bent>>,
    /// Its texture.
    pub texture: Option<FaceTexture>,
}

impl Appearance {
    /// The appearance of a face of unit normal `normal`, with the texture on it; `shadow_offsets` are those of
    /// [`shadow_offsets`](super::receiving::shadow_offsets).
    pub fn new(
        surface: &Surface,
        normal: DVec3,
        lamps: &Lamps,
        shadow_offsets: Vec<DVec3>,
        texture: Option<FaceTexture>,
    ) -> Self {
        let (how, normal): (Reflectance, Vec3) = (surface.into(), normal.as_vec3());
        let color = surface.color.0;
        let reflected =
            lamps.plain.iter().map(|lamp| lamp.reflected(color, normal, &how)).sum::<Vec3>();
        let shadowed = lamps.shadowed.iter();
        Self {
            opacity: f64::from(surface.opacity),
            ambient: (color * how.ambient).as_dvec3(),
            reflected: reflected.as_dvec3(),
            shadowed: shadowed
                .map(|(_, lamp)| lamp.reflected(color, normal, &how).as_dvec3())
                .collect(),
            shadow_offsets,
            bent: None,
            texture,
        }
    }

    /// The same face, with a normal that runs from corner to corner.
    pub fn bent(self, bent: Option<Bent>) -> Self {
        Self { bent: bent.map(Box::new), ..self }
    }

    /// What it reflects at a world point of it of the lights that cast no shadow.
    pub fn reflected_at(&self, world: impl Fn() -> DVec3) -> DVec3 {
        self.bent.as_ref().map_or(self.reflected, |bent| bent.reflected(world()))
    }

    /// What it reflects there of the light of that number that does, unshadowed.
    pub fn shadowed_at(&self, light: usize, world: impl Fn() -> DVec3) -> DVec3 {
        self.bent.as_ref().map_or(self.shadowed[light], |bent| bent.shadowed(light, world()))
    }
}
