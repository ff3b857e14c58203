//! One volume as rays meet it: which samples of a packet are interesting, and what is there (paper §6).

use glam::{DVec3, I64Vec3, Vec3, Vec4};

use super::beams::Occupied;
use super::cue::Cue;
use super::lanes::{LANES, Lanes, Packet, each};
use super::media::Media;
use super::shaft::Dust;
use crate::view::composite::{recolor, thicken};
use crate::view::samples::Counts;
use crate::view::walk::{FRACTION_BITS, Stride, Walk};
use crate::volume::gel::{EMPTY, Texel, TexelSlices};
use crate::volume::pyramid::{PyramidSlices, empty_level_within};

/// The gel of one volume as the rays of one view meet it.
pub struct Medium<'a, T> {
    /// How samples walk through it.
    pub walk: Walk,
    /// The gel; its reflected part where `ambient` is apart.
    pub gel: TexelSlices<'a, T>,
    /// The ambient part of its colour, where reflected light is cued.
    pub ambient: Option<TexelSlices<'a, T>>,
    /// What steps over empty gel; `None`: every sample is taken.
    pub pyramid: Option<PyramidSlices<'a>>,
    /// Where the rays of each beam may meet gel; `None`: anywhere.
    pub occupied: Option<Occupied>,
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
pub struct Entered {
    lanes: [Lane; LANES],
    /// All samples before this number that were not asked for are empty.
    next: i64,
}

/// Where one ray is.
#[derive(Debug, Clone, Copy)]
struct Lane {
    /// The samples that lie in the domain and in occupied bricks of its beam.
    first: i64,
    end: i64,
    /// Fixed-point voxel index of sample 0, and from each sample to the next: modulo 2⁶⁴, exact within the domain.
    base: I64Vec3,
    stride: Stride,
    /// The slab's thickness along the ray against the opacity unit.
    ratio: f64,
    /// The world point at depth 0 and the way for each unit of depth, for what asks for world points.
    origin: DVec3,
    along: DVec3,
    /// The brick around its last sample.
    stored: u32,
}

impl Default for Lane {
    /// A ray that meets no gel.
    fn default() -> Self {
        Self {
            first: i64::MAX,
            end: i64::MIN,
            base: I64Vec3::ZERO,
            stride: Stride::NONE,
            ratio: 1.0,
            origin: DVec3::ZERO,
            along: DVec3::ZERO,
            stored: EMPTY,
        }
    }
}

impl Lane {
    #[inline]
    fn at(&self, k: i64) -> I64Vec3 {
        self.base.wrapping_add(self.stride.step.wrapping_mul(I64Vec3::splat(k)))
    }

    fn world(&self, k: i64, distance: f64) -> DVec3 {
        self.origin + self.along * ((k as f64 + 0.5) * distance)
    }
}

impl Entered {
    /// The world point of a ray that has entered at sample `k`, and its slab's thickness against the opacity unit.
    pub fn place(&self, lane: usize, k: i64, distance: f64) -> (DVec3, f64) {
        let lane = &self.lanes[lane];
        (lane.world(k, distance), lane.ratio)
    }
}

/// Where in its cell a fixed-point voxel index lies, 0..1.
#[inline]
fn within(at: I64Vec3) -> Vec3 {
    // 24 of the 40 bits behind the point: exact in an f32.
    let part = |p: i64| ((p >> (FRACTION_BITS - 24)) & 0xff_ffff) as f32 / 16_777_216.0;
    Vec3::new(part(at.x), part(at.y), part(at.z))
}

/// The cell that a fixed-point voxel index lies in.
#[inline]
fn cell(at: I64Vec3) -> [usize; 3] {
    let whole = |p: i64| (p >> FRACTION_BITS) as usize;
    [whole(at.x), whole(at.y), whole(at.z)]
}

