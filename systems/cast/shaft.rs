//! Light shafts: dust that answers a light, seen where its strength is above zero (paper §8).
//!
//! The paper gives all voxels a slightly non-zero opacity. Here the dust is not in the volume: its opacity is the stated
//! one times the light's strength, taken at each sample of a ray, so that a scene without a shaft has no dust to skip
//! and one with it keeps its empty space. A beam that the volume weakens reads the light's 3D buffer; one that passes
//! without attenuation reads its slide alone, without a shadow pass.

use glam::{DVec3, Vec3, Vec4};

use crate::components::{Light, Shaft};
use crate::light::shading::toward;
use crate::light::strength::ProjectedBy;
use crate::light::strength::{LightStrength, Slide};
use crate::view::camera::Camera;

/// What a shaft is made of: the light and what shapes its beam.
#[derive(Clone, PartialEq)]
pub(crate) struct StatedShaft {
    /// The dust.
    pub shaft: Shaft,
    /// The light that it answers.
    pub light: Light,
    /// The profile that is extruded along the light.
    pub projected: Option<ProjectedBy>,
    /// β of the light, for a beam that the volume weakens.
    pub strength: Option<LightStrength>,
}

/// Every shaft of a scene on one view.
pub struct Dust {
    beams: Vec<Beam>,
}

struct Beam {
    /// Linear colour of the lit dust.
    color: Vec3,
    /// Opacity per opacity unit where the strength is 1.
    opacity: f32,
    strength: Strength,
}

enum Strength {
    Weakened(Box<LightStrength>),
    Profile(Slide),
    Full,
}

impl Dust {
    /// The dust of some shafts; `None` without one. The error is a sentence without a subject.
    pub fn new(stated: &[StatedShaft], camera: &Camera) -> Result<Option<Self>, String> {
        let beams: Vec<Beam> =
            stated.iter().map(|stated| Beam::new(stated, camera)).collect::<Result<_, _>>()?;
        let dust = Self { beams };
        Ok((!dust.beams.is_empty()).then_some(dust))
    }

    /// Associated colour and opacity per opacity unit of the dust at a world point, together with the gel that is there
    /// too: what they let through multiplies, and their colours keep their weights.
    pub fn join(&self, gel: Vec4, world: DVec3) -> Vec4 {
        self.beams.iter().fold(gel, |seen, beam| {
            let strength = beam.strength(world).min(1.0);
            let opacity = beam.opacity * strength;
            let sum = seen.w + opacity;
            if opacity <= 0.0 {
                return seen;
            }
            let joint = 1.0 - (1.0 - seen.w) * (1.0 - opacity);
            ((seen.truncate() + beam.color * opacity) * (joint / sum)).extend(joint)
        })
    }
}

impl Beam {
    fn new(stated: &StatedShaft, camera: &Camera) -> Result<Self, String> {
        let StatedShaft { shaft, light, projected, strength } = stated;
        let toward = toward(light, -camera.forward);
        let strength = match (strength, projected) {
            (Some(strength), _) if shaft.attenuated => {
                Strength::Weakened(Box::new(strength.clone()))
            }
            (_, Some(projected)) => Strength::Profile(Slide::new(projected, toward)?),
            _ => Strength::Full,
        };
        let color = shaft.color.unwrap_or(light.color).0 * light.strength;
        Ok(Self { color, opacity: shaft.opacity, strength })
    }

    fn strength(&self, world: DVec3) -> f32 {
        match &self.strength {
            Strength::Weakened(strength) => strength.at(world),
            Strength::Profile(slide) => slide.at(world, [0.0; 2]),
            Strength::Full => 1.0,
        }
    }
}
