//! A volume as values that are interpolated, asked at points and along stretches of a ray.

use fearless_simd::Level;
use glam::{DAffine3, DVec3};

use super::passage::Sought;
use crate::components::{Classify, Clip, Filter, Material};
use crate::view::composite::thicken;
use crate::volume::classification::{Classifier, SharpContour};
use crate::volume::clipping::Cut;
use crate::volume::field::{Field, Sampled, Spot};
use crate::volume::grid::{Grid, Scalars};
use crate::volume::pyramid::{BLOCK, Pyramid};

/// Halvings of a stretch that holds a crossing.
const HALVINGS: usize = 16;

/// A surface that a stretch crosses.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossed {
    /// The part of the stretch before it, 0..=1.
    pub part: f64,
    pub opacity: f64,
    /// Its unit normal, world, where it is not that of the values.
    pub normal: Option<DVec3>,
}

/// The values of a volume, and what is seen of them.
pub(super) struct Valued {
    /// What is interpolated, and how.
    pub scalars: Scalars,
    pub filter: Filter,
    pub grid: Grid,
    /// Which cells may be seen, if any are ruled out.
    pub pyramid: Option<Pyramid>,
    classifier: Classifier,
    surfaces: Vec<SharpContour>,
    /// Whether anything but surfaces is seen.
    has_gel: bool,
    /// Whether slabs are integrated from one end to the other.
    integrated: bool,
    cut: Option<Cut>,
    to_index: DAffine3,
    level: Level,
}

impl Valued {
    /// Values of opacity unit `unit` on a grid, and how they are classified.
    pub fn new(
        (scalars, filter): (Scalars, Filter),
        (grid, unit): (Grid, f64),
        pyramid: Option<Pyramid>,
        (classify, material, clip): (&Classify, &Material, Option<&Clip>),
    ) -> Self {
        let classifier = Classifier::new(classify, material, unit);
        Self {
            surfaces: classifier.surfaces(),
            has_gel: classifier.has_gel(),
            classifier,
            integrated: false,
            cut: clip.map(|clip| Cut::new(clip, &grid)),
            to_index: grid.world_to_index(),
            level: Level::new(),
            scalars,
            filter,
            grid,
            pyramid,
        }
    }

    /// With slabs integrated, where that is asked for and means something to the classification.
    pub fn integrated(self, asked: bool) -> Self {
        Self { integrated: asked && self.classifier.integrates(), ..self }
    }

    /// Where in a slab it is looked for what that shows; `smooth` says that all values are finite.
    pub fn sought(&self, smooth: bool) -> Sought {
        match (self.surfaces.is_empty(), self.integrated) {
            (true, false) => Sought::AtMiddle,
            (false, false) if smooth => Sought::BetweenEnds,
            _ => Sought::AtEnds,
        }
    }

    /// The opacity of a slab around a world point, per opacity unit; `way` is the ray's way through it.
    pub fn opacity(&self, world: DVec3, way: DVec3) -> f64 {
        let around = self.integrated || !self.surfaces.is_empty();
        if !self.has_gel || !self.may_show(world, around.then_some(way)) {
            return 0.0;
        }
        let Some(sampled) = self.sampled(world) else { return 0.0 };
        let integral = self.integrated.then(|| self.integral(world, way, &sampled)).flatten();
        let whole = integral
            .unwrap_or_else(|| f64::from(self.classifier.opacity(sampled.value, sampled.gradient)));
        let left = self.cut.as_ref().map_or(1.0, |cut| cut.at(world).left(way));
        if left >= 1.0 { whole } else { thicken(whole, left) }
    }

    /// The opacity per opacity unit of a slab through which the scalar goes evenly from its beginning to its middle and on to
    /// its end; `None` where one of them is no number or outside.
    fn integral(&self, middle: DVec3, way: DVec3, sampled: &Sampled) -> Option<f64> {
        let end = |part: f64| Some(self.sampled(middle + way * part)?.value);
        let values = [end(-0.5)?, sampled.value, end(0.5)?];
        if !values.iter().all(|value| value.is_finite()) {
            return None;
        }
        let mut depth = 0.0;
        for half in values.windows(2) {
            let half = [half[0], half[1]];
            self.classifier
                .along(half, sampled.gradient, |piece| depth += piece.part * piece.depth / 2.0);
        }
        Some(-libm::expm1(-depth))
    }

