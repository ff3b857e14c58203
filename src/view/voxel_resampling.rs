//! The picture of rays through voxels: their lattice is interpolated where pixels lie.
//!
//! A pixel that is not wider than two rays is the mean over it of cubics through the rays around: between them nothing else is
//! known. One that is wider is the mean over so many places, interpolated bilinearly, that no ray is passed over; other filters
//! than a box sum over such places.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

mod cubics;
mod lattice_walk;
mod leaning;
mod met_rays;
mod upright;

use fearless_simd::{Level, Simd, SimdBase, dispatch, f32x4, f32x8};
use glam::{DVec2, Vec4};
use rayon::prelude::*;

use super::picture::within_opacity;
use super::samples::POSITIONS;
use super::voxel_rays::VoxelRays;
use crate::components::PixelFilter;
use cubics::Cubics;
use lattice_walk::LatticeWalk;
use met_rays::MetRays;
use upright::Upright;

/// Rows of pixels that are made together.
const ROWS: usize = 16;

/// Makes the pixels of a picture of `size` of what rays saw; linear associated RGBA, row by row.
pub(super) fn pixels(rays: &VoxelRays, size: [usize; 2], filter: PixelFilter) -> Vec<[f32; 4]> {
    let mut pixels = vec![[0.0; 4]; size[0] * size[1]];
    if !rays.meet_anything() {
        return pixels;
    }
    let met = MetRays::of(rays);
    match Cubics::of(&rays.places).filter(|_| filter == PixelFilter::Box) {
        Some(cubics) => of_cubics((rays, &met), &cubics, (size, &mut pixels)),
        None => of_places((rays, &met), filter, (size[0], &mut pixels)),
    }
    pixels
}

/// Pixels that are means of cubics.
fn of_cubics(
    rays: (&VoxelRays, &MetRays),
    cubics: &Cubics,
    ([width, height], pixels): ([usize; 2], &mut [[f32; 4]]),
) {
    let level = Level::new();
    if let Some(upright) = Upright::of(rays, cubics, height) {
        let threads = rayon::current_num_threads();
        let high = height.div_ceil(4 * threads).clamp(ROWS, upright::MOST_ROWS);
        pixels.par_chunks_mut(width * high).enumerate().for_each(|(chunk, rows)| {
            dispatch!(level, simd => upright.pixels(simd, chunk * high, (width, rows)));
        });
        return;
    }
    let places = &rays.0.places;
    let rows = pixels.par_chunks_mut(width).with_min_len(ROWS);
    rows.enumerate().for_each(|(y, row)| {
        let start = places.first + places.down * y as f64;
        dispatch!(level, simd => leaning::pixels(simd, rays, (cubics, start), row));
    });
}

