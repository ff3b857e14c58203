//! Projections: of a volume a ray shows its greatest, its least or its mean value, colored by the volume's transfer function.
//!
//! What a ray shows is met like a polygon: at the depth of the value, so that polygons before it cover it and those behind are
//! covered. A brick whose scalars cannot surpass what was found is leapt over, to the very samples that walking would meet.

use super::gathering::{Hit, Shaded};
use super::lanes::Packet;
use super::sought::Sought;
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
            each.extend(walk.map(|walk| Projected { stated, classifier, walk, skips }));
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

    /// Puts what a ray shows among its own `hits`, those from number `first` on. Values behind the first of them that
    /// `is_opaque` do not count.
    pub fn meet(
        &self,
        (packet, entered, lane): (&Packet, &[Tile], usize),
        (hits, first): (&mut Vec<Hit>, usize),
        is_opaque: impl Fn(&Hit) -> bool,
        counts: &mut Counts,
    ) {
        let end = hits[first..].iter().find(|hit| is_opaque(hit)).map(|hit| hit.depth);
        // The first sample at the opaque polygon or behind it; casts saturate.
        let end = end.map_or(i64::MAX, |depth| (depth / self.distance - 0.5).ceil() as i64);
        for (number, (projected, tile)) in self.each.iter().zip(entered).enumerate() {
            let window = Camera::window(packet.position(lane));
            let place = |k: i64| self.camera.ray(window).at((k as f64 + 0.5) * self.distance);
            let Some((value, k)) = projected.seek((tile, lane), end, place, counts) else {
                continue;
            };
            let depth = (k as f64 + 0.5) * self.distance;
            let at = first + hits[first..].partition_point(|hit| hit.depth <= depth);
            hits.insert(at, Hit { depth, face: u32::MAX - number as u32, value });
        }
    }

    /// How a hit looks that is one of a projection.
    pub fn shade(&self, hit: &Hit) -> Option<Shaded> {
        let projected = self.each.get((u32::MAX - hit.face) as usize)?;
        let opacity = f64::from(projected.classifier.opacity(hit.value, [0.0; 3]));
        let color = projected.classifier.color(hit.value, [0.0; 3]).as_dvec3() * opacity;
        Some(Shaded { color, opacity, plain_color: DVec3::ZERO, plain_opacity: opacity })
    }
}

impl Projected<'_> {
    /// The value that a ray of a tile shows, of its samples before number `end`, and the number of that sample; `None` where it
    /// shows nothing. `place` is the world point of a sample.
    fn seek(
        &self,
        (tile, lane): (&Tile, usize),
        end: i64,
        place: impl Fn(i64) -> DVec3,
        counts: &mut Counts,
    ) -> Option<(f32, i64)> {
        let (first, end) = (tile.some[0], tile.some[1].min(end));
        let first = (first..end).find(|&k| self.walk.holds(tile, lane, k))?;
        // A ray leaves a grid once.
        let holds = |k: i64| k < end && self.walk.holds(tile, lane, k);
        let StatedProjection { shows, grid, scalars, ranges, clip, .. } = self.stated;
        let is_kept = |k: i64| clip.as_ref().is_none_or(|clip| clip.distance(place(k)) >= 0.0);
        let ray = Sought { tile, lane, size: grid.size, first };
        with_scalars!(scalars, values => match shows {
            Projection::Maximum => ray.best(
                (values, holds, is_kept),
                |a, b| a > b,
                |brick| if self.skips { ranges.around(brick).high } else { f32::INFINITY },
                counts,
            ),
            Projection::Minimum => ray.best(
                (values, holds, is_kept),
                |a, b| a < b,
                |brick| if self.skips { ranges.around(brick).low } else { f32::NEG_INFINITY },
                counts,
            ),
            Projection::Mean => ray.mean((values, holds, is_kept), counts),
        })
    }
}
