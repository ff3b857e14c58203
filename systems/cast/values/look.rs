//! What a sample of values looks like: classified, shaded, shadowed and cut where it is.

use fearless_simd::Level;
use glam::{DVec3, Vec3, Vec4};
use hecs::Entity;

use super::super::crossing::spots_of;
use super::super::integrated::Ends;
use super::super::lanes::{LANES, each};
use super::{SampledRays, Values};
use crate::light::shading::Lamp;
use crate::light::side_by_side::{self, Lighting, Vectors};
use crate::light::strength::LightStrength;
use crate::view::composite::{recolor, thicken};
use crate::volume::clipping::{Cut, Section};
use crate::volume::field::{FOUR, Sampled, SampledFour, Spot};
use crate::volume::gradients::normal;

/// So many samples or fewer are looked at in half of the time.
const HALF: usize = LANES / 2;

/// Voxels under a cut that are shaded by its normal alone: those of the slab that it is in.
const CUT_DEEP: f64 = 0.5;

impl Values<'_> {
    /// Whether nothing of what a sample shows is told by its place.
    fn is_alike_everywhere(&self) -> bool {
        self.cut.is_none() && !self.is_shadowed()
    }

    /// Whether any light is weaker somewhere than elsewhere.
    fn is_shadowed(&self) -> bool {
        self.strengths.iter().any(Option::is_some)
    }

    /// Samples the field for some rays, in their order, and finds what they see of it where slabs are not integrated.
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    pub(super) fn see(
        &self,
        level: Level,
        rays: &SampledRays<'_>,
        sampled: &mut [SampledFour; LANES / FOUR],
        seen: &mut [Vec4; LANES],
    ) {
        let mut room = [Spot::default(); LANES];
        let mut rays = *rays;
        let found = spots_of(rays.tile, (rays.k, rays.lanes), &mut room).len();
        let found = if self.leaves_out() {
            self.leave_out(level, (&mut rays, &mut room), found, seen)
        } else {
            found
        };
        let spots = &room[..found];
        if !self.has_gel {
            let mut values = [0.0; LANES];
            self.field.values(level, spots, &mut values);
            for (sampled, values) in sampled.iter_mut().zip(values.chunks(FOUR)) {
                sampled.values.copy_from_slice(values);
            }
            each(rays.lanes).for_each(|lane| seen[lane] = Vec4::ZERO);
            return;
        }
        self.field.sample_fours(level, spots, sampled);
        if self.integrated {
            return;
        }
        if spots.len() <= HALF {
            self.look_at_all::<HALF>(sampled, (&rays, spots), seen);
        } else {
            self.look_at_all::<LANES>(sampled, (&rays, spots), seen);
        }
    }

    /// Whether values are found before gradients: where many may show nothing, and are made of fewer voxels by far.
    fn leaves_out(&self) -> bool {
        let has_ends = self.classifier.range().iter().any(|end| end.is_finite());
        self.field.is_linear() && has_ends && !self.integrated
    }

    /// Leaves out the rays whose samples show nothing, whatever the gradient; how many there are still.
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn leave_out(
        &self,
        level: Level,
        (rays, spots): (&mut SampledRays<'_>, &mut [Spot; LANES]),
        found: usize,
        seen: &mut [Vec4; LANES],
    ) -> usize {
        let mut values = [0.0; LANES];
        self.field.values(level, &spots[..found], &mut values);
        let mut left = 0;
        for (at, lane) in each(rays.lanes).enumerate() {
            if self.classifier.is_in_range(values[at]) {
                spots[left] = spots[at];
                left += 1;
            } else {
                rays.lanes &= !(1 << lane);
                seen[lane] = Vec4::ZERO;
            }
        }
        left
    }

    /// [`look`](Self::look) for samples of rays, in their order: side by side, to the last bit the same. No slab is integrated.
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn look_at_all<const N: usize>(
        &self,
        sampled: &[SampledFour],
        (rays, spots): (&SampledRays<'_>, &[Spot]),
        seen: &mut [Vec4; LANES],
    ) {
        let mut values = [0.0; N];
        let mut gradients = [[0.0; N]; 3];
        for (at, four) in (0..N).step_by(FOUR).zip(sampled) {
            values[at..at + FOUR].copy_from_slice(&four.values);
            for (own, four) in gradients.iter_mut().zip(&four.gradients) {
                own[at..at + FOUR].copy_from_slice(four);
            }
        }
        let alphas = self.classifier.opacities(&values, &gradients);
        let alphas_of_rays = &alphas[..spots.len()];
        if !alphas_of_rays.iter().any(|alpha| *alpha > 0.0) {
            each(rays.lanes).for_each(|lane| seen[lane] = Vec4::ZERO);
            return;
        }
        let mut colors: Vectors<N> =
            side_by_side::all(self.classifier.only_color().unwrap_or_default());
        if self.classifier.only_color().is_none() {
            for at in (0..spots.len()).filter(|&at| alphas[at] > 0.0) {
                let gradient = side_by_side::one(&gradients, at).to_array();
                side_by_side::set(&mut colors, at, self.classifier.color(values[at], gradient));
            }
        }
        let mut normals = side_by_side::normals(&gradients);
        let sections = self.near_cut(spots).map(|cut| self.sections(cut, rays, &alphas));
        if let Some(sections) = &sections {
            for (at, section) in sections.iter().enumerate() {
                let turned = section.turned(side_by_side::one(&normals, at), CUT_DEEP);
                side_by_side::set(&mut normals, at, turned);
            }
        }
        let lighting = Lighting { ambient: 0.0, lamps: &self.all_lamps, how: self.how };
        let reflected = if self.is_shadowed() {
            self.sent_through(&lighting, (&colors, &normals), rays, &alphas)
        } else {
            lighting.sent(&colors, &normals)
        };
        for (at, lane) in each(rays.lanes).enumerate() {
            let reflected = side_by_side::one(&reflected, at);
            let color = side_by_side::one(&colors, at);
            let lit = self.lit(color, reflected, rays.fade, alphas[at]);
            seen[lane] = if alphas[at] > 0.0 { lit } else { Vec4::ZERO };
        }
        if let Some(sections) = &sections {
            for (at, lane) in each(rays.lanes).enumerate() {
                let [_, way] = self.world(rays.tile, lane, rays.k);
                seen[lane] = part_of(seen[lane], sections[at], way);
            }
        }
    }

    /// The cut, if it is near enough to some of the samples to change what they show.
    #[inline]
    fn near_cut(&self, spots: &[Spot]) -> Option<&Cut> {
        let cut = self.cut.as_ref()?;
        let (mut low, mut high) = ([usize::MAX; 3], [0; 3]);
        for Spot { cell, .. } in spots {
            for axis in 0..3 {
                low[axis] = low[axis].min(cell[axis]);
                high[axis] = high[axis].max(cell[axis]);
            }
        }
        (!cut.is_whole([low, high.map(|cell| cell + 1)], CUT_DEEP)).then_some(cut)
    }

    /// How the samples that are seen lie to the cut.
    fn sections<const N: usize>(
        &self,
        cut: &Cut,
        rays: &SampledRays<'_>,
        alphas: &[f32; N],
    ) -> [Section; N] {
        let mut sections = [Section::NONE; N];
        for (at, lane) in each(rays.lanes).enumerate().filter(|&(at, _)| alphas[at] > 0.0) {
            sections[at] = cut.at(self.world(rays.tile, lane, rays.k)[0]);
        }
        sections
    }

    /// What comes back of all lights, some of which are weaker at some places.
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn sent_through<const N: usize>(
        &self,
        lighting: &Lighting<'_>,
        colors_and_normals: (&Vectors<N>, &Vectors<N>),
        rays: &SampledRays<'_>,
        alphas: &[f32; N],
    ) -> Vectors<N> {
        let mut sent = [[0.0; N]; 3];
        for (lamp, strength) in self.all_lamps.iter().zip(self.strengths_of_all()) {
            let mut through = [1.0; N];
            if let Some(strength) = strength {
                for (at, lane) in each(rays.lanes).enumerate().filter(|&(at, _)| alphas[at] > 0.0) {
                    let [world, _] = self.world(rays.tile, lane, rays.k);
                    through[at] = strength.at(world + lamp.toward.as_dvec3() * strength.bias());
                }
            }
            lighting.add(lamp, colors_and_normals, &through, &mut sent);
        }
        sent
    }

    /// How strong each of all lamps still is; `None`: as strong everywhere.
    fn strengths_of_all(&self) -> impl Iterator<Item = Option<&LightStrength>> {
        let plain = self.lamps.plain.iter().map(|_| None);
        plain.chain(self.strengths.iter().map(Option::as_ref))
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
