//! Facts about gradients: exact where they can be, of second order elsewhere, finite always.

use glam::DAffine3;

use super::*;
use crate::shared::Shared;

const SIZE: [usize; 3] = [7, 5, 6];

fn made(grid: &Grid, field: impl Fn(DVec3) -> f64) -> Vec<[f32; 3]> {
    let [nx, ny, _] = grid.size;
    let values = (0..grid.voxels()).map(|at| {
        let index = [at % nx, at / nx % ny, at / (nx * ny)].map(|n| n as f64);
        field(grid.index_to_world.transform_point3(index.into())) as f32
    });
    let scalars = Scalars::F32(Shared::new(values.collect()));
    all(&scalars, grid)
}

/// The gradients of all voxels, taken in rows of every length.
fn all(scalars: &Scalars, grid: &Grid) -> Vec<[f32; 3]> {
    let [nx, ny, nz] = grid.size;
    let gradients = Gradients::new(grid);
    let mut made = vec![[0.0; 3]; grid.voxels()];
    with_scalars!(scalars, values => for (at, line) in made.chunks_mut(nx).enumerate() {
        let (y, z) = (at % ny, at / ny);
        let mut x = 0;
        for row in line.chunks_mut(1 + at % nx) {
            gradients.row(values, [x, y, z], row);
            x += row.len();
        }
    });
    assert_eq!(made[nx * ny * nz - 1], gradients.of(scalars, [nx - 1, ny - 1, nz - 1]));
    made
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
    grids
        .extend([shear, turned].map(|matrix3| {
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
    let made = all(&scalars, &grid);
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

#[test]
fn no_gradient_is_longer_than_the_spread_of_the_scalars_allows() {
    let shear = DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.5, 2.0, 0.0, -0.25, 0.5, 1.5]);
    let flipped = DMat3::from_diagonal(DVec3::new(0.5, -2.0, 1e-3));
    for (matrix3, scale) in [(shear, 1.0), (flipped, 1.0), (shear, 1e-44), (flipped, 1e30)] {
        let grid = Grid::new(SIZE, DAffine3 { matrix3, translation: DVec3::ONE }).unwrap();
        let values = (0..grid.voxels()).map(|at| (at * 73 % 17) as f32 * scale).collect();
        let made = all(&Scalars::F32(Shared::new(values)), &grid);
        let gradients = Gradients::new(&grid);
        let longest = |block: [usize; 3], extent: [usize; 3]| {
            let inside = |at: &usize| {
                let voxel = [at % 7, at / 7 % 5, at / 35];
                (0..3).all(|a| voxel[a] >= block[a] && voxel[a] < block[a] + extent[a])
            };
            let lengths = (0..made.len()).filter(inside).map(|at| Vec3::from(made[at]).as_dvec3());
            lengths.map(DVec3::length).fold(0.0, f64::max)
        };
        for (first, extent) in [([0; 3], SIZE), ([1; 3], [5, 3, 4]), ([2; 3], [1; 3])] {
            let (length, limit) =
                (longest(first, extent), gradients.at_most(16.0 * scale, first, extent));
            assert!(length <= limit && limit.is_finite(), "{length} {limit}");
        }
        assert_eq!(gradients.at_most(0.0, [0; 3], SIZE), 0.0);
    }
}

#[test]
fn a_normal_has_length_one_however_steep_or_shallow_the_field() {
    for length in [f32::MIN_POSITIVE / 1e6, 1e-20, 1.0, 1e30, f32::MAX / 2.0] {
        let made = normal([0.0, length, 0.0]);
        assert_eq!(made, Vec3::NEG_Y, "{length}");
        assert!((normal([length, length, -length]).length() - 1.0).abs() < 1e-6);
    }
    assert_eq!(normal([0.0; 3]), Vec3::ZERO);
}
