//! The most bytes that a view's sample array takes while its rays are cast, for a plan.

use glam::DVec3;
use hecs::{Or, World};

use super::beams::Patch;
use super::binned::Near;
use super::projected::ProjectedFace;
use super::slices;
use super::targets::{Outlines, looks_for_edges, most_opened};
use crate::components::{Classify, DepthCue, Sampling, Shaft, Surface, View, Voxelize};
use crate::polygon::face::{Face, Faces};
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::view::samples::{Layout, POSITIONS};
use crate::volume::grid::smallest_spacing;
use crate::volume::scene_volumes::{Content, volumes, with_content};

/// Bytes of a color of a block, and of the positions between in a block that is opened.
const COLOR: u64 = 16;
const FINE: u64 = COLOR * (POSITIONS * POSITIONS) as u64;
/// C_A and C_G of an opened block.
const EDGES: u64 = 2 * FINE / 4;

/// Those of a face on a view, and of its place in a beam or two.
const FACE: u64 = (size_of::<ProjectedFace>() + size_of::<Patch>() + 3 * size_of::<Near>()) as u64;

/// Pairs of faces that are looked at for where they meet; with more of them all of the picture may be split.
const MOST_PAIRS: usize = 1 << 22;

/// The part of the outlines that is expected to be seen: what is hidden, or edges of facets alike, is not split.
const SEEN: f64 = 0.5;
/// The part of what may be opened for silhouettes of surfaces that is expected to be.
const SILHOUETTES: f64 = 0.25;

/// The most bytes, and the part of them that is expected.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weight {
    pub most: u64,
    pub part: f64,
}

/// What the rays of a view take: C at every pixel; where polygons are traced or values have surfaces, C_A and C_G too; and the
/// positions between where a region may be split below a ray a pixel.
pub(crate) fn of(
    world: &World,
    layout: &Layout,
    (view, sampling, extent): (&View, &Sampling, &Extent),
) -> Weight {
    let mut query = world.query::<&Faces>().with::<&Surface>().without::<&Voxelize>();
    let traced: Vec<&Faces> = query.iter().collect();
    if let Some(most) = voxel_rays(world, traced.is_empty(), (view, sampling, extent)) {
        return Weight { most, part: 1.0 };
    }
    let blocks = layout.blocks().iter().product::<usize>() as u64;
    let all_open = (sampling.coarsest as usize) < POSITIONS;
    let surfaces = has_surfaces(world);
    let supersampled = keeps_edges(world, sampling);
    let colors = if supersampled { 3 } else { 1 };
    let (open, seen) = if all_open {
        (blocks, 1.0)
    } else if !supersampled {
        (0, 1.0)
    } else if surfaces {
        (blocks.min(most_opened(layout) as u64), SILHOUETTES)
    } else if world.query::<&DepthCue>().iter().next().is_some() {
        (blocks, SEEN)
    } else {
        (opened(&traced, &Camera::new(view, extent), layout).unwrap_or(blocks), SEEN)
    };
    // A number, flags of rays and of splits for each block, and the flags of two levels while they are decided on.
    // C_A and C_G are free again before there is a frame, which is planned for beside them: the lesser of both is counted once.
    let free = u64::from(supersampled);
    let faces: usize = traced.iter().map(|faces| faces.0.len()).sum();
    let always = blocks * ((colors - free) * COLOR + 4 + 2 + 1 + 2) + faces as u64 * FACE;
    let opened = open * (FINE + if supersampled { EDGES } else { 0 });
    let most = always + opened;
    Weight { most, part: (always as f64 + opened as f64 * seen) / most.max(1) as f64 }
}

/// Whether C_A and C_G are kept while rays of a view with such sampling are cast: where edges may ask for more than a ray a
/// pixel. Each takes as much as a picture, and is free again when rays are cast.
#[must_use]
pub fn keeps_edges(world: &World, sampling: &Sampling) -> bool {
    let mut traced = world.query::<&Faces>().with::<&Surface>().without::<&Voxelize>();
    let any = traced.iter().any(|faces| !faces.0.is_empty()) || has_surfaces(world);
    any && looks_for_edges(sampling)
}

