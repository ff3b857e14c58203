//! What a change makes again, and what is not asked for is neither run nor kept (architecture: the schedule).

use gelray::components::{
    Classify, Color, Contour, Light, Material, OpacityUnit, Order, Sampling, Surface, Toward, View,
};
use gelray::polygon::face::{Face, Faces};
use gelray::schedule::Ran;
use gelray::shared::Shared;
use gelray::systems::JOBS;
use gelray::view::extent::Extent;
use gelray::view::samples::Samples;
use gelray::volume::grid::Scalars;
use gelray::volume::layer::Opacity;
use gelray::volume::ranges::Ranges;
use glam::{DVec3, Vec3};
use hecs::{Entity, World};

use super::support::{Mixture, centred, flat, homogeneous, run, square};

struct Parts {
    world: World,
    volume: Entity,
    polygon: Entity,
    light: Entity,
    view: Entity,
}

/// A ball under a fixed light, without highlights, and a polygon in it.
fn parts() -> Parts {
    let mut world = World::new();
    let grid = centred([24; 3], 1.0);
    let scalar = |at: usize| {
        let voxel = [at % 24, at / 24 % 24, at / 576].map(|n| n as f64);
        100.0 - DVec3::from(voxel).distance(DVec3::splat(11.5)) as f32
    };
    let scalars = Scalars::F32(Shared::new((0..grid.voxels()).map(scalar).collect()));
    let classify = Classify { iso: vec![Contour::at(92.0)], ..Classify::default() };
    let volume =
        world.spawn((Order(0), grid, scalars, classify, Material::default(), OpacityUnit(1.0)));
    let face = Face::new(vec![square(DVec3::ZERO, DVec3::X, 11.0)]).unwrap();
    let polygon = world.spawn((
        Order(1),
        Faces(vec![face].into()),
        Surface { opacity: 0.5, ..Surface::default() },
    ));
    let toward = Toward::Direction([1.0, -2.0, 1.0]);
    let light = world.spawn((Order(2), Light { toward, strength: 0.8, color: Color::WHITE }));
    let view = View { size: [24; 2], ..View::default() };
    let view =
        world.spawn((Order(3), view, Sampling::default(), Extent::of(grid.corners()).unwrap()));
    Parts { world, volume, polygon, light, view }
}

/// The systems that made something; a second run makes nothing.
fn made(world: &mut World) -> Vec<&'static str> {
    let names = |ran: Vec<Ran>| ran.iter().filter(|ran| ran.made > 0).map(|ran| ran.name).collect();
    let first: Vec<_> = names(run(world));
    assert_eq!(names(run(world)), [""; 0]);
    first
}

#[test]
fn a_turn_of_the_view_casts_rays_and_resamples_and_nothing_else() {
    let Parts { mut world, view, .. } = parts();
    let all = ["ranges", "classify", "relight", "pyramid", "cast", "resample"];
    assert_eq!(made(&mut world), all);
    for _ in 0..3 {
        world.get::<&mut View>(view).unwrap().azimuth += 25.0;
        assert_eq!(made(&mut world), ["cast", "resample"]);
    }
    world.get::<&mut View>(view).unwrap().size = [12, 30];
    assert_eq!(made(&mut world), ["cast", "resample"]);
}

#[test]
fn an_edit_makes_again_what_depends_on_it_and_never_the_ranges() {
    let Parts { mut world, volume, polygon, light, view } = parts();
    made(&mut world);
    let ranges = Ranges::clone(&world.get::<&Ranges>(volume).unwrap());
    let all = ["classify", "relight", "pyramid", "cast", "resample"];
    // Other light makes no other cells interesting.
    let lit = ["relight", "cast", "resample"];
    world.get::<&mut Classify>(volume).unwrap().iso[0].value = 93.0;
    assert_eq!(made(&mut world), all);
    world.get::<&mut Material>(volume).unwrap().ambient = 0.4;
    assert_eq!(made(&mut world), lit);
    world.get::<&mut Light>(light).unwrap().strength = 0.4;
    assert_eq!(made(&mut world), lit);
    world.get::<&mut Surface>(polygon).unwrap().color = Color(Vec3::X);
    assert_eq!(made(&mut world), ["cast", "resample"]);
    world.get::<&mut Sampling>(view).unwrap().tolerance = 0.07;
    assert_eq!(made(&mut world), ["cast", "resample"]);
    world.get::<&mut View>(view).unwrap().background = Some(Color::WHITE);
    let background = made(&mut world);
    assert!(background.ends_with(&["resample"]), "{background:?}");
    world.despawn(polygon).unwrap();
    assert_eq!(made(&mut world), ["cast", "resample"]);
    assert!(ranges == *world.get::<&Ranges>(volume).unwrap(), "the very same array");
}

/// The systems that ran for something, made or kept, and those that plan to.
fn at_work(world: &mut World) -> [Vec<&'static str>; 2] {
    let planned = JOBS.iter().filter(|job| !(job.plan)(world).makes.is_empty());
    let mut planned: Vec<_> = planned.map(|job| job.name).collect();
    let ran = run(world);
    let mut ran: Vec<_> =
        ran.iter().filter(|ran| ran.made + ran.reused > 0).map(|ran| ran.name).collect();
    planned.sort_unstable();
    ran.sort_unstable();
    [planned, ran]
}

#[test]
fn paint_without_polygons_runs_no_system_for_what_it_does_not_state() {
    let grid = centred([9; 3], 1.0);
    let scene = Mixture::of(grid, homogeneous(&grid, [1.0, 0.5, 0.2, 0.1]));
    let (mut world, view) = scene.seen((0.0, 0.0), 16, 14.0).world();
    let [planned, ran] = at_work(&mut world);
    assert_eq!(ran, ["cast", "pyramid", "relight", "resample"]);
    assert_eq!(planned, ran);
    for job in JOBS.iter().filter(|job| !ran.contains(&job.name)) {
        let plan = (job.plan)(&world);
        assert!(plan.bytes() == 0 && !plan.why.is_empty(), "{}", job.name);
    }
    for entity in &world {
        assert!(!entity.has::<Ranges>() && !entity.has::<Opacity>());
    }
    // Without a polygon nothing is kept for C_G and C_A, and no position below a pixel.
    let samples = world.get::<&Samples>(view).unwrap();
    assert!(samples.0.colors.fine.is_empty());
}

#[test]
fn polygons_alone_run_no_system_of_volumes() {
    let square = vec![square(DVec3::ZERO, DVec3::Y, 3.0)];
    let scene = Mixture::polygons(vec![(square, flat([1.0; 3], 1.0))]);
    let (mut world, _) = scene.seen((10.0, 0.0), 16, 14.0).world();
    let [planned, ran] = at_work(&mut world);
    assert_eq!(ran, ["cast", "resample"]);
    assert_eq!(planned, ran);
}
