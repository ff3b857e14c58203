//! The picture of rays through voxels: their lattice is interpolated bilinearly where pixels lie.
//!
//! A pixel that is smaller than the distance between rays is what lies at its middle: between rays nothing else is known. One
//! that is larger is the mean over so many places that no ray is passed over; other filters than a box sum over places.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::{Level, Simd, SimdBase, dispatch, f32x4, f32x8};
use glam::{DVec2, Vec4};
use rayon::prelude::*;

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
    let level = Level::new();
    pixels.par_chunks_mut(size[0] * ROWS).enumerate().for_each(|(chunk, rows)| {
        for (at, row) in rows.chunks_exact_mut(size[0]).enumerate() {
            let y = chunk * ROWS + at;
            if filter == PixelFilter::Mitchell {
                summed(rays, &taps, y, row);
                continue;
            }
            // Of one place a pixel is written, of several they add up.
            for &(offset, weight) in &taps {
                let start = rays.places.first + rays.places.down * y as f64 + offset;
                let weight = (taps.len() > 1).then_some(weight);
                dispatch!(level, simd => at_places(simd, rays, (start, weight), row));
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

/// The pixels of a row, each what lies at one place, from `start` on; or, with a weight, that much more.
#[inline(always)]
fn at_places<S: Simd>(
    simd: S,
    rays: &VoxelRays,
    (start, weight): (DVec2, Option<f32>),
    row: &mut [[f32; 4]],
) {
    let right = rays.places.right;
    let [from, to] = shown(rays, start, row.len());
    let fixed = |place: DVec2| [(place.x * UNIT) as i64, (place.y * UNIT) as i64];
    let step = fixed(right);
    let mut at = fixed(start + right * from as f64);
    for pixel in &mut row[from..to] {
        let [x, y] = at.map(|at| {
            let part = (at >> (FRACTION_BITS - PLACE_BITS)) & ((1 << PLACE_BITS) - 1);
            part as i32 as f32 * (1.0 / (1_u32 << PLACE_BITS) as f32)
        });
        let [i, j] = at.map(|at| at >> FRACTION_BITS);
        at = [at[0] + step[0], at[1] + step[1]];
        let Some([above, below]) = pairs(rays, [i, j]) else { continue };
        let above = f32x8::from_slice(simd, above.as_flattened());
        let below = f32x8::from_slice(simd, below.as_flattened());
        let (left, right) = simd.split_f32x8((below - above) * y + above);
        let mut color: f32x4<S> = (right - left) * x + left;
        if let Some(weight) = weight {
            color = color * weight + f32x4::from_slice(simd, pixel);
        }
        color.store_slice(pixel);
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

/// The pixels `[from, to)` of a row outside which nothing that rays met is near.
fn shown(rays: &VoxelRays, start: DVec2, width: usize) -> [usize; 2] {
    let (mut from, mut to) = (0.0_f64, width as f64);
    let right = rays.places.right;
    for axis in 0..2 {
        // Strictly between the rays before the first and after the last that met anything; a little more, for what is rounded.
        let (low, high) = (rays.met[0][axis] as f64 - 1.001, rays.met[1][axis] as f64 + 0.001);
        let (start, step) = (start[axis], right[axis]);
        let ends = [(low - start) / step, (high - start) / step];
        if ends.iter().all(|end| end.is_finite()) {
            from = from.max(ends[0].min(ends[1]).floor());
            to = to.min(ends[0].max(ends[1]).ceil() + 1.0);
        } else if !(low..=high).contains(&start) {
            return [0, 0];
        }
    }
    if from < to { [from as usize, (to as usize).min(width)] } else { [0, 0] }
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
    use crate::view::voxel_rays::LatticePlaces;

    /// A lattice of 40 × 30 rays whose colors rise evenly, with pixels so many rays apart.
    fn slope(apart: f64) -> VoxelRays {
        let color = |at: usize| [(at % 40) as f32 / 100.0, (at / 40) as f32 / 100.0, 0.0, 0.5];
        let colors = (0..40 * 30).map(color).collect();
        let places =
            LatticePlaces::of(|window| DVec2::new(4.0 + apart * window.x, 3.0 + apart * window.y));
        VoxelRays { size: [40, 30], colors, met: [[0, 0], [40, 30]], places }
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
        rays.met = [[7, 7], [7, 7]];
        assert!(pixels(&rays, [60, 50], PixelFilter::Box).iter().all(|pixel| *pixel == [0.0; 4]));
    }
}