impl<T: Texel> Media for Medium<'_, T> {
    type Entered = Entered;

    fn enter(&self, packet: &Packet<'_>, entered: &mut Entered) -> [i64; 2] {
        entered.next = i64::MIN;
        let mut range = [i64::MAX, i64::MIN];
        for ((lane, ray), beam) in entered.lanes.iter_mut().zip(packet.rays).zip(packet.beams) {
            *lane = Lane::default();
            let occupied = self.occupied.as_ref().map_or([i64::MIN, i64::MAX], |o| o[*beam]);
            if occupied[0] >= occupied[1] {
                continue;
            }
            let Some(samples) = self.walk.enter(ray) else { continue };
            let stride = samples.stride;
            let base =
                samples.at.wrapping_sub(stride.step.wrapping_mul(I64Vec3::splat(samples.first)));
            let (first, end) = (samples.first.max(occupied[0]), samples.end.min(occupied[1]));
            // A stretch of exactly 1 is that of parallel rays and of the line of sight.
            let ratio = self.ratio * self.walk.stretch(ray);
            let ratio = if (ratio - 1.0).abs() < 1e-12 { 1.0 } else { ratio };
            let (origin, along) = (ray.origin, ray.along);
            *lane = Lane { first, end, base, stride, ratio, origin, along, stored: EMPTY };
            range = [range[0].min(first), range[1].max(end)];
        }
        range
    }

    fn seek(&self, entered: &mut Entered, k: i64) -> i64 {
        k.max(entered.next)
    }

    #[inline]
    fn meet(&self, entered: &mut Entered, k: i64, lanes: Lanes, counts: &mut Counts) -> Lanes {
        let mut met = 0;
        for index in each(lanes) {
            let lane = &mut entered.lanes[index];
            if k < lane.first || k >= lane.end {
                continue;
            }
            let [x, y, z] = cell(lane.at(k));
            let (_, stored) = self.gel.brick([x, y, z]);
            lane.stored = stored;
            let interesting = match self.pyramid {
                Some(pyramid) => pyramid.is_interesting(stored, [x, y, z]),
                None => true,
            };
            met |= Lanes::from(interesting) << index;
            counts.cells_skipped += u64::from(!interesting);
        }
        counts.samples += u64::from(met.count_ones());
        if let Some(pyramid) = self.pyramid.filter(|_| met == 0) {
            entered.next = self.after(pyramid, entered, k, lanes);
        }
        met
    }

    #[inline]
    fn slab(&self, entered: &mut Entered, k: i64, lane: usize) -> (DVec3, f64) {
        let lane = &entered.lanes[lane];
        let at = lane.at(k);
        let sample = self.sample(lane.stored, at, k);
        match self.dust {
            Some(dust) => slab(dust.join(sample, lane.world(k, self.distance)), lane.ratio),
            None => slab(sample, lane.ratio),
        }
    }
}

impl<T: Texel> Medium<'_, T> {
    /// The first sample after `k`, which is empty for all of `lanes`, that one of them may meet gel at.
    fn after(&self, pyramid: PyramidSlices<'_>, entered: &Entered, k: i64, lanes: Lanes) -> i64 {
        let mut next = i64::MAX;
        for lane in each(lanes).map(|index| &entered.lanes[index]).filter(|lane| k < lane.end) {
            let own = if k < lane.first { lane.first } else { k + self.leap(pyramid, lane, k) };
            next = next.min(own);
            if next == k + 1 {
                break;
            }
        }
        next
    }

    /// How many samples on the first one of a ray beyond the empty cell of the pyramid around its sample `k` is: at least
    /// 1, and never past a sample outside that cell.
    fn leap(&self, pyramid: PyramidSlices<'_>, lane: &Lane, k: i64) -> i64 {
        let at = lane.at(k);
        let cell = cell(at);
        let (entry, stored) = self.gel.brick(cell);
        let level = match stored {
            EMPTY => pyramid.empty_level(entry),
            _ => empty_level_within(pyramid.cells(stored), cell),
        };
        lane.stride.leap(at, level)
    }

    /// Sample `k`, at a place in a brick; with a cue, both parts of its colour together.
    #[inline]
    fn sample(&self, stored: u32, at: I64Vec3, k: i64) -> Vec4 {
        let (cell, at) = (cell(at), within(at));
        let sample = self.gel.sample(stored, cell, at);
        let (Some(cue), Some(ambient)) = (&self.cue, self.ambient) else { return sample };
        let factor = cue.factor((k as f64 + 0.5) * self.distance) as f32;
        let ambient = ambient.sample(stored, cell, at).truncate();
        (sample.truncate() * factor + ambient).extend(sample.w)
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
