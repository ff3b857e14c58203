//! Furniture that stands in the gel: the rods of bounding boxes and the lines of callouts become faces.

use std::sync::Arc;

use glam::DVec3;
use hecs::{Entity, World};

use super::carriers::carriers;
use super::fault::Fault;
use super::fill::{fill, fill_from};
use crate::components::{BoundingBox, Callout, Color, Prism, Surface};
use crate::polygon::face::{Face, Faces};
use crate::polygon::shape::prism;
use crate::view::extent::Extent;
use crate::volume::scene_volumes::visible;

/// Gives bounding boxes and callouts their faces and surfaces.
pub(super) fn fill_in(world: &mut World) -> Result<(), Fault> {
    for entity in carriers::<Callout>(world) {
        fill_from(world, entity, |callout: &Callout| line(entity, callout))?;
        fill_from(world, entity, |callout: &Callout| Ok(flat(callout.color)))?;
    }
    let boxes = carriers::<BoundingBox>(world);
    if boxes.is_empty() {
        return Ok(());
    }
    let corners = visible(world).into_iter().flat_map(|volume| volume.grid.corners());
    let around = Extent::of(corners);
    for entity in boxes {
        let Some(around) = around else {
            let problem =
                "is around all volumes, and there is none; state a `volume` or take it away";
            return Err(Fault::of(entity, "bounding_box", "", problem));
        };
        let Some(stated) = super::carriers::get::<BoundingBox>(world, entity) else { continue };
        fill(world, entity, (stated.clone(), around), |(stated, around)| Ok(rods(stated, around)))?;
        fill(world, entity, stated, |stated| Ok(flat(stated.color)))?;
    }
    Ok(())
}

/// A surface that has its color whatever light falls on it.
fn flat(color: Color) -> Surface {
    Surface { color, ambient: 1.0, diffuse: 0.0, ..Surface::default() }
}

/// The line of a callout, a rod of square profile.
fn line(entity: Entity, callout: &Callout) -> Result<Faces, Fault> {
    let [at, from] = [callout.at, callout.from].map(DVec3::from);
    let width = callout.width_mm.unwrap_or(at.distance(from) / 100.0);
    let faces = rod(from, at, width);
    if faces.is_empty() {
        let problem = "has a line of no length; `at` and `from` must differ";
        return Err(Fault::of(entity, "callout", "from", problem));
    }
    Ok(Faces(Arc::new(faces)))
}

/// The twelve edges of a box.
fn rods(stated: &BoundingBox, around: &Extent) -> Faces {
    let width = stated.width_mm.unwrap_or(2.0 * around.radius() / 300.0);
    let corner = |n: usize| {
        let of =
            |axis: usize| if n >> axis & 1 == 1 { around.high[axis] } else { around.low[axis] };
        DVec3::new(of(0), of(1), of(2))
    };
    let edges = (0..8).flat_map(|n| (0..3).map(move |axis| (n, n | 1 << axis)));
    let edges = edges.filter(|(a, b)| a != b);
    Faces(Arc::new(edges.flat_map(|(a, b)| rod(corner(a), corner(b), width)).collect()))
}

/// A rod of square profile and of so many world units' width; no face where it has no length.
fn rod(from: DVec3, to: DVec3, width: f64) -> Vec<Face> {
    if from.distance(to) <= 0.0 {
        return Vec::new();
    }
    let radius = width * std::f64::consts::FRAC_1_SQRT_2;
    let (from, to) = (from.to_array(), to.to_array());
    let outlines = prism(&Prism { from, to, radius, to_radius: None, sides: 4 });
    outlines.into_iter().filter_map(|outline| Face::new(vec![outline]).ok()).collect()
}
