//! What a ray sees of a volume: the next interesting sample, however much empty gel lies before it (paper §6).

use glam::{DVec3, I64Vec3, Vec3, Vec4};

use super::shaft::Dust;
use crate::view::composite::{Gathered, recolor, thicken};
use crate::view::samples::Counts;
use crate::view::walk::{FRACTION_BITS, Samples, Walk};
use crate::volume::gel::{CELLS, EMPTY, Texel, TexelSlices};
use crate::volume::pyramid::{PyramidSlices, empty_level_within};

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
    pub gel: TexelSlices<'a, T>,
    /// The ambient part of its colour, where reflected light is cued.
    pub ambient: Option<TexelSlices<'a, T>>,
    /// What steps over empty gel; `None`: every sample is taken.
    pub pyramid: Option<PyramidSlices<'a>>,
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
    at: I64Vec3,
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
    pub const NOWHERE: Self = Self { k: 0, end: 0, at: I64Vec3::ZERO, origin: DVec3::ZERO };

    #[inline]
    pub fn advance(&mut self, walk: &Walk, steps: i64) {
        self.k += steps;
        self.at += walk.step * steps;
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

impl<T: Texel> Volume<'_, T> {
    /// Takes the samples before number `until` that lie in interesting cells, front to back, until `take` wants no more:
    /// associated colour and opacity per opacity unit. Without a pyramid, or in dust, that is every sample.
    #[inline]
    pub fn visit(
        &self,
        cursor: &mut Cursor,
        until: i64,
        counts: &mut Counts,
        take: impl FnMut(Vec4) -> bool,
    ) {
        let until = until.min(cursor.end);
        match self.pyramid {
            Some(pyramid) if self.dust.is_none() => {
                self.visit_interesting(pyramid, cursor, until, counts, take);
            }
            _ => self.visit_all(cursor, until, counts, take),
        }
    }

    #[inline]
    fn visit_interesting(
        &self,
        pyramid: PyramidSlices<'_>,
        cursor: &mut Cursor,
        until: i64,
        counts: &mut Counts,
        mut take: impl FnMut(Vec4) -> bool,
    ) {
        // Kept in registers: a ray spends its time in this loop.
        let Cursor { mut k, mut at, .. } = *cursor;
        let (mut skipped, mut samples) = (0, 0);
        while k < until {
            let cell = cell(at);
            let (entry, stored) = self.gel.brick(cell);
            let level = if stored == EMPTY {
                pyramid.empty_level(entry)
            } else {
                let cells = pyramid.cells(stored);
                let [x, y, z] = [cell[0] % CELLS, cell[1] % CELLS, cell[2] % CELLS];
                if cells[z] >> (y * CELLS + x) & 1 == 1 {
                    let sample = self.sample(stored, cell, at, k);
                    samples += 1;
                    k += 1;
                    at += self.walk.step;
                    if take(sample) {
                        continue;
                    }
                    break;
                }
                empty_level_within(cells, [x, y, z])
            };
            skipped += 1;
            let steps = self.leap(at, level);
            k += steps;
            at += self.walk.step * steps;
        }
        (cursor.k, cursor.at) = (k, at);
        counts.cells_skipped += skipped;
        counts.samples += samples;
    }

    fn visit_all(
        &self,
        cursor: &mut Cursor,
        until: i64,
        counts: &mut Counts,
        mut take: impl FnMut(Vec4) -> bool,
    ) {
        while cursor.k < until {
            let (k, cell) = (cursor.k, cell(cursor.at));
            let mut sample = self.sample(self.gel.brick(cell).1, cell, cursor.at, k);
            if let Some(dust) = &self.dust {
                sample = dust.join(sample, cursor.origin, k);
            }
            counts.samples += 1;
            cursor.advance(&self.walk, 1);
            if !take(sample) {
                break;
            }
        }
    }

    /// Sample `k`, at a place in a cell; with a cue, both parts of its colour together.
    #[inline]
    fn sample(&self, stored: u32, cell: [usize; 3], at: I64Vec3, k: i64) -> Vec4 {
        let at = within(at);
        let sample = self.gel.sample(stored, cell, at);
        let (Some(cue), Some(ambient)) = (&self.cue, self.ambient) else { return sample };
        let factor = cue.factor((k as f64 + 0.5) * self.distance) as f32;
        let ambient = ambient.sample(stored, cell, at).truncate();
        (sample.truncate() * factor + ambient).extend(sample.w)
    }

    /// How many samples on the first one beyond the pyramid's cell of `level` around `at` is: at least 1, and never
    /// past a sample outside that cell.
    #[inline]
    fn leap(&self, at: I64Vec3, level: u32) -> i64 {
        if level == 0 && self.walk.is_coarse {
            return 1;
        }
        // Cells are aligned: the bits under `mask` are the place in the cell, whose complement is the room ahead.
        let mask = (1_i64 << (level + FRACTION_BITS)) - 1;
        let Walk { step, per_step, .. } = self.walk;
        let ahead = |at: i64, step: i64| ((at ^ !(step >> 63)) & mask) as f64;
        let x = ahead(at.x, step.x) * per_step[0];
        let y = ahead(at.y, step.y) * per_step[1];
        let z = ahead(at.z, step.z) * per_step[2];
        // Written out: `f64::min` would look for NaN, which cannot be.
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
        if ray.through > stop {
            self.visit(cursor, until, counts, |sample| {
                let (color, opacity) = self.slab(sample);
                ray.under(color, opacity);
                ray.through > stop
            });
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