/// Pixels that are sums over places.
fn of_places(
    (rays, met): (&VoxelRays, &MetRays),
    filter: PixelFilter,
    (width, pixels): (usize, &mut [[f32; 4]]),
) {
    let (taps, level) = (taps(rays, filter), Level::new());
    let rows = pixels.par_chunks_mut(width).with_min_len(ROWS);
    rows.enumerate().for_each(|(y, row)| {
        if filter == PixelFilter::Mitchell {
            return summed(rays, &taps, y, row);
        }
        let start = rays.places.first + rays.places.down * y as f64;
        for &(offset, weight) in &taps {
            let of_row = (start + offset, weight);
            dispatch!(level, simd => at_places(simd, (rays, met), of_row, row));
        }
        // Weights that sum to 1 may do so but for rounding.
        for pixel in row {
            pixel[3] = pixel[3].min(1.0);
        }
    });
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
    use crate::volume::field::tests::levels;
    use crate::volume::filter::Taps;

    /// A lattice of 40 × 30 rays whose colors rise evenly, with pixels so many rays apart.
    fn slope(apart: f64) -> VoxelRays {
        let color = |at: usize| [(at % 40) as f32 / 100.0, (at / 40) as f32 / 100.0, 0.0, 0.5];
        let colors = (0..40 * 30).map(color).collect();
        let places =
            LatticePlaces::of(|window| DVec2::new(4.0 + apart * window.x, 3.0 + apart * window.y));
        VoxelRays { size: [40, 30], colors, met: vec![[0, 40]; 30], excess: 0.0, places }
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

    /// Rays that differ, some of which met nothing, under pixels of a picture that stands upright; `below` is from a pixel to
    /// the next below.
    fn upright([aside, below]: [f64; 2], size: [usize; 2]) -> VoxelRays {
        let number = |at: usize| ((at as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as f32;
        let mut met = vec![[0, 0]; size[1]];
        for (j, met) in met.iter_mut().enumerate().skip(4).take(size[1] - 9) {
            *met = [3 + j as u32 % 5, (size[0] - 4 - j % 7) as u32];
        }
        let color = |at: usize| {
            let [from, to] = met[at / size[0]].map(|end| end as usize);
            let alpha = number(4 * at) / 2.0_f32.powi(24);
            let channel = |n: usize| alpha * number(4 * at + n) / 2.0_f32.powi(24);
            let color = [channel(1), channel(2), channel(3), alpha];
            if (from..to).contains(&(at % size[0])) { color } else { [0.0; 4] }
        };
        let colors = (0..size[0] * size[1]).map(color).collect();
        let first = if below < 0.0 { size[1] as f64 - 3.0 } else { 1.7 };
        let place = |at: DVec2| DVec2::new(2.3 + 0.43 * at.x, first + aside * at.x + below * at.y);
        VoxelRays { size, colors, met, excess: 0.0, places: LatticePlaces::of(place) }
    }

    #[test]
    fn an_upright_picture_is_what_each_pixel_of_it_is_alone_with_every_set_of_instructions() {
        for steps in [[0.0, 0.4], [0.9, -0.7], [-0.13, 1.0], [0.3, 0.0], [-1.1, 1.6]] {
            let (rays, [width, height]) = (upright(steps, [64, 90]), [131, 150]);
            let made = pixels(&rays, [width, height], PixelFilter::Box);
            let (met, cubics) = (MetRays::of(&rays), Cubics::of(&rays.places).unwrap());
            let mut expected = vec![[0.0; 4]; width * height];
            for (y, row) in expected.chunks_exact_mut(width).enumerate() {
                let start = rays.places.first + rays.places.down * y as f64;
                let of_row = (&cubics, start);
                dispatch!(Level::new(), simd => leaning::pixels(simd, (&rays, &met), of_row, row));
            }
            assert!(expected.iter().filter(|pixel| pixel[3] > 0.0).count() > 1000, "{steps:?}");
            let both = || made.as_flattened().iter().zip(expected.as_flattened());
            let worst = both().map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst < 2e-6, "{steps:?} {worst}");
            for (level, high) in levels().into_iter().zip([64, 16, 37, 50]) {
                let lattice = Upright::of((&rays, &met), &cubics, height).unwrap();
                let mut again = vec![[0.0; 4]; width * height];
                for (chunk, rows) in again.chunks_mut(width * high).enumerate() {
                    dispatch!(level, simd => lattice.pixels(simd, chunk * high, (width, rows)));
                }
                assert_eq!(again, made, "{level:?} {high}");
            }
        }
    }

    #[test]
    fn a_lattice_that_leans_is_not_upright() {
        let mut rays = upright([0.2, 0.5], [60, 90]);
        rays.places.down.x = 1e-6;
        let (met, cubics) = (MetRays::of(&rays), Cubics::of(&rays.places).unwrap());
        assert!(Upright::of((&rays, &met), &cubics, 150).is_none());
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
    fn a_pixel_between_rays_is_the_mean_of_the_cubic_through_them_and_within_its_opacity() {
        let mut rays = slope(0.25);
        let heights = [0.0, 1.0, 0.0, 0.0];
        for (at, color) in rays.colors.iter_mut().enumerate() {
            *color = [heights[at % 4]; 4];
        }
        let made = pixels(&rays, [40, 8], PixelFilter::Box);
        // Pixel 4 is 5 to 5.25 rays from the first.
        let weight = |n: u8| {
            Taps::new(Filter::CatmullRom, (f32::from(n) + 0.5) / 4.0 / 64.0).weights[1] / 64.0
        };
        let pixel = made[3 * 40 + 4];
        assert!((pixel[3] - (0..64).map(weight).sum::<f32>()).abs() < 2e-3, "{pixel:?}");
        for pixel in &made {
            assert!(pixel[..3].iter().all(|c| (0.0..=pixel[3]).contains(c)) && pixel[3] <= 1.0);
        }
    }
}
