//! The view: the default one where none is stated, its sampling, and the extent of what it can see.

use hecs::{Entity, World};

use super::carriers::{carriers, get};
use super::fault::{Fault, Notice};
use super::fill::fill;
use super::lights::falloff;
use super::order::spawn;
use crate::components::{Axes, DepthCue, Legend, Light, Sampling, TexelKind, Title, View};
use crate::polygon::face::Faces;
use crate::view::extent::Extent;
use crate::volume::grid::{Grid, smallest_spacing};
use crate::volume::scene_volumes::visible;

/// How much larger a box, at both ends of each side, a default view frames where letters stand around it, as a part of it.
const ROOM: f64 = 0.08;

/// On the view that was added because none was stated; it goes when one is.
struct DefaultView;

/// The bounding box of the domains of all volumes and of all polygons; the error is that there is neither.
pub(super) fn extent(world: &World) -> Result<Extent, Fault> {
    let (mut grids, mut faces) = (world.query::<&Grid>(), world.query::<&Faces>());
    let corners = grids.iter().flat_map(Grid::corners);
    let faces = faces.iter().flat_map(|faces| faces.0.iter());
    match Extent::of(corners.chain(faces.flat_map(|face| face.outlines.vertices()))) {
        Some(extent) if extent.radius().is_finite() => Ok(extent),
        Some(_) => Err(Fault::of_all(
            "its coordinates are too far apart to be computed with; state smaller ones",
        )),
        None => Err(Fault::of_all(
            "there is nothing to see; state an entity with a `volume`, a `polygon` or a `mesh`",
        )),
    }
}

/// Gives every view its sampling and the extent of the scene, and a world without a view the default one.
pub(super) fn fill_in(
    world: &mut World,
    extent: Extent,
    notices: &mut Vec<Notice>,
) -> Result<(), Fault> {
    let default = carriers::<DefaultView>(world);
    let views = carriers::<View>(world);
    if views.is_empty() {
        spawn(world, "observer", (View::default(), DefaultView));
    }
    for view in default.into_iter().filter(|_| views.len() > 1) {
        let _ = world.despawn(view);
    }
    let framed = if is_lettered(world) { extent.grown(ROOM) } else { extent };
    for view in carriers::<View>(world) {
        if let Some(DepthCue { k1, k2 }) = get(world, view) {
            falloff(k1, k2, extent).map_err(|p| Fault::of(view, "depth_cue", "k2", p))?;
        }
        fill(world, view, (), |()| Ok(Sampling::default()))?;
        fill(world, view, framed, |framed| Ok(*framed))?;
        check_distance(world, view, extent)?;
        notices.extend(cut_colors(world, view));
    }
    Ok(())
}

/// Whether something is written around what is seen.
fn is_lettered(world: &World) -> bool {
    let any = (carriers::<Title>(world).len(), carriers::<Axes>(world).len());
    any != (0, 0) || !carriers::<Legend>(world).is_empty()
}

/// Says that texels of whole numbers cut colors which lights make brighter than 1.
fn cut_colors(world: &World, view: Entity) -> Option<Notice> {
    let texel = get::<Sampling>(world, view)?.texel;
    let whole = matches!(texel, TexelKind::U16 | TexelKind::U8) && !visible(world).is_empty();
    let sum: f64 = world.query::<&Light>().iter().map(|light| f64::from(light.strength)).sum();
    let problem = format!(
        "`texel` keeps colors up to 1 and the lights sum to {sum}: what is brighter is cut; state \"auto\" or \"f32\""
    );
    (whole && sum > 1.0).then_some(Notice { entity: view, problem })
}

/// The most samples that a ray may have before it is refused as a slip: a thousand for each voxel of a thousand in a row.
const MOST_SAMPLES: f64 = (1 << 20) as f64;

/// Refuses a sample distance at which a ray has more than [`MOST_SAMPLES`].
fn check_distance(world: &World, view: Entity, extent: Extent) -> Result<(), Fault> {
    let volumes = visible(world);
    let Some(smallest) = smallest_spacing(volumes.iter().map(|volume| volume.grid)) else {
        return Ok(());
    };
    let stated = get::<Sampling>(world, view).and_then(|sampling| sampling.distance_mm);
    let samples = extent.samples(stated.unwrap_or(smallest));
    if samples <= MOST_SAMPLES {
        return Ok(());
    }
    let most = MOST_SAMPLES;
    let least = 2.0 * extent.radius() / most;
    let problem = format!(
        "samples so near would be {samples:.0} along a ray through the scene, and {most} are the most; state a `distance_mm` of at least {least:.3e} or leave it away"
    );
    Err(Fault::of(view, "sampling", "distance_mm", problem))
}
