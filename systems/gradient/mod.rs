//! `gradient`: ∇f at every voxel by central differences, one-sided at the borders, in world units (algorithm §2).
//!
//! Differences are taken in index space, from numbers of the scanner's own type, and brought to the world by the
//! inverse transpose of the grid's matrix: that is right for anisotropic, flipped and sheared grids alike.

use glam::Mat3;
use hecs::{Entity, World};
use rayon::prelude::*;

use crate::components::{Classify, OpacityUnit};
use crate::error::Error;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::shared::Shared;
use crate::volume::grid::{Grid, Scalar, Scalars};
use crate::volume::layer::Gradient;
use crate::volume::scene_volumes::{Content, with_content};
use crate::with_scalars;

/// Makes the [`Gradient`] of every volume that is to be classified.
pub struct TakeGradient;

impl System for TakeGradient {
    type Product = Gradient;
    const NAME: &'static str = "gradient";
    const READS: &'static [ProductKey] = &[];

    fn run(world: &World, out: &mut Outbox<'_, Gradient>) -> Result<(), Error> {
        let watch = out.watch();
        let mut volumes =
            world.query::<(Entity, &Scalars, &Grid)>().with::<(&Classify, &OpacityUnit)>();
        for (entity, scalars, grid) in &mut volumes {
            out.derive(entity, (scalars.clone(), *grid), |(scalars, grid)| {
                Ok(Gradient(Shared::new(gradient(scalars, grid, watch)?)))
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let voxel = size_of::<[f32; 3]>() as u64;
        let bytes = |size: [usize; 3]| size.iter().fold(voxel, |n, &m| n.saturating_mul(m as u64));
        let makes: Vec<_> = with_content(world, Content::Classified)
            .iter()
            .map(|v| (v.entity, bytes(v.size())))
            .collect();
        if makes.is_empty() {
            return Plan::absent("no volume of scalars states `classify`");
        }
        Plan { makes, why: "`classify` needs the gradient of the scalars" }
    }
}

fn gradient(scalars: &Scalars, grid: &Grid, watch: &Watch) -> Result<Vec<[f32; 3]>, Error> {
    let to_world = grid.index_to_world.matrix3.inverse().transpose();
    let diagonal = [to_world.x_axis.x, to_world.y_axis.y, to_world.z_axis.z];
    with_scalars!(scalars, values => {
        if glam::DMat3::from_diagonal(diagonal.into()) == to_world {
            let scale = diagonal.map(|s| s as f32);
            differences(values, grid.size, watch, |d| [d[0] * scale[0], d[1] * scale[1], d[2] * scale[2]])
        } else {
            let matrix: Mat3 = to_world.as_mat3();
            differences(values, grid.size, watch, |d| (matrix * glam::Vec3::from(d)).to_array())
        }
    })
}

/// The differences per voxel of every voxel, each passed through `to_world`.
fn differences<T: Scalar>(
    values: &[T],
    [nx, ny, nz]: [usize; 3],
    watch: &Watch,
    to_world: impl Fn([f32; 3]) -> [f32; 3] + Sync,
) -> Result<Vec<[f32; 3]>, Error> {
    let mut made = vec![[0.0; 3]; values.len()];
    watch.expect(nz as u64);
    made.par_chunks_mut(nx * ny).enumerate().try_for_each(|(z, slab)| -> Result<(), Error> {
        watch.check()?;
        let line = |y: usize, z: usize| &values[(z * ny + y) * nx..][..nx];
        let (z0, z1, per_z) = neighbours(z, nz);
        for (y, row) in slab.chunks_mut(nx).enumerate() {
            let (y0, y1, per_y) = neighbours(y, ny);
            let lines = Lines {
                x: line(y, z),
                y: [line(y0, z), line(y1, z)],
                z: [line(y, z0), line(y, z1)],
                per: [per_y, per_z],
            };
            lines.differences(row, &to_world);
        }
        watch.advance();
        Ok(())
    })?;
    Ok(made)
}

/// The neighbours of voxel `at` of `n` on an axis, itself at a border, and 1 / the distance between them.
fn neighbours(at: usize, n: usize) -> (usize, usize, f32) {
    let (low, high) = (at.saturating_sub(1), (at + 1).min(n - 1));
    (low, high, if high - low == 2 { 0.5 } else { 1.0 })
}

/// A line of voxels along x, and its neighbours below and above on the other axes.
struct Lines<'a, T> {
    x: &'a [T],
    y: [&'a [T]; 2],
    z: [&'a [T]; 2],
    /// 1 / the distance between those neighbours, in voxels.
    per: [f32; 2],
}

impl<T: Scalar> Lines<'_, T> {
    fn differences(&self, row: &mut [[f32; 3]], to_world: &impl Fn([f32; 3]) -> [f32; 3]) {
        let last = self.x.len() - 1;
        row[0] = self.at(0, self.x[1].minus(self.x[0]), to_world);
        row[last] = self.at(last, self.x[last].minus(self.x[last - 1]), to_world);
        // Slices of one length, so that the inner loop checks no bounds and runs in lanes.
        let inside = last - 1;
        let (left, right) = (&self.x[..inside], &self.x[2..][..inside]);
        let [y0, y1] = self.y.map(|line| &line[1..][..inside]);
        let [z0, z1] = self.z.map(|line| &line[1..][..inside]);
        let [per_y, per_z] = self.per;
        for (i, made) in row[1..last].iter_mut().enumerate() {
            *made = finite(to_world([
                right[i].minus(left[i]) * 0.5,
                y1[i].minus(y0[i]) * per_y,
                z1[i].minus(z0[i]) * per_z,
            ]));
        }
    }

    fn at(&self, i: usize, along_x: f32, to_world: &impl Fn([f32; 3]) -> [f32; 3]) -> [f32; 3] {
        let [along_y, along_z] = [self.y, self.z].map(|[low, high]| high[i].minus(low[i]));
        finite(to_world([along_x, along_y * self.per[0], along_z * self.per[1]]))
    }
}

/// The gradient itself, or zero if it needed a NaN or an infinite scalar.
#[inline]
fn finite(gradient: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = gradient;
    // One test for all three: 0 times a number is 0, times anything else NaN.
    if x * 0.0 + y * 0.0 + z * 0.0 == 0.0 { gradient } else { [0.0; 3] }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3, DVec3};

    use super::*;

    const SIZE: [usize; 3] = [7, 5, 6];

    fn made(grid: &Grid, field: impl Fn(DVec3) -> f64) -> Vec<[f32; 3]> {
        let [nx, ny, _] = grid.size;
        let values = (0..grid.voxels()).map(|at| {
            let index = [at % nx, at / nx % ny, at / (nx * ny)].map(|n| n as f64);
            field(grid.index_to_world.transform_point3(index.into())) as f32
        });
        let scalars = Scalars::F32(Shared::new(values.collect()));
        gradient(&scalars, grid, &Watch::default()).unwrap()
    }

    fn worst(made: &[[f32; 3]], expected: DVec3) -> f64 {
        let error = |g: &[f32; 3]| (glam::Vec3::from(*g).as_dvec3() - expected).length();
        made.iter().map(error).fold(0.0, f64::max)
    }

    #[test]
    fn a_linear_field_is_exact_on_anisotropic_flipped_and_sheared_grids() {
        let slope = DVec3::new(3.0, -2.0, 0.5);
        let mut grids: Vec<_> = [[1.0, 1.0, 1.0], [0.5, 2.0, 4.0], [-0.5, 2.0, -1.0]]
            .map(|spacing| Grid::axis_aligned(SIZE, spacing, [4.0, -8.0, 2.0]).unwrap())
            .to_vec();
        let shear = DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.5, 2.0, 0.0, -0.25, 0.5, 1.5]);
        let turned = DMat3::from_cols_array(&[0.0, 2.0, 0.0, 0.0, 0.0, -1.0, 0.5, 0.0, 0.0]);
        grids.extend([shear, turned].map(|matrix3| {
            Grid::new(SIZE, DAffine3 { matrix3, translation: DVec3::ONE }).unwrap()
        }));
        for grid in grids {
            let made = made(&grid, |p| 7.0 + slope.dot(p));
            assert!(worst(&made, slope) < 4e-6, "{grid:?}: {}", worst(&made, slope));
        }
    }

