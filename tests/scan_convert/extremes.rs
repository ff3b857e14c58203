//! Facts about extremes: planes of voxels, edge-on, tiny and huge polygons, scaled and moved worlds, and thrift.

use gelray::components::{Color, Matte};
use gelray::components::{Light, Observer, Order, Surface, Toward, View, Voxelize};
use gelray::polygon::face::Face;
use gelray::schedule::System;
use gelray::systems::matte::MattePolygons;
use gelray::systems::scan_convert::ScanConvert;
use gelray::volume::grid::Grid;
use gelray::volume::layer::{Composite, Coverage, Layer};
use glam::DVec3;

use crate::scene::{Tracer, add, composite, cover, cube, flat, rectangle, run, total, world};

#[test]
fn worlds_scaled_and_moved_get_the_same_voxels() {
    let opacities = |scale: f64, moved: f64| {
        let (spacing, origin) = ([scale, scale, -2.0 * scale], [moved, moved, -moved]);
        let grid = Grid::axis_aligned([20, 24, 16], spacing, origin).unwrap();
        let center = DVec3::new(9.0, 11.0, -14.0) * scale + DVec3::from(origin);
        let face = rectangle(center, DVec3::new(0.3, -0.5, 0.4), 6.0 * scale);
        cover(grid, vec![face], 0.5, true).0.opacity
    };
    let plain = opacities(1.0, 0.0);
    let cases = [
        (1e-6, 0.0, 1e-6),
        (1e6, 0.0, 1e-6),
        (1.0, 1e6, 1e-5),
        (1e-3, 1e3, 1e-5),
        (1e3, -1e6, 1e-6),
    ];
    for (scale, moved, bound) in cases {
        let other = opacities(scale, moved);
        for (place, brick) in plain.stored() {
            for (at, voxel) in place.voxels() {
                let difference = (brick[at] - other.value(voxel)).abs();
                assert!(difference <= bound, "{scale} {moved} {voxel:?} {difference}");
            }
        }
        assert_eq!(plain.stored().count(), other.stored().count());
    }
}

#[test]
fn a_polygon_on_a_plane_of_voxels_is_symmetric_about_it_even_at_the_border() {
    for z in [0, 8, 15] {
        let opacity = cover(
            cube(16),
            vec![rectangle(DVec3::new(7.5, 7.5, z as f64), DVec3::Z, 99.0)],
            0.5,
            true,
        )
        .0
        .opacity;
        let at = |z: usize| opacity.value([7, 3, z]);
        assert!(at(z) > 0.25);
        for step in 1..=2 {
            if z >= step && z + step < 16 {
                assert_eq!(at(z - step), at(z + step));
            }
        }
    }
}

#[test]
fn a_polygon_seen_edge_on_is_a_strip_of_finite_opacity_and_width() {
    let face = rectangle(DVec3::splat(12.0), DVec3::Z, 6.0);
    let opacity = cover(cube(25), vec![face], 0.5, true).0.opacity;
    let tracer =
        Tracer { grid: cube(25), opacity: &opacity, along: DVec3::X, distance: 1.0, unit: 1.0 };
    let through = |z: f64| tracer.trace(DVec3::new(12.0, 12.0, z), 0.3);
    assert!(through(12.0) > 0.95 && through(12.0) < 1.0 && through(15.01) == 0.0);
}

#[test]
fn a_polygon_smaller_than_a_voxel_covers_its_area_wherever_it_lies() {
    for phase in 0..16 {
        let at = DVec3::splat(8.0) + DVec3::new(0.37, 0.61, 0.83) * f64::from(phase);
        let face = rectangle(at, DVec3::new(0.0, 0.0, 1.0), 0.15);
        for (calibrated, least, most) in [(false, 0.5, 1.6), (true, 0.5, 1.6)] {
            let sum = total(&cover(cube(25), vec![face.clone()], 0.01, calibrated).0.opacity);
            let area = sum / 0.01 / 0.09 / if calibrated { 1.0 } else { 4.0 / 3.0 };
            assert!((least..=most).contains(&area), "{phase} {calibrated} {area}");
        }
    }
}

#[test]
fn a_polygon_a_million_times_larger_than_the_volume_is_as_one_that_just_fills_it() {
    let normal = DVec3::new(0.1, 0.2, 1.0);
    let covered = |half: f64| {
        cover(cube(16), vec![rectangle(DVec3::splat(7.5), normal, half)], 0.5, true).0.opacity
    };
    let (fills, huge) = (covered(40.0), covered(16e6));
    for (place, brick) in fills.stored() {
        for (at, voxel) in place.voxels() {
            assert!((brick[at] - huge.value(voxel)).abs() < 1e-6);
        }
    }
}

