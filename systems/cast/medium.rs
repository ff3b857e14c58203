//! One volume as rays meet it: which samples of a packet are interesting, and what is there (paper §6).
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::Simd;
use glam::{DVec3, Vec4};

use super::bundle::Bundle;
use super::crossing::{Crossings, Sheet};
use super::cue::Cue;
use super::kernel;
use super::lanes::{LANES, Lanes, Packet};
use super::media::{Media, slab};
use super::shaft::Dust;
use super::thick::Thick;
use super::window::{Cells, SAMPLES, Sight, Window};
use crate::view::camera::Camera;
use crate::view::ray::Ray;
use crate::view::samples::Counts;
use crate::view::walk::{Tile, Walk};
use crate::volume::gel::Texel;
use crate::volume::pyramid::{BLOCK, PyramidSlices};

/// What a volume is at samples: gel, or values that are classified there.
pub trait Source: Sync {
    /// The cells in which alone it is met, if it is looked for as far from its samples as it [reaches](Self::reach); `None`:
    /// anywhere. `inner` are samples before and after which all rays are in the grid.
    fn cells(&self, reach: f64, inner: bool) -> Option<Cells<'_>>;

    /// Which of `lanes` (all inside the grid, and in such cells) meet anything at sample `k`, and what: associated RGBA per
    /// opacity unit; of its reflected part `fade` is left, slabs are so many opacity units thick, and there is room for what
    /// rays cross.
    fn meet<I: Simd>(
        &self,
        simd: I,
        fade: Option<f32>,
        tile_and_window: (&Tile, &Window),
        sample: (i64, Lanes),
        seen_ratios_and_room: (&mut [Vec4; LANES], &[f64; LANES], &mut Crossings),
    ) -> Lanes;

    /// Whether rays may cross surfaces in it.
    #[inline]
    fn has_surfaces(&self) -> bool {
        false
    }

    /// How far from its samples it is looked for, cells; no bit of what is empty as far as that may be missed.
    fn reach(&self, _: &Tile) -> f64 {
        0.0
    }
}

impl<T: Texel> Source for kernel::GelSlices<'_, T> {
    #[inline]
    fn cells(&self, _: f64, _: bool) -> Option<Cells<'_>> {
        Some(Self::cells(self))
    }

    #[inline(always)]
    fn meet<I: Simd>(
        &self,
        simd: I,
        fade: Option<f32>,
        tile_and_window: (&Tile, &Window),
        sample: (i64, Lanes),
        (seen, ..): (&mut [Vec4; LANES], &[f64; LANES], &mut Crossings),
    ) -> Lanes {
        kernel::meet(simd, self, fade, tile_and_window, sample, seen);
        sample.1
    }
}

/// One volume as the rays of one view meet it.
pub(crate) struct Medium<'a, S> {
    /// How samples walk through it.
    pub walk: Walk,
    /// The view's frame.
    pub camera: &'a Camera,
    /// What it is at samples.
    pub source: S,
    /// What steps over empty space; `None`: every sample is taken.
    pub pyramid: Option<PyramidSlices<'a>>,
    /// Δ / u.
    pub ratio: f64,
    /// Δ, world units.
    pub distance: f64,
    /// The depth cue, if stated.
    pub cue: Option<Cue>,
    /// Dust in shafts of light, all over the domain: then nothing steps over it.
    pub dust: Option<&'a Dust>,
}

/// Where the rays of a packet are in a volume.
#[derive(Debug, Clone, Default)]
pub(crate) struct Entered {
    /// Where each of them is.
    pub tile: Tile,
    /// What each sees of the gel at the sample that was met last: associated RGBA per opacity unit.
    pub seen: [Vec4; LANES],
    /// The slab's thickness along each ray against the opacity unit.
    ratios: [f64; LANES],
    /// Slabs so thick of what was seen last, where that takes powers; `None` where it takes none.
    thick: Option<Thick>,
    /// What rays cross.
    crossings: Crossings,
    packet: Option<Packet>,
    bundle: Bundle,
    /// The samples that were looked at last.
    window: Window,
    /// Before it no ray meets gel, as far as was sought.
    next: i64,
}

