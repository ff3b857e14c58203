//! The picture of rays through voxels: their lattice is interpolated where pixels lie.
//!
//! A pixel that is smaller than the distance between rays is what lies at its middle, by cubics through the rays around: between
//! them nothing else is known. One that is larger is the mean over so many places, interpolated bilinearly, that no ray is
//! passed over; other filters than a box sum over such places.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::{Level, Simd, SimdBase, dispatch, f32x4, f32x8, f32x16, u8x16, u8x64};
use glam::{DVec2, Vec4};
use rayon::prelude::*;

use super::met_rays::MetRays;
use super::picture::within_opacity;
use super::samples::POSITIONS;
use super::voxel_rays::VoxelRays;
use crate::components::PixelFilter;

/// Bits of a place between two rays.
const FRACTION_BITS: u32 = 32;
/// A ray's distance to the next in such places.
const UNIT: f64 = (1_u64 << FRACTION_BITS) as f64;
/// Of which so many are looked at: exact in an f32.
const PLACE_BITS: u32 = 24;
/// Rows of pixels that are made together.
const ROWS: usize = 16;

/// Makes the pixels of a picture of `size` of what rays saw; linear associated RGBA, row by row.
pub(super) fn pixels(rays: &VoxelRays, size: [usize; 2], filter: PixelFilter) -> Vec<[f32; 4]> {
    let mut pixels = vec![[0.0; 4]; size[0] * size[1]];
    if !rays.meet_anything() {
        return pixels;
    }
    let taps = taps(rays, filter);
    let (met, level) = (MetRays::of(rays), Level::new());
    pixels.par_chunks_mut(size[0] * ROWS).enumerate().for_each(|(chunk, rows)| {
        for (at, row) in rows.chunks_exact_mut(size[0]).enumerate() {
            let y = chunk * ROWS + at;
            if filter == PixelFilter::Mitchell {
                summed(rays, &taps, y, row);
                continue;
            }
            let start = rays.places.first + rays.places.down * y as f64;
            if taps.len() == 1 {
                dispatch!(level, simd => at_middles(simd, (rays, &met), start, row));
                continue;
            }
            for &(offset, weight) in &taps {
                let of_row = (start + offset, weight);
                dispatch!(level, simd => at_places(simd, (rays, &met), of_row, row));
            }
            // Weights that sum to 1 may do so but for rounding.
            for pixel in row {
                pixel[3] = pixel[3].min(1.0);
            }
        }
    });
    pixels
}

/// Where a pixel's parts are on the lattice, from its middle, and their weights, which sum to 1.
fn taps(rays: &VoxelRays, filter: PixelFilter) -> Vec<(DVec2, f32)> {
    let axis = |step: DVec2| {
        // So many places a pixel that no ray is passed over, as long as they are not too many.
        let least = step.abs().max_element().ceil().clamp(1.0, 64.0) as i32;
        let (places, reach) = match filter {
            PixelFilter::Box => (least, 0),
            _ => (least.max(POSITIONS as i32), filter.reach() as i32),
        };
        let taps: Vec<(DVec2, f32)> = if reach == 0 {
            let place = |n: i32| (f64::from(n) + 0.5) / f64::from(places) - 0.5;
            (0..places).map(|n| (step * place(n), 1.0)).collect()
        } else {
            let ends = reach * places / POSITIONS as i32;
            let place = |n: i32| f64::from(n) / f64::from(places);
            let tap = |n: i32| (step * place(n), filter.weight(place(n) as f32));
            (-ends..=ends).map(tap).filter(|(_, weight)| *weight != 0.0).collect()
        };
        let sum: f32 = taps.iter().map(|(_, weight)| weight).sum();
        taps.into_iter().map(|(at, weight)| (at, weight / sum)).collect::<Vec<_>>()
    };
    let (across, down) = (axis(rays.places.right), axis(rays.places.down));
    let pair = |&(y, wy): &(DVec2, f32)| across.iter().map(move |&(x, wx)| (x + y, wx * wy));
    down.iter().flat_map(pair).collect()
}

/// A place on the lattice, and those one pixel after the other to its right, in fixed point.
struct LatticeWalk {
    at: [i64; 2],
    step: [i64; 2],
}

impl LatticeWalk {
    fn from(start: DVec2, right: DVec2) -> Self {
        let fixed = |place: DVec2| [(place.x * UNIT) as i64, (place.y * UNIT) as i64];
        Self { at: fixed(start), step: fixed(right) }
    }

    /// The ray before it along both axes, and how far it is behind that.
    #[inline(always)]
    fn next(&mut self) -> ([i64; 2], [f32; 2]) {
        let at = self.at;
        self.at = [at[0] + self.step[0], at[1] + self.step[1]];
        let part = |at: i64| {
            let part = (at >> (FRACTION_BITS - PLACE_BITS)) & ((1 << PLACE_BITS) - 1);
            part as i32 as f32 * (1.0 / (1_u32 << PLACE_BITS) as f32)
        };
        (at.map(|at| at >> FRACTION_BITS), [part(at[0]), part(at[1])])
    }
}

