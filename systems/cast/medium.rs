//! One volume as rays meet it: which samples of a packet are interesting, and what is there (paper §6).

use fearless_simd::{Level, dispatch};
use glam::{DVec3, Vec4};

use super::crossing::{Crossings, Sheet};
use super::cue::Cue;
use super::kernel;
use super::lanes::{LANES, Lanes, Packet};
use super::media::Media;
use super::shaft::Dust;
use crate::view::camera::Camera;
use crate::view::composite::{recolor, thicken};
use crate::view::ray::Ray;
use crate::view::samples::Counts;
use crate::view::walk::{FRACTION_BITS, Tile, Walk};
use crate::volume::gel::Texel;
use crate::volume::pyramid::{BLOCK, PyramidSlices};

/// What a volume is at samples: gel, or values that are classified there.
pub trait Source: Sync {
    /// Which of `lanes` (all inside the grid) meet anything at sample `k`, and what: associated RGBA per opacity unit; of its
    /// reflected part `fade` is left, slabs are so many opacity units thick, and there is room for what rays cross. No bit
    /// depends on the `level` of instructions.
    fn meet(
        &self,
        level: Level,
        fade: Option<f32>,
        tile: &Tile,
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
    fn meet(
        &self,
        level: Level,
        fade: Option<f32>,
        tile: &Tile,
        sample: (i64, Lanes),
        (seen, ..): (&mut [Vec4; LANES], &[f64; LANES], &mut Crossings),
    ) -> Lanes {
        dispatch!(level, simd => kernel::meet(simd, *self, fade, tile, sample, seen))
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
    /// The instructions that samples are taken with; no bit depends on them.
    pub level: Level,
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
    /// What rays cross.
    crossings: Crossings,
    packet: Option<Packet>,
    bundle: Bundle,
    /// The sample that may meet gel, as far as was sought.
    next: i64,
}

/// A packet as a thick ray: all its rays lie within `radius` of its middle.
#[derive(Debug, Clone, Copy, Default)]
struct Bundle {
    /// Fixed-point voxel index at the tile's middle sample.
    at: [i64; 3],
    step: [i64; 3],
    /// Cells, along the axis that the rays are most spread on.
    radius: f64,
    /// Steps to a cell, along the axis that it goes fastest on.
    per_cell: f64,
    /// Which of the pyramid's bits answer for all of it, if some do.
    reaching: Option<usize>,
}

impl Bundle {
    fn of(tile: &Tile, pyramid: Option<PyramidSlices<'_>>, reach: f64) -> Self {
        let last = LANES - 1;
        // Places are affine over the tile: its middle is that of opposite corners, and the corners are farthest from it.
        let middle = |triples: &[[i64; LANES]; 3]| {
            std::array::from_fn(|axis| i64::midpoint(triples[axis][0], triples[axis][last]))
        };
        let (at, step): ([i64; 3], [i64; 3]) = (middle(&tile.at), middle(&tile.step));
        let spread = |k: i64| {
            let steps = k.wrapping_sub(tile.middle);
            let from = |axis: usize, lane: usize| {
                let middle = at[axis].wrapping_add(step[axis].wrapping_mul(steps));
                tile.place(axis, lane, k).wrapping_sub(middle).unsigned_abs()
            };
            (0..3).flat_map(|axis| [from(axis, 0), from(axis, 3)]).max().unwrap_or(0)
        };
        let unit = (1_u64 << FRACTION_BITS) as f64;
        let spread = spread(tile.some[0]).max(spread(tile.some[1]));
        let fastest = step.iter().map(|step| step.unsigned_abs()).max().unwrap_or(0).max(1);
        // Rounding moves each end by less than a unit, and by as much again with every step from the middle.
        let steps = tile.some.map(|k| k.abs_diff(tile.middle)).into_iter().max().unwrap_or(0);
        let radius = (spread.saturating_add(steps) + 8) as f64 / unit + reach;
        let reaching = pyramid.and_then(|_| PyramidSlices::reaching(radius));
        Self { at, step, radius, per_cell: unit / fastest as f64, reaching }
    }

    fn cell(&self, steps: i64) -> [i64; 3] {
        std::array::from_fn(|axis| {
            self.at[axis].wrapping_add(self.step[axis].wrapping_mul(steps)) >> FRACTION_BITS
        })
    }
}

impl<S: Source> Medium<'_, S> {
    /// The world point of a ray that has entered at sample `k`, and its slab's thickness against the opacity unit.
    pub fn place(&self, entered: &Entered, lane: usize, k: i64) -> (DVec3, f64) {
        let depth = (k as f64 + 0.5) * self.distance;
        (self.ray(entered, lane).at(depth), entered.ratios[lane])
    }

    /// The slab of a sample with the dust that is there.
    #[inline(never)]
    fn dusty(&self, dust: &Dust, entered: &Entered, (lane, k): (usize, i64)) -> (DVec3, f64) {
        let (world, ratio) = self.place(entered, lane, k);
        slab(dust.join(entered.seen[lane], world), ratio)
    }

    fn ray(&self, entered: &Entered, lane: usize) -> Ray {
        let position = entered.packet.map_or([0; 2], |packet| packet.position(lane));
        self.camera.ray(Camera::window(position))
    }
}

impl<S: Source> Media for Medium<'_, S> {
    type Entered = Entered;