    /// The surfaces without thickness that a stretch around a world point crosses, the nearest first.
    pub fn crossings(&self, middle: DVec3, way: DVec3) -> Vec<Crossed> {
        if self.surfaces.is_empty() || !self.may_show(middle, Some(way)) {
            return Vec::new();
        }
        let at = |part: f64| middle + way * (part - 0.5);
        let ends = [0.0, 0.5, 1.0];
        // What the values are is the same for all surfaces.
        let values = ends.map(|part| self.value(at(part)));
        let mut found = Vec::new();
        for surface in &self.surfaces {
            let sides: [_; 3] = std::array::from_fn(|n| self.side(surface, values[n], at(ends[n])));
            for half in [0, 1] {
                let [mut low, mut high] = [ends[half], ends[half + 1]];
                let first = sides[half];
                if first.is_none_or(|first| sides[half + 1].is_none_or(|s| s == first)) {
                    continue;
                }
                for _ in 0..HALVINGS {
                    let part = f64::midpoint(low, high);
                    let same = self.side(surface, self.value(at(part)), at(part)) == first;
                    *(if same { &mut low } else { &mut high }) = part;
                }
                let part = f64::midpoint(low, high);
                let out = at(if first == Some(true) { high } else { low });
                let left = self.cut.as_ref().is_none_or(|cut| cut.at(at(part)).inside >= 0.0);
                if surface.is_capped || left {
                    let normal = if surface.is_capped { self.face(out) } else { None };
                    found.push(Crossed { part, opacity: f64::from(surface.opacity), normal });
                }
            }
        }
        found.sort_by(|a, b| a.part.total_cmp(&b.part));
        found
    }

    /// Whether a world point of some value is above a surface's; `None` where there is none. Of a surface that is closed nothing is
    /// above outside of the grid and where the volume is cut away.
    fn side(&self, surface: &SharpContour, value: Option<f32>, world: DVec3) -> Option<bool> {
        if !surface.is_capped {
            return value.map(|value| value >= surface.value);
        }
        let left = || self.cut.as_ref().is_none_or(|cut| cut.at(world).inside >= 0.0);
        Some(value.is_some_and(|value| value >= surface.value) && left())
    }

    /// The normal of the flat face that a point just outside of a closed surface lies before; `None` before the surface itself.
    fn face(&self, out: DVec3) -> Option<DVec3> {
        let index = self.to_index.transform_point3(out);
        let last = DVec3::from(self.grid.size.map(|n| n as f64 - 1.0));
        let beyond = index - index.clamp(DVec3::ZERO, last);
        if beyond != DVec3::ZERO {
            return Some((self.to_index.matrix3.transpose() * beyond).normalize_or_zero());
        }
        let section = self.cut.as_ref().map(|cut| cut.at(out));
        section.filter(|section| section.inside < 0.0).map(|section| section.normal)
    }

    /// Where values fall, world: minus their gradient.
    pub fn slope(&self, world: DVec3) -> DVec3 {
        let gradient = self.sampled(world).map(|sampled| sampled.gradient).unwrap_or_default();
        -DVec3::from(gradient.map(f64::from))
    }

    /// The value at a world point; `None` outside and where it is no number.
    fn value(&self, world: DVec3) -> Option<f32> {
        let mut made = [0.0];
        self.field().values(self.level, &[self.spot(world)?], &mut made);
        Some(made[0]).filter(|value| !value.is_nan())
    }

    fn sampled(&self, world: DVec3) -> Option<Sampled> {
        let mut made = [Sampled::default()];
        self.field().sample(self.level, &[self.spot(world)?], &mut made);
        Some(made[0])
    }

    fn field(&self) -> Field<'_> {
        Field::new(&self.scalars, &self.grid, self.filter)
    }

    /// Where in the grid a world point is; `None` outside.
    fn spot(&self, world: DVec3) -> Option<Spot> {
        let index = self.to_index.transform_point3(world).to_array();
        let last = self.grid.size.map(|n| n as f64 - 1.0);
        if (0..3).any(|axis| !(0.0..=last[axis]).contains(&index[axis])) {
            return None;
        }
        let cell = index.map(|n| n as usize);
        let part = std::array::from_fn(|axis| (index[axis] - cell[axis] as f64) as f32);
        Some(Spot { cell, part })
    }

    /// Whether something may be seen at a world point, or within half a `way` of it.
    fn may_show(&self, world: DVec3, way: Option<DVec3>) -> bool {
        let Some(pyramid) = &self.pyramid else { return true };
        let cell = self.to_index.transform_point3(world).to_array().map(|n| n.floor() as i64);
        let Some(way) = way else {
            return pyramid.slices().shows(cell.map(|n| n.max(0) as usize));
        };
        // Within a block's side of a cell are that block and those around it.
        let reach = (self.to_index.matrix3 * way).abs().max_element() / 2.0;
        reach >= BLOCK as f64 || pyramid.slices().distance(cell) <= 1
    }
}
