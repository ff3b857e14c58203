//! Pixels whose columns keep to one place along the rows of rays: a volume stands upright in the picture, as it does in every
//! view of a turn about its axis.
//!
//! All pixels of a column need the same place between the rays of each row. So a row is interpolated once a column, and not
//! once a pixel; what is left are cubics down the columns, of which four are made side by side.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x16, i32x16, u32x16};

use super::cubics::{Cubics, Powers};
use super::lattice_walk::{FRACTION_BITS, LEAST_PART, UNSEEN_BITS, divided, fixed};
use super::leaning::four_of_row;
use super::met_rays::MetRays;
use crate::view::four_colors::{fourth, spread, sum};
use crate::view::voxel_rays::VoxelRays;

/// Columns that are made side by side.
const COLUMNS: usize = 4;
/// Most rows of pixels that are made together.
pub(super) const MOST_ROWS: usize = 64;
/// Rows of rays that these need: a pixel is no wider than two of them, across and down, and four are around each place.
const MOST_RAYS: usize = 2 * (MOST_ROWS + COLUMNS) + 4;

/// The rays of an upright lattice, and where pixels are on it, in fixed point.
pub(super) struct Upright<'a> {
    rays: &'a VoxelRays,
    met: &'a MetRays,
    cubics: &'a Cubics,
    /// Along rows of rays: of the first pixel, and from a column to the next.
    across: [i64; 2],
    /// Along columns: of the first pixel, from a column to the next, and from a row to the next.
    down: [i64; 3],
}

/// Places of four pixels of a row between the rays of their columns, in the four channels of each.
struct Places<S: Simd> {
    /// The ray before.
    whole: i32x16<S>,
    /// How far it is behind that, in fixed point.
    part: u32x16<S>,
}

impl<'a> Upright<'a> {
    /// `None` where columns of so many pixels do not keep to one place along the rows.
    pub fn of(
        (rays, met): (&'a VoxelRays, &'a MetRays),
        cubics: &'a Cubics,
        height: usize,
    ) -> Option<Self> {
        let [first, right, down] = [rays.places.first, rays.places.right, rays.places.down];
        let leans = down.x.abs() * height as f64 > f64::from(LEAST_PART);
        let across = [fixed(first.x), fixed(right.x)];
        let down = [fixed(first.y), fixed(right.y), fixed(down.y)];
        (!leans).then_some(Self { rays, met, cubics, across, down })
    }

    /// Makes rows of pixels, `width` each, from row `top` of the picture on; at most [`MOST_ROWS`].
    #[inline(always)]
    pub fn pixels<S: Simd>(&self, simd: S, top: usize, (width, rows): (usize, &mut [[f32; 4]])) {
        let [start, aside, below] = self.down;
        let start = start + top as i64 * below;
        let last = (rows.len() / width) as i64 - 1;
        let mut made = [[[0.0; 4]; COLUMNS]; MOST_RAYS];
        for left in (0..width).step_by(COLUMNS) {
            let first: [i64; COLUMNS] = std::array::from_fn(|n| start + (left + n) as i64 * aside);
            let ends = [first[0].min(first[3]), first[0].max(first[3])];
            let [low, high] = [ends[0] + (last * below).min(0), ends[1] + (last * below).max(0)];
            let low = ((low >> FRACTION_BITS) - 1).max(0);
            let high = ((high >> FRACTION_BITS) + 3).min(self.rays.size[1] as i64);
            let Some(made) = made.get_mut(..(high - low).max(0) as usize) else { continue };
            let met = self.rows_of_rays(simd, left, (low, made));
            if met[0] <= met[1] {
                let powers = &self.cubics.down;
                let columns = Columns { made, low, met, below, powers };
                columns.pixels(simd, (first, ends), self.rays.excess, (left, width, rows));
            }
        }
    }

    /// What lies in rows of rays, from row `low` on, at the places of the columns from `left` on: `made`; the first and the last
    /// row that has anything near.
    #[inline(always)]
    fn rows_of_rays<S: Simd>(
        &self,
        simd: S,
        left: usize,
        (low, made): (i64, &mut [[[f32; 4]; COLUMNS]]),
    ) -> [i64; 2] {
        let [none, first, second, third] = [0, 1, 2, 3];
        macro_rules! power {
            ($power:expr) => {
                f32x4::from_slice(simd, &self.cubics.across[$power])
            };
        }
        let mut met = [i64::MAX, i64::MIN];
        for n in 0..COLUMNS {
            let (i, part) = divided(self.across[0] + (left + n) as i64 * self.across[1]);
            let weights = (power!(third) * part + power!(second)) * part + power!(first);
            let weights = spread(simd, weights * part + power!(none));
            for (j, made) in (low..).zip(made.iter_mut()) {
                let near = self.met.near.get(j as usize).filter(|near| i >= near[0] && i < near[1]);
                let Some(four) = near.and_then(|_| four_of_row(self.rays, [i, j])) else {
                    made[n] = [0.0; 4];
                    continue;
                };
                met = [met[0].min(j), met[1].max(j)];
                let four = f32x16::from_slice(simd, four.as_flattened()) * weights;
                sum(simd, four).store_slice(&mut made[n]);
            }
        }
        met
    }
}