/// The pixels of a row, each what lies at its middle, the first at `start`: by the cubics of Catmull and Rom along both axes
/// (Keys 1981), which pass through the rays.
#[inline(always)]
fn at_middles<S: Simd>(
    simd: S,
    (rays, met): (&VoxelRays, &MetRays),
    start: DVec2,
    row: &mut [[f32; 4]],
) {
    /// Of the four rays around a place, by the powers of how far it is behind the second; along each axis. They are the weights
    /// of `volume::filter::Taps`, which, made one number after the other, take as long as all else here.
    const POWERS: [[[f32; 4]; 2]; 4] = [
        [[0.0, 1.0, 0.0, 0.0]; 2],
        [[-0.5, 0.0, 0.5, 0.0]; 2],
        [[1.0, -2.5, 2.0, -0.5]; 2],
        [[-0.5, 1.5, -1.5, 0.5]; 2],
    ];
    /// The bytes of number n in all four of block n.
    const EACH: [u8; 64] = {
        let (mut bytes, mut n) = ([0; 64], 0);
        while n < 64 {
            bytes[n] = (4 * (n / 16) + n % 4) as u8;
            n += 1;
        }
        bytes
    };
    const LAST: [u8; 16] = [12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15];
    let [none, first, second, third] = [
        f32x8::from_slice(simd, POWERS[0].as_flattened()),
        f32x8::from_slice(simd, POWERS[1].as_flattened()),
        f32x8::from_slice(simd, POWERS[2].as_flattened()),
        f32x8::from_slice(simd, POWERS[3].as_flattened()),
    ];
    let (each, last) = (u8x64::from_slice(simd, &EACH), u8x16::from_slice(simd, &LAST));
    let excess = f32x4::from_slice(simd, &[met.excess, met.excess, met.excess, 0.0]);
    let right = rays.places.right;
    let [from, to] = met.shown((start, right), row.len());
    let mut places = LatticeWalk::from(start + right * from as f64, right);
    for pixel in &mut row[from..to] {
        let ([i, j], [x, y]) = places.next();
        let Some(&[low, high]) = met.near.get(j as usize) else { continue };
        if i < low || i >= high {
            continue;
        }
        let Some([a, b, c, d]) = around(rays, [i, j]) else { continue };
        let part = simd.combine_f32x4(f32x4::splat(simd, x), f32x4::splat(simd, y));
        let weights = ((third * part + second) * part + first) * part + none;
        let (across, down) = simd.split_f32x8(weights);
        let down = down.as_slice();
        let a = f32x16::from_slice(simd, a.as_flattened()) * down[0];
        let b = f32x16::from_slice(simd, b.as_flattened()) * down[1];
        let c = f32x16::from_slice(simd, c.as_flattened()) * down[2];
        let d = f32x16::from_slice(simd, d.as_flattened()) * down[3];
        let across = simd.combine_f32x4(across, across);
        let across = simd.combine_f32x8(across, across).swizzle_dyn_within_blocks(each);
        let (left, right) = simd.split_f32x16(((a + b) + (c + d)) * across);
        let (left, right) = simd.split_f32x8(left + right);
        let color: f32x4<S> = (left + right).max(0.0);
        // What the cubics overshoot stays an opacity, and a color within it as those of rays are.
        let alpha = color.swizzle_dyn(last).min(1.0);
        color.min(alpha + excess).store_slice(pixel);
    }
}

/// The rays around a place that is [`near`](MetRays::near) some: four of four rows, the second before it along both axes.
#[inline(always)]
fn around(rays: &VoxelRays, [i, j]: [i64; 2]) -> Option<[&[[f32; 4]; 4]; 4]> {
    let across = rays.size[0];
    let first = (j as usize - 1) * across + i as usize - 1;
    let row = |n: usize| rays.colors.get(first + n * across..)?.first_chunk();
    Some([row(0)?, row(1)?, row(2)?, row(3)?])
}

/// Adds so much to the pixels of a row of what lies at places, the first at `start`, between the rays around.
#[inline(always)]
fn at_places<S: Simd>(
    simd: S,
    (rays, met): (&VoxelRays, &MetRays),
    (start, weight): (DVec2, f32),
    row: &mut [[f32; 4]],
) {
    let right = rays.places.right;
    let [from, to] = met.shown((start, right), row.len());
    let mut places = LatticeWalk::from(start + right * from as f64, right);
    for pixel in &mut row[from..to] {
        let (first, [x, y]) = places.next();
        let Some([above, below]) = pairs(rays, first) else { continue };
        let above = f32x8::from_slice(simd, above.as_flattened());
        let below = f32x8::from_slice(simd, below.as_flattened());
        let (left, right) = simd.split_f32x8((below - above) * y + above);
        let color: f32x4<S> = (right - left) * x + left;
        (color * weight + f32x4::from_slice(simd, pixel)).store_slice(pixel);
    }
}

