//! A packet of rays through gel and polygons: slabs, split into slivers where polygons cross them (paper §2, equations 2a
//! and 2b).
//!
//! The rays go side by side from sample to sample: all have theirs at the same depths. Where none meets gel or a polygon
//! they go on together, and each stops on its own. What a ray gathers is what it would gather alone, in the same order.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::Simd;
use glam::DVec3;

use super::crossing::Sheet;
use super::lanes::{LANES, Lanes, each};
use super::media::Media;
use crate::view::composite::{Gathered, recolor, thicken};
use crate::view::samples::Counts;

/// A polygon that a ray meets, shaded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shaded {
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
pub(crate) struct Hit {
    /// Depth along the ray, world units.
    pub depth: f64,
    /// Its number among the faces seen, in the order of the scene.
    pub face: u32,
    /// What a projection shows; 0 of a face.
    pub value: f32,
}

/// What all rays of a view have in common.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slabs {
    /// Δ, world units.
    pub distance: f64,
    /// A ray stops when no more than this comes through of what is behind.
    pub stop: f64,
    /// The depth of the eye in a perspective view: the slab that it is in counts from there on.
    pub eye: f64,
}

impl Slabs {
    /// The number of the slab around a depth.
    fn number(&self, depth: f64) -> i64 {
        (depth / self.distance).floor() as i64
    }

    /// How far into slab `k` a depth is, 0..=1.
    fn place(&self, k: i64, depth: f64) -> f64 {
        (depth / self.distance - k as f64).clamp(0.0, 1.0)
    }
}

/// The state of C and C_A of one ray (paper §2).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gathering {
    /// C: volume and polygons.
    pub full: Gathered,
    /// C_A: polygons attenuated by the volume.
    attenuated: Gathered,
    /// How much of the ray polygons cover in C_A.
    covered: f64,
    /// C_G as far as the ray goes, where volumes have surfaces.
    geometric: Gathered,
    /// Those of the packet's hits that the ray has not come to yet.
    left: [u32; 2],
}

impl Gathering {
    /// Nothing gathered yet by a ray that is to meet the hits numbered `[first, end)`.
    pub fn new(hits: [u32; 2]) -> Self {
        let nothing = Gathered::NOTHING;
        Self { full: nothing, attenuated: nothing, covered: 0.0, geometric: nothing, left: hits }
    }

    /// Those of the packet's hits that the ray has not come to yet, `[first, end)`.
    pub fn hits(&self) -> [u32; 2] {
        self.left
    }

    /// C_A; what polygons cover is kept beside, as associated RGBA.
    pub fn attenuated(&self) -> [f32; 4] {
        let [r, g, b] = self.attenuated.color.to_array();
        [r as f32, g as f32, b as f32, self.covered as f32]
    }

    /// C_G of a ray that meets surfaces of volumes: as far as it went, and then the polygons that it did not come to.
    pub fn with_surfaces(
        &self,
        hits: &[Hit],
        plain: impl Fn(&Hit) -> (DVec3, f64),
        stop: f64,
    ) -> [f32; 4] {
        under(self.geometric, hits, plain, stop)
    }

    /// Whether polygons are still to come: only then does C_A go on.
    fn has_hits(&self) -> bool {
        self.left[0] < self.left[1]
    }

    fn is_open(&self, stop: f64) -> bool {
        self.full.through > stop || (self.has_hits() && self.attenuated.through > stop)
    }

    #[inline]
    fn gel(&mut self, color: DVec3, opacity: f64, sheet: Option<Sheet>, stop: f64) {
        if self.full.through > stop {
            self.full.under(color, opacity);
        }
        if let Some(sheet) = sheet {
            self.covered += self.attenuated.through * sheet.opacity;
            self.attenuated.under(sheet.color, opacity);
            self.geometric.under(sheet.turn, sheet.opacity);
        } else if self.has_hits() {
            self.attenuated.under(DVec3::ZERO, opacity);
        }
    }

    fn polygon(&mut self, met: &Shaded, stop: f64, counts: &mut Counts) {
        if self.full.through > stop {
            counts.polygon_hits += 1;
            self.full.under(met.color, met.opacity);
        }
        self.covered += self.attenuated.through * met.plain_opacity;
        self.attenuated.under(met.plain_color, met.plain_opacity);
        self.geometric.under(met.plain_color, met.plain_opacity);
    }
}

/// Takes the rays of a packet, which has entered `media`, through it and the polygons at `hits`; each ray's own are in the
/// order of their depths. `shade` shades a hit of a ray, and is called for those alone that the ray reaches.
#[inline(always)]
pub fn march<S: Simd, M: Media>(
    (simd, media, entered, [first, end]): (S, &M, &mut M::Entered, [i64; 2]),
    slabs: &Slabs,
    hits: &[Hit],
    shade: impl Fn(&Hit, usize) -> Shaded,
    (lanes, gathered): (Lanes, &mut [Gathering; LANES]),
    counts: &mut Counts,
) {
    let eye = slabs.number(slabs.eye);
    let mut next = Next::new(slabs, hits, lanes, gathered);
    let (mut open, mut k, mut gel) = (lanes, first, i64::MIN);
    while open != 0 {
        if gel < k {
            let found = media.seek(simd, entered, (k, open), counts);
            gel = if found < end { found } else { i64::MAX };
        }
        k = gel.min(next.least);
        if k == i64::MAX {
            break;
        }
        let met = if k == gel { media.meet(simd, entered, (k, open), counts) } else { 0 };
        let cut = if k == eye { open } else { next.at(k, open) };
        for lane in each(met & !cut) {
            let (color, opacity) = media.slab(entered, k, lane);
            let sheet = media.has_surfaces().then(|| media.sheet(entered, lane));
            let ray = &mut gathered[lane];
            ray.gel(color, opacity, sheet, slabs.stop);
            if !ray.is_open(slabs.stop) {
                open &= !(1 << lane);
            }
        }
        for lane in each(cut) {
            let gel = (met >> lane & 1 == 1).then(|| media.slab(entered, k, lane));
            let sheet = (gel.is_some() && media.has_surfaces()).then(|| media.sheet(entered, lane));
            let crosses = sheet.is_some_and(|sheet| sheet.opacity > 0.0);
            let gel = if crosses { Some(media.bare(entered, k, lane)) } else { gel };
            let slab = Slab { k, gel, sheet, from: slabs.place(k, slabs.eye) };
            slab.split(slabs, hits, |hit| shade(hit, lane), &mut gathered[lane], counts);
            if !gathered[lane].is_open(slabs.stop) {
                open &= !(1 << lane);
            }
        }
        // Also where those that were to meet a polygon here have stopped before it.
        if cut != 0 || k >= next.least {
            next = Next::new(slabs, hits, open, gathered);
        }
        k += 1;
    }
}