impl<S: Source> Medium<'_, S> {
    /// The world point of a ray that has entered at sample `k`, and its slab's thickness against the opacity unit.
    pub fn place(&self, entered: &Entered, lane: usize, k: i64) -> (DVec3, f64) {
        let depth = (k as f64 + 0.5) * self.distance;
        (self.ray(entered, lane).at(depth), entered.ratios[lane])
    }

    /// The slab of a sample with the dust that is there.
    #[inline(never)]
    fn dusty(
        &self,
        (dust, sample): (&Dust, Vec4),
        entered: &Entered,
        (lane, k): (usize, i64),
    ) -> (DVec3, f64) {
        let (world, ratio) = self.place(entered, lane, k);
        slab(dust.join(sample, world), ratio)
    }

    /// The first sample from `k` on that is not known to be empty for all rays of the packet.
    #[inline]
    fn leap(&self, entered: &Entered, mut k: i64, counts: &mut Counts) -> i64 {
        let Some(pyramid) = self.pyramid else { return k };
        let Entered { bundle, tile, .. } = entered;
        while k < tile.some[1] {
            let cell = bundle.cell(k - tile.middle);
            let near = bundle.reaching.and_then(|reaching| pyramid.is_near(reaching, cell));
            if near == Some(true) {
                break;
            }
            // Blocks nearer than that are empty, the bundle's own and those that it reaches on its way.
            let distance = i64::from(pyramid.distance(cell));
            let room = (distance - 1) as f64 * BLOCK as f64 - bundle.radius;
            if near.is_none() && room < 0.0 {
                break;
            }
            counts.cells_skipped += 1;
            k = k.saturating_add((room.max(0.0) * bundle.per_cell) as i64 + 1);
        }
        k
    }

    /// Looks at the samples from `k` on.
    #[inline(always)]
    fn look<I: Simd>(
        &self,
        simd: I,
        (entered, cells): (&mut Entered, Cells<'_>),
        k: i64,
        counts: &mut Counts,
    ) {
        let Entered { tile, bundle, window, .. } = entered;
        let last = (k + SAMPLES as i64).min(tile.some[1]) - 1;
        let held = if tile.all[0] <= k && k + SAMPLES as i64 <= tile.all[1] {
            u64::MAX
        } else {
            (k..=last).rev().fold(0, |held, k| held << LANES | u64::from(self.held(tile, k)))
        };
        let sight = Sight { cells: bundle.reach([k, last].map(|k| k - tile.middle)), held };
        window.look(simd, cells, tile, k, &sight);
        let [empty, looks] = window.looked(held);
        counts.cells_skipped += empty;
        counts.packet_steps += looks;
    }

    /// Which rays are in the grid at a sample.
    #[inline]
    fn held(&self, tile: &Tile, k: i64) -> Lanes {
        if tile.all[0] <= k && k < tile.all[1] {
            return Lanes::MAX;
        }
        (0..LANES)
            .filter(|&lane| self.walk.holds(tile, lane, k))
            .fold(0, |set, lane| set | 1 << lane)
    }

    fn ray(&self, entered: &Entered, lane: usize) -> Ray {
        let position = entered.packet.map_or([0; 2], |packet| packet.position(lane));
        self.camera.ray(Camera::window(position))
    }
}

