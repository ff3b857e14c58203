//! What a sample of values looks like: classified, shaded, shadowed and cut where it is.

use glam::{DVec3, Vec3, Vec4};
use hecs::Entity;

use super::super::integrated::Ends;
use super::super::lanes::{LANES, Lanes, each};
use super::Values;
use crate::light::shading::Lamp;
use crate::light::side_by_side::{self, Lighting, Vectors};
use crate::view::composite::{recolor, thicken};
use crate::volume::clipping::Section;
use crate::volume::field::Sampled;
use crate::volume::gradients::normal;

/// Voxels under a cut that are shaded by its normal alone: those of the slab that it is in.
const CUT_DEEP: f64 = 0.5;

impl Values<'_> {
    /// Whether what a sample shows is told by its value and gradient alone, and by nothing about its place or slab.
    pub(super) fn is_plain(&self) -> bool {
        !self.integrated && self.is_alike_everywhere()
    }

    /// Whether nothing of what a sample shows is told by its place.
    fn is_alike_everywhere(&self) -> bool {
        self.cut.is_none() && self.strengths.iter().all(Option::is_none)
    }

    /// [`look`](Self::look) for samples of the rays `met`, `N` at the most, in their order, that are [plain](Self::is_plain): side
    /// by side, to the last bit the same.
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    pub(super) fn look_at_all<const N: usize>(
        &self,
        sampled: &[Sampled; N],
        (met, fade): (Lanes, f32),
        seen: &mut [Vec4; LANES],
    ) {
        let mut values = [0.0; N];
        let mut gradients = [[0.0; N]; 3];
        for (at, sampled) in sampled.iter().enumerate() {
            values[at] = sampled.value;
            side_by_side::set(&mut gradients, at, Vec3::from(sampled.gradient));
        }
        let alphas = self.classifier.opacities(&values, &gradients);
        let mut colors: Vectors<N> =
            side_by_side::all(self.classifier.only_color().unwrap_or_default());
        if self.classifier.only_color().is_none() {
            for at in (0..N).filter(|&at| alphas[at] > 0.0) {
                let gradient = side_by_side::one(&gradients, at).to_array();
                side_by_side::set(&mut colors, at, self.classifier.color(values[at], gradient));
            }
        }
        let lighting = Lighting { ambient: 0.0, lamps: &self.all_lamps, how: self.how };
        let reflected = lighting.sent(&colors, &side_by_side::normals(&gradients));
        for (at, lane) in each(met).enumerate() {
            let reflected = side_by_side::one(&reflected, at);
            let color = side_by_side::one(&colors, at);
            let lit = self.lit(color, reflected, fade, alphas[at]);
            seen[lane] = if alphas[at] > 0.0 { lit } else { Vec4::ZERO };
        }
    }

    /// Associated RGBA per opacity unit of a sample that stands for a slab; of its reflected part `fade` is left.
    pub(super) fn look(
        &self,
        (sampled, slab): (&Sampled, Option<Ends>),
        ray: impl FnOnce() -> [DVec3; 2],
        fade: f32,
    ) -> Vec4 {
        let Sampled { value, gradient } = *sampled;
        let integral = slab.filter(|slab| slab.are_finite(value));
        let integral = integral.map(|slab| slab.integral(&self.classifier, sampled));
        let alpha =
            integral.map_or_else(|| self.classifier.opacity(value, gradient), |(_, alpha)| alpha);
        if alpha <= 0.0 {
            return Vec4::ZERO;
        }
        let color =
            integral.map_or_else(|| self.classifier.color(value, gradient), |(color, _)| color);
        if self.is_alike_everywhere() {
            let reflected = self.reflected(color, normal(gradient), DVec3::ZERO);
            return self.lit(color, reflected, fade, alpha);
        }
        let [world, way] = ray();
        let section = self.cut.as_ref().map(|cut| cut.at(world));
        let normal = section.map_or(normal(gradient), |s| s.turned(normal(gradient), CUT_DEEP));
        let whole = self.lit(color, self.reflected(color, normal, world), fade, alpha);
        section.map_or(whole, |section| part_of(whole, section, way))
    }

    /// What comes back of all lights.
    pub(super) fn reflected(&self, color: Vec3, normal: Vec3, world: DVec3) -> Vec3 {
        let of = |lamp: &Lamp| lamp.reflected(color, normal, &self.how);
        let plain: Vec3 = self.lamps.plain.iter().map(of).sum();
        let lights = self.lamps.shadowed.iter().zip(self.strengths);
        lights.fold(plain, |sum, ((_, lamp), strength): (&(Entity, Lamp), _)| {
            let beta = strength.as_ref().map_or(1.0, |strength| {
                strength.at(world + lamp.toward.as_dvec3() * strength.bias())
            });
            sum + of(lamp) * beta
        })
    }

    pub(super) fn lit(&self, color: Vec3, reflected: Vec3, fade: f32, alpha: f32) -> Vec4 {
        ((color * self.how.ambient + reflected * fade) * alpha).extend(alpha)
    }
}

/// What a cut leaves of a slab, as a thinner one of the whole.
fn part_of(whole: Vec4, section: Section, way: DVec3) -> Vec4 {
    let left = section.left(way);
    if left >= 1.0 {
        return whole;
    }
    let opacity = f64::from(whole.w);
    let thin = thicken(opacity, left);
    (whole.truncate() * recolor(opacity, thin, left) as f32).extend(thin as f32)
}
