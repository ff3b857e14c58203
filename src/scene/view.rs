//! The view of a scene, the default one where none is stated, and the extent of what it can see.

use super::lights::falloff;
use super::loading::Loading;
use crate::components::{DepthCue, Sampling, View};
use crate::error::Error;
use crate::error::SceneError;
use crate::polygon::face::Faces;
use crate::view::extent::Extent;
use crate::volume::grid::Grid;
use crate::volume::scene_volumes::visible;

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

/// The most samples that a ray may have before it is refused as a slip: a thousand for each voxel of a thousand in a row.
const MOST_SAMPLES: f64 = (1 << 20) as f64;

/// Refuses a sample distance at which a ray has more than [`MOST_SAMPLES`].
fn check_distance(loading: &Loading, sampling: &Sampling, extent: Extent) -> Result<(), Error> {
    let volumes = visible(&loading.world);
    let smallest =
        volumes.iter().map(|v| v.grid.spacing().min_element()).fold(f64::INFINITY, f64::min);
    let samples = extent.samples(sampling.distance_mm.unwrap_or(smallest));
    if volumes.is_empty() || samples <= MOST_SAMPLES {
        return Ok(());
    }
    let most = MOST_SAMPLES;
    let least = 2.0 * extent.radius() / most;
    let problem = format!(
        "samples so near would be {samples:.0} along a ray through the scene, and {most} are the most; state a `distance_mm` of at least {least:.3e} or leave it away"
    );
    match loading.nouns(&["view"]).first() {
        Some(&entry) => Err(loading.error(entry, "sampling", "distance_mm", problem)),
        None => Err(SceneError::elsewhere(loading.text.file, problem).into()),
    }
}

/// Gives the view its sampling and the extent of the scene; `exact` takes the settings of `--exact`.
pub(super) fn bring_in(loading: &mut Loading, extent: Extent, exact: bool) -> Result<(), Error> {
    let sampled = |stated: Sampling| if exact { stated.exact() } else { stated };
    let Some(&entry) = loading.nouns(&["view"]).first() else {
        check_distance(loading, &Sampling::default(), extent)?;
        loading.spawn("observer", (View::default(), sampled(Sampling::default()), extent));
        return Ok(());
    };
    if let Some(DepthCue { k1, k2 }) = loading.get(entry) {
        falloff(k1, k2, extent)
            .map_err(|problem| loading.error(entry, "depth_cue", "k2", problem))?;
    }
    let sampling = loading.get::<Sampling>(entry).unwrap_or_default();
    check_distance(loading, &sampling, extent)?;
    loading.add(entry, (sampled(sampling), extent));
    Ok(())
}
