//! Pixels one by one: however their lattice leans in the picture, each is made of the sixteen rays around.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::{Simd, SimdBase, f32x4, f32x8, f32x16, u8x16};
use glam::DVec2;

use super::cubics::Cubics;
use super::lattice_walk::LatticeWalk;
use super::met_rays::MetRays;
use crate::view::four_colors::{spread, sum};
use crate::view::voxel_rays::VoxelRays;

/// The pixels of a row, the first at `start`.
#[inline(always)]
pub(super) fn pixels<S: Simd>(
    simd: S,
    (rays, met): (&VoxelRays, &MetRays),
    (cubics, start): (&Cubics, DVec2),
    row: &mut [[f32; 4]],
) {
    const LAST: [u8; 16] = [12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15, 12, 13, 14, 15];
    macro_rules! both_axes {
        ($power:expr) => {
            f32x8::from_slice(simd, [cubics.across[$power], cubics.down[$power]].as_flattened())
        };
    }
    let [none, first] = [both_axes!(0), both_axes!(1)];
    let [second, third] = [both_axes!(2), both_axes!(3)];
    let last = u8x16::from_slice(simd, &LAST);
    let excess = f32x4::from_slice(simd, &[rays.excess, rays.excess, rays.excess, 0.0]);
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
        let columns = ((a + b) + (c + d)) * spread(simd, across);
        let color: f32x4<S> = sum(simd, columns).max(0.0);
        // What the cubics overshoot stays an opacity, and a color within it as those of rays are.
        let alpha = color.swizzle_dyn(last).min(1.0);
        color.min(alpha + excess).store_slice(pixel);
    }
}

/// The rays around a place that is [`near`](MetRays::near) some: four of four rows, the second before it along both axes.
#[inline(always)]
fn around(rays: &VoxelRays, [i, j]: [i64; 2]) -> Option<[&[[f32; 4]; 4]; 4]> {
    let row = |n| four_of_row(rays, [i, j + n]);
    Some([row(-1)?, row(0)?, row(1)?, row(2)?])
}

/// Four rays of row `j`, the second of which is ray `i`.
#[inline(always)]
pub(super) fn four_of_row(rays: &VoxelRays, [i, j]: [i64; 2]) -> Option<&[[f32; 4]; 4]> {
    let first = j as usize * rays.size[0] + i as usize - 1;
    rays.colors.get(first..)?.first_chunk()
}
