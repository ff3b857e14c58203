//! What a ray sees of a volume: the next interesting sample, however much empty gel lies before it (paper §6).

use glam::{DVec3, Vec3, Vec4};

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
}

/// How far one ray is: the sample to come, where it is, and where the ray ends.
#[derive(Clone, Copy)]
pub struct Cursor {
    k: i64,
    end: i64,
    at: [i64; 3],
}

impl Cursor {
    /// At the first of some samples, restricted to sample numbers `range`.
    pub fn new(walk: &Walk, samples: Samples, range: [i64; 2]) -> Self {
        let mut cursor = Self { k: samples.first, end: samples.end.min(range[1]), at: samples.at };
        // `range` may begin at the least of all numbers: no difference of the two is taken before the greater is known.
        cursor.advance(walk, range[0].max(samples.first) - samples.first);
        cursor
    }

    /// A ray that meets no gel.
    pub const NOWHERE: Self = Self { k: 0, end: 0, at: [0; 3] };

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
    /// Goes on to the next sample before number `until` that lies in an interesting cell, and takes it: its depth's
    /// number, and associated colour and opacity per opacity unit. The cursor stays on it.
    #[inline]
    pub fn next(&self, cursor: &mut Cursor, until: i64, counts: &mut Counts) -> Option<Vec4> {
        let counts_of_bricks = self.gel.counts();
        let until = until.min(cursor.end);
        while cursor.k < until {
            let cell = cursor.cell();
            let brick = cell.map(|c| c / CELLS);
            let entry =
                (brick[2] * counts_of_bricks[1] + brick[1]) * counts_of_bricks[0] + brick[0];
            let stored = self.gel.table()[entry];
            let empty = match self.pyramid {
                Some(pyramid) if stored == EMPTY => Some(pyramid.empty_level(entry)),
                Some(pyramid) => {
                    let cells = pyramid.cells(stored);
                    let bit =
                        cells[cell[2] % CELLS] >> ((cell[1] % CELLS) * CELLS + cell[0] % CELLS) & 1;
                    (bit == 0).then(|| empty_level_within(cells, cell))
                }
                None => None,
            };
            if let Some(level) = empty {
                counts.cells_skipped += 1;
                cursor.advance(&self.walk, self.leap(cursor, cell, level));
                continue;
            }
            counts.samples += 1;
            if stored != EMPTY {
                return Some(self.sample(stored, cell, cursor));
            }
            cursor.advance(&self.walk, 1);
        }
        None
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

    /// How many samples on the first one beyond the pyramid's cell of `level` around `cell` is: at least 1, and never
    /// past a sample outside the cell.
    #[inline]
    fn leap(&self, cursor: &Cursor, cell: [usize; 3], level: u32) -> i64 {
        let mut inside = f64::INFINITY;
        for axis in [0, 1, 2] {
            let step = self.walk.step[axis];
            let low = ((cell[axis] >> level) << level) as i64;
            let room = if step > 0 {
                ((low + (1 << level)) << FRACTION_BITS) - 1 - cursor.at[axis]
            } else {
                cursor.at[axis] - (low << FRACTION_BITS)
            };
            inside = inside.min(room as f64 * self.walk.per_step[axis]);
        }
        // `inside` is infinite only if the rays stand still, which `Walk::new` refuses.
        inside as i64 + 1
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