/// The slabs in which the rays of a packet meet their next polygons.
struct Next {
    slabs: [i64; LANES],
    least: i64,
}

impl Next {
    fn new(slabs: &Slabs, hits: &[Hit], lanes: Lanes, gathered: &[Gathering; LANES]) -> Self {
        let mut next = Self { slabs: [i64::MAX; LANES], least: i64::MAX };
        for lane in each(lanes).filter(|&lane| gathered[lane].has_hits()) {
            let slab = slabs.number(hits[gathered[lane].left[0] as usize].depth);
            next.slabs[lane] = slab;
            next.least = next.least.min(slab);
        }
        next
    }

    /// Which of `lanes` meet a polygon in slab `k`.
    fn at(&self, k: i64, lanes: Lanes) -> Lanes {
        if k < self.least {
            return 0;
        }
        let here = |lane: &usize| self.slabs[*lane] == k;
        each(lanes).filter(here).fold(0, |set, lane| set | 1 << lane)
    }
}

/// A slab of one ray that is cut.
struct Slab {
    k: i64,
    /// Associated colour and opacity of the whole of it, where there is gel; without the surfaces in it.
    gel: Option<(DVec3, f64)>,
    /// The surfaces in it, of volumes that have some.
    sheet: Option<Sheet>,
    /// Where in it the ray begins, 0..1.
    from: f64,
}

impl Slab {
    /// The slab cut at the depths of the hits in it: sliver, polygon, sliver, polygon, …, sliver; where it has surfaces they
    /// are met as a polygon is, at their own depth.
    fn split(
        &self,
        slabs: &Slabs,
        hits: &[Hit],
        shade: impl Fn(&Hit) -> Shaded,
        ray: &mut Gathering,
        counts: &mut Counts,
    ) {
        let mut passed = self.from;
        let mut sheet = self.sheet.filter(|sheet| sheet.opacity > 0.0 && sheet.part >= passed);
        while ray.has_hits() {
            let hit = &hits[ray.left[0] as usize];
            if slabs.number(hit.depth) > self.k || !ray.is_open(slabs.stop) {
                break;
            }
            let place = slabs.place(self.k, hit.depth).max(passed);
            if let Some(sheet) = sheet.take_if(|sheet| sheet.part <= place) {
                self.surface(&mut passed, &sheet, (ray, slabs.stop), counts);
            }
            self.sliver(place - passed, (ray, slabs.stop), counts);
            passed = place;
            ray.polygon(&shade(hit), slabs.stop, counts);
            ray.left[0] += 1;
        }
        if let Some(sheet) = sheet.filter(|_| ray.is_open(slabs.stop)) {
            self.surface(&mut passed, &sheet, (ray, slabs.stop), counts);
        }
        if ray.is_open(slabs.stop) {
            self.sliver(1.0 - passed, (ray, slabs.stop), counts);
        }
    }

    /// The gel of a part of it.
    fn sliver(&self, part: f64, (ray, stop): (&mut Gathering, f64), counts: &mut Counts) {
        let Some((color, opacity)) = self.gel.filter(|_| part > 0.0) else { return };
        let opacity = opacity.min(1.0);
        let thick = thicken(opacity, part);
        counts.slivers += 1;
        let bare = self.sheet.map(|_| Sheet::default());
        ray.gel(color * recolor(opacity, thick, part), thick, bare, stop);
    }

    /// The gel from where it is `passed` to its surfaces, and those.
    fn surface(
        &self,
        passed: &mut f64,
        sheet: &Sheet,
        (ray, stop): (&mut Gathering, f64),
        counts: &mut Counts,
    ) {
        self.sliver(sheet.part - *passed, (ray, stop), counts);
        *passed = sheet.part;
        ray.gel(sheet.color, sheet.opacity, Some(*sheet), stop);
    }
}

/// C_G of a ray: the polygons alone, as associated RGBA; stops on its own (paper §6). `plain` shades a hit: associated
/// colour and opacity.
pub fn geometric(hits: &[Hit], plain: impl Fn(&Hit) -> (DVec3, f64), stop: f64) -> [f32; 4] {
    under(Gathered::NOTHING, hits, plain, stop)
}

/// The polygons at `hits` behind what was gathered, as associated RGBA.
fn under(
    mut ray: Gathered,
    hits: &[Hit],
    plain: impl Fn(&Hit) -> (DVec3, f64),
    stop: f64,
) -> [f32; 4] {
    for hit in hits {
        if ray.through <= stop {
            break;
        }
        let (color, opacity) = plain(hit);
        ray.under(color, opacity);
    }
    ray.rgba(0.0)
}
