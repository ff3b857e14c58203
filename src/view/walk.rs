//! Rays through the voxels of a grid: samples at one global phase, in fixed-point voxel indices (algorithm §1).

mod affine;
mod places;

use glam::{DVec3, I64Vec3};

use super::camera::Camera;
use crate::volume::grid::Grid;
pub(crate) use affine::FRACTION_BITS;
use affine::{Affine, UNIT};
pub(crate) use places::TilePlaces;
pub use places::{LANES, SIDE};

/// Bits of a place in a cell that are looked at: exact in an f32.
pub(crate) const PLACE_BITS: u32 = 24;
/// How the samples of the rays of a view walk through a grid: sample `k` lies at depth `(k + 1/2) Δ`.
///
/// Where a ray is, and how far it goes from sample to sample, are affine over the picture, in perspective too: both are
/// fixed-point voxel indices, so that going on by n steps is exact however the n are grouped. Stepping over empty space lands
/// on the very samples that walking would have met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walk {
    /// Where rays are at sample `middle`.
    places: Affine,
    /// From each sample to the next.
    steps: Affine,
    /// The sample in the plane through the middle of the grid.
    middle: i64,
    /// The index of the last voxel, fixed-point.
    last: I64Vec3,
    /// The number of the slab that the eye is in: none before it is seen.
    nearest: i64,
    /// Whether rays are parallel.
    is_parallel: bool,
}

/// Where the sixteen rays of a tile are, side by side on each axis; ray n is the one at `(n mod 4, n / 4)`.
#[derive(Debug, Clone)]
pub struct Tile {
    /// Fixed-point voxel index at sample `middle`.
    pub at: [[i64; LANES]; 3],
    /// From each sample to the next.
    pub step: [[i64; LANES]; 3],
    /// The sample that `at` is of.
    pub middle: i64,
    /// Outside these samples, `[first, end)`, all rays are outside the grid, or before the eye.
    pub some: [i64; 2],
    /// At these, which may be none, all are inside.
    pub all: [i64; 2],
}

impl Default for Tile {
    /// Rays that are nowhere.
    fn default() -> Self {
        let none = [[0; LANES]; 3];
        Self { at: none, step: none, middle: 0, some: [i64::MAX, i64::MIN], all: [0, 0] }
    }
}

impl Walk {
    /// The walk of `camera`'s rays through `grid` with samples `distance` (world units, above 0) apart; `None` where pixels are
    /// so much larger than voxels (a million times) that no ray can be placed among them.
    ///
    /// A step is at least 2⁻⁴⁰ and at most 2²⁰ voxels along the axis that it moves most on; the error names the remedy.
    pub fn new(grid: &Grid, camera: &Camera, distance: f64) -> Result<Option<Self>, String> {
        let world_to_index = grid.world_to_index();
        let step = world_to_index.transform_vector3(camera.forward * distance);
        let most = step.abs().max_element();
        if !(1.0 / UNIT..=1_048_576.0).contains(&most) {
            return Err(format!(
                "a sample distance of {distance} is {most:.1e} voxels; choose `sampling.distance_mm` near the voxel spacing"
            ));
        }
        let last = I64Vec3::from(grid.size.map(|n| ((n - 1) as i64) << FRACTION_BITS));
        let center = grid.corners().into_iter().sum::<DVec3>() / 8.0;
        let middle = (camera.depth(center) / distance).floor() as i64;
        let depth = (middle as f64 + 0.5) * distance;
        let place = |window| world_to_index.transform_point3(camera.ray(window).at(depth));
        let go = |window| world_to_index.transform_vector3(camera.ray(window).along * distance);
        let is_parallel = camera.eye.is_none();
        let places = Affine::new(place, camera.size);
        let steps =
            if is_parallel { Some(Affine::constant(step)) } else { Affine::new(go, camera.size) };
        let nearest = camera.eye.map_or(i64::MIN, |eye| (-eye / distance).floor() as i64);
        let walk = |(places, steps)| Self { places, steps, middle, last, nearest, is_parallel };
        Ok(places.zip(steps).map(walk))
    }

