//! Values as rays meet them: interpolated, and classified, cut, shaded and shadowed at the sample (§8: "better reconstruction").

mod look;

use fearless_simd::{Level, Simd};
use glam::{DAffine3, DMat3, DVec3, Vec3, Vec4};

use super::caps;
use super::crossing::{self, CrossedSurface, Crossings, Sheet, Stretch, index, spot};
use super::inputs::StatedValues;
use super::integrated::{self, Ends};
use super::lanes::{LANES, Lanes, each};
use super::medium::Source;
use super::window::{Cells, Window};
use crate::light::shading::{Lamp, Lamps, Reflectance};
use crate::light::strength::LightStrength;
use crate::view::walk::{FRACTION_BITS, Tile};
use crate::volume::classification::{Classifier, SharpContour};
use crate::volume::clipping::Cut;
use crate::volume::field::{FOUR, Field, SampledFour};
use crate::volume::gradients::normal;
use crate::volume::grid::Grid;
use crate::volume::pyramid::PyramidSlices;

/// The scalars of one volume, and how they look.
pub struct Values<'a> {
    field: Field<'a>,
    /// Which cells may be seen; `None`: all.
    pyramid: Option<PyramidSlices<'a>>,
    /// Voxels on each axis.
    size: [usize; 3],
    index_to_world: DAffine3,
    /// From normals in index space to those in the world.
    to_world: DMat3,
    classifier: Classifier,
    /// Contours without thickness.
    surfaces: Vec<SharpContour>,
    /// Whether there is anything else to be seen.
    has_gel: bool,
    /// Whether slabs are integrated, from one end to the other.
    integrated: bool,
    /// Whether what a sample shows is found around it.
    looks_around: bool,
    cut: Option<Cut>,
    lamps: &'a Lamps,
    /// All of them, in the order in which they are summed.
    all_lamps: Vec<Lamp>,
    how: Reflectance,
    strengths: &'a [Option<LightStrength>],
}

/// Rays that are sampled side by side.
#[derive(Clone, Copy)]
struct SampledRays<'a> {
    /// Where they are.
    tile: &'a Tile,
    /// The number of the sample.
    k: i64,
    /// Which of the tile's rays.
    lanes: Lanes,
    /// What is left of what they reflect.
    fade: f32,
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
            has_gel: classifier.has_gel(),
            integrated: stated.integrate && classifier.integrates(),
            looks_around: classifier.looks_around(stated.integrate),
            classifier,
            field: Field::new(scalars, grid, *filter),
            pyramid,
            size: grid.size,
            index_to_world: grid.index_to_world,
            to_world: grid.index_to_world.matrix3.inverse().transpose(),
            cut: clip.as_ref().map(|clip| Cut::new(clip, grid)),
            lamps,
            all_lamps: lamps
                .plain
                .iter()
                .chain(lamps.shadowed.iter().map(|(_, l)| l))
                .copied()
                .collect(),
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

    /// Of rays that may meet something as far from a sample as `reach`, those whose stretch does.
    fn near(&self, tile: &Tile, (k, lanes): (i64, Lanes), reach: f64) -> Lanes {
        let Some(pyramid) = self.pyramid.filter(|_| self.looks_around) else { return lanes };
        if PyramidSlices::reaching(reach).is_none() {
            return lanes;
        }
        let closed = self.is_capped() && !tile.is_inner(k, 1);
        let reached = |lane: usize| {
            if closed {
                caps::reached(tile, (lane, k), self.last())
            } else {
                Stretch::of(tile, lane, k)
            }
        };
        each(lanes)
            .filter(|&lane| self.passes(pyramid, &reached(lane)))
            .fold(0, |set, lane| set | 1 << lane)
    }

    /// Whether a stretch passes cells that may be seen; those that it cannot leave are asked.
    #[inline]
    fn passes(&self, pyramid: PyramidSlices<'_>, stretch: &Stretch) -> bool {
        let ends = stretch.ends();
        let cell = |axis: usize, place: i64| {
            (place >> FRACTION_BITS).clamp(0, self.size[axis] as i64 - 1) as usize
        };
        let sorted = |axis: usize| {
            let [a, b] = ends.map(|end| end[axis]);
            [cell(axis, a.min(b)), cell(axis, a.max(b))]
        };
        pyramid.shows_any([sorted(0), sorted(1), sorted(2)])
    }

    /// Whether some surfaces are closed where the grid ends and where it is cut.
    fn is_capped(&self) -> bool {
        self.surfaces.iter().any(|surface| surface.is_capped)
    }

    /// The grid's last voxel, fixed point.
    fn last(&self) -> [i64; 3] {
        self.size.map(|n| (n as i64 - 1) << FRACTION_BITS)
    }

    /// The flat faces that close surfaces within the slab of sample `k`, whose stretch is known, of those that a ray crosses there.
    fn close(
        &self,
        (level, fade): (Level, f32),
        (tile, stretch): (&Tile, &Stretch),
        (lane, k): (usize, i64),
        met: &mut Vec<CrossedSurface>,
    ) {
        let world = |place: DVec3| self.index_to_world.transform_point3(place);
        let border = if tile.is_inner(k, 1) {
            [None; 2]
        } else {
            caps::at_border(tile, (lane, k), self.last(), &self.to_world)
        };
        let cut = self.cut.as_ref().map(|cut| caps::at_cut(cut, stretch, world));
        for cap in border.into_iter().chain(cut.into_iter().flatten()).flatten() {
            let place = stretch.at(cap.part);
            let at = world(index(place));
            if self.cut.as_ref().is_some_and(|cut| cut.at(at).inside < 0.0) {
                continue;
            }
            let mut value = [0.0];
            self.field.values(level, &[spot(place)], &mut value);
            for surface in self.surfaces.iter().filter(|s| s.is_capped && value[0] >= s.value) {
                met.push(self.crossed(surface, (cap.part, cap.normal, at), fade));
            }
        }
    }

    /// A surface as it looks at a part of a stretch, by its normal and the world point there.
    fn crossed(
        &self,
        surface: &SharpContour,
        (part, normal, world): (f64, Vec3, DVec3),
        fade: f32,
    ) -> CrossedSurface {
        let reflected = self.reflected(surface.color, normal, world);
        let color = surface.color * self.how.ambient + reflected * fade;
        CrossedSurface { part, color, opacity: surface.opacity, normal }
    }

    /// Puts the surfaces that a ray crosses within a slab into what it sees there, and hands them out; the values are those at
    /// its beginning, its sample and its end. Some may be met already.
    fn cross(
        &self,
        level: Level,
        fade: f32,
        (stretch, [front, middle, back]): (&Stretch, [f32; 3]),
        (seen, ratio, met): (&mut Vec4, f64, &mut Vec<CrossedSurface>),
    ) -> Sheet {
        let values = [(0.0, front), (0.5, middle), (1.0, back)];
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
                    let there = (part, normal(sampled.gradient), world);
                    met.push(self.crossed(surface, there, fade));
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
}

