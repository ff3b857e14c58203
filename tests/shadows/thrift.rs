//! What is made when, from what, and what it costs.

use std::sync::Arc;

use gelray::components::{CastsShadow, Observer, Order, Shaft, Toward, View, Voxelize};
use gelray::components::{Light, Matte};
use gelray::light::strength::LightStrength;
use gelray::polygon::face::{Face, Faces};
use gelray::schedule::{Job, Schedule, System, Watch};
use gelray::shared::Shared;
use gelray::systems::light_sweep::LightSweep;
use gelray::volume::bricks::Bricks;
use gelray::volume::grid::Scalars;
use gelray::volume::layer::{Coverage, Layer, LitColors};
use glam::DVec3;
use hecs::World;

use crate::setup::{NO_BIAS, Scene, at, beta, bricks, cubes, point};

fn did(world: &mut World) -> (u32, u32) {
    let schedule = Schedule::new(&[Job::of::<LightSweep>()]).unwrap();
    let ran = schedule.run(world, &Watch::default()).unwrap();
    (ran[0].made, ran[0].reused)
}

#[test]
fn a_light_that_casts_no_shadow_costs_nothing() {
    let mut scene = Scene::new(cubes([8; 3]), [0.0, 0.0, 1.0], NO_BIAS, |_| 0.1);
    assert_eq!(did(&mut scene.world), (1, 0));
    scene.world.remove_one::<CastsShadow>(scene.light).unwrap();
    assert_eq!(did(&mut scene.world), (0, 0));
    assert!(scene.world.get::<&LightStrength>(scene.light).is_err());
    let plan = LightSweep::plan(&scene.world);
    assert!(plan.makes.is_empty() && plan.why.contains("casts_shadow"));
}

#[test]
fn moving_the_observer_remakes_no_light_but_his_own() {
    let mut scene = Scene::new(cubes([8; 3]), [0.0, 0.0, 1.0], NO_BIAS, |_| 0.1);
    let view = scene.world.spawn((View::default(), Order(9)));
    assert_eq!(did(&mut scene.world), (1, 0));
    scene.world.get::<&mut View>(view).unwrap().azimuth = 40.0;
    assert_eq!(did(&mut scene.world), (0, 1));
    scene.world.get::<&mut Light>(scene.light).unwrap().toward =
        Toward::Observer(Observer::Observer);
    assert_eq!(did(&mut scene.world), (1, 0));
    scene.world.get::<&mut View>(view).unwrap().azimuth = 180.0;
    assert_eq!(did(&mut scene.world), (1, 0));
    // At azimuth 180 the observer, and his light, stand at +y.
    let strength = (*scene.world.get::<&LightStrength>(scene.light).unwrap()).clone();
    assert_eq!(beta(&strength, [3, 7, 3]), 1.0);
    assert!((beta(&strength, [3, 0, 3]) - 0.9_f64.powi(7)).abs() < 1e-5);
    scene.world.get::<&mut View>(view).unwrap().roll = 15.0;
    assert_eq!(did(&mut scene.world), (0, 1));
}

fn square() -> Faces {
    let corners = [(1.0, 1.0), (14.0, 1.0), (14.0, 14.0), (1.0, 14.0)];
    let corners = corners.map(|(x, y)| DVec3::new(x, y, 11.0)).to_vec();
    Faces(Arc::new(vec![Face::new(vec![corners]).unwrap()]))
}