    #[test]
    fn the_error_on_a_sine_falls_with_the_square_of_the_spacing() {
        let error = |h: f64| {
            let grid = Grid::axis_aligned([3; 3], [h; 3], [0.4 - h; 3]).unwrap();
            let made = made(&grid, |p| p.x.sin() + p.y.sin() + p.z.sin());
            worst(&made[13..14], DVec3::splat(0.4_f64.cos()))
        };
        let ratio = error(0.4) / error(0.2);
        assert!((3.9..4.1).contains(&ratio), "{ratio}");
    }

    #[test]
    fn integers_subtract_exactly_and_without_overflow() {
        let grid = Grid::axis_aligned([2; 3], [1.0; 3], [0.0; 3]).unwrap();
        let values = [0, u64::MAX, 1 << 62, (1 << 62) + 3, 5, 4, 3, 2];
        let scalars = Scalars::U64(Shared::new(values.to_vec()));
        let made = gradient(&scalars, &grid, &Watch::default()).unwrap();
        assert_eq!(made[2][0], 3.0);
        assert_eq!(made[4], [-1.0, -2.0, 5.0]);
        assert_eq!(made[0][0], u64::MAX as f32);
    }

    #[test]
    fn a_gradient_that_needs_a_nan_is_zero_and_no_other() {
        let grid = Grid::axis_aligned([5; 3], [1.0; 3], [0.0; 3]).unwrap();
        let middle = DVec3::splat(2.0);
        let made = made(&grid, |p| if p == middle { f64::NAN } else { p.x });
        let zero = made.iter().filter(|g| **g == [0.0; 3]).count();
        assert_eq!((zero, made[62]), (6, [1.0, 0.0, 0.0]));
        assert!(made.iter().flatten().all(|c| c.is_finite()));
    }
}
