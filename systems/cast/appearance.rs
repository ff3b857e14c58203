//! How a polygon looks under the lights of a scene, as far as it is the same all over it (algorithm §3).

use glam::{DVec3, Vec3};

use super::texture::FaceTexture;
use crate::components::Surface;
use crate::light::shading::{Lamps, Reflectance};

/// How a polygon of one orientation and surface looks under the lights of a scene: constant over it, but for the cue,
/// textures and shadows.
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
            texture,
        }
    }
}