    fn enter(&self, packet: &Packet, entered: &mut Entered) -> [i64; 2] {
        self.walk.enter(packet.first, packet.step as i64, &mut entered.tile);
        if entered.tile.is_empty() {
            return entered.tile.some;
        }
        entered.packet = Some(*packet);
        entered.next = i64::MIN;
        let reach = self.source.reach(&entered.tile);
        if reach > 0.0 {
            entered.crossings.begin();
        }
        entered.bundle = Bundle::of(&entered.tile, self.pyramid, reach);
        entered.ratios = [self.ratio; LANES];
        if !self.walk.is_parallel() {
            entered.ratios = std::array::from_fn(|lane| {
                // A stretch of exactly 1 is that of the line of sight.
                let ratio = self.ratio * self.ray(entered, lane).along.length();
                if (ratio - 1.0).abs() < 1e-12 { 1.0 } else { ratio }
            });
        }
        entered.tile.some
    }

    #[inline]
    fn seek(&self, entered: &mut Entered, k: i64, counts: &mut Counts) -> i64 {
        let (Some(pyramid), mut k) = (self.pyramid, k.max(entered.next)) else { return k };
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
        entered.next = k;
        k
    }

    #[inline]
    fn meet(&self, entered: &mut Entered, k: i64, lanes: Lanes, counts: &mut Counts) -> Lanes {
        let mut there = lanes;
        if k < entered.tile.all[0] || k >= entered.tile.all[1] {
            there = (0..LANES)
                .filter(|&lane| self.walk.holds(&entered.tile, lane, k))
                .fold(0, |set, lane| set | 1 << lane)
                & lanes;
        }
        let fade = self.cue.map(|cue| cue.factor((k as f64 + 0.5) * self.distance) as f32);
        let Entered { tile, seen, ratios, crossings, .. } = entered;
        let met = self.source.meet(self.level, fade, tile, (k, there), (seen, ratios, crossings));
        counts.packet_steps += 1;
        counts.samples += u64::from(met.count_ones());
        counts.cells_skipped += u64::from((there & !met).count_ones());
        met
    }

    #[inline]
    fn slab(&self, entered: &mut Entered, k: i64, lane: usize) -> (DVec3, f64) {
        let sample = entered.seen[lane];
        match self.dust {
            Some(dust) => self.dusty(dust, entered, (lane, k)),
            None => slab(sample, entered.ratios[lane]),
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

/// A sample of associated colour and opacity per opacity unit, as a slab `ratio` units thick.
#[inline]
pub fn slab(sample: Vec4, ratio: f64) -> (DVec3, f64) {
    let (color, opacity) = (sample.truncate().as_dvec3(), f64::from(sample.w).min(1.0));
    if ratio == 1.0 {
        return (color, opacity);
    }
    let thick = thicken(opacity, ratio);
    (color * recolor(opacity, thick, ratio), thick)
}

#[cfg(test)]
mod tests;
