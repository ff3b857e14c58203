//! Facts about where a polygon is in the voxels, what its parts sum to, and what it costs.

use std::f64::consts::PI;

use gelray::components::{CastsShadow, Color, DepthCue, Light, Order, Surface, Toward, View};
use gelray::polygon::face::Face;
use gelray::volume::grid::Grid;
use gelray::volume::layer::{Coverage, Layer};
use glam::{DVec3, Vec3};

use crate::scene::{Tracer, add, cover, cube, flat, rectangle, run, sphere, total, world};

const SQUARE: [(f64, f64); 4] = [(4.3, 4.1), (11.7, 4.1), (11.7, 12.2), (4.3, 12.2)];

#[test]
fn the_printed_form_sums_to_the_volume_of_the_ball_times_the_area() {
    // Per unit of area the heights' 1 − h² sum to 4/3 on the mean over phases; over an irregular plane that mean is met.
    let normal = DVec3::new(0.31, 0.53, 0.79);
    let face = rectangle(DVec3::splat(16.0), normal, 8.0);
    let sum = total(&cover(cube(33), vec![face], 0.6, false).0.opacity);
    let expected = 0.6 * 256.0 * 4.0 / 3.0;
    assert!((sum / expected - 1.0).abs() < 0.01, "{sum} {expected}");
}

#[test]
fn a_voxel_of_the_printed_form_gets_the_area_of_disc_and_polygon_by_pi() {
    let face =
        Face::new(vec![flat(&[(-50.0, -50.0), (8.4, -50.0), (8.4, 80.0), (-50.0, 80.0)], 8.3)])
            .unwrap();
    let opacity = cover(cube(17), vec![face], 0.5, false).0.opacity;
    for (x, z) in (0..17).flat_map(|x| (0..17).map(move |z| (x, z))) {
        let height = (z as f64 - 8.3).abs();
        let expected = if height < 1.0 {
            // The part of the disc to the left of the edge.
            let radius = (1.0 - height * height).sqrt();
            let away = ((8.4 - x as f64) / radius).clamp(-1.0, 1.0);
            let segment = away.acos() - away * (1.0 - away * away).sqrt();
            0.5 * radius * radius * (PI - segment) / PI
        } else {
            0.0
        };
        let found = f64::from(opacity.value([x, 9, z]));
        assert!((found - expected).abs() < 1e-6, "{x} {z}: {found} {expected}");
    }
}

#[test]
fn polygons_that_share_an_edge_cover_what_the_undivided_one_covers_either_way_round() {
    let whole = Face::new(vec![flat(&SQUARE, 8.3)]).unwrap();
    let corner = |k: usize| flat(&SQUARE, 8.3)[k];
    let middle = corner(0).midpoint(corner(2)) + DVec3::new(0.4, 0.2, 0.0);
    let part = |k: usize| Face::new(vec![vec![corner(k), corner((k + 1) % 4), middle]]).unwrap();
    let turned = |k: usize| Face::new(vec![vec![middle, corner((k + 1) % 4), corner(k)]]).unwrap();
    for (opacity, calibrated) in [(0.5, false), (0.5, true), (1.0, true)] {
        let whole = cover(cube(17), vec![whole.clone()], opacity, calibrated).0.opacity;
        for parts in
            [vec![part(0), part(1), part(2), part(3)], vec![part(0), turned(1), part(2), turned(3)]]
        {
            let parts = cover(cube(17), parts, opacity, calibrated).0.opacity;
            for (place, brick) in whole.stored() {
                for (at, voxel) in place.voxels() {
                    let difference = (brick[at] - parts.value(voxel)).abs();
                    assert!(difference < 2e-6, "{opacity} {calibrated} {voxel:?} {difference}");
                }
            }
            assert!((total(&whole) - total(&parts)).abs() < 1e-3);
        }
    }
}

#[test]
fn two_sides_of_something_thin_add_their_optical_depths() {
    let sheet = |z: f64, turn: bool| {
        let mut outline = flat(&[(-9.0, -9.0), (99.0, -9.0), (99.0, 99.0), (-9.0, 99.0)], z);
        if turn {
            outline.reverse();
        }
        Face::new(vec![outline]).unwrap()
    };
    let one = cover(cube(16), vec![sheet(8.0, false)], 0.5, true).0.opacity.value([5, 5, 8]);
    let two = cover(cube(16), vec![sheet(8.0, false), sheet(8.0, true)], 0.5, true).0.opacity;
    assert!((two.value([5, 5, 8]) - (1.0 - (1.0 - one) * (1.0 - one))).abs() < 1e-6);
}

#[test]
fn a_closed_surface_of_many_faces_is_as_opaque_as_stated_from_every_side_and_on_any_threads() {
    let faces = sphere(DVec3::splat(24.0), 17.0, 24);
    let covered = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| cover(cube(49), faces.clone(), 0.5, true)).0
    };
    let layer = covered(1);
    for other in [2, 7].map(covered) {
        let bricks = |layer: &Layer| -> Vec<_> {
            let colors = layer.colors.base.bricks();
            let colors = colors.stored().map(|(_, brick)| brick.map(|c| c.map(f32::to_bits)));
            layer.opacity.stored().map(|(p, b)| (p, b.map(f32::to_bits))).zip(colors).collect()
        };
        assert!(bricks(&layer) == bricks(&other));
    }
    // A ray through the middle meets the surface twice, face-on.
    for along in [DVec3::X, DVec3::Z, DVec3::ONE, DVec3::new(0.3, -0.5, 0.8)] {
        let tracer =
            Tracer { grid: cube(49), opacity: &layer.opacity, along, distance: 1.0, unit: 1.0 };
        let mean =
            (0..16).map(|n| tracer.trace(DVec3::splat(24.0), f64::from(n) / 16.0)).sum::<f64>()
                / 16.0;
        assert!((mean - 0.75).abs() < 0.03, "{along} {mean}");
    }
}

