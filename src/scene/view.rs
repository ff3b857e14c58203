//! The view of a scene, the default one where none is stated, and the extent of what it can see.

use super::lights::falloff;
use super::loading::Loading;
use crate::components::{DepthCue, Sampling, View};
use crate::error::Error;
use crate::error::SceneError;
use crate::polygon::face::Faces;
use crate::view::extent::Extent;
use crate::volume::grid::Grid;

/// The bounding box of the volume's domain and of all polygons; the error is that there is neither.
pub(super) fn extent(loading: &Loading) -> Result<Extent, Error> {
    let entries = loading.nouns(&["volume", "polygon", "mesh"]);
    let corners =
        entries.iter().filter_map(|&entry| loading.get::<Grid>(entry)).flat_map(|g| g.corners());
    let faces: Vec<_> = entries.iter().filter_map(|&entry| loading.get::<Faces>(entry)).collect();
    let vertices =
        faces.iter().flat_map(|f| f.0.iter()).flat_map(|f| f.outlines.iter().flatten().copied());
    let refused = |problem| Err(SceneError::elsewhere(loading.text.file, problem).into());
    match Extent::of(corners.chain(vertices)) {
        Some(extent) if extent.radius().is_finite() => Ok(extent),
        Some(_) => {
            refused("its coordinates are too far apart to be computed with; state smaller ones")
        }
        None => refused(
            "there is nothing to see; state an entity with a `volume`, a `polygon` or a `mesh`",
        ),
    }
}

/// Gives the view its sampling and the extent of the scene; `exact` takes the settings of `--exact`.
pub(super) fn bring_in(loading: &mut Loading, extent: Extent, exact: bool) -> Result<(), Error> {
    let sampled = |stated: Sampling| if exact { stated.exact() } else { stated };
    let Some(&entry) = loading.nouns(&["view"]).first() else {
        loading.spawn("observer", (View::default(), sampled(Sampling::default()), extent));
        return Ok(());
    };
    if let Some(DepthCue { k1, k2 }) = loading.get(entry) {
        falloff(k1, k2, extent)
            .map_err(|problem| loading.error(entry, "depth_cue", "k2", problem))?;
    }
    let sampling = loading.get::<Sampling>(entry).unwrap_or_default();
    loading.add(entry, (sampled(sampling), extent));
    Ok(())
}