#[test]
fn opacities_and_coordinates_at_the_extremes_never_leave_the_range() {
    let shapes = [
        rectangle(DVec3::splat(4.0), DVec3::ONE, 1e-9),
        rectangle(DVec3::splat(4.0), DVec3::ONE, 1e12),
        rectangle(DVec3::splat(1e15), DVec3::X, 1e15),
        Face::new(vec![flat(&[(-1e4, 3.5), (1e4, 3.5), (1e4, 3.5001)], 4.0)]).unwrap(),
    ];
    for (shape, opacity) in shapes.iter().flat_map(|s| {
        [0.0, 1e-9, 1e-7, 0.5, 1.0 - f32::EPSILON / 2.0, 1.0, f32::NAN].map(|o| (s, o))
    }) {
        for calibrated in [false, true] {
            let Coverage(layer) = cover(cube(9), vec![shape.clone()], opacity, calibrated);
            for (place, brick) in layer.opacity.stored() {
                assert!(
                    opacity > 0.0 && brick.iter().all(|alpha| (0.0..=1.0).contains(alpha)),
                    "{place:?}"
                );
            }
        }
    }
}

#[test]
fn too_far_away_and_no_volume_are_sentences_with_a_remedy() {
    let far = Face::new(vec![flat(&[(0.0, 0.0), (1e120, 0.0), (0.0, 1e120)], 0.0)]).unwrap();
    let mut scene = world(cube(9));
    add(&mut scene, vec![far], 0.5, true);
    assert!(run(&mut scene).unwrap_err().to_string().contains("1e100 voxels"));
    let mut bare = hecs::World::new();
    add(&mut bare, vec![rectangle(DVec3::ZERO, DVec3::Z, 1.0)], 0.5, true);
    assert!(run(&mut bare).unwrap_err().to_string().contains("state a `volume`"));
}

#[test]
fn a_second_run_makes_nothing_and_a_turn_of_the_view_only_what_depends_on_it() {
    let mut scene = world(cube(9));
    let entity = add(&mut scene, vec![rectangle(DVec3::splat(4.0), DVec3::Z, 3.0)], 0.5, true);
    let toward = Toward::Direction([0.0, 0.0, 1.0]);
    let light = scene.spawn((Light { toward, strength: 1.0, color: Color::WHITE }, Order(7)));
    let view = scene.spawn((View::default(), Order(8)));
    assert_eq!(run(&mut scene).unwrap(), [(1, 0), (1, 0)]);
    scene.get::<&mut View>(view).unwrap().azimuth = 30.0;
    assert_eq!(run(&mut scene).unwrap(), [(0, 1), (0, 1)]);
    scene.get::<&mut Voxelize>(entity).unwrap().matte = Matte::Under;
    assert_eq!(run(&mut scene).unwrap(), [(0, 1), (1, 0)]);
    scene.get::<&mut Light>(light).unwrap().toward = Toward::Observer(Observer::Observer);
    assert_eq!(run(&mut scene).unwrap(), [(1, 0), (1, 0)]);
    scene.get::<&mut View>(view).unwrap().azimuth = 60.0;
    assert_eq!(run(&mut scene).unwrap(), [(1, 0), (1, 0)]);
    scene.get::<&mut Light>(light).unwrap().toward = toward;
    scene.get::<&mut Surface>(entity).unwrap().specular = 0.5;
    run(&mut scene).unwrap();
    scene.get::<&mut View>(view).unwrap().azimuth = 90.0;
    assert_eq!(run(&mut scene).unwrap(), [(1, 0), (1, 0)]);
    scene.remove_one::<Voxelize>(entity).unwrap();
    assert_eq!(run(&mut scene).unwrap(), [(0, 0), (0, 0)]);
    assert!(scene.query::<&Composite>().iter().next().is_none());
}

#[test]
fn a_plan_says_what_will_be_made_and_bounds_its_bytes() {
    let plans = |scene: &hecs::World| [ScanConvert::plan(scene), MattePolygons::plan(scene)];
    let mut scene = world(cube(40));
    assert!(plans(&scene).iter().all(|plan| plan.makes.is_empty()));
    let entity = add(&mut scene, vec![rectangle(DVec3::splat(20.0), DVec3::ONE, 11.0)], 0.5, true);
    let plans = plans(&scene);
    assert!(plans.iter().all(|plan| plan.makes.len() == 1));
    run(&mut scene).unwrap();
    let bytes = |layer: &Layer| layer.opacity.bytes() + layer.colors.base.bytes();
    let covered = bytes(&scene.get::<&Coverage>(entity).unwrap().0);
    assert!(covered <= plans[0].bytes() && plans[0].bytes() < 2 * covered);
    assert!(bytes(&composite(&scene).0) <= plans[1].bytes());
}
