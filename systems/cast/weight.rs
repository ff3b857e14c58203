//! The most bytes that a view's sample array takes while its rays are cast, for a plan.

use glam::DVec2;
use hecs::World;

use crate::components::{DepthCue, Sampling, Surface, View, Voxelize};
use crate::polygon::face::Faces;
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::view::samples::{Layout, POSITIONS};

/// Bytes of a color of a block, and of the positions between in a block that is opened.
const COLOR: u64 = 16;
const FINE: u64 = COLOR * (POSITIONS * POSITIONS) as u64;

/// So many faces more are not looked at one by one: all of the picture may be split below a ray a pixel.
const MOST_FACES: usize = 1 << 12;

/// Blocks that are opened for a step of an outline from pixel to pixel: its own and those to the right and below, which
/// mostly are the next step's own.
const A_PIXEL: f64 = 2.5;

/// What the rays of a view take: C at every pixel; where polygons are traced, C_A and C_G too; and the positions between
/// where a region may be split below a ray a pixel.
pub fn most_bytes(
    world: &World,
    layout: &Layout,
    (view, sampling, extent): (&View, &Sampling, &Extent),
) -> u64 {
    let mut query = world.query::<&Faces>().with::<&Surface>().without::<&Voxelize>();
    let traced: Vec<&Faces> = query.iter().collect();
    let faces: usize = traced.iter().map(|faces| faces.0.len()).sum();
    let blocks = layout.blocks().iter().product::<usize>() as u64;
    let all_open = (sampling.coarsest as usize) < POSITIONS;
    let supersampled =
        faces > 0 && (sampling.finest as usize) < POSITIONS && sampling.coarsest > sampling.finest;
    let colors = if supersampled { 3 } else { 1 };
    let open = if all_open {
        blocks
    } else if !supersampled {
        0
    } else if faces > MOST_FACES || world.query::<&DepthCue>().iter().next().is_some() {
        blocks
    } else {
        opened(&traced, faces, &Camera::new(view, extent)).map_or(blocks, |open| open.min(blocks))
    };
    // A number, flags of rays and of splits for each block, and the flags of two levels while they are decided on.
    blocks * (colors * COLOR + 4 + 2 + 1 + 2) + open * colors * FINE
}

/// The most blocks that outlines and intersections of polygons pass through; `None` where some lie behind the eye.
fn opened(traced: &[&Faces], faces: usize, camera: &Camera) -> Option<u64> {
    let window = camera.size.iter().sum::<usize>() as f64;
    let mut length = 0.0;
    for outline in traced.iter().flat_map(|faces| faces.0.iter()).flat_map(|face| &face.outlines) {
        let drawn: Option<Vec<DVec2>> = outline
            .iter()
            .map(|vertex| {
                let (at, depth) = camera.project(*vertex);
                let seen = camera.eye.is_none_or(|eye| depth > -0.99 * eye) && at.is_finite();
                seen.then_some(at)
            })
            .collect();
        let drawn = drawn?;
        let next = drawn.iter().cycle().skip(1);
        let pixels = |(a, b): (&DVec2, &DVec2)| (*a - *b).abs().element_sum().min(window) + 2.0;
        length += drawn.iter().zip(next).map(pixels).sum::<f64>();
    }
    // Two polygons meet along a line no longer than half of the shorter outline.
    let meeting = 1.0 + (faces.saturating_sub(1) as f64) / 4.0;
    Some((A_PIXEL * length * meeting) as u64)
}
