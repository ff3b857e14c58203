//! What is not asked for is not made, and what was made of the same inputs is kept.

use gelray::components::{
    CastsShadow, Classify, DepthCue, Material, Observer, Order, Sampling, Skip, TexelKind, Toward,
    View,
};
use gelray::shared::Shared;
use gelray::systems::JOBS;
use gelray::volume::gel::Gel;
use gelray::volume::grid::{Grid, Painted};
use gelray::volume::layer::Opacity;
use gelray::volume::pyramid::Pyramid;
use gelray::volume::ranges::Ranges;
use hecs::{Entity, World};

use super::{Ball, STAGES, ball, contour, prepare, sampled, spawn_light, spawn_view, spawn_volume};

/// The stages that made something in a run.
fn made(world: &mut World) -> Vec<&'static str> {
    let ran = prepare(world);
    let made: Vec<_> = ran.iter().filter(|ran| ran.made > 0).map(|ran| ran.name).collect();
    let again = prepare(world);
    assert!(again.iter().all(|ran| ran.made == 0), "a second run makes nothing: {again:?}");
    made
}

fn turn(world: &mut World, view: Entity) {
    world.get::<&mut View>(view).unwrap().azimuth += 30.0;
}

#[test]
fn each_change_makes_again_what_depends_on_it_and_nothing_else() {
    let Ball { mut world, volume, light, view, .. } = ball();
    assert_eq!(made(&mut world), ["ranges", "classify", "relight", "pyramid"]);
    world.insert_one(volume, contour(90.0)).unwrap();
    assert_eq!(made(&mut world), ["classify", "relight", "pyramid"]);
    world.get::<&mut Material>(volume).unwrap().diffuse = 0.5;
    assert_eq!(made(&mut world), ["relight"]);
    world.get::<&mut gelray::components::Light>(light).unwrap().strength = 0.25;
    assert_eq!(made(&mut world), ["relight"]);
    world.insert_one(light, CastsShadow::default()).unwrap();
    assert_eq!(made(&mut world), ["relight"]);
    world.get::<&mut Sampling>(view).unwrap().texel = TexelKind::U8;
    assert_eq!(made(&mut world), ["relight", "pyramid"]);
    world.insert_one(view, DepthCue { k1: 1.0, k2: 0.01 }).unwrap();
    assert_eq!(made(&mut world), ["relight"]);
    world.get::<&mut Sampling>(view).unwrap().stop_at = 0.5;
    assert_eq!(made(&mut world), [""; 0]);
    world.get::<&mut Sampling>(view).unwrap().skip = Skip::None;
    assert_eq!(made(&mut world), [""; 0]);
    assert!(world.get::<&Pyramid>(volume).is_err());
}

#[test]
fn a_turn_of_the_view_makes_nothing_while_shading_does_not_depend_on_it() {
    let Ball { mut world, volume, view, .. } = ball();
    made(&mut world);
    turn(&mut world, view);
    assert_eq!(made(&mut world), [""; 0]);
    world.get::<&mut Material>(volume).unwrap().specular = 0.2;
    made(&mut world);
    turn(&mut world, view);
    assert_eq!(made(&mut world), ["relight"]);
}

#[test]
fn a_head_light_shades_again_with_every_turn_of_the_view() {
    let Ball { mut world, light, view, .. } = ball();
    world.despawn(light).unwrap();
    spawn_light(&mut world, 1, Toward::Observer(Observer::Observer));
    made(&mut world);
    turn(&mut world, view);
    assert_eq!(made(&mut world), ["relight"]);
}

#[test]
fn paint_is_neither_classified_nor_shaded() {
    let mut world = World::new();
    let grid = Grid::axis_aligned([9; 3], [1.0; 3], [0.0; 3]).unwrap();
    let painted = Painted::U8(Shared::new(vec![[255; 4]; grid.voxels()]));
    world.spawn((Order(0), grid, painted));
    spawn_light(&mut world, 1, Toward::Observer(Observer::Observer));
    let view = spawn_view(&mut world, &grid);
    assert_eq!(made(&mut world), ["relight", "pyramid"]);
    turn(&mut world, view);
    assert_eq!(made(&mut world), [""; 0]);
}

#[test]
fn a_world_without_volumes_prepares_nothing() {
    let mut world = World::new();
    let grid = Grid::axis_aligned([9; 3], [1.0; 3], [0.0; 3]).unwrap();
    spawn_light(&mut world, 1, Toward::Observer(Observer::Observer));
    spawn_view(&mut world, &grid);
    assert_eq!(made(&mut world), [""; 0]);
    for job in JOBS.iter().filter(|job| STAGES.contains(&job.name)) {
        assert_eq!((job.plan)(&world).makes, [], "{}", job.name);
    }
}

#[test]
fn what_is_no_longer_stated_is_taken_off() {
    let Ball { mut world, volume, .. } = ball();
    made(&mut world);
    world.remove_one::<Classify>(volume).unwrap();
    prepare(&mut world);
    let left = world.entity(volume).unwrap();
    assert!(!left.has::<Ranges>() && !left.has::<Opacity>());
    assert!(!left.has::<Gel>() && !left.has::<Pyramid>());
}

/// The bytes that a stage's product takes on an entity, if it is there.
fn taken(world: &World, stage: &str, entity: Entity) -> Option<u64> {
    match stage {
        "ranges" => world.get::<&Ranges>(entity).ok().map(|made| made.bytes()),
        "classify" => world.get::<&Opacity>(entity).ok().map(|made| made.voxels.bytes()),
        "relight" => world.get::<&Gel>(entity).ok().map(|made| {
            made.lit.bytes()
                + made.ambient.as_ref().map_or(0, gelray::volume::gel::GelBricks::bytes)
        }),
        _ => world.get::<&Pyramid>(entity).ok().map(|made| made.bytes()),
    }
}

#[test]
fn a_plan_names_what_is_then_made_and_never_too_few_bytes() {
    let Ball { mut world, light, view, grid, .. } = ball();
    // Every voxel of this one is interesting: the worst case.
    let values = sampled(&grid, |_| 5.0);
    spawn_volume(&mut world, grid, values, contour(5.0));
    let painted = Painted::U8(Shared::new(vec![[255; 4]; grid.voxels()]));
    world.spawn((Order(3), grid, painted));
    world.insert_one(light, CastsShadow::default()).unwrap();
    world.insert_one(view, DepthCue { k1: 1.0, k2: 0.01 }).unwrap();
    let plans: Vec<_> = STAGES
        .map(|stage| JOBS.iter().find(|job| job.name == stage).unwrap())
        .map(|job| (job.name, (job.plan)(&world)))
        .to_vec();
    prepare(&mut world);
    for (stage, plan) in plans {
        let entities: Vec<Entity> = world.iter().map(|entity| entity.entity()).collect();
        for entity in entities {
            let planned = plan.makes.iter().find(|(planned, _)| *planned == entity);
            let taken = taken(&world, stage, entity);
            assert_eq!(planned.is_some(), taken.is_some(), "{stage} {entity:?}");
            assert!(planned.map(|(_, bytes)| *bytes) >= taken, "{stage} {entity:?}");
        }
    }
}
