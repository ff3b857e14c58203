//! `furnish`: what is written and drawn over a view's picture: titles, scale bars, legends, the text of callouts and axes,
//! orientation cubes.

mod axes;
mod layout;

use glam::DVec3;
use hecs::{Entity, World};

use crate::components::{
    Axes, Callout, Classify, Color, Legend, Name, Order, OrientationCube, ScaleBar, Title, View,
};
use crate::error::Error;
use crate::schedule::{Outbox, Plan, ProductKey, System};
use crate::view::axes::TICK;
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::view::overlay::Overlay;
use crate::volume::scene_volumes::visible;
use layout::Sheet;

/// Makes the [`Overlay`] of every view of a scene that states furniture.
pub(crate) struct Furnish;

/// What is drawn, in the order of the scene.
#[derive(Debug, Clone, PartialEq)]
enum Drawn {
    Bar(ScaleBar),
    Title(Title),
    /// With the values and colors of the volume that it is of.
    Legend(Legend, Vec<(f32, Color)>),
    Text(Callout),
    /// With the box that they are of.
    Axes(Axes, Extent),
    Cube(OrientationCube),
}

#[derive(PartialEq)]
struct Inputs {
    camera: Camera,
    background: Option<Color>,
    drawn: Vec<Drawn>,
}

impl System for Furnish {
    type Product = Overlay;
    const NAME: &'static str = "furnish";
    const READS: &'static [ProductKey] = &[];

    fn run(world: &World, out: &mut Outbox<'_, Overlay>) -> Result<(), Error> {
        let drawn = drawn(world)?;
        if drawn.is_empty() {
            return Ok(());
        }
        for (entity, view, extent) in &mut world.query::<(Entity, &View, &Extent)>() {
            let (camera, background) = (Camera::new(view, extent), view.background);
            let inputs = Inputs { camera, background, drawn: drawn.clone() };
            out.derive(entity, inputs, |inputs| Ok(inputs.furnish()))?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let stated = drawn(world).is_ok_and(|drawn| !drawn.is_empty());
        if !stated {
            return Plan::absent(
                "no `title`, `scale_bar`, `legend`, `callout`, `axes` or `orientation_cube` is stated",
            );
        }
        let mut views = world.query::<(Entity, &View)>();
        let bytes = |view: &View| view.size.iter().map(|&n| u64::from(n)).product::<u64>() * 16;
        let makes = views.iter().map(|(entity, view)| (entity, bytes(view))).collect();
        Plan::of_most(makes, "furniture is drawn over the picture")
    }
}

/// The furniture of a scene; the error is about a legend of what has no colors.
fn drawn(world: &World) -> Result<Vec<Drawn>, Error> {
    type Stated<'a> = (
        Option<&'a Order>,
        Entity,
        Option<&'a ScaleBar>,
        Option<&'a Title>,
        Option<&'a Legend>,
        Option<&'a Callout>,
        (Option<&'a Axes>, Option<&'a OrientationCube>),
    );
    let mut query = world.query::<Stated<'_>>();
    let mut all: Vec<_> = query.iter().collect();
    all.sort_by_key(|(order, entity, ..)| (order.copied(), *entity));
    let mut drawn = Vec::new();
    let corners = visible(world).into_iter().flat_map(|volume| volume.grid.corners());
    let around = Extent::of(corners);
    for (_, _, bar, title, legend, callout, (axes, cube)) in all {
        drawn.extend(axes.cloned().zip(around).map(|(axes, around)| Drawn::Axes(axes, around)));
        drawn.extend(cube.cloned().map(Drawn::Cube));
        drawn.extend(bar.cloned().map(Drawn::Bar));
        drawn.extend(title.cloned().map(Drawn::Title));
        drawn.extend(callout.cloned().map(Drawn::Text));
        if let Some(legend) = legend {
            drawn.push(Drawn::Legend(legend.clone(), colors(world, legend)?));
        }
    }
    Ok(drawn)
}

/// The values and colors of the volume that a legend is of; none where it is of none.
fn colors(world: &World, legend: &Legend) -> Result<Vec<(f32, Color)>, Error> {
    let Some(of) = &legend.of else { return Ok(Vec::new()) };
    let mut volumes = world.query::<(&Name, &Classify)>();
    let found = volumes.iter().find(|(name, _)| name.0 == *of);
    let points = found.map(|(_, classify)| &classify.transfer[..]).unwrap_or_default();
    if points.len() < 2 {
        let problem = format!(
            "is of `{of}`, which is no volume with a `transfer` or `colormap`; name one that has"
        );
        return Err(Error::entity("legend", problem));
    }
    Ok(points.iter().map(|p| (p.value, p.color.unwrap_or(Color::WHITE))).collect())
}

impl Inputs {
    fn furnish(&self) -> Overlay {
        let mut layout = Sheet::new(self.camera.size, self.background);
        // What has a corner of its own comes first, and axes give way.
        let is_axes = |drawn: &&Drawn| matches!(drawn, Drawn::Axes(..));
        let first = self.drawn.iter().filter(|drawn| !is_axes(drawn));
        for drawn in first.chain(self.drawn.iter().filter(is_axes)) {
            match drawn {
                Drawn::Bar(bar) => layout.scale_bar(bar, self.camera.pixel),
                Drawn::Title(title) => layout.title(title),
                Drawn::Cube(cube) => layout.cube(cube, &self.camera),
                Drawn::Axes(stated, around) => {
                    let axes = crate::view::axes::axes(around, &self.camera, stated.step_mm);
                    let tick = 2.0 * around.radius() * TICK;
                    layout.axes(stated, &axes, &self.camera, tick);
                }
                Drawn::Legend(legend, colors) => layout.legend(legend, colors),
                Drawn::Text(callout) => {
                    let [at, from] = [callout.at, callout.from].map(|p| {
                        let (window, depth) = self.camera.project(DVec3::from(p));
                        (depth >= self.camera.nearest()).then_some(window)
                    });
                    if let (Some(at), Some(from)) = (at, from) {
                        layout.callout(callout, from.x < at.x, from.as_vec2());
                    }
                }
            }
        }
        Overlay(layout.canvas.picture())
    }
}
