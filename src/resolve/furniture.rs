//! Furniture that stands in the gel: the rods of bounding boxes and axes and the lines of callouts become faces.

use std::sync::Arc;

use glam::DVec3;
use hecs::{Entity, World};

use super::carriers::carriers;
use super::fault::Fault;
use super::fill::{fill, fill_from};
use crate::components::{Axes, BoundingBox, Callout, Color, Prism, Surface, View};
use crate::polygon::face::{Face, Faces};
use crate::polygon::shape::prism;
use crate::view::axes::{Axis, TICK, axes};
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::view::observer::first_view;
use crate::volume::scene_volumes::visible;

/// Gives bounding boxes and callouts their faces and surfaces.
pub(super) fn fill_in(world: &mut World) -> Result<(), Fault> {
    for entity in carriers::<Callout>(world) {
        fill_from(world, entity, |callout: &Callout| line(entity, callout))?;
        fill_from(world, entity, |callout: &Callout| Ok(flat(callout.color)))?;
    }
    let (boxes, axes) = (carriers::<BoundingBox>(world), carriers::<Axes>(world));
    if boxes.is_empty() && axes.is_empty() {
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
    for entity in axes {
        let Some(around) = around else {
            let problem =
                "are those of volumes, and there is none; state a `volume` or take them away";
            return Err(Fault::of(entity, "axes", "", problem));
        };
        let Some(stated) = super::carriers::get::<Axes>(world, entity) else { continue };
        let ticked = axes_of(world, &stated, &around);
        fill(world, entity, (stated.clone(), around, ticked), |(stated, around, ticked)| {
            Ok(ticks(stated, around, ticked))
        })?;
        fill(world, entity, stated, |stated| Ok(flat(stated.color)))?;
    }
    Ok(())
}

/// The axes of a box for the first view: where it looks from makes a difference, and how far from does not.
fn axes_of(world: &World, stated: &Axes, around: &Extent) -> [Axis; 3] {
    let view = first_view(world).and_then(|entity| super::carriers::get::<View>(world, entity));
    axes(around, &Camera::new(&view.unwrap_or_default(), around), stated.step_mm)
}

/// The rods of axes and of their ticks.
fn ticks(stated: &Axes, around: &Extent, axes: &[Axis; 3]) -> Faces {
    let diagonal = 2.0 * around.radius();
    let width = stated.width_mm.unwrap_or(diagonal / 300.0);
    let tick = diagonal * TICK;
    let mut faces = Vec::new();
    for axis in axes {
        faces.extend(rod(axis.ends[0], axis.ends[1], width));
        for at in axis.ticks.iter().map(|value| axis.at(*value)) {
            faces.extend(rod(at, at + axis.out * tick, width));
        }
    }
    Faces(Arc::new(faces))
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
