//! What a ray sees of a volume: the next interesting sample, however much empty gel lies before it (paper §6).

use glam::{DVec3, Vec3, Vec4};

use super::shaft::Dust;
use crate::composite::{Gathered, recolor, thicken};
use crate::gel::{CELLS, EMPTY, Texel, Texels};
use crate::pyramid::{Pyramid, empty_level_within};
use crate::ray::{FRACTION_BITS, Samples, Walk};
use crate::samples::Counts;

/// How reflected light fades with depth: divided by `k1 + k2 (t − near)`, t the depth along the ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cue {
    /// k_1.
    pub k1: f64,
    /// k_2, per world unit.
    pub k2: f64,
    /// Depth of the near side of the scene's bounding sphere.
    pub near: f64,
}

impl Cue {
    /// What reflected light at depth `t` is multiplied by; above 0 within the scene.
    #[must_use]
    pub fn factor(&self, t: f64) -> f64 {
        1.0 / (self.k1 + self.k2 * (t - self.near).max(0.0))
    }
}

/// The gel as the rays of one view see it.
pub struct Volume<'a, T> {
    /// How samples walk through it.
    pub walk: Walk,
    /// The gel; its reflected part where `ambient` is apart.
    pub gel: &'a Texels<T>,
    /// The ambient part of its colour, where reflected light is cued.
    pub ambient: Option<&'a Texels<T>>,
    /// What steps over empty gel; `None`: every sample is taken.
    pub pyramid: Option<&'a Pyramid>,
    /// Δ / u.
    pub ratio: f64,
    /// Δ, world units.
    pub distance: f64,
    /// The depth cue, if stated.
    pub cue: Option<Cue>,
    /// Dust in shafts of light, all over the domain.
    pub dust: Option<Dust>,
}

/// How far one ray is: the sample to come, where it is, and where the ray ends.
#[derive(Clone, Copy)]
pub struct Cursor {
    k: i64,
    end: i64,
    at: [i64; 3],
    /// The ray's world point at depth 0.
    origin: DVec3,
}

impl Cursor {
    /// At the first of some samples of the ray through `origin`, restricted to sample numbers `range`.
    pub fn new(walk: &Walk, samples: Samples, range: [i64; 2], origin: DVec3) -> Self {
        let end = samples.end.min(range[1]);
        let mut cursor = Self { k: samples.first, end, at: samples.at, origin };
        // `range` may begin at the least of all numbers: no difference of the two is taken before the greater is known.
        cursor.advance(walk, range[0].max(samples.first) - samples.first);
        cursor
    }

    /// A ray that meets no gel.
    pub const NOWHERE: Self = Self { k: 0, end: 0, at: [0; 3], origin: DVec3::ZERO };

    #[inline]
    pub fn advance(&mut self, walk: &Walk, steps: i64) {
        self.k += steps;
        for (at, step) in self.at.iter_mut().zip(walk.step) {
            *at += step * steps;
        }
    }

    #[inline]
    fn cell(&self) -> [usize; 3] {
        self.at.map(|p| (p >> FRACTION_BITS) as usize)
    }

    #[inline]
    fn within(&self) -> Vec3 {
        // 24 of the 40 bits behind the point: exact in an f32.
        let part = |p: i64| ((p >> (FRACTION_BITS - 24)) & 0xff_ffff) as f32 / 16_777_216.0;
        Vec3::from_array(self.at.map(part))
    }
}