/// The rays at the corners of a place, two of a row and the two below them; `None` outside the lattice.
#[inline(always)]
fn pairs(rays: &VoxelRays, [i, j]: [i64; 2]) -> Option<[&[[f32; 4]; 2]; 2]> {
    let [across, down] = rays.size.map(|n| n as i64);
    if i < 0 || j < 0 || i + 1 >= across || j + 1 >= down {
        return None;
    }
    let first = (j * across + i) as usize;
    let above = rays.colors.get(first..)?.first_chunk()?;
    let below = rays.colors.get(first + rays.size[0]..)?.first_chunk()?;
    Some([above, below])
}

/// The pixels of row `y`, each a sum over places.
fn summed(rays: &VoxelRays, taps: &[(DVec2, f32)], y: usize, row: &mut [[f32; 4]]) {
    for (x, pixel) in row.iter_mut().enumerate() {
        let middle = rays.places.at(DVec2::new(x as f64, y as f64) + 0.5);
        let (mut sum, mut excess) = (Vec4::ZERO, 0.0_f32);
        for &(offset, weight) in taps {
            let color = between(rays, middle + offset);
            excess = excess.max(color.max_element() - color.w);
            sum += color * weight;
        }
        *pixel = within_opacity(sum, excess).to_array();
    }
}

/// What lies at a place, between the four rays around it; nothing outside the lattice.
fn between(rays: &VoxelRays, place: DVec2) -> Vec4 {
    let first = place.floor();
    let part = (place - first).as_vec2();
    let Some(rows) = pairs(rays, [first.x as i64, first.y as i64]) else { return Vec4::ZERO };
    let [above, below] =
        rows.map(|[left, right]| Vec4::from_array(*left).lerp(Vec4::from_array(*right), part.x));
    above.lerp(below, part.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::components::Filter;
    use crate::view::voxel_rays::LatticePlaces;
    use crate::volume::filter::Taps;

    /// A lattice of 40 × 30 rays whose colors rise evenly, with pixels so many rays apart.
    fn slope(apart: f64) -> VoxelRays {
        let color = |at: usize| [(at % 40) as f32 / 100.0, (at / 40) as f32 / 100.0, 0.0, 0.5];
        let colors = (0..40 * 30).map(color).collect();
        let places =
            LatticePlaces::of(|window| DVec2::new(4.0 + apart * window.x, 3.0 + apart * window.y));
        VoxelRays { size: [40, 30], colors, met: vec![[0, 40]; 30], places }
    }

    #[test]
    fn what_rises_evenly_is_resampled_exactly_by_every_filter_and_size_of_pixel() {
        for filter in [PixelFilter::Box, PixelFilter::Tent, PixelFilter::Mitchell] {
            for apart in [0.3, 1.0, 1.7] {
                let made = pixels(&slope(apart), [9, 7], filter);
                for (at, pixel) in made.iter().enumerate().skip(9 * 3 + 3).take(3) {
                    let [x, y] = [at % 9, at / 9].map(|n| apart * (n as f64 + 0.5));
                    let expected = [(4.0 + x) / 100.0, (3.0 + y) / 100.0, 0.0, 0.5];
                    for (made, expected) in pixel.iter().zip(expected) {
                        assert!((f64::from(*made) - expected).abs() < 1e-6, "{filter:?} {apart}");
                    }
                }
            }
        }
    }

    #[test]
    fn pixels_beyond_what_rays_met_are_clear() {
        let mut rays = slope(1.0);
        let seen = pixels(&rays, [60, 50], PixelFilter::Box);
        assert_eq!(seen[59], [0.0; 4]);
        assert_eq!(seen[60 * 49], [0.0; 4]);
        rays.met = vec![[7, 7]; 30];
        assert!(pixels(&rays, [60, 50], PixelFilter::Box).iter().all(|pixel| *pixel == [0.0; 4]));
    }

    #[test]
    fn a_pixel_between_rays_is_on_the_cubic_through_them_and_within_its_opacity() {
        let mut rays = slope(0.25);
        let heights = [0.0, 1.0, 0.0, 0.0];
        for (at, color) in rays.colors.iter_mut().enumerate() {
            *color = [heights[at % 4]; 4];
        }
        let made = pixels(&rays, [40, 8], PixelFilter::Box);
        // The middle of pixel 4 is 5.125 rays from the first.
        let t: f32 = 0.125;
        let weight = |t: f32| Taps::new(Filter::CatmullRom, t).weights[1];
        let pixel = made[3 * 40 + 4];
        assert!((pixel[3] - weight(t)).abs() < 1e-6, "{pixel:?}");
        for pixel in &made {
            assert!(pixel[..3].iter().all(|c| (0.0..=pixel[3]).contains(c)) && pixel[3] <= 1.0);
        }
    }
}
