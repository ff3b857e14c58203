//! Projections: of a volume a ray shows its greatest, its least or its mean value, colored by the volume's transfer function;
//! or its greatest as one among emitters.
//!
//! What a ray shows is met like a polygon: at the depth of the value, so that polygons before it cover it and those behind are
//! covered. A brick whose scalars cannot surpass what was found (and emit nothing, where they are to) is leapt over, to the very
//! samples that walking would meet.

use super::emitters::Emitters;
use super::gathering::{Hit, Shaded};
use super::lanes::Packet;
use super::sought::{Found, Sought};
use crate::components::{Classify, Clip, Material, Projection};
use crate::view::camera::Camera;
use crate::view::samples::Counts;
use crate::view::walk::{Tile, Walk};
use crate::volume::classification::Classifier;
use crate::volume::grid::{Grid, Scalars};
use crate::volume::ranges::Ranges;
use crate::with_scalars;
use glam::DVec3;

/// A volume that is projected, as it is stated.
#[derive(PartialEq)]
pub(crate) struct StatedProjection {
    /// Which value of a ray is shown.
    pub shows: Projection,
    /// Where the voxels are.
    pub grid: Grid,
    /// What they hold.
    pub scalars: Scalars,
    /// Between which scalars each brick lies.
    pub ranges: Ranges,
    /// How values are colored.
    pub classify: Classify,
    /// The color of what has none of its own.
    pub material: Material,
    /// What is cut away: its values do not count.
    pub clip: Option<Clip>,
}

/// The projected volumes of a scene on one view.
pub struct Projections<'a> {
    each: Vec<Projected<'a>>,
    camera: &'a Camera,
    /// Δ, world units.
    distance: f64,
}

struct Projected<'a> {
    stated: &'a StatedProjection,
    classifier: Classifier,
    walk: Walk,
    /// How its values emit, where they do.
    emitters: Option<Emitters>,
    /// Whether bricks are leapt over.
    skips: bool,
}

impl<'a> Projections<'a> {
    /// The projections of `stated` volumes by samples `distance` (world units) apart; the error is about that distance.
    pub fn new(
        stated: &'a [StatedProjection],
        camera: &'a Camera,
        distance: f64,
        skips: bool,
    ) -> Result<Self, String> {
        let mut each = Vec::new();
        for stated in stated {
            let classifier = Classifier::new(&stated.classify, &stated.material, 1.0);
            let skips = skips && stated.shows != Projection::Mean;
            let walk = Walk::new(&stated.grid, camera, distance)?;
            let emitters = (stated.shows == Projection::Sabella)
                .then(|| Emitters::new(&stated.classify, &stated.grid, camera));
            each.extend(walk.map(|walk| Projected { stated, classifier, walk, emitters, skips }));
        }
        Ok(Self { each, camera, distance })
    }

    /// Whether no volume is projected.
    pub fn is_empty(&self) -> bool {
        self.each.is_empty()
    }

    /// Lets a packet enter the volumes.
    pub(crate) fn enter(&self, packet: &Packet, entered: &mut Vec<Tile>) {
        entered.resize_with(self.each.len(), Tile::default);
        for (projected, tile) in self.each.iter().zip(entered) {
            projected.walk.enter(&packet.places, tile);
            projected.walk.scatter(&packet.places, tile);
        }
    }

    /// Puts what a ray shows among its own `hits`, those from number `first` on, and how it looks among what is `shown`. Values
    /// behind the first of them that `is_opaque` do not count.
    pub fn meet(
        &self,
        (packet, entered, lane): (&Packet, &[Tile], usize),
        (hits, first, shown): (&mut Vec<Hit>, usize, &mut Vec<Shaded>),
        is_opaque: impl Fn(&Hit) -> bool,
        counts: &mut Counts,
    ) {
        let end = hits[first..].iter().find(|hit| is_opaque(hit)).map(|hit| hit.depth);
        let end = end.map_or(f64::INFINITY, |depth| depth / self.distance - 0.5);
        for (projected, tile) in self.each.iter().zip(entered) {
            let ray = self.camera.ray(Camera::window(packet.position(lane)));
            let place = |k: f64| ray.at((k + 0.5) * self.distance);
            let Some(found) = projected.seek((tile, lane), end, place, counts) else {
                continue;
            };
            let depth = (found.sample + 0.5) * self.distance;
            let way = found.sum * self.distance * ray.along.length();
            let at = first + hits[first..].partition_point(|hit| hit.depth <= depth);
            hits.insert(at, Hit { depth, face: u32::MAX, shown: shown.len() as u32 });
            shown.push(projected.shaded(found.value, depth, way));
        }
    }
}

