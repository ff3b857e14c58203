//! Lights from everywhere, through grids that are flipped, anisotropic, sheared and turned.

use gelray::components::CastsShadow;
use gelray::volume::grid::Grid;
use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::setup::{NO_BIAS, Scene, at, beta, cubes, noise, point, voxels};

const LIGHTS: [[f64; 3]; 12] = [
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, -1.0, 1.0],
    [0.3, -0.5, 0.9],
    [-0.9, 0.2, -0.35],
];

/// Distance that light has gone in the domain of `grid` at a voxel.
fn depth(grid: &Grid, toward: DVec3, voxel: [usize; 3]) -> f64 {
    let step = grid.world_to_index().transform_vector3(toward.normalize());
    (0..3).fold(f64::INFINITY, |depth, axis| {
        let (at, last) = (voxel[axis] as f64, (grid.size[axis] - 1) as f64);
        let left = if step[axis] > 0.0 { last - at } else { at };
        if step[axis].abs() < 1e-9 { depth } else { depth.min(left / step[axis].abs()) }
    })
}

#[test]
fn light_from_every_direction_falls_with_its_way_through_a_homogeneous_volume() {
    let size = [17, 21, 19];
    let affine = |m: [[f64; 3]; 3]| {
        let m = DMat3::from_cols_array_2d(&m);
        Grid::new(size, DAffine3 { matrix3: m, translation: DVec3::new(3.0, -40.0, 7.0) }).unwrap()
    };
    let grids = [
        ("cubes", affine([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])),
        ("flipped", affine([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]])),
        ("anisotropic", affine([[0.7, 0.0, 0.0], [0.0, 0.7, 0.0], [0.0, 0.0, 2.1]])),
        ("sheared", affine([[1.0, 0.0, 0.0], [0.3, 1.1, 0.0], [0.2, -0.4, 1.3]])),
    ];
    println!("grid         greatest error  mean error, over {} lights", LIGHTS.len());
    for (name, grid) in grids {
        let (mut greatest, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
        for toward in LIGHTS {
            let strength = Scene::new(grid, toward, NO_BIAS, |_| 0.05).sweep();
            for voxel in voxels(size) {
                let expected = 0.95_f64.powf(depth(&grid, DVec3::from(toward), voxel));
                let error = (beta(&strength, voxel) - expected).abs();
                greatest = greatest.max(error);
                sum += error;
                count += 1.0;
            }
        }
        println!("{name:<12} {greatest:<15.5} {:.6}", sum / count);
        // Where light that came through one face meets light that came through another, β has a crease between columns.
        assert!(greatest < 0.1 && sum / count < 5e-4, "{name}: {greatest}");
    }
}

#[test]
fn along_axes_and_diagonals_of_cubes_the_law_is_exact() {
    let size = [14, 14, 14];
    for toward in &LIGHTS[..10] {
        let grid = cubes(size);
        let strength = Scene::new(grid, *toward, NO_BIAS, |_| 0.05).sweep();
        for voxel in voxels(size) {
            let expected = 0.95_f64.powf(depth(&grid, DVec3::from(*toward), voxel));
            let error = (beta(&strength, voxel) - expected).abs();
            assert!(error < 1e-5, "{toward:?} {voxel:?}: {error}");
        }
    }
}

fn lumps(p: DVec3) -> f32 {
    let lump = |c: [f64; 3], r: f64| (1.0 + (r - p.distance(DVec3::from(c))) / 3.0).clamp(0.0, 1.0);
    let lumps =
        [lump([3.0, 2.0, 5.0], 4.0), lump([-5.0, 1.0, -3.0], 3.0), lump([1.0, -6.0, 0.0], 2.0)];
    lumps.iter().sum::<f64>().min(1.0) as f32 * 0.15
}

#[test]
fn turning_volume_and_light_together_leaves_every_strength_as_it_was() {
    let size = [20, 18, 22];
    let toward = DVec3::new(0.3, -0.4, 0.85);
    let shadow = CastsShadow { bias_voxels: 2.0, k1: 1.0, k2: 0.01 };
    let opacity = |v: [usize; 3]| lumps(point(v) - DVec3::splat(9.5));
    let still = Scene::new(cubes(size), toward.to_array(), shadow, opacity).sweep();
    for angle in [0.3, 1.7, 4.0] {
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), angle);
        let grid = Grid::new(size, DAffine3::from_rotation_translation(turn, DVec3::splat(50.0)));
        let turned = Scene::new(grid.unwrap(), (turn * toward).to_array(), shadow, opacity).sweep();
        for voxel in voxels(size) {
            let difference = (beta(&still, voxel) - beta(&turned, voxel)).abs();
            assert!(difference < 4e-5, "{angle} {voxel:?}: {difference}");
        }
    }
}

#[test]
fn turning_gel_and_light_in_a_still_grid_changes_strengths_by_interpolation_alone() {
    let size = [40; 3];
    let center = DVec3::splat(19.5);
    let toward = DVec3::new(0.1, 0.2, 0.9);
    let cast = |turn: DQuat| {
        let opacity = move |v: [usize; 3]| lumps(turn.inverse() * (point(v) - center));
        let mut scene = Scene::new(cubes(size), (turn * toward).to_array(), NO_BIAS, opacity);
        scene = scene.buffered();
        scene.sweep()
    };
    let still = cast(DQuat::IDENTITY);
    println!("turn   greatest difference  root mean square");
    for angle in [0.2, 0.7, 1.3, 2.5] {
        let turn = DQuat::from_axis_angle(DVec3::new(0.4, 1.0, 0.3).normalize(), angle);
        let turned = cast(turn);
        let (mut greatest, mut squares) = (0.0_f64, 0.0);
        for seed in 0..4000 {
            let p = DVec3::from([0, 1, 2].map(|i| noise(3 * seed + i) * 22.0 - 11.0));
            let difference = at(&still, center + p) - at(&turned, center + turn * p);
            greatest = greatest.max(difference.abs());
            squares += difference * difference / 4000.0;
        }
        println!("{angle:<6} {greatest:<20.4} {:.4}", squares.sqrt());
        assert!(greatest < 0.05 && squares.sqrt() < 0.01, "{angle}");
    }
}
