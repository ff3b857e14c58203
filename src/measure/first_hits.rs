//! What is seen first of each pixel: how deep it lies, which way it faces, and of which entity it is.
//!
//! A pixel's ray through its middle meets what makes it half opaque: where its transparency falls below ½, in gel or at a
//! polygon. Textures are left out, and so are volumes that are projected. Of all faces a pixel asks those drawn near it
//! (`tiles`), and of slabs those in which a volume may show anything (`passage`); what it finds is what it would find in all.

mod gelled;
mod passage;
mod tiles;
mod traced;
mod valued;

use glam::DVec3;
use hecs::World;
use rayon::prelude::*;

use crate::components::{Classify, Clip, Material, Order, Sampling, Surface, View, Voxelize};
use crate::error::Error;
use crate::polygon::face::{Face, FaceOpacities, Faces};
use crate::polygon::smooth::CornerNormals;
use crate::view::camera::Camera;
use crate::view::composite::thicken;
use crate::view::extent::Extent;
use crate::view::observer::first_view;
use crate::view::ray::Ray;
use crate::volume::coefficients::Coefficients;
use crate::volume::gel::Gel;
use crate::volume::grid::{Scalars, smallest_spacing};
use crate::volume::pyramid::Pyramid;
use crate::volume::ranges::Ranges;
use crate::volume::scene_volumes::{Content, SceneVolume, volumes};
use crate::with_texels;
use gelled::Gelled;
use passage::{Passage, Room, Sought};
use tiles::{Pixels, Tiles};
use traced::{Traced, pixels};
use valued::{Crossed, Valued};

/// What a ray lets through where it has met something.
const HALF: f64 = 0.5;

/// For each pixel, row by row from the top, what its middle shows first.
#[derive(Debug, Clone, PartialEq)]
pub struct FirstHits {
    /// Pixels across and down.
    pub size: [usize; 2],
    /// Depth from the focal plane along the line of sight, world units, less is nearer; NaN where nothing is met.
    pub depth: Vec<f32>,
    /// The unit normal, world, on the side that is seen: of a smooth mesh that of the surface that it stands for; zeros where
    /// nothing is met or the gel has no slope.
    pub normal: Vec<[f32; 3]>,
    /// The place in the scene of the entity that is met, from 1; 0 where nothing is.
    pub entity: Vec<u32>,
}

/// What a ray met.
#[derive(Clone, Copy)]
struct Hit {
    depth: f64,
    normal: DVec3,
    entity: u32,
}

/// The first hits of a world whose systems have run, on its first view.
///
/// Fails without a view.
pub fn first_hits(world: &World) -> Result<FirstHits, Error> {
    Ok(Scene::of(world)?.hits())
}

/// What is traced, and what is known of it.
type SeenFaces<'a> = (&'a Faces, &'a Surface, Own<'a>, Option<&'a Order>);

/// What faces have of their own.
type Own<'a> = (Option<&'a FaceOpacities>, Option<&'a CornerNormals>);

/// All polygons that are traced, of those that any pixels may meet.
fn traced(world: &World, pixels: impl Fn(&Face) -> Option<Pixels> + Sync) -> Vec<Traced> {
    let mut all = world.query::<SeenFaces<'_>>().without::<&Voxelize>();
    let of_entity = |(faces, surface, (opacities, normals), order): SeenFaces| {
        let traced = |(at, face): (usize, &Face)| {
            let opacity = f64::from(surface.opacity * FaceOpacities::of(opacities, at));
            let pixels = pixels(face)?;
            let bent = normals.and_then(|normals| normals.over(at, face));
            Some(Traced::new((face, bent), pixels, opacity, number(order)))
        };
        faces.0.par_iter().enumerate().filter_map(traced).collect::<Vec<_>>()
    };
    all.iter().flat_map(of_entity).collect()
}