/// Four columns of places in rows of rays.
struct Columns<'m> {
    made: &'m [[[f32; 4]; COLUMNS]],
    /// The row of the first.
    low: i64,
    /// The first and the last that have anything.
    met: [i64; 2],
    /// From a pixel to the next below.
    below: i64,
    /// What rows of rays count.
    powers: &'m Powers,
}

impl Columns<'_> {
    /// Makes the pixels of the columns from `left` on, of which those of the first row are at `first`, between two `ends`.
    #[inline(always)]
    fn pixels<S: Simd>(
        &self,
        simd: S,
        (first, ends): ([i64; COLUMNS], [i64; 2]),
        excess: f32,
        (left, width, rows): (usize, usize, &mut [[f32; 4]]),
    ) {
        let excess = [[excess, excess, excess, 0.0]; COLUMNS];
        let excess = f32x16::from_slice(simd, excess.as_flattened());
        let clear = f32x16::splat(simd, 0.0);
        let mut places = Places::<S>::of(simd, first);
        // Of four pixels the one that comes to a ray last, and the one that comes to it first.
        let (mut behind, mut ahead) =
            if self.below < 0 { (ends[1], ends[0]) } else { (ends[0], ends[1]) };
        let toward = self.below.signum() | 1;
        let (mut known, mut cubics) = (i64::MIN, [clear; 4]);
        for row in rows.chunks_exact_mut(width) {
            let part = places.part(simd);
            let (mut j, last) = (behind >> FRACTION_BITS, ahead >> FRACTION_BITS);
            let mut color = clear;
            loop {
                if j + 2 >= self.met[0] && j - 1 <= self.met[1] {
                    if j != known {
                        (known, cubics) = (j, self.cubics(simd, j).unwrap_or([clear; 4]));
                    }
                    let [none, first, second, third] = cubics;
                    let here = ((third * part + second) * part + first) * part + none;
                    color = places.whole.simd_eq(j as i32).select(here, color);
                }
                if j == last {
                    break;
                }
                j += toward;
            }
            // What the cubics overshoot stays an opacity, and a color within it as those of rays are.
            let color = color.max(0.0);
            let alpha = fourth(simd, color).min(1.0);
            let color = color.min(alpha + excess);
            if let Some(four) = row[left..].first_chunk_mut::<COLUMNS>() {
                color.store_slice(four.as_flattened_mut());
            } else {
                let row = row[left..].as_flattened_mut();
                row.copy_from_slice(&color.as_slice()[..row.len()]);
            }
            places.step(simd, self.below);
            (behind, ahead) = (behind + self.below, ahead + self.below);
        }
    }

    /// The cubics from row `j` of rays to the next, by the powers of a place between the two; `None` where a row is missing.
    #[inline(always)]
    fn cubics<S: Simd>(&self, simd: S, j: i64) -> Option<[f32x16<S>; 4]> {
        let first = usize::try_from(j - 1 - self.low).ok()?;
        let rows: &[[[f32; 4]; COLUMNS]; 4] = self.made.get(first..)?.first_chunk()?;
        macro_rules! row {
            ($n:expr) => {
                f32x16::from_slice(simd, rows[$n].as_flattened())
            };
        }
        let [before, at, next, beyond] = [row!(0), row!(1), row!(2), row!(3)];
        macro_rules! power {
            ($n:expr) => {{
                let [a, b, c, d] = self.powers[$n];
                (before * a + at * b) + (next * c + beyond * d)
            }};
        }
        Some([power!(0), power!(1), power!(2), power!(3)])
    }
}

impl<S: Simd> Places<S> {
    #[inline(always)]
    fn of(simd: S, at: [i64; COLUMNS]) -> Self {
        let whole: [i32; 16] = std::array::from_fn(|n| (at[n / 4] >> FRACTION_BITS) as i32);
        let part: [u32; 16] = std::array::from_fn(|n| at[n / 4] as u32);
        Self { whole: i32x16::from_slice(simd, &whole), part: u32x16::from_slice(simd, &part) }
    }

    /// How far they are behind the rays before them, 0..1.
    #[inline(always)]
    fn part(&self, simd: S) -> f32x16<S> {
        let part: i32x16<S> = (self.part >> UNSEEN_BITS).bitcast();
        part.to_float::<f32x16<S>>() * f32x16::splat(simd, LEAST_PART)
    }

    /// Those so much further.
    #[inline(always)]
    fn step(&mut self, simd: S, by: i64) {
        let whole = (by >> FRACTION_BITS) as i32;
        let part = self.part + u32x16::splat(simd, by as u32);
        let carried = part.simd_lt(self.part);
        let [whole, next] = [whole, whole + 1].map(|by| i32x16::splat(simd, by));
        self.whole += carried.select(next, whole);
        self.part = part;
    }
}
