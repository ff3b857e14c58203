//! Values as rays meet them: interpolated, and classified, cut, shaded and shadowed at the sample (§8: "better reconstruction").

use fearless_simd::{Level, Simd};
use glam::{DAffine3, DVec3, Vec3, Vec4};
use hecs::Entity;

use super::crossing::{self, CrossedSurface, Crossings, Sheet, Stretch, index, spot};
use super::inputs::StatedValues;
use super::integrated::{self, Ends};
use super::lanes::{LANES, Lanes, each};
use super::medium::Source;
use super::window::{Cells, Window};
use crate::light::shading::{Lamp, Lamps, Reflectance};
use crate::light::side_by_side::{self, Lighting};
use crate::light::strength::LightStrength;
use crate::view::composite::{recolor, thicken};
use crate::view::walk::{FRACTION_BITS, Tile};
use crate::volume::classification::{Classifier, SharpContour};
use crate::volume::clipping::{Cut, Section};
use crate::volume::field::{Field, Sampled, Spot};
use crate::volume::gradients::normal;
use crate::volume::grid::Grid;
use crate::volume::pyramid::PyramidSlices;

/// Voxels under a cut that are shaded by its normal alone: those of the slab that it is in.
const CUT_DEEP: f64 = 0.5;

/// The scalars of one volume, and how they look.
pub struct Values<'a> {
    field: Field<'a>,
    /// Which cells may be seen; `None`: all.
    pyramid: Option<PyramidSlices<'a>>,
    /// Voxels on each axis.
    size: [usize; 3],
    index_to_world: DAffine3,
    classifier: Classifier,
    /// Contours without thickness.
    surfaces: Vec<SharpContour>,
    /// Whether slabs are integrated, from one end to the other.
    integrated: bool,
    cut: Option<Cut>,
    lamps: &'a Lamps,
    /// All of them, in the order in which they are summed.
    all_lamps: Vec<&'a Lamp>,
    how: Reflectance,
    strengths: &'a [Option<LightStrength>],
}

impl<'a> Values<'a> {
    /// What is stated of a volume on `grid` with opacity unit `unit`.
    pub fn new(
        stated: &'a StatedValues,
        (grid, unit): (&Grid, f64),
        pyramid: Option<PyramidSlices<'a>>,
    ) -> Self {
        let StatedValues { scalars, filter, classify, material, clip, lamps, strengths, .. } =
            stated;
        let classifier = Classifier::new(classify, material, unit);
        Self {
            surfaces: classifier.surfaces(),
            integrated: stated.integrate && classifier.integrates(),
            classifier,
            field: Field::new(scalars, grid, *filter),
            pyramid,
            size: grid.size,
            index_to_world: grid.index_to_world,
            cut: clip.as_ref().map(|clip| Cut::new(clip, grid)),
            lamps,
            all_lamps: lamps.plain.iter().chain(lamps.shadowed.iter().map(|(_, l)| l)).collect(),
            how: Reflectance::from(material),
            strengths,
        }
    }

    /// The world point and the way of a ray from sample to sample.
    fn world(&self, tile: &Tile, lane: usize, k: i64) -> [DVec3; 2] {
        let place = index(tile.at_sample(lane, k));
        let step = index(std::array::from_fn(|axis| tile.step[axis][lane]));
        [self.index_to_world.transform_point3(place), self.index_to_world.matrix3 * step]
    }

    /// Whether what a sample shows is found around it.
    fn looks_around(&self) -> bool {
        self.integrated || !self.surfaces.is_empty()
    }

    /// Whether what a sample shows is told by its value and gradient alone, and by nothing about its place or slab.
    fn is_plain(&self) -> bool {
        !self.integrated && self.cut.is_none() && self.strengths.iter().all(Option::is_none)
    }