impl<S: Source> Media for Medium<'_, S> {
    type Entered = Entered;

    #[inline(always)]
    fn enter(&self, packet: &Packet, entered: &mut Entered) -> [i64; 2] {
        self.walk.enter(&packet.places, &mut entered.tile);
        if entered.tile.is_empty() {
            return entered.tile.some;
        }
        entered.packet = Some(*packet);
        entered.next = i64::MIN;
        entered.window.forget();
        let reach = self.source.reach(&entered.tile);
        if reach > 0.0 {
            entered.crossings.begin(reach);
        }
        entered.bundle = Bundle::of(&entered.tile, self.pyramid, reach);
        self.walk.scatter(&packet.places, &mut entered.tile);
        entered.ratios = [self.ratio; LANES];
        if !self.walk.is_parallel() {
            entered.ratios = std::array::from_fn(|lane| {
                // A stretch of exactly 1 is that of the line of sight.
                let ratio = self.ratio * self.ray(entered, lane).along.length();
                if (ratio - 1.0).abs() < 1e-12 { 1.0 } else { ratio }
            });
        }
        entered.thick = Thick::needed(&entered.ratios).filter(|_| self.dust.is_none());
        entered.tile.some
    }

    fn scout(&self, group: &Packet, entered: &mut Entered, counts: &mut Counts) -> [i64; 2] {
        // In perspective the rays between those of the group may be in the grid where none of its own is.
        if !self.walk.is_parallel() {
            return [i64::MIN, i64::MAX];
        }
        let [first, end] = self.enter(group, entered);
        if first < end { [self.leap(entered, first, counts), end] } else { [i64::MAX; 2] }
    }

    #[inline(always)]
    fn seek<I: Simd>(
        &self,
        simd: I,
        entered: &mut Entered,
        (k, lanes): (i64, Lanes),
        counts: &mut Counts,
    ) -> i64 {
        let mut k = k.max(entered.next);
        while k < entered.tile.some[1] {
            if entered.window.holds(k) {
                if let Some(met) = entered.window.next(k, lanes) {
                    k = met;
                    break;
                }
                k = entered.window.end();
                continue;
            }
            k = self.leap(entered, k, counts);
            let inner = entered.tile.is_inner(k, SAMPLES);
            let Some(cells) = self.source.cells(entered.crossings.reach, inner) else { break };
            if k < entered.tile.some[1] {
                self.look(simd, (entered, cells), k, counts);
            }
        }
        entered.next = k;
        k
    }

    #[inline(always)]
    fn meet<I: Simd>(
        &self,
        simd: I,
        entered: &mut Entered,
        (k, lanes): (i64, Lanes),
        counts: &mut Counts,
    ) -> Lanes {
        let fade = self.cue.map(|cue| cue.factor((k as f64 + 0.5) * self.distance) as f32);
        let there = if entered.window.holds(k) {
            entered.window.at(k) & lanes
        } else {
            counts.packet_steps += 1;
            self.held(&entered.tile, k) & lanes
        };
        let Entered { tile, seen, ratios, crossings, window, thick, .. } = entered;
        let shared = (&*tile, &*window);
        let met = self.source.meet(simd, fade, shared, (k, there), (seen, ratios, crossings));
        if let Some(thick) = thick {
            thick.fill(seen, ratios);
        }
        counts.samples += u64::from(met.count_ones());
        counts.cells_skipped += u64::from((there & !met).count_ones());
        met
    }

    #[inline]
    fn slab(&self, entered: &mut Entered, k: i64, lane: usize) -> (DVec3, f64) {
        let sample = entered.seen[lane];
        match (self.dust, &entered.thick) {
            (Some(dust), _) => self.dusty((dust, sample), entered, (lane, k)),
            (None, Some(thick)) => thick.slab(sample, lane),
            (None, None) => slab(sample, entered.ratios[lane]),
        }
    }

    fn bare(&self, entered: &mut Entered, k: i64, lane: usize) -> (DVec3, f64) {
        let sample = if self.has_surfaces() { &entered.crossings.bare } else { &entered.seen };
        match self.dust {
            Some(dust) => self.dusty((dust, sample[lane]), entered, (lane, k)),
            None => slab(sample[lane], entered.ratios[lane]),
        }
    }

    #[inline]
    fn has_surfaces(&self) -> bool {
        self.source.has_surfaces()
    }

    #[inline]
    fn sheet(&self, entered: &Entered, lane: usize) -> Sheet {
        entered.crossings.sheets[lane]
    }
}

#[cfg(test)]
mod tests;
