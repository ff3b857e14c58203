//! How a polygon looks under the lights of a scene, where a ray meets it (algorithm §3).

use glam::{DAffine3, DVec3, Vec3};

use super::receiving;
use super::texture::FaceTexture;
use crate::light::shading::{Lamp, Lamps, Reflectance};
use crate::light::strength::LightStrength;
use crate::polygon::face::Face;
use crate::volume::grid::Grid;

/// What light falls on the faces of one entity, and how they answer it.
#[derive(Clone, Copy)]
pub(crate) struct Answer<'a> {
    /// The coefficients of the entity's surface.
    pub how: Reflectance,
    /// The lights of the view.
    pub lamps: &'a Lamps,
    /// β of each light of `lamps` that casts a shadow.
    pub strengths: &'a [Option<LightStrength>],
    /// The grid of the volume that shadows are cast in.
    pub grid: Option<&'a Grid>,
}

/// Which way a face points.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Pointing {
    /// Its unit normal.
    Flat(Vec3),
    /// World points of it to vectors along the normal of what it stands for.
    Bent(DAffine3),
}

/// How one face looks, but for the cue and the strengths of lights.
pub(crate) struct Appearance<'a> {
    /// α_P.
    pub opacity: f64,
    /// c_P k_a.
    pub ambient: DVec3,
    /// Its texture.
    pub texture: Option<FaceTexture<'a>>,
    answer: Answer<'a>,
    face: &'a Face,
    pointing: Pointing,
    color: Vec3,
    known: Option<Box<Known>>,
}

/// What is the same all over a face, found in advance.
struct Known {
    /// What it reflects of the lights that cast no shadow, and of each that does, unshadowed; of a flat face.
    reflected: Option<(DVec3, Vec<DVec3>)>,
    /// For each of those lights, the way from a point of it to the one whose strength it gets.
    offsets: Vec<DVec3>,
}

impl<'a> Appearance<'a> {
    /// The appearance of a face of a color and an opacity, and how it points, with the texture on it.
    #[inline]
    pub fn new(
        answer: Answer<'a>,
        (color, opacity): (Vec3, f32),
        (face, pointing): (&'a Face, Pointing),
        texture: Option<FaceTexture<'a>>,
    ) -> Self {
        Self {
            opacity: f64::from(opacity),
            ambient: (color * answer.how.ambient).as_dvec3(),
            texture,
            answer,
            face,
            pointing,
            color,
            known: None,
        }
    }

    /// The same, with all found that is the same wherever it is met.
    pub fn in_advance(self) -> Self {
        let shadowed = 0..self.answer.lamps.shadowed.len();
        let reflected = matches!(self.pointing, Pointing::Flat(_)).then(|| {
            let all = shadowed.clone().map(|light| self.shadowed_at(light, || DVec3::ZERO));
            (self.reflected_at(|| DVec3::ZERO), all.collect())
        });
        let offsets = shadowed.map(|light| self.shadow_offset(light)).collect();
        let texture = self.texture.map(FaceTexture::in_advance);
        Self { known: Some(Box::new(Known { reflected, offsets })), texture, ..self }
    }

    /// How many lights cast shadows.
    pub fn shadows(&self) -> usize {
        self.answer.lamps.shadowed.len()
    }

    /// What is reflected all over it, where that is known.
    fn alike(&self) -> Option<&(DVec3, Vec<DVec3>)> {
        self.known.as_ref()?.reflected.as_ref()
    }

    fn normal_at(&self, world: impl Fn() -> DVec3) -> Vec3 {
        match &self.pointing {
            Pointing::Flat(normal) => *normal,
            Pointing::Bent(normal) => {
                normal.transform_point3(world()).normalize_or_zero().as_vec3()
            }
        }
    }

    /// What it reflects at a world point of it of the lights that cast no shadow.
    pub fn reflected_at(&self, world: impl Fn() -> DVec3) -> DVec3 {
        if let Some((reflected, _)) = self.alike() {
            return *reflected;
        }
        let normal = self.normal_at(world);
        let reflected = |lamp: &Lamp| lamp.reflected(self.color, normal, &self.answer.how);
        self.answer.lamps.plain.iter().map(reflected).sum::<Vec3>().as_dvec3()
    }

    /// What it reflects there of the light of that number that does, unshadowed.
    pub fn shadowed_at(&self, light: usize, world: impl Fn() -> DVec3) -> DVec3 {
        if let Some((_, shadowed)) = self.alike() {
            return shadowed[light];
        }
        let (_, lamp) = &self.answer.lamps.shadowed[light];
        lamp.reflected(self.color, self.normal_at(world), &self.answer.how).as_dvec3()
    }

    /// The way from a point of it to the point whose strength of that light it gets, world units.
    pub fn shadow_offset(&self, light: usize) -> DVec3 {
        if let Some(known) = &self.known {
            return known.offsets[light];
        }
        let Answer { lamps, strengths, grid, .. } = &self.answer;
        let (_, lamp) = &lamps.shadowed[light];
        let strength = strengths.get(light).and_then(Option::as_ref);
        grid.map_or(DVec3::ZERO, |grid| {
            receiving::shadow_offset(self.face.normal, (lamp, strength), grid)
        })
    }
}