#[test]
fn hybrid_polygons_cast_shadows_and_receive_them() {
    let size = [16; 3];
    let plain = |v: [usize; 3]| if v[2] == 11 { 0.2 } else { 0.1 };
    let mut scene = Scene::new(cubes(size), [0.0, 0.0, 1.0], NO_BIAS, plain);
    assert!(scene.sweep().buffers.is_empty());
    let sheet = bricks(size, |v| if v[2] == 11 { 0.5 } else { 0.0 });
    let base = Bricks::make(size, |_, _| false).into();
    let colors = LitColors { base, shadowed: vec![], ambient: None };
    let coverage = Coverage(Layer { opacity: sheet, colors });
    let polygon = scene.world.spawn((square(), coverage, Order(2)));
    let strength = scene.sweep();
    let expected = |sheet: f64| 0.9_f64.powf(3.5 + 7.5) * sheet;
    assert!((beta(&strength, [8, 8, 3]) - expected(1.0 - 0.6)).abs() < 1e-5);
    assert!((at(&strength, point([8, 8, 3])) - expected(0.4)).abs() < 1e-5);
    // Scan-converted, it is in the composite opacity already, and nothing reads the buffer.
    let voxelize = Voxelize { matte: Matte::Over, calibrated: true };
    scene.world.insert_one(polygon, voxelize).unwrap();
    let strength = scene.sweep();
    assert!(strength.buffers.is_empty());
    assert!((beta(&strength, [8, 8, 3]) - expected(0.8)).abs() < 1e-5);
}

#[test]
fn only_an_attenuated_shaft_asks_for_the_buffer() {
    let mut scene = Scene::new(cubes([8; 3]), [0.0, 0.0, 1.0], NO_BIAS, |_| 0.1);
    for attenuated in [false, true] {
        let shaft = Shaft { opacity: 0.1, color: None, attenuated };
        scene.world.insert_one(scene.light, shaft).unwrap();
        assert_eq!(!scene.sweep().buffers.is_empty(), attenuated);
    }
}

#[test]
fn the_plan_bounds_what_a_sweep_takes() {
    let size = [40, 30, 20];
    for (toward, buffered) in [([0.0, 0.0, 1.0], false), ([1.0, 1.0, 1.0], true)] {
        let mut scene = Scene::new(cubes(size), toward, CastsShadow::default(), |_| 0.1);
        let scalars = Scalars::U8(Shared::new(vec![0; 40 * 30 * 20]));
        scene.world.insert_one(scene.volume, scalars).unwrap();
        scene = if buffered { scene.buffered() } else { scene };
        let plan = LightSweep::plan(&scene.world);
        let strength = scene.sweep();
        assert_eq!(plan.makes[0].0, scene.light);
        assert!(plan.bytes() >= strength.bytes() && plan.bytes() < 3 * strength.bytes());
        assert_eq!(plan.why.contains("because"), buffered);
    }
}

#[test]
fn the_strengths_of_a_head_of_ct_size_take_two_bytes_in_three_voxels_at_the_most() {
    // Shells of a skin and a skull: 5 to 6 % of 256 × 256 × 113 voxels are interesting.
    let size = [256, 256, 113];
    let head = |v: [usize; 3]| {
        let p = (point(v) - DVec3::new(128.0, 128.0, 50.0)) / DVec3::new(1.0, 1.2, 0.6);
        let shell = |r: f64, thick: f64| (1.0 - (p.length() - r).abs() / thick).max(0.0);
        (0.8 * shell(96.0, 1.8) + 0.9 * shell(82.0, 2.1)) as f32
    };
    let voxels = bricks(size, head);
    let interesting: usize =
        voxels.stored().map(|(_, b)| b.iter().filter(|&&a| a > 0.0).count()).sum();
    println!("{:.1} % interesting", 100.0 * interesting as f64 / (256.0 * 256.0 * 113.0));
    println!("toward the light      bytes    with buffer");
    for toward in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-0.4, -0.8, 0.5], [1.0, 1.0, 1.0]] {
        let mut scene = Scene::new(cubes(size), toward, CastsShadow::default(), head);
        let bytes = scene.sweep().bytes();
        let all = scene.buffered().sweep().bytes();
        println!("{:<21} {bytes:<8} {all}", format!("{toward:?}"));
        assert!(bytes < 5_000_000, "{bytes}");
    }
}
