//! The lights of a scene, and the head light of a scene that states none.

use super::loading::Loading;
use crate::components::{CastsShadow, Color, Light, Observer, Projects, Shaft, Toward};
use crate::error::Error;
use crate::view::extent::Extent;
use crate::volume::grid::Painted;

/// Checks the falloff of shadows over the scene, and adds a head light where something wants light and none is stated.
pub(super) fn bring_in(loading: &mut Loading, extent: Extent) -> Result<(), Error> {
    let lights = loading.nouns(&["light"]);
    let volumes = loading.nouns(&["volume"]);
    for &entry in &lights {
        let shadow = loading.get::<CastsShadow>(entry);
        if let Some(CastsShadow { k1, k2, .. }) = shadow {
            falloff(k1, k2, extent)
                .map_err(|problem| loading.error(entry, "casts_shadow", "k2", problem))?;
        }
        let shaft = loading.get::<Shaft>(entry);
        if shaft.is_some_and(|shaft| shaft.attenuated) && shadow.is_none() {
            let problem = "a beam that the volume weakens needs `casts_shadow` on its light; state it, or `attenuated = false`";
            return Err(loading.error(entry, "shaft", "attenuated", problem));
        }
        let projects = loading.get::<Projects>(entry).is_some();
        if projects && shadow.is_none() && shaft.is_none() {
            let problem = "`projects` has no effect on a light that neither `casts_shadow` nor has a `shaft`: nothing says where its light falls; state `casts_shadow = {}`, or take it away";
            loading.warn(entry, problem);
        }
        let keys = [
            ("casts_shadow", shadow.is_some()),
            ("shaft", shaft.is_some()),
            ("projects", projects),
        ];
        for (key, _) in keys.into_iter().filter(|(_, stated)| *stated && volumes.is_empty()) {
            loading.warn(
                entry,
                format!("`{key}` has no effect without a `volume`; add one or take it away"),
            );
        }
    }
    let painted =
        !volumes.is_empty() && volumes.iter().all(|&entry| loading.get::<Painted>(entry).is_some());
    let polygons = !loading.nouns(&["polygon", "mesh"]).is_empty();
    if lights.is_empty() && (polygons || !painted) {
        let toward = Toward::Observer(Observer::Observer);
        loading.spawn("head light", (Light { toward, strength: 1.0, color: Color::WHITE },));
    }
    Ok(())
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