/// The bytes of rays through voxels, where they are [asked](slices::asked) for: `alone` where no polygon is traced.
fn voxel_rays(
    world: &World,
    alone: bool,
    (view, sampling, extent): (&View, &Sampling, &Extent),
) -> Option<u64> {
    let alone = alone
        && view.field_of_view.is_none()
        && world.query::<Or<&Shaft, &DepthCue>>().iter().next().is_none();
    let volumes = volumes(world);
    let [volume] = &volumes[..] else { return None };
    let has_gel = !matches!(volume.content, Content::Values | Content::Projected);
    if sampling.per_voxel <= 0.0 || !alone || !has_gel {
        return None;
    }
    let distance = sampling.distance_mm.or(smallest_spacing([volume.grid]))?;
    slices::bytes(&volume.grid, &Camera::new(view, extent), distance, sampling)
}

/// Whether a volume of values has a surface, a contour without thickness.
fn has_surfaces(world: &World) -> bool {
    with_content(world, Content::Values).iter().any(|volume| {
        let classify = world.get::<&Classify>(volume.entity);
        classify.is_ok_and(|classify| classify.iso.iter().any(|c| c.thickness_voxels <= 0.0))
    })
}

/// The most blocks that are opened: those that outlines and intersections of polygons pass through, and those to the right
/// and below of them. `None` where some lie behind the eye, or polygons are too many to look at each pair.
fn opened(traced: &[&Faces], camera: &Camera, layout: &Layout) -> Option<u64> {
    let mut outlines = Outlines::none(layout, POSITIONS);
    let mut mark = |edge: [DVec3; 2]| {
        let drawn = |vertex: DVec3| {
            let (at, depth) = camera.project(vertex);
            let seen = camera.eye.is_none_or(|eye| depth > -0.99 * eye) && at.is_finite();
            seen.then(|| outlines.square(layout, at))
        };
        let [p, q] = edge.map(drawn);
        outlines.mark(p?, q?);
        Some(())
    };
    let faces: Vec<&Face> = traced.iter().flat_map(|faces| faces.0.iter()).collect();
    for (p, q) in faces.iter().flat_map(|face| face.outlines.edges()) {
        mark([p, q])?;
    }
    meetings(&faces, &mut mark)?;
    let Outlines { across, crossed, .. } = &outlines;
    let opened = |at: usize| {
        crossed[at]
            || (!at.is_multiple_of(*across) && crossed[at - 1])
            || at.checked_sub(*across).is_some_and(|above| crossed[above])
    };
    let within = (0..crossed.len()).filter(|at| opened(*at)).count();
    // The last blocks of a row and of the picture begin no region.
    let border = layout.blocks().iter().sum::<usize>();
    Some((within + border) as u64)
}

/// Hands out where two faces may meet: the part of the line of their planes that lies in the boxes of both.
fn meetings(faces: &[&Face], mut mark: impl FnMut([DVec3; 2]) -> Option<()>) -> Option<()> {
    let boxed = |face: &&Face| {
        let vertices = face.outlines.vertices();
        let ends = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        vertices.fold(ends, |[low, high], vertex| [low.min(vertex), high.max(vertex)])
    };
    let mut boxes: Vec<_> = faces.iter().map(|face| (boxed(face), *face)).collect();
    boxes.sort_by(|a, b| a.0[0].x.total_cmp(&b.0[0].x));
    let mut left = MOST_PAIRS;
    for (at, ([low, high], face)) in boxes.iter().enumerate() {
        for ([other_low, other_high], other) in
            boxes[at + 1..].iter().take_while(|(other, _)| other[0].x <= high.x)
        {
            left = left.checked_sub(1)?;
            let (low, high) = (low.max(*other_low), high.min(*other_high));
            if low.cmple(high).all()
                && let Some(line) = meeting(face, other, low, high)
            {
                mark(line)?;
            }
        }
    }
    Some(())
}

/// The part within a box of the line in which the planes of two faces meet; `None` for parallel ones and outside of it.
fn meeting(a: &Face, b: &Face, low: DVec3, high: DVec3) -> Option<[DVec3; 2]> {
    let along = a.normal.cross(b.normal);
    let square = along.length_squared();
    if square < 1e-18 {
        return None;
    }
    let [ha, hb] = [a, b].map(|face| face.normal.dot(face.center));
    let point = (b.normal.cross(along) * ha + along.cross(a.normal) * hb) / square;
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    // A little more, for what is rounded.
    let slack = 1e-6 * (high - low).max_element();
    for axis in (0..3).filter(|axis| along[*axis] != 0.0) {
        let ends = [low[axis] - slack, high[axis] + slack];
        let [p, q] = ends.map(|end| (end - point[axis]) / along[axis]);
        (from, to) = (from.max(p.min(q)), to.min(p.max(q)));
    }
    (from <= to).then(|| [point + along * from, point + along * to])
}
