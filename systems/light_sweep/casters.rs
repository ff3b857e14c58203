//! What attenuates a light: opacities of the volume and of polygons, read a row of a slice at a time.

use glam::Vec4;

use super::inputs::LitOpacity;
use crate::light::strength::Shear;
use crate::volume::bricks::{Bricks, EDGE, VOXELS};
use crate::volume::grid::Grid;
use crate::volume::painting::Painting;

/// Everything with an opacity, per voxel.
pub(super) struct Casters {
    /// What is relit: α in 0..=1 per opacity unit.
    pub opacity: Bricks<f32>,
    polygons: Vec<Bricks<f32>>,
}

impl Casters {
    pub fn new(source: &LitOpacity, polygons: &[Bricks<f32>], grid: &Grid) -> Self {
        let opacity = match source {
            LitOpacity::Made(opacity) => opacity.clone(),
            LitOpacity::Painted(painted, clip) => {
                alphas(&Painting::new(painted, grid, clip.as_ref()), grid.size)
            }
        };
        Self { opacity, polygons: polygons.to_vec() }
    }

    /// The opacities of row `y` of slice `slice`: α of everything there, `1 − (1 − α)(1 − α_G)`.
    ///
    /// `row` has room for whole bricks. Returns whether any opacity is above 0; all are in 0..=1, a NaN is 0.
    pub fn row(&self, shear: &Shear, (slice, y): (usize, usize), row: &mut [f32]) -> bool {
        row.fill(0.0);
        let strides = shear.axes.map(|axis| EDGE.pow(axis as u32));
        let along = shear.flip(slice);
        let first = (y % EDGE) * strides[1] + (along % EDGE) * strides[2];
        let mut any = false;
        for bricks in std::iter::once(&self.opacity).chain(&self.polygons) {
            for (x, row) in row.chunks_exact_mut(EDGE).enumerate() {
                let mut place = [0; 3];
                for (axis, brick) in shear.axes.into_iter().zip([x, y / EDGE, along / EDGE]) {
                    place[axis] = brick;
                }
                if let Some(brick) = bricks.brick(place) {
                    any |= add(brick, first, strides[0], row);
                }
            }
        }
        any
    }
}

/// Lets one row of a brick attenuate what comes through; whether it does.
fn add(brick: &[f32; VOXELS], first: usize, stride: usize, row: &mut [f32]) -> bool {
    let mut any = false;
    for (x, total) in row.iter_mut().enumerate() {
        let opacity = sound(brick[first + x * stride]);
        any |= opacity > 0.0;
        *total = if *total > 0.0 { 1.0 - (1.0 - *total) * (1.0 - opacity) } else { opacity };
    }
    any
}

/// An opacity in 0..=1; 0 for a NaN.
#[inline]
fn sound(opacity: f32) -> f32 {
    if opacity > 0.0 { opacity.min(1.0) } else { 0.0 }
}

/// The opacities of voxels that were classified and shaded already, as far as they are not cut away.
fn alphas(painting: &Painting<'_>, size: [usize; 3]) -> Bricks<f32> {
    Bricks::make(size, |place, brick| {
        let mut row = [Vec4::ZERO; EDGE];
        let [x, y, z] = place.first;
        for (dz, dy) in
            (0..place.extent[2]).flat_map(|dz| (0..place.extent[1]).map(move |dy| (dz, dy)))
        {
            let row = &mut row[..place.extent[0]];
            painting.row([x, y + dy, z + dz], row);
            let made = &mut brick[(dz * EDGE + dy) * EDGE..][..row.len()];
            made.iter_mut().zip(row).for_each(|(alpha, voxel)| *alpha = sound(voxel.w));
        }
        brick.iter().any(|&alpha| alpha > 0.0)
    })
}
