//! What the products of each stage count and how many bytes they take, read off a world that was rendered.

use hecs::{Component, World};

use crate::light::strength::LightStrength;
use crate::measure::judged::Judged;
use crate::polygon::face::Faces;
use crate::polygon::texture::{MappedTexture, TexturedBy};
use crate::view::overlay::Overlay;
use crate::view::picture::{Frame, Picture};
use crate::view::samples::{SampleArray, Samples};
use crate::view::voxel_rays::VoxelRays;
use crate::volume::coefficients::Coefficients;
use crate::volume::gel::{Gel, GelBricks};
use crate::volume::grid::{Grid, Painted, Scalars};
use crate::volume::layer::{Composite, Coverage, Layer, LitColors, Opacity};
use crate::volume::pyramid::Pyramid;
use crate::volume::ranges::Ranges;

/// What a stage left in a world.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Held {
    /// Bytes of its products.
    pub bytes: u64,
    /// Counts of them, each with what is counted.
    pub counts: Vec<(&'static str, u64)>,
}

/// What a stage left in a world, by the name of its span: `load` left voxels and polygons. `None` for a name that no stage has.
#[must_use]
pub fn held(world: &World, stage: &str) -> Option<Held> {
    let held = match stage {
        "load" => loaded(world),
        "ranges" => bytes(sum(world, Ranges::bytes)),
        "prefilter" => {
            bytes(sum(world, |c: &Coefficients| c.values.len() as u64 * size_of::<f32>() as u64))
        }
        "classify" => classified(world),
        "scan_convert" => {
            with("polygons", count::<Coverage>(world), sum(world, |c: &Coverage| of_layer(&c.0)))
        }
        "matte" => bytes(sum(world, |c: &Composite| of_layer(&c.0))),
        "light_sweep" => {
            with("lights", count::<LightStrength>(world), sum(world, LightStrength::bytes))
        }
        "relight" => bytes(sum(world, of_gel)),
        "pyramid" => bytes(sum(world, Pyramid::bytes)),
        "cast" => cast(world),
        "furnish" => bytes(sum(world, |overlay: &Overlay| of_picture(&overlay.0))),
        "judge" => with(
            "exact pixels",
            sum(world, |judged: &Judged| judged.pixels),
            sum(world, |judged: &Judged| size_of_val(&judged.exact[..]) as u64),
        ),
        "resample" => bytes(sum(world, |frame: &Frame| of_picture(&frame.0))),
        _ => return None,
    };
    Some(held)
}

fn bytes(bytes: u64) -> Held {
    Held { bytes, counts: Vec::new() }
}

fn with(what: &'static str, count: u64, bytes: u64) -> Held {
    Held { bytes, counts: vec![(what, count)] }
}

/// The sum over all entities that carry a component.
fn sum<C: Component>(world: &World, of: impl Fn(&C) -> u64) -> u64 {
    world.query::<&C>().iter().map(of).sum()
}

fn count<C: Component>(world: &World) -> u64 {
    sum(world, |_: &C| 1)
}

fn loaded(world: &World) -> Held {
    let voxels = sum(world, |grid: &Grid| grid.size.iter().map(|n| *n as u64).product());
    let polygons = sum(world, |faces: &Faces| faces.0.len() as u64);
    let bytes = sum(world, Scalars::bytes) + sum(world, Painted::bytes) + sum(world, Faces::bytes);
    let bytes =
        bytes + sum(world, |by: &TexturedBy| by.laid.all().iter().map(MappedTexture::bytes).sum());
    Held { bytes, counts: vec![("voxels", voxels), ("polygons", polygons)] }
}

/// Classification and shading cost in proportion to the interesting voxels: those whose opacity is not zero (§7).
fn classified(world: &World) -> Held {
    let interesting = |opacity: &Opacity| -> u64 {
        let bricks = opacity.voxels.stored();
        bricks.map(|(_, voxels)| voxels.iter().filter(|a| **a > 0.0).count() as u64).sum()
    };
    let bytes = sum(world, |opacity: &Opacity| opacity.voxels.bytes());
    with("interesting voxels", sum(world, interesting), bytes)
}

fn of_colors(colors: &LitColors) -> u64 {
    let beside = colors.shadowed.iter().chain(&colors.ambient);
    beside.fold(colors.base.bytes(), |sum, bricks| sum + bricks.bytes())
}

fn of_layer(layer: &Layer) -> u64 {
    layer.opacity.bytes() + of_colors(&layer.colors)
}

fn of_gel(gel: &Gel) -> u64 {
    gel.lit.bytes() + gel.ambient.as_ref().map_or(0, GelBricks::bytes)
}

fn of_picture(picture: &Picture) -> u64 {
    (picture.pixels.len() * size_of::<[f32; 4]>()) as u64
}

fn cast(world: &World) -> Held {
    let views: Vec<_> = world.query::<&Samples>().iter().cloned().collect();
    let total = |of: &dyn Fn(&SampleArray) -> u64| views.iter().map(|view| of(&view.0)).sum();
    let counts = vec![
        ("rays", total(&|array| array.counts.rays)),
        ("samples", total(&|array| array.counts.samples)),
        ("polygon hits", total(&|array| array.counts.polygon_hits)),
        ("slivers", total(&|array| array.counts.slivers)),
    ];
    let of_array = |array: &SampleArray| {
        let colors = size_of_val(&array.colors.lattice[..]) + size_of_val(&array.colors.fine[..]);
        let beside = size_of_val(&array.opened[..]) + size_of_val(&array.cast[..]);
        let voxel_rays = array.voxel_rays.as_ref().map_or(0, VoxelRays::bytes);
        (colors + beside + array.splits.len()) as u64 + voxel_rays
    };
    Held { bytes: total(&of_array), counts }
}
