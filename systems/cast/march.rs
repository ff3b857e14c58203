//! A packet of rays through gel and polygons: slabs, split into slivers where polygons cross them (paper §2, equations 2a
//! and 2b).
//!
//! The rays go side by side from sample to sample: all have theirs at the same depths. Where none meets gel or a polygon
//! they go on together, and each stops on its own. What a ray gathers is what it would gather alone, in the same order.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]
#![allow(clippy::needless_range_loop, reason = "sixteen lanes at once, by their number")]

use fearless_simd::Simd;
use glam::DVec3;

use super::crossing::Sheet;
use super::gathering::{Gathering, Hit, Shaded};
use super::lanes::{LANES, Lanes, each};
use super::media::Media;
use crate::view::composite::{recolor, thicken};
use crate::view::samples::Counts;

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
            let found = if k < end { media.seek(simd, entered, (k, open), counts) } else { end };
            gel = if found < end { found } else { i64::MAX };
        }
        if gel == i64::MAX {
            // What is left has no gel around it.
            for lane in each(open) {
                gathered[lane].polygons(hits, |hit| shade(hit, lane), slabs.stop, counts);
            }
            break;
        }
        k = gel.min(next.least);
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
            next.after(slabs, hits, (cut, open), gathered);
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
        next.after(slabs, hits, (lanes, lanes), gathered);
        next
    }

    /// The next polygons of the rays `passed`, which may have passed some, and of those that are not `open` any longer none.
    #[inline(always)]
    fn after(
        &mut self,
        slabs: &Slabs,
        hits: &[Hit],
        (passed, open): (Lanes, Lanes),
        gathered: &[Gathering; LANES],
    ) {
        for lane in each(passed | !open) {
            let ray = &gathered[lane];
            let next = ray.next(hits).filter(|_| open >> lane & 1 == 1);
            self.slabs[lane] = next.map_or(i64::MAX, |hit| slabs.number(hit.depth));
        }
        self.least = i64::MAX;
        for lane in 0..LANES {
            self.least = self.least.min(self.slabs[lane]);
        }
    }

    /// Which of `lanes` meet a polygon in slab `k`.
    #[inline(always)]
    fn at(&self, k: i64, lanes: Lanes) -> Lanes {
        if k < self.least {
            return 0;
        }
        let mut here = 0;
        for lane in 0..LANES {
            here |= Lanes::from(self.slabs[lane] == k) << lane;
        }
        here & lanes
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
        while let Some(hit) = ray.next(hits) {
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
