//! A ray through gel and polygons: slabs, split into slivers where polygons cross them (paper §2, equations 2a and 2b).

use glam::DVec3;

use super::volume::{Cursor, Volume};
use crate::view::composite::{Gathered, recolor, thicken};
use crate::view::samples::Counts;
use crate::volume::gel::Texel;

/// A polygon that a ray meets, shaded.
#[derive(Debug, Clone, Copy)]
pub struct Shaded {
    /// Associated colour: textured, shadowed, cued.
    pub color: DVec3,
    /// α_P, textured.
    pub opacity: f64,
    /// The associated colour that C_A and C_G see: neither textured nor shadowed.
    pub plain_color: DVec3,
    /// The opacity that C_A and C_G see.
    pub plain_opacity: f64,
}

/// A polygon on a ray: where, and which.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Depth along the ray, world units.
    pub depth: f64,
    /// Its number among the faces seen, in the order of the scene.
    pub face: u32,
}

/// The three colours of a ray (paper §2).
pub struct Colors {
    /// C: volume and polygons.
    pub full: Gathered,
    /// C_A: polygons attenuated by the volume; what they cover is kept beside, as associated RGBA.
    pub attenuated: [f32; 4],
}

/// The state of C and C_A on their way through a slab.
struct Pair<'c> {
    full: Gathered,
    attenuated: Gathered,
    covered: f64,
    stop: f64,
    counts: &'c mut Counts,
}

impl<'c> Pair<'c> {
    fn new(stop: f64, counts: &'c mut Counts) -> Self {
        let (full, attenuated) = (Gathered::NOTHING, Gathered::NOTHING);
        Self { full, attenuated, covered: 0.0, stop, counts }
    }

    fn colors(&self) -> Colors {
        let [r, g, b] = self.attenuated.color.to_array();
        Colors { full: self.full, attenuated: [r as f32, g as f32, b as f32, self.covered as f32] }
    }

    fn open(&self) -> bool {
        self.full.through > self.stop || self.attenuated.through > self.stop
    }

    fn gel(&mut self, color: DVec3, opacity: f64) {
        if self.full.through > self.stop {
            self.full.under(color, opacity);
        }
        self.attenuated.under(DVec3::ZERO, opacity);
    }

    fn polygon(&mut self, met: &Shaded) {
        if self.full.through > self.stop {
            self.counts.polygon_hits += 1;
            self.full.under(met.color, met.opacity);
        }
        self.covered += self.attenuated.through * met.plain_opacity;
        self.attenuated.under(met.plain_color, met.plain_opacity);
    }
}

impl<T: Texel> Volume<'_, T> {
    /// A ray that meets polygons at `hits`, in the order of their depths: C and C_A. `shade` shades a hit, and is
    /// called for those alone that the ray reaches.
    pub fn march_through(
        &self,
        cursor: &mut Cursor,
        hits: &[Hit],
        shade: impl Fn(&Hit) -> Shaded,
        stop: f64,
        counts: &mut Counts,
    ) -> Colors {
        let mut pair = Pair::new(stop, counts);
        let mut left = hits;
        while let Some(hit) = left.first().filter(|_| pair.open()) {
            let k = (hit.depth / self.distance).floor() as i64;
            self.gather_pair(cursor, k, &mut pair);
            let here = left
                .iter()
                .take_while(|hit| (hit.depth / self.distance).floor() as i64 <= k)
                .count();
            let (split, rest) = left.split_at(here);
            self.split_slab(cursor, k, split, &shade, &mut pair);
            left = rest;
        }
        self.gather(cursor, i64::MAX, stop, &mut pair.full, pair.counts);
        pair.colors()
    }

    fn gather_pair(&self, cursor: &mut Cursor, until: i64, pair: &mut Pair<'_>) {
        if pair.open() {
            let mut counts = Counts::default();
            self.visit(cursor, until, &mut counts, |sample| {
                let (color, opacity) = self.slab(sample);
                pair.gel(color, opacity);
                pair.open()
            });
            *pair.counts += counts;
        }
    }

    /// Slab `k`, cut at the depths of `hits`: sliver, polygon, sliver, polygon, …, sliver.
    fn split_slab(
        &self,
        cursor: &mut Cursor,
        k: i64,
        hits: &[Hit],
        shade: &impl Fn(&Hit) -> Shaded,
        pair: &mut Pair<'_>,
    ) {
        let mut gel = None;
        self.visit(cursor, k.saturating_add(1), pair.counts, |sample| {
            gel = Some(sample);
            false
        });
        let sliver = |pair: &mut Pair<'_>, part: f64| {
            let Some(sample) = gel.filter(|_| part > 0.0) else { return };
            let (color, opacity) = (sample.truncate().as_dvec3(), f64::from(sample.w).min(1.0));
            let thick = thicken(opacity, part * self.ratio);
            pair.counts.slivers += 1;
            pair.gel(color * recolor(opacity, thick, part * self.ratio), thick);
        };
        let mut passed = 0.0;
        for hit in hits {
            if !pair.open() {
                return;
            }
            let place = (hit.depth / self.distance - k as f64).clamp(passed, 1.0);
            sliver(pair, place - passed);
            passed = place;
            pair.polygon(&shade(hit));
        }
        sliver(pair, 1.0 - passed);
    }
}

/// C_G of a ray: the polygons alone, as associated RGBA; stops on its own (paper §6). `plain` shades a hit: associated
/// colour and opacity.
pub fn geometric(hits: &[Hit], plain: impl Fn(&Hit) -> (DVec3, f64), stop: f64) -> [f32; 4] {
    let mut ray = Gathered::NOTHING;
    for hit in hits {
        if ray.through <= stop {
            break;
        }
        let (color, opacity) = plain(hit);
        ray.under(color, opacity);
    }
    ray.rgba(0.0)
}

/// A ray through polygons where there is no volume: C, which C_A equals but for textures and shadows.
pub fn polygons_alone(
    hits: &[Hit],
    shade: impl Fn(&Hit) -> Shaded,
    stop: f64,
    counts: &mut Counts,
) -> Colors {
    let mut pair = Pair::new(stop, counts);
    for hit in hits {
        if !pair.open() {
            break;
        }
        pair.polygon(&shade(hit));
    }
    pair.colors()
}