/// A volume as rays of the view sample it; `None` where it has neither gel nor values.
fn asked(world: &World, volume: &SceneVolume, sampling: &Sampling) -> Option<Volume> {
    let SceneVolume { entity, grid, unit, content } = *volume;
    let order = world.get::<&Order>(entity).ok();
    let pyramid = world.get::<&Pyramid>(entity).map(|pyramid| (*pyramid).clone()).ok();
    let (content, room) = if content == Content::Values {
        type Stated<'a> = (&'a Scalars, &'a Classify, Option<&'a Material>, Option<&'a Clip>);
        let mut query = world.query_one::<Stated<'_>>(entity);
        let (scalars, classify, material, clip) = query.get().ok()?;
        let made = world.get::<&Coefficients>(entity).ok();
        let values = made.as_ref().map_or(scalars, |made| &made.values).clone();
        let sampled = (values, sampling.filter);
        let material = material.cloned().unwrap_or_default();
        let stated = (classify, &material, clip);
        let finite = world.get::<&Ranges>(entity).is_ok_and(|ranges| ranges.are_finite());
        let valued = Valued::new(sampled, (grid, unit), pyramid.clone(), stated);
        let valued = valued.integrated(sampling.integrate && finite);
        let smooth = finite && made.is_none_or(|made| made.ranges.are_finite());
        let room = Room::new(&grid, pyramid, valued.sought(smooth));
        (Asked::Values(Box::new(valued)), room)
    } else {
        let gel = world.get::<&Gel>(entity).ok()?.lit.clone();
        let pyramid = pyramid.unwrap_or_else(|| with_texels!(&gel, texels => Pyramid::of(texels)));
        (Asked::Gel(Gelled::new(gel, &grid)), Room::new(&grid, Some(pyramid), Sought::AtMiddle))
    };
    Some(Volume { content, room, unit, entity: number(order.as_deref()) })
}

fn number(order: Option<&Order>) -> u32 {
    order.map_or(0, |order| order.0).saturating_add(1)
}

struct Scene {
    camera: Camera,
    extent: Extent,
    step: f64,
    volumes: Vec<Volume>,
    faces: Vec<Traced>,
}

/// A volume as it is asked.
struct Volume {
    content: Asked,
    room: Room,
    unit: f64,
    entity: u32,
}

enum Asked {
    Gel(Gelled),
    Values(Box<Valued>),
}

impl Scene {
    /// What the first view of a world whose systems have run sees; fails without a view.
    fn of(world: &World) -> Result<Self, Error> {
        let missing = || Error::Schedule("there is no view to find first hits on".to_owned());
        let view = first_view(world).ok_or_else(missing)?;
        let mut seen = world.query_one::<(&View, &Sampling, &Extent)>(view);
        let (view, sampling, extent) = seen.get().map_err(|_| missing())?;
        let seen = volumes(world).into_iter();
        let seen: Vec<_> = seen.filter(|volume| volume.content != Content::Projected).collect();
        let step = sampling.distance_mm.or_else(|| smallest_spacing(seen.iter().map(|v| v.grid)));
        let volumes = seen.iter().filter_map(|volume| asked(world, volume, sampling)).collect();
        let camera = Camera::new(view, extent);
        let faces = traced(world, |face| pixels(face, &camera));
        let step = step.unwrap_or(extent.radius());
        Ok(Self { camera, extent: *extent, step, volumes, faces })
    }

    fn hits(&self) -> FirstHits {
        let size = self.camera.size;
        let tiles = Tiles::new(size, self.faces.iter().map(|face| face.pixels).collect());
        let of_tile = |tile: usize| {
            let near = tiles.near(tile);
            let hit = |pixel: [usize; 2]| {
                let held = near.iter().filter(|(_, pixels)| pixels.hold(pixel));
                self.hit(pixel, held.map(|(at, _)| &self.faces[*at]))
            };
            tiles.pixels(tile).map(hit).collect::<Vec<_>>()
        };
        let found: Vec<Vec<Option<Hit>>> =
            (0..tiles.count()).into_par_iter().map(of_tile).collect();
        let hits = || {
            let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
            pixels.map(|pixel| {
                let (tile, within) = tiles.place(pixel);
                found[tile][within]
            })
        };
        let normal = |hit: Hit| hit.normal.as_vec3().to_array();
        FirstHits {
            size,
            depth: hits().map(|hit| hit.map_or(f32::NAN, |hit| hit.depth as f32)).collect(),
            normal: hits().map(|hit| hit.map_or([0.0; 3], normal)).collect(),
            entity: hits().map(|hit| hit.map_or(0, |hit| hit.entity)).collect(),
        }
    }