impl<T: Texel> Volume<'_, T> {
    /// Goes on to the next sample before number `until` that lies in an interesting cell, and takes it: associated colour
    /// and opacity per opacity unit. The cursor stays on it. Without a pyramid that is the very next sample.
    #[inline]
    pub fn next(&self, cursor: &mut Cursor, until: i64, counts: &mut Counts) -> Option<Vec4> {
        if let Some(dust) = &self.dust {
            return self.next_dusty(dust, cursor, until, counts);
        }
        let until = until.min(cursor.end);
        while cursor.k < until {
            let cell = cursor.cell();
            let entry = self.entry(cell);
            let stored = self.gel.table()[entry];
            if let Some(level) = self.empty_level(entry, stored, cell) {
                counts.cells_skipped += 1;
                cursor.advance(&self.walk, self.leap(cursor, level));
                continue;
            }
            counts.samples += 1;
            return Some(self.sample(stored, cell, cursor));
        }
        None
    }

    /// The next sample in which there is gel or dust. Dust may be anywhere: no sample is stepped over.
    fn next_dusty(
        &self,
        dust: &Dust,
        cursor: &mut Cursor,
        until: i64,
        counts: &mut Counts,
    ) -> Option<Vec4> {
        while cursor.k < until.min(cursor.end) {
            let cell = cursor.cell();
            let stored = self.gel.table()[self.entry(cell)];
            let gel = self.sample(stored, cell, cursor);
            counts.samples += 1;
            let sample = dust.join(gel, cursor.origin, cursor.k);
            if sample.w > 0.0 {
                return Some(sample);
            }
            cursor.advance(&self.walk, 1);
        }
        None
    }

    /// The place of a cell's brick in the gel's table.
    #[inline]
    fn entry(&self, cell: [usize; 3]) -> usize {
        let [across, down, _] = self.gel.counts();
        let brick = cell.map(|c| c / CELLS);
        (brick[2] * down + brick[1]) * across + brick[0]
    }

    /// The highest level of the pyramid whose cell around `cell` is known to be empty, if its level-0 cell is.
    #[inline]
    fn empty_level(&self, entry: usize, stored: u32, cell: [usize; 3]) -> Option<u32> {
        let pyramid = self.pyramid?;
        if stored == EMPTY {
            return Some(pyramid.empty_level(entry));
        }
        let cells = pyramid.cells(stored);
        let bit = cells[cell[2] % CELLS] >> ((cell[1] % CELLS) * CELLS + cell[0] % CELLS) & 1;
        (bit == 0).then(|| empty_level_within(cells, cell))
    }

    /// The sample under the cursor; with a cue, both parts of its colour together.
    #[inline]
    fn sample(&self, stored: u32, cell: [usize; 3], cursor: &Cursor) -> Vec4 {
        let at = cursor.within();
        let sample = self.gel.sample(stored, cell, at);
        let (Some(cue), Some(ambient)) = (&self.cue, self.ambient) else { return sample };
        let factor = cue.factor((cursor.k as f64 + 0.5) * self.distance) as f32;
        let ambient = ambient.sample(stored, cell, at).truncate();
        (sample.truncate() * factor + ambient).extend(sample.w)
    }

    /// How many samples on the first one beyond the pyramid's cell of `level` around the cursor is: at least 1, and never
    /// past a sample outside that cell.
    #[inline]
    fn leap(&self, cursor: &Cursor, level: u32) -> i64 {
        if level == 0 && self.walk.is_coarse {
            return 1;
        }
        // Cells are aligned: the bits under `mask` are the place in the cell, whose complement is the room ahead.
        let mask = (1_i64 << (level + FRACTION_BITS)) - 1;
        let room = |axis: usize| {
            let ahead = (cursor.at[axis] ^ !(self.walk.step[axis] >> 63)) & mask;
            ahead as f64 * self.walk.per_step[axis]
        };
        // Written out: `f64::min` would look for NaN, which cannot be.
        let (x, y, z) = (room(0), room(1), room(2));
        let xy = if y < x { y } else { x };
        (if z < xy { z } else { xy }) as i64 + 1
    }

    /// Composites the gel of the slabs before number `until`, unless the ray is opaque to `stop` before.
    #[inline]
    pub fn gather(
        &self,
        cursor: &mut Cursor,
        until: i64,
        stop: f64,
        ray: &mut Gathered,
        counts: &mut Counts,
    ) {
        while ray.through > stop {
            let Some(sample) = self.next(cursor, until, counts) else { break };
            let (color, opacity) = self.slab(sample);
            ray.under(color, opacity);
            cursor.advance(&self.walk, 1);
        }
    }

    /// A sample as the slab of thickness Δ that it stands for.
    #[inline]
    pub fn slab(&self, sample: Vec4) -> (DVec3, f64) {
        let (color, opacity) = (sample.truncate().as_dvec3(), f64::from(sample.w).min(1.0));
        if self.ratio == 1.0 {
            return (color, opacity);
        }
        let thick = thicken(opacity, self.ratio);
        (color * recolor(opacity, thick, self.ratio), thick)
    }

    /// A ray that meets no polygon: C.
    pub fn march(&self, cursor: &mut Cursor, stop: f64, counts: &mut Counts) -> Gathered {
        let mut ray = Gathered::NOTHING;
        self.gather(cursor, i64::MAX, stop, &mut ray, counts);
        ray
    }
}

#[cfg(test)]
mod tests;
