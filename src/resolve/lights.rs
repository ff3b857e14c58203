//! Lights: their falloff over the scene, and the head light of a world that states none.

use hecs::{Entity, World};

use super::carriers::{carriers, get};
use super::fault::{Fault, Notice};
use super::order::spawn;
use crate::components::{CastsShadow, Color, Light, Observer, Projects, Shaft, Toward};
use crate::polygon::face::Faces;
use crate::view::extent::Extent;
use crate::volume::grid::{Grid, Painted};

/// On the light that was added because none was stated; it goes when one is.
struct HeadLight;

/// A light that has been looked at: what it states, and whether there was a volume.
#[derive(PartialEq)]
struct Seen([bool; 3], bool);

/// Checks the lights over the scene, and adds a head light where something wants light and none is stated.
pub(super) fn fill_in(
    world: &mut World,
    extent: Extent,
    notices: &mut Vec<Notice>,
) -> Result<(), Fault> {
    let mut lights = carriers::<Light>(world);
    lights.retain(|&light| world.get::<&HeadLight>(light).is_err());
    let volumes = carriers::<Grid>(world);
    for &light in &lights {
        check(world, light, extent)?;
        notice(world, light, !volumes.is_empty(), notices);
    }
    let painted = |&volume: &Entity| get::<Painted>(world, volume).is_some();
    let painted = !volumes.is_empty() && volumes.iter().all(painted);
    let wanted = lights.is_empty() && (!carriers::<Faces>(world).is_empty() || !painted);
    let heads = carriers::<HeadLight>(world);
    if wanted && heads.is_empty() {
        let toward = Toward::Observer(Observer::Observer);
        spawn(
            world,
            "head light",
            (Light { toward, strength: 1.0, color: Color::WHITE }, HeadLight),
        );
    }
    for head in heads.into_iter().filter(|_| !wanted) {
        let _ = world.despawn(head);
    }
    Ok(())
}

fn check(world: &World, light: Entity, extent: Extent) -> Result<(), Fault> {
    let shadow = get::<CastsShadow>(world, light);
    if let Some(CastsShadow { k1, k2, .. }) = shadow {
        falloff(k1, k2, extent).map_err(|p| Fault::of(light, "casts_shadow", "k2", p))?;
    }
    let shaft = get::<Shaft>(world, light);
    if shaft.is_some_and(|shaft| shaft.attenuated) && shadow.is_none() {
        let problem = "a beam that the volume weakens needs `casts_shadow` on its light; state it, or `attenuated = false`";
        return Err(Fault::of(light, "shaft", "attenuated", problem));
    }
    Ok(())
}

/// Says what a light states without effect, once.
fn notice(world: &mut World, light: Entity, any_volume: bool, notices: &mut Vec<Notice>) {
    let shadow = get::<CastsShadow>(world, light).is_some();
    let (shaft, projects) =
        (get::<Shaft>(world, light).is_some(), get::<Projects>(world, light).is_some());
    let seen = Seen([shadow, shaft, projects], any_volume);
    if world.get::<&Seen>(light).is_ok_and(|last| *last == seen) {
        return;
    }
    let _ = world.insert_one(light, seen);
    let mut say = |problem: String| notices.push(Notice { entity: light, problem });
    if projects && !shadow && !shaft {
        say("`projects` has no effect on a light that neither `casts_shadow` nor has a `shaft`: nothing says where its light falls; state `casts_shadow = {}`, or take it away".to_owned());
    }
    let keys = [("casts_shadow", shadow), ("shaft", shaft), ("projects", projects)];
    for (key, _) in keys.into_iter().filter(|(_, stated)| *stated && !any_volume) {
        say(format!("`{key}` has no effect without a `volume`; add one or take it away"));
    }
}

/// Passes if `k1 + k2 d` is above 0 for every distance within the scene's bounding sphere; it is linear, so at its ends.
pub(super) fn falloff(k1: f64, k2: f64, extent: Extent) -> Result<(), String> {
    let diameter = 2.0 * extent.radius();
    let far = k1 + k2 * diameter;
    if k1 > 0.0 && far > 0.0 && far.is_finite() {
        return Ok(());
    }
    Err(format!(
        "k1 + k2 d falls to {far:.3} over the scene's {diameter:.1} world units and must stay above 0; raise `k2` above {:.3e}",
        -k1 / diameter
    ))
}