impl Projected<'_> {
    /// How a value looks at a depth, with that much density on the ray's way (both world units).
    fn shaded(&self, value: f32, depth: f64, way: f64) -> Shaded {
        let opacity = f64::from(self.classifier.opacity(value, [0.0; 3]));
        let color = self.classifier.color(value, [0.0; 3]).as_dvec3();
        let shown = |emitters: &Emitters| emitters.shown(color, depth, way);
        let color = self.emitters.as_ref().map_or(color, shown) * opacity;
        Shaded { color, opacity, plain_color: DVec3::ZERO, plain_opacity: opacity }
    }

    /// What a ray of a tile shows, of its samples before number `end`; `None` where it shows nothing. `place` is the world point
    /// of a sample, or between two.
    ///
    /// A ray whose way through the volume is so short that no sample lies on it shows what is in the middle of that way: where a
    /// volume ends in the picture is told by its box and not by the places of samples.
    fn seek(
        &self,
        (tile, lane): (&Tile, usize),
        end: f64,
        place: impl Fn(f64) -> DVec3,
        counts: &mut Counts,
    ) -> Option<Found> {
        if tile.is_empty() {
            return None;
        }
        let opaque = end;
        // The first sample at the opaque polygon or behind it; casts saturate.
        let (first, end) = (tile.some[0], tile.some[1].min(end.ceil() as i64));
        let Some(first) = (first..end).find(|&k| self.walk.holds(tile, lane, k)) else {
            return self.between((tile, lane), opaque, place, counts);
        };
        // A ray leaves a grid once.
        let holds = |k: i64| k < end && self.walk.holds(tile, lane, k);
        let StatedProjection { shows, grid, scalars, ranges, clip, .. } = self.stated;
        let is_kept =
            |k: i64| clip.as_ref().is_none_or(|clip| clip.distance(place(k as f64)) >= 0.0);
        let ray = Sought { tile, lane, size: grid.size, first };
        let emitters = self.emitters.as_ref();
        let density = |value| self.density(value);
        // Whether what is nowhere above that value emits nothing.
        let is_silent = |high| emitters.is_none_or(|emitters| high <= emitters.empty_to());
        with_scalars!(scalars, values => match shows {
            Projection::Maximum | Projection::Sabella => ray.best(
                (values, holds, is_kept),
                (|a, b| a > b, density),
                |brick| self.skips.then(|| ranges.around(brick).high).filter(|high| is_silent(*high)),
                counts,
            ),
            Projection::Minimum => ray.best(
                (values, holds, is_kept),
                (|a, b| a < b, |_| 0.0),
                |brick| self.skips.then(|| ranges.around(brick).low),
                counts,
            ),
            Projection::Mean => ray.mean((values, holds, is_kept), counts),
        })
    }

    /// What is in the middle of a ray's way through the volume before `end`, where no sample lies on it.
    fn between(
        &self,
        (tile, lane): (&Tile, usize),
        end: f64,
        place: impl Fn(f64) -> DVec3,
        counts: &mut Counts,
    ) -> Option<Found> {
        let [low, high] = self.walk.interval(tile, lane);
        let high = high.min(end);
        let middle = f64::midpoint(low, high);
        let StatedProjection { grid, scalars, clip, .. } = self.stated;
        let is_cut = || clip.as_ref().is_some_and(|clip| clip.distance(place(middle)) < 0.0);
        if low >= high || is_cut() {
            return None;
        }
        let ray = Sought { tile, lane, size: grid.size, first: middle as i64 };
        let density = |value| self.density(value);
        with_scalars!(scalars, values => ray.between(values, (middle, high - low), density, counts))
    }

    /// How much a value emits, if any does.
    fn density(&self, value: f32) -> f64 {
        self.emitters.as_ref().map_or(0.0, |emitters| emitters.density(value))
    }
}