    /// The rays of a tile. Those that are [scattered](TilePlaces::are_scattered) lie within the lattice that is put into it until
    /// they are [set](Self::scatter).
    #[inline]
    pub(crate) fn enter(&self, places: &TilePlaces, tile: &mut Tile) {
        if places.are_scattered() && !self.is_parallel {
            // Of rays that are not parallel each is looked at, and not those around them.
            self.scatter(places, tile);
        } else {
            self.lattice(places, tile);
        }
        tile.middle = self.middle;
        let last = self.last.as_dvec3() / UNIT;
        let ray = |lane: usize| {
            let of = |triples: &[[i64; LANES]; 3]| {
                DVec3::from(std::array::from_fn(|axis| triples[axis][lane] as f64)) / UNIT
            };
            [of(&tile.at), of(&tile.step)]
        };
        let mut whole = Within::NOWHERE;
        if self.is_parallel {
            // TilePlaces are affine over the tile: the greatest and the least are at its corners.
            let corners = [0, SIDE - 1, LANES - SIDE, LANES - 1].map(|lane| ray(lane)[0]);
            let low = corners.into_iter().fold(DVec3::INFINITY, DVec3::min);
            let high = corners.into_iter().fold(DVec3::NEG_INFINITY, DVec3::max);
            whole.join(Within::new([low, high], ray(0)[1], last));
        } else {
            for [at, step] in (0..LANES).map(ray) {
                whole.join(Within::new([at, at], step, last));
            }
        }
        let [some, all] = whole.samples(self.middle);
        tile.some = [some[0].max(self.nearest), some[1]];
        tile.all = [all[0].max(self.nearest), all[1]];
        if places.are_scattered() && !self.is_parallel {
            self.lattice(places, tile);
        }
    }

    /// Sets the rays of a tile that has been entered where they are, if they are scattered.
    pub(crate) fn scatter(&self, places: &TilePlaces, tile: &mut Tile) {
        if places.are_scattered() {
            self.places.scatter(places, &mut tile.at);
            self.steps.scatter(places, &mut tile.step);
        }
    }

    #[inline]
    fn lattice(&self, places: &TilePlaces, tile: &mut Tile) {
        self.places.tile(places.first, places.apart, &mut tile.at);
        self.steps.tile(places.first, places.apart, &mut tile.step);
    }

    /// Whether a ray of a tile is in the grid at a sample.
    #[must_use]
    pub fn holds(&self, tile: &Tile, lane: usize, k: i64) -> bool {
        let inside = |axis: usize| (0..=self.last[axis]).contains(&tile.place(axis, lane, k));
        k >= self.nearest && (0..3).all(inside)
    }

    /// From where to where a ray of a tile is in the grid, in samples: a whole number is a sample, others lie between two. It is
    /// nowhere in it where the first is not below the second.
    #[must_use]
    pub(crate) fn interval(&self, tile: &Tile, lane: usize) -> [f64; 2] {
        let of = |triples: &[[i64; LANES]; 3]| {
            DVec3::from(std::array::from_fn(|axis| triples[axis][lane] as f64)) / UNIT
        };
        let at = of(&tile.at);
        let within = Within::new([at, at], of(&tile.step), self.last.as_dvec3() / UNIT);
        let [low, high] = within.some.map(|step| step + self.middle as f64);
        [low.max(self.nearest as f64), high]
    }

    /// Whether rays are parallel.
    #[must_use]
    pub(crate) fn is_parallel(&self) -> bool {
        self.is_parallel
    }
}

impl Tile {
    /// The fixed-point voxel index of a ray at a sample, on one axis.
    #[must_use]
    #[inline]
    pub fn place(&self, axis: usize, lane: usize, k: i64) -> i64 {
        let steps = k.wrapping_sub(self.middle);
        self.at[axis][lane].wrapping_add(self.step[axis][lane].wrapping_mul(steps))
    }