impl Source for Values<'_> {
    fn has_surfaces(&self) -> bool {
        !self.surfaces.is_empty()
    }

    fn reach(&self, tile: &Tile) -> f64 {
        // To where the grid ends it may be a whole step.
        let steps = if self.is_capped() { 2.0 } else { 1.0 };
        if self.looks_around { steps * crossing::reach(tile) } else { 0.0 }
    }

    fn cells(&self, reach: f64, inner: bool) -> Option<Cells<'_>> {
        let reach = if inner && self.is_capped() { reach / 2.0 } else { reach };
        let pyramid = self.pyramid?;
        let counts = pyramid.bricks();
        if self.looks_around {
            let reaching = PyramidSlices::reaching(reach)?;
            let (table, words) = pyramid.near(reaching)?;
            return Some(Cells { counts, table, words: Some(words) });
        }
        Some(Cells { counts, table: pyramid.table(), words: Some(pyramid.all_words()) })
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
        let met = self.near(tile, (k, lanes), crossings.reach);
        let mut sampled = [SampledFour::default(); LANES / FOUR];
        let rays = SampledRays { tile, k, lanes: met, fade };
        let mut slabs = [[0.0; 2]; LANES];
        if self.looks_around {
            slabs = integrated::ends((&self.field, level), tile, (k, met), &mut crossings.ends);
        }
        simd.vectorize(
            #[inline(always)]
            || self.see(level, &rays, &mut sampled, seen),
        );
        let one = |at: usize| sampled[at / FOUR].one(at % FOUR);
        if self.integrated {
            for (at, lane) in each(met).enumerate() {
                let slab = Ends { values: slabs[lane], ratio: ratios[lane] };
                seen[lane] = self.look((&one(at), Some(slab)), || self.world(tile, lane, k), fade);
            }
        }
        if !self.surfaces.is_empty() {
            let capped = self.is_capped();
            for (at, lane) in each(met).enumerate() {
                let stretch = Stretch::of(tile, lane, k);
                crossings.bare[lane] = seen[lane];
                crossings.met.clear();
                if capped {
                    let at = (tile, &stretch);
                    self.close((level, fade), at, (lane, k), &mut crossings.met);
                }
                let slab = (&mut seen[lane], ratios[lane], &mut crossings.met);
                let values = [slabs[lane][0], one(at).value, slabs[lane][1]];
                crossings.sheets[lane] = self.cross(level, fade, (&stretch, values), slab);
            }
        }
        met
    }
}