    /// [`look`](Self::look) for samples of the rays `met`, in their order, that are [plain](Self::is_plain): side by side, to the
    /// last bit the same.
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn look_at_all(
        &self,
        sampled: &[Sampled; LANES],
        (met, fade): (Lanes, f32),
        seen: &mut [Vec4; LANES],
    ) {
        let mut values = [0.0; LANES];
        let mut gradients = [[0.0; LANES]; 3];
        for (at, sampled) in sampled.iter().enumerate() {
            values[at] = sampled.value;
            side_by_side::set(&mut gradients, at, Vec3::from(sampled.gradient));
        }
        let alphas = self.classifier.opacities(&values, &gradients);
        let colors = self.classifier.only_color().map(side_by_side::all).unwrap_or_else(|| {
            let mut colors = [[0.0; LANES]; 3];
            for at in (0..LANES).filter(|&at| alphas[at] > 0.0) {
                let gradient = side_by_side::one(&gradients, at).to_array();
                side_by_side::set(&mut colors, at, self.classifier.color(values[at], gradient));
            }
            colors
        });
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
    fn look(
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
        if self.cut.is_none() && self.strengths.iter().all(Option::is_none) {
            let reflected = self.reflected(color, normal(gradient), DVec3::ZERO);
            return self.lit(color, reflected, fade, alpha);
        }
        let [world, way] = ray();
        let section = self.cut.as_ref().map(|cut| cut.at(world));
        let normal = section.map_or(normal(gradient), |s| s.turned(normal(gradient), CUT_DEEP));
        let whole = self.lit(color, self.reflected(color, normal, world), fade, alpha);
        section.map_or(whole, |section| part_of(whole, section, way))
    }

    /// Which rays may meet something as far from a sample as is looked.
    fn near(&self, tile: &Tile, k: i64, lanes: Lanes) -> Lanes {
        let Some(pyramid) = self.pyramid else { return lanes };
        let near = |reaching: usize, lane: usize| {
            let cell = tile.at_sample(lane, k).map(|place| place >> FRACTION_BITS);
            pyramid.is_near(reaching, cell) == Some(true)
        };
        let set = |set: Lanes, lane: usize| set | 1 << lane;
        if !self.looks_around() {
            return lanes;
        }
        match PyramidSlices::reaching(crossing::reach(tile)) {
            Some(reaching) => each(lanes)
                .filter(|&lane| near(reaching, lane))
                .filter(|&lane| self.passes(pyramid, &Stretch::of(tile, lane, k)))
                .fold(0, set),
            None => lanes,
        }
    }

    /// Whether a stretch passes cells that may be seen; those that it cannot leave are asked.
    fn passes(&self, pyramid: PyramidSlices<'_>, stretch: &Stretch) -> bool {
        let cell = |part: f64, axis: usize| {
            (stretch.at(part)[axis] >> FRACTION_BITS).clamp(0, self.size[axis] as i64 - 1) as usize
        };
        let [x, y, z] = std::array::from_fn(|axis| {
            let ends = [cell(0.0, axis), cell(1.0, axis)];
            ends[0].min(ends[1])..=ends[0].max(ends[1])
        });
        z.into_iter().any(|z| y.clone().any(|y| x.clone().any(|x| pyramid.shows([x, y, z]))))
    }

    /// Puts the surfaces that a ray crosses within a slab into what it sees there, and hands them out; `middle` is the value at
    /// its sample.
    fn cross(
        &self,
        level: Level,
        fade: f32,
        (stretch, middle): (&Stretch, f32),
        (seen, ratio, met): (&mut Vec4, f64, &mut Vec<CrossedSurface>),
    ) -> Sheet {
        let mut ends = [Sampled::default(); 2];
        let spots = [0.0, 1.0].map(|part| spot(stretch.at(part)));
        self.field.sample(level, &spots, &mut ends);
        let values = [(0.0, ends[0].value), (0.5, middle), (1.0, ends[1].value)];
        met.clear();
        for surface in &self.surfaces {
            for half in values.windows(2) {
                let field = (&self.field, level);
                let Some((part, sampled)) =
                    crossing::crossing(field, stretch, surface.value, [half[0], half[1]])
                else {
                    continue;
                };
                let place = index(stretch.at(part));
                let world = self.index_to_world.transform_point3(place);
                if self.cut.as_ref().is_none_or(|cut| cut.at(world).inside >= 0.0) {
                    let normal = normal(sampled.gradient);
                    let reflected = self.reflected(surface.color, normal, world);
                    let color = surface.color * self.how.ambient + reflected * fade;
                    met.push(CrossedSurface { part, color, opacity: surface.opacity, normal });
                }
            }
        }
        if met.is_empty() {
            return Sheet::default();
        }
        let (slab, sheet) = crossing::slab(*seen, met, ratio);
        *seen = slab;
        sheet
    }

    /// What comes back of all lights.
    fn reflected(&self, color: Vec3, normal: Vec3, world: DVec3) -> Vec3 {
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

    fn lit(&self, color: Vec3, reflected: Vec3, fade: f32, alpha: f32) -> Vec4 {
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

impl Source for Values<'_> {
    fn has_surfaces(&self) -> bool {
        !self.surfaces.is_empty()
    }

    fn reach(&self, tile: &Tile) -> f64 {
        if self.looks_around() { crossing::reach(tile) } else { 0.0 }
    }

    fn cells(&self) -> Option<Cells<'_>> {
        let pyramid = self.pyramid.filter(|_| !self.looks_around())?;
        let words = Some(pyramid.all_words());
        Some(Cells { counts: pyramid.bricks(), table: pyramid.table(), words })
    }

    fn meet<I: Simd>(
        &self,
        simd: I,
        fade: Option<f32>,
        (tile, _): (&Tile, &Window),
        (k, lanes): (i64, Lanes),
        (seen, ratios, crossings): (&mut [Vec4; LANES], &[f64; LANES], &mut Crossings),
    ) -> Lanes {
        let (level, fade) = (simd.level(), fade.unwrap_or(1.0));
        let met = self.near(tile, k, lanes);
        let mut sampled = [Sampled::default(); LANES];
        let mut spots = [Spot::default(); LANES];
        let middles = each(met).map(|lane| spot(tile.at_sample(lane, k)));
        let found = spots.iter_mut().zip(middles).map(|(made, spot)| *made = spot).count();
        self.field.sample(level, &spots[..found], &mut sampled);
        if self.is_plain() {
            simd.vectorize(|| self.look_at_all(&sampled, (met, fade), seen));
        } else {
            let slabs = if self.integrated {
                integrated::ends((&self.field, level), tile, (k, met), &mut crossings.ends)
            } else {
                [[0.0; 2]; LANES]
            };
            for (lane, sampled) in each(met).zip(&sampled) {
                let slab = Ends { values: slabs[lane], ratio: ratios[lane] };
                let slab = self.integrated.then_some(slab);
                seen[lane] = self.look((sampled, slab), || self.world(tile, lane, k), fade);
            }
        }
        if !self.surfaces.is_empty() {
            for (lane, sampled) in each(met).zip(&sampled) {
                let stretch = Stretch::of(tile, lane, k);
                crossings.bare[lane] = seen[lane];
                let slab = (&mut seen[lane], ratios[lane], &mut crossings.met);
                crossings.sheets[lane] = self.cross(level, fade, (&stretch, sampled.value), slab);
            }
        }
        met
    }
}