    /// The fixed-point voxel index of a ray between two samples, on one axis.
    #[must_use]
    pub(crate) fn place_between(&self, axis: usize, lane: usize, k: f64) -> i64 {
        let way = self.step[axis][lane] as f64 * (k - self.middle as f64);
        self.at[axis][lane].saturating_add(way as i64)
    }

    /// The fixed-point voxel index of a ray at a sample.
    #[must_use]
    #[inline]
    pub(crate) fn at_sample(&self, lane: usize, k: i64) -> [i64; 3] {
        std::array::from_fn(|axis| self.place(axis, lane, k))
    }

    /// Whether all rays are in the grid at `n` samples from `k` on, at the one before them and at the one after.
    #[must_use]
    #[inline]
    pub(crate) fn is_inner(&self, k: i64, n: usize) -> bool {
        self.all[0] < k && k + (n as i64) < self.all[1]
    }

    /// Whether there is no sample at which a ray may be in the grid.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.some[0] >= self.some[1]
    }
}

/// A fixed-point way through a cell, 0..=1 of it, as a number.
#[must_use]
#[inline]
pub fn part(way: i64) -> f32 {
    // By way of 32 bits: of those, several become floats at once.
    (way >> (FRACTION_BITS - PLACE_BITS)) as i32 as f32 * (1.0 / (1_u32 << PLACE_BITS) as f32)
}

/// At which steps from the middle some of a bundle of rays may be in the grid, and all are for certain.
#[derive(Clone, Copy)]
struct Within {
    some: [f64; 2],
    all: [f64; 2],
}

impl Within {
    /// That of no ray.
    const NOWHERE: Self =
        Self { some: [f64::INFINITY, f64::NEG_INFINITY], all: [f64::NEG_INFINITY, f64::INFINITY] };

    /// That of rays which lie between `low` and `high` at step 0 and go by `step`, in voxels.
    fn new([low, high]: [DVec3; 2], step: DVec3, last: DVec3) -> Self {
        let (mut some, mut all) = ([f64::NEG_INFINITY, f64::INFINITY], Self::NOWHERE.all);
        let cut = |range: &mut [f64; 2], ends: [f64; 2]| {
            *range = [range[0].max(ends[0]), range[1].min(ends[1])];
        };
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        for axis in 0..3 {
            let (low, high, step, last) = (low[axis], high[axis], step[axis], last[axis]);
            if step == 0.0 {
                if high < 0.0 || low > last {
                    cut(&mut some, none);
                }
                if low < 0.0 || high > last {
                    cut(&mut all, none);
                }
            } else if step > 0.0 {
                cut(&mut some, [-high / step, (last - low) / step]);
                cut(&mut all, [-low / step, (last - high) / step]);
            } else {
                cut(&mut some, [(last - low) / step, -high / step]);
                cut(&mut all, [(last - high) / step, -low / step]);
            }
        }
        Self { some, all }
    }

    /// Takes rays in, of which there was none or some.
    fn join(&mut self, other: Self) {
        if other.some[0] <= other.some[1] + 2.0 {
            self.some = [self.some[0].min(other.some[0]), self.some[1].max(other.some[1])];
        }
        self.all = [self.all[0].max(other.all[0]), self.all[1].min(other.all[1])];
    }

    /// The samples `[first, end)` of both, a step more than rounding asks for.
    fn samples(self, middle: i64) -> [[i64; 2]; 2] {
        if self.some[0] > self.some[1] + 2.0 || self.some.iter().any(|step| step.abs() > 1e15) {
            return [[i64::MAX, i64::MIN], [0, 0]];
        }
        let [first, end] = [self.some[0].floor() - 1.0, self.some[1].ceil() + 2.0];
        let some = [first, end].map(|step| middle + step as i64);
        let [first, end] = [self.all[0].ceil() + 1.0, self.all[1].floor()];
        let all = if first < end { [first, end].map(|step| middle + step as i64) } else { [0, 0] };
        [some, all]
    }
}

#[cfg(test)]
mod tests;