    /// What the middle of a pixel shows first; it meets no faces but those `near`.
    fn hit<'a>(&self, [x, y]: [usize; 2], near: impl Iterator<Item = &'a Traced>) -> Option<Hit> {
        let ray = self.camera.ray(glam::DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
        let mut met: Vec<(f64, &Traced)> = near
            .filter_map(|face| Some((face.depth(&ray)?, face)))
            .filter(|(depth, _)| *depth >= self.camera.nearest())
            .collect();
        met.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut met = met.into_iter().peekable();
        let toward = -ray.along.normalize();
        let facing = |normal: DVec3| if normal.dot(toward) < 0.0 { -normal } else { normal };
        let middle = self.camera.depth(self.extent.center());
        let near = (middle - self.extent.radius()).max(self.camera.nearest());
        let slabs = (2.0 * self.extent.radius() / self.step).ceil().min(1e6) as usize;
        let slabs = if self.volumes.is_empty() { 0 } else { slabs };
        let first = (ray.at(near + self.step / 2.0), ray.along * self.step);
        let mut passages: Vec<Passage> =
            self.volumes.iter().map(|volume| volume.room.passage(first)).collect();
        let (mut slab, mut clear) = (0, 1.0);
        loop {
            // What is leapt over lets all through.
            slab = passages.iter_mut().map(|passage| passage.next(slab)).fold(slabs, usize::min);
            let from = near + slab as f64 * self.step;
            let until = if slab == slabs { f64::INFINITY } else { from + self.step };
            while let Some((depth, face)) = met.next_if(|(depth, _)| *depth < until) {
                clear *= 1.0 - face.opacity;
                if clear < HALF {
                    let normal = face.normal_seen(&ray, depth);
                    return Some(Hit { depth, normal, entity: face.entity });
                }
            }
            if slab == slabs {
                return None;
            }
            let there = self.volumes.iter().zip(&mut passages);
            let there = there
                .filter_map(|(volume, passage)| (passage.next(slab) == slab).then_some(volume));
            if let Some(hit) = self.met_in_slab((&ray, from), there, &mut clear) {
                return Some(Hit { normal: facing(hit.normal), ..hit });
            }
            slab += 1;
        }
    }

    /// Takes a ray through some volumes in the slab from a depth on: what makes it half opaque there, if anything does.
    fn met_in_slab<'a>(
        &self,
        (ray, from): (&Ray, f64),
        volumes: impl Iterator<Item = &'a Volume>,
        clear: &mut f64,
    ) -> Option<Hit> {
        let (middle, way) = (ray.at(from + self.step / 2.0), ray.along * self.step);
        let (mut left, mut thickest) = (1.0, (0.0, None));
        let mut surfaces: Vec<(Crossed, &Volume)> = Vec::new();
        for volume in volumes {
            let opacity = volume.opacity(middle, way);
            // What is clear is so at every thickness.
            let opacity =
                if opacity == 0.0 { 0.0 } else { thicken(opacity, way.length() / volume.unit) };
            left *= 1.0 - opacity;
            if opacity > thickest.0 {
                thickest = (opacity, Some(volume));
            }
            if let Asked::Values(values) = &volume.content {
                let crossed = values.crossings(middle, way).into_iter();
                surfaces.extend(crossed.map(|crossed| (crossed, volume)));
            }
        }
        surfaces.sort_by(|a, b| a.0.part.total_cmp(&b.0.part));
        let hit = |part: f64, volume: &Volume, at: DVec3, flat: Option<DVec3>| {
            let normal = flat.unwrap_or_else(|| volume.slope(at).normalize_or_zero());
            Hit { depth: from + self.step * part, normal, entity: volume.entity }
        };
        // Gel fills the slab evenly, before and behind each surface.
        let mut passed = 0.0;
        for (part, surface) in surfaces.iter().map(|s| (s.0.part, Some(s))).chain([(1.0, None)]) {
            let before = *clear;
            *clear *= thin(left, part - passed);
            if *clear < HALF {
                let within = (before / HALF).ln() / (before / clear.max(1e-9)).ln();
                let part = passed + (part - passed) * within.clamp(0.0, 1.0);
                return Some(hit(part, thickest.1?, middle, None));
            }
            passed = part;
            if let Some((crossed, volume)) = surface {
                *clear *= 1.0 - crossed.opacity;
                if *clear < HALF {
                    return Some(hit(part, volume, middle + way * (part - 0.5), crossed.normal));
                }
            }
        }
        None
    }
}

/// What a part of a slab lets through, all of which lets `left` through.
fn thin(left: f64, part: f64) -> f64 {
    1.0 - thicken(1.0 - left, part)
}

impl Volume {
    /// The opacity of a slab around a world point, per opacity unit; `way` is the ray's way through it.
    fn opacity(&self, world: DVec3, way: DVec3) -> f64 {
        match &self.content {
            Asked::Gel(gel) => gel.opacity(world),
            Asked::Values(values) => values.opacity(world, way),
        }
    }

    /// The way out of what is seen there.
    fn slope(&self, world: DVec3) -> DVec3 {
        match &self.content {
            Asked::Gel(gel) => gel.slope(world),
            Asked::Values(values) => values.slope(world),
        }
    }
}

#[cfg(test)]
mod tests;