#[test]
fn a_concave_polygon_with_a_hole_covers_its_own_area_and_nothing_in_hole_or_notch() {
    let outline = [(3.0, 3.0), (29.0, 3.0), (29.0, 29.0), (16.0, 20.0), (3.0, 29.0)];
    let hole = [(12.0, 8.0), (20.0, 8.0), (20.0, 14.0), (12.0, 14.0)];
    let face = Face::new(vec![flat(&outline, 16.0), flat(&hole, 16.0)]).unwrap();
    let opacity = cover(cube(33), vec![face], 0.5, false).0.opacity;
    let at = |x: usize, y: usize| opacity.value([x, y, 16]);
    assert_eq!([at(16, 11), at(16, 25), at(8, 10), at(25, 22)], [0.0, 0.0, 0.5, 0.5]);
    assert!((total(&opacity) / 0.5 - (26.0 * 26.0 - 13.0 * 9.0 - 48.0)).abs() < 1.0);
}

#[test]
fn parts_outside_are_not_there_and_what_is_inside_does_not_change_by_them() {
    let normal = DVec3::new(0.2, 0.3, 1.0);
    let covered = |size: usize, low: f64, center: DVec3| {
        let grid = Grid::axis_aligned([size; 3], [1.0; 3], [low; 3]).unwrap();
        cover(grid, vec![rectangle(center, normal, 9.0)], 0.7, true).0.opacity
    };
    let center = DVec3::new(14.0, 3.0, 15.0);
    let (small, large) = (covered(16, 0.0, center), covered(48, -16.0, center));
    let all = (0..16_usize.pow(3)).map(|i| [i % 16, i / 16 % 16, i / 256]);
    assert!(all.clone().all(|v| small.value(v) == large.value(v.map(|n| n + 16))));
    assert!(all.clone().any(|v| small.value(v) > 0.0));
    for away in [DVec3::X * 100.0, DVec3::NEG_Z * 40.0, DVec3::splat(1e9)] {
        assert_eq!(covered(16, 0.0, center + away).stored().count(), 0);
    }
}

#[test]
fn what_is_stored_grows_with_the_area_and_not_with_the_volume() {
    let bricks = |size: usize, half: f64| {
        let face = rectangle(DVec3::splat(size as f64 / 2.0), DVec3::new(0.3, 0.5, 0.8), half);
        cover(cube(size), vec![face], 0.5, true).0.opacity.stored().count() as f64
    };
    let small = bricks(128, 12.0);
    assert!(bricks(256, 12.0) <= 1.3 * small && bricks(64, 12.0) >= small / 1.3);
    let growth = bricks(256, 96.0) / bricks(256, 24.0);
    assert!((8.0..=16.0).contains(&growth), "16 times the area: {growth} times the bricks");
}

#[test]
fn faces_are_shaded_once_and_mixed_by_what_they_cover() {
    let mut scene = world(cube(16));
    let light = |toward: [f64; 3]| Light {
        toward: Toward::Direction(toward),
        strength: 1.0,
        color: Color::WHITE,
    };
    scene.spawn((light([0.0, 0.0, 1.0]), Order(10)));
    scene.spawn((light([1.0, 0.0, 0.0]), Order(11), CastsShadow::default()));
    scene.spawn((View::default(), Order(12), DepthCue { k1: 1.0, k2: 0.01 }));
    let far = [-50.0, 50.0];
    let roof = |x: f64| {
        let corner = |(x, y): (f64, f64)| DVec3::new(x, y, 8.0 - (x - 8.0).abs());
        Face::new(vec![
            [(8.0, far[0]), (x, far[0]), (x, far[1]), (8.0, far[1])].map(corner).to_vec(),
        ])
        .unwrap()
    };
    let entity = add(&mut scene, vec![roof(-50.0), roof(50.0)], 1.0, false);
    run(&mut scene).unwrap();
    let Coverage(layer) = (*scene.get::<&Coverage>(entity).unwrap()).clone();
    let how = Surface::default();
    let (diffuse, ambient) = (how.diffuse * 0.5_f32.sqrt(), Vec3::splat(how.ambient));
    for voxel in [[8, 8, 8], [4, 8, 4], [12, 8, 4]] {
        assert!(layer.opacity.value(voxel) > 0.5);
        // Two-sided lights: both slopes answer alike.
        for bricks in [&layer.colors.base, &layer.colors.shadowed[0]] {
            assert!(Vec3::from(bricks.value(voxel)).abs_diff_eq(Vec3::splat(diffuse), 1e-6));
        }
        assert_eq!(Vec3::from(layer.colors.ambient.as_ref().unwrap().value(voxel)), ambient);
    }
    assert_eq!(layer.colors.base.value([8, 8, 12]), [0.0; 3]);
}
