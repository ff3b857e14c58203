//! Every scene that is part of the program: sound at a small size, as planned, and thrifty.

use gelray::components::View;
use gelray::scene::EMBEDDED;
use gelray::systems::JOBS;
use gelray::view::picture::Frame;
use gelray::view::samples::Samples;
use gelray::volume::gel::Gel;
use gelray::volume::layer::Opacity;
use gelray::volume::pyramid::Pyramid;
use gelray::volume::ranges::Ranges;
use hecs::EntityRef;

use super::support::{Shown, assert_sound, rendered, run};

/// The bytes that a system's product takes on an entity, where they can be told; `None` without the product.
fn taken(entity: EntityRef<'_>, system: &str) -> Option<u64> {
    fn bytes<P: hecs::Component>(entity: EntityRef<'_>, of: impl Fn(&P) -> u64) -> Option<u64> {
        entity.get::<&P>().map(|product| of(&product))
    }
    match system {
        "ranges" => bytes(entity, |made: &Ranges| made.bytes()),
        "classify" => bytes(entity, |made: &Opacity| made.voxels.bytes()),
        "relight" => bytes(entity, |made: &Gel| {
            made.lit.bytes()
                + made.ambient.as_ref().map_or(0, gelray::volume::gel::GelBricks::bytes)
        }),
        "pyramid" => bytes(entity, Pyramid::bytes),
        "cast" => bytes(entity, |made: &Samples| {
            let array = &made.0;
            let colors = array.colors.lattice.len() * 16 + array.colors.fine.len() * 256;
            (colors + array.opened.len() * 4 + array.cast.len() * 2 + array.splits.len()) as u64
        }),
        "resample" => bytes(entity, |made: &Frame| made.0.pixels.bytes()),
        _ => None,
    }
}

#[test]
fn every_embedded_scene_is_sound_and_runs_as_planned() {
    for (name, _) in EMBEDDED {
        let Shown { mut world, view } = Shown::embedded(name, &[]);
        world.get::<&mut View>(view).unwrap().size = [20, 24];
        let plans: Vec<_> = JOBS.iter().map(|job| (job.name, (job.plan)(&world))).collect();
        let ran = run(&mut world);
        for (system, plan) in plans {
            let ran = ran.iter().find(|ran| ran.name == system).unwrap();
            assert_eq!(ran.made as usize, plan.makes.len(), "{name}: {system}");
            for entity in &world {
                let planned = plan.makes.iter().find(|(planned, _)| *planned == entity.entity());
                if let Some(taken) = taken(entity, system) {
                    let bytes = planned.map(|(_, bytes)| *bytes);
                    assert!(bytes >= Some(taken), "{name}: {system} takes {taken} of {bytes:?}");
                }
            }
        }
        let made = rendered(&world, view);
        assert_sound(&made.picture, name);
        assert!(made.picture.pixels.iter().any(|pixel| pixel[3] > 0.5), "{name} shows something");
        assert!(run(&mut world).iter().all(|ran| ran.made == 0), "{name}: a second run");
    }
}
