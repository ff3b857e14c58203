//! A ray through the voxels of a grid: samples at one global phase, in fixed-point voxel indices (algorithm §1).

use glam::{DAffine3, DVec3, I64Vec3};

use super::camera::Camera;
use super::ray::Ray;
use crate::volume::grid::Grid;

/// Bits of a voxel index behind the point.
pub const FRACTION_BITS: u32 = 40;
const UNIT: f64 = (1_u64 << FRACTION_BITS) as f64;

/// How the samples of the rays of a view walk through a grid: sample `k` lies at depth `(k + 1/2) Δ`.
///
/// Positions are fixed-point voxel indices, so that going on by n steps is exact however the n are grouped: stepping
/// over empty space lands on the very samples that walking would have met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walk {
    world_to_index: DAffine3,
    /// Δ, world units.
    distance: f64,
    last: I64Vec3,
    /// The stride that all rays share, if they are parallel.
    parallel: Option<Stride>,
    /// The number of the slab that the eye is in: none before it is seen.
    nearest: i64,
}

/// The way from a sample of a ray to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stride {
    /// Voxel indices, fixed-point.
    pub step: I64Vec3,
    /// 1 / |step|, a hair less, in 1 / fixed-point units; huge along an axis that the ray does not move on.
    pub per_step: [f64; 3],
    /// Whether a step is half a voxel or more: then a cell of eight voxels is not worth a leap.
    pub is_coarse: bool,
}

impl Stride {
    fn new(step: DVec3) -> Self {
        let is_coarse = step.abs().max_element() >= 0.5;
        let step = step.to_array().map(|s| (s * UNIT).round() as i64);
        let per_step = step.map(|s| ((1.0 - 1e-12) / (s.unsigned_abs() as f64)).min(1e60));
        Self { step: I64Vec3::from(step), per_step, is_coarse }
    }

    /// The stride of a ray that goes nowhere.
    pub const NONE: Self = Self { step: I64Vec3::ZERO, per_step: [1e60; 3], is_coarse: true };

    /// How many samples on the first one outside a cell of 2^`level` voxels a side is, from fixed-point voxel index `at` in
    /// that cell: at least 1, and never past a sample outside it. Cells are aligned.
    #[must_use]
    #[inline]
    pub fn leap(&self, at: I64Vec3, level: u32) -> i64 {
        if level == 0 && self.is_coarse {
            return 1;
        }
        // The bits under `mask` are the place in the cell, whose complement is the room ahead.
        let mask = (1_i64 << (level + FRACTION_BITS)) - 1;
        let Self { step, per_step, .. } = *self;
        let ahead = |at: i64, step: i64| ((at ^ !(step >> 63)) & mask) as f64;
        let x = ahead(at.x, step.x) * per_step[0];
        let y = ahead(at.y, step.y) * per_step[1];
        let z = ahead(at.z, step.z) * per_step[2];
        // Written out: `f64::min` would look for NaN, which cannot be.
        let xy = if y < x { y } else { x };
        (if z < xy { z } else { xy }) as i64 + 1
    }
}

/// The samples of one ray that lie in the domain: numbers `first..end`, and where the first of them is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Samples {
    /// Number of the first sample.
    pub first: i64,
    /// One past the number of the last.
    pub end: i64,
    /// Fixed-point voxel index of sample `first`.
    pub at: I64Vec3,
    /// From each sample to the next.
    pub stride: Stride,
}

impl Walk {
    /// The walk of `camera`'s rays through `grid` with samples `distance` (world units, above 0) apart.
    ///
    /// A step is at least 2⁻⁴⁰ and at most 2²⁰ voxels along the axis that it moves most on; the error names the remedy.
    pub fn new(grid: &Grid, camera: &Camera, distance: f64) -> Result<Self, String> {
        let world_to_index = grid.world_to_index();
        let step = world_to_index.transform_vector3(camera.forward * distance);
        let most = step.abs().max_element();
        if !(1.0 / UNIT..=1_048_576.0).contains(&most) {
            return Err(format!(
                "a sample distance of {distance} is {most:.1e} voxels; choose `sampling.distance_mm` near the voxel spacing"
            ));
        }
        let last = I64Vec3::from(grid.size.map(|n| ((n - 1) as i64) << FRACTION_BITS));
        let parallel = camera.eye.is_none().then(|| Stride::new(step));
        let nearest = camera.eye.map_or(i64::MIN, |eye| (-eye / distance).floor() as i64);
        Ok(Self { world_to_index, distance, last, parallel, nearest })
    }

    /// The samples in the domain of a ray, from the slab on that the eye is in; `None` if there are none.
    #[must_use]
    pub fn enter(&self, ray: &Ray) -> Option<Samples> {
        let stride = self.parallel.unwrap_or_else(|| {
            Stride::new(self.world_to_index.transform_vector3(ray.along * self.distance))
        });
        let start = self.world_to_index.transform_point3(ray.at(0.5 * self.distance));
        // The interval in steps from `start`, in floating point, is widened by a step and then cut exactly.
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let (from, step) = (start[axis], stride.step[axis] as f64 / UNIT);
            let last = (self.last[axis] >> FRACTION_BITS) as f64;
            if stride.step[axis] == 0 {
                if !(0.0..=last).contains(&from) {
                    return None;
                }
            } else {
                let (a, b) = (-from / step, (last - from) / step);
                low = low.max(a.min(b));
                high = high.min(a.max(b));
            }
        }
        if low > high + 2.0 || low.abs() > 1e15 || high.abs() > 1e15 {
            return None;
        }
        let samples = self.cut(start, stride, low.floor() as i64 - 1, high.ceil() as i64 + 2)?;
        samples.from(self.nearest)
    }

    /// How long a ray's way through a slab is, against that of a ray on the line of sight: 1 or more, exactly 1 for
    /// parallel rays.
    #[must_use]
    pub fn stretch(&self, ray: &Ray) -> f64 {
        if self.parallel.is_some() { 1.0 } else { ray.along.length() }
    }

    /// Exactly the samples of `first..end` that are inside, positions counted from the first of them.
    fn cut(&self, start: DVec3, stride: Stride, first: i64, end: i64) -> Option<Samples> {
        let Stride { step, .. } = stride;
        let middle = first + (end - first) / 2;
        let place = start + (step.as_dvec3() / UNIT) * middle as f64;
        let place = (place * UNIT).round().as_i64vec3();
        let at = |k: i64| place + step * (k - middle);
        let inside = |k: i64| {
            let at = at(k);
            at.cmpge(I64Vec3::ZERO).all() && at.cmple(self.last).all()
        };
        let first = (first..end.min(first + 6)).find(|&k| inside(k))?;
        let last = (first.max(end - 6)..end).rev().find(|&k| inside(k))?;
        Some(Samples { first, end: last + 1, at: at(first), stride })
    }
}

impl Samples {
    /// Those of number `first` and above; `None` if there are none.
    #[must_use]
    pub fn from(self, first: i64) -> Option<Self> {
        if first <= self.first {
            return Some(self);
        }
        let at = self.at + self.stride.step * first.min(self.end).saturating_sub(self.first);
        (first < self.end).then_some(Self { first, at, ..self })
    }
}

#[cfg(test)]
mod tests;
