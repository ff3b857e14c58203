//! Casting rays: the hybrid ray tracer of the paper's §2 with the optimisations of its §6.
//!
//! `inputs` gathers what a view's rays may meet, `mod` gives each beam of rays what it needs of that, `beams` says where a beam can meet anything,
//! `adaptive` says where rays are cast, `march` takes a ray through slabs and slivers, `volume` finds the samples on it,
//! `polygons` says what it meets, and `receiving` where the shadows on that are read.

mod adaptive;
mod band;
mod beams;
mod inputs;
mod level;
mod march;
mod polygons;
mod receiving;
mod shaft;
mod texture;
mod volume;

use std::sync::Arc;

use glam::DVec2;
use hecs::{Entity, World};

use crate::components::{DepthCue, Sampling, View};
use crate::error::Error;
use crate::light::strength::LightStrength;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::view::samples::{Counts, Layout, SampleArray, Samples};
use crate::view::walk::Walk;
use crate::volume::gel::{Gel, GelBricks, Texel, Texels};
use crate::volume::pyramid::Pyramid;
use adaptive::{Aim, Caster, Ray, Refinement};
use beams::{Beams, Occupied};
use inputs::{Inputs, Medium};
use march::Hit;
use polygons::{Look, Polygons, Seen};
use shaft::Dust;
use texture::Laid;
use volume::{Cue, Cursor, Volume};

/// Casts the rays of every view.
pub struct Cast;

impl System for Cast {
    type Product = Samples;
    const NAME: &'static str = "cast";
    const READS: &'static [ProductKey] =
        &[ProductKey::of::<Gel>(), ProductKey::of::<Pyramid>(), ProductKey::of::<LightStrength>()];

    fn run(world: &World, out: &mut Outbox<'_, Samples>) -> Result<(), Error> {
        let watch = out.watch();
        let mut views = world.query::<(Entity, &View, &Sampling, &Extent, Option<&DepthCue>)>();
        for (entity, view, sampling, extent, cue) in &mut views {
            let camera = Camera::new(view, extent);
            let inputs = Inputs::of(world, (view, sampling, *extent, cue.copied()), &camera);
            out.derive(entity, inputs, |inputs| cast(inputs, &camera, watch))?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let mut views = world.query::<(Entity, &View, &Sampling)>();
        let bytes =
            |view: &View, sampling: &Sampling| SampleArray::most_bytes(&layout(view, sampling));
        let makes =
            views.iter().map(|(entity, view, sampling)| (entity, bytes(view, sampling))).collect();
        Plan { makes, why: "a view is stated" }
    }
}

/// Where the positions of a view's sample array are.
fn layout(view: &View, sampling: &Sampling) -> Layout {
    let size = view.size.map(|n| n as usize);
    Layout::new(size, sampling.coarsest as usize, sampling.pixel_filter.reach())
}

fn cast(inputs: &Inputs, camera: &Camera, watch: &Watch) -> Result<Samples, Error> {
    let layout = layout(&inputs.view, &inputs.sampling);
    let beams = Beams::new(layout);
    let cue = inputs.cue.map(|cue| {
        let near = camera.project(inputs.extent.center()).1 - inputs.extent.radius();
        Cue { k1: cue.k1, k2: cue.k2, near }
    });
    let seen = inputs.polygons.iter().flat_map(|shown| {
        shown.faces.0.iter().filter_map(|face| {
            let laid = shown.textured.as_ref().and_then(|by| Laid::new(by, face, camera));
            let (normal, lamps) = (face.normal, &inputs.lamps);
            let ways = inputs.volume.as_ref().map_or_else(Vec::new, |medium| {
                receiving::ways(normal, lamps, &inputs.strengths, &medium.grid)
            });
            Seen::new(face, camera, Look::new(&shown.surface, normal, lamps, ways, laid))
        })
    });
    // What rounding may do to the depth of a plane, in a scene of that size so far from the world's origin.
    let slack = 1e-9 * inputs.extent.radius() + 1e-14 * inputs.extent.center().abs().max_element();
    let seen = seen.collect();
    let polygons = Polygons::new(seen, &beams, slack, *camera, cue, inputs.strengths.clone());
    // A transparency is never under 0: a ray that is not to stop goes on behind what is opaque.
    let stop_at = f64::from(inputs.sampling.stop_at);
    let stop = if stop_at > 0.0 { stop_at } else { f64::NEG_INFINITY };
    let rays = Rays { camera, polygons, stop, cue };
    let Some(medium) = &inputs.volume else {
        return rays.refine::<[f32; 4]>(inputs, layout, None, watch);
    };
    match (&medium.gel.lit, &medium.gel.ambient) {
        (GelBricks::F32(lit), None) => rays.through(inputs, layout, (medium, lit, None), watch),
        (GelBricks::F32(lit), Some(GelBricks::F32(ambient))) => {
            rays.through(inputs, layout, (medium, lit, Some(ambient)), watch)
        }
        (GelBricks::U16(lit), None) => rays.through(inputs, layout, (medium, lit, None), watch),
        (GelBricks::U16(lit), Some(GelBricks::U16(ambient))) => {
            rays.through(inputs, layout, (medium, lit, Some(ambient)), watch)
        }
        (GelBricks::U8(lit), None) => rays.through(inputs, layout, (medium, lit, None), watch),
        (GelBricks::U8(lit), Some(GelBricks::U8(ambient))) => {
            rays.through(inputs, layout, (medium, lit, Some(ambient)), watch)
        }
        _ => Err(Error::Schedule("the two parts of the gel are of different texels".to_owned())),
    }
}

/// What the rays of a view share, whatever numbers the gel is kept in.
struct Rays<'a> {
    camera: &'a Camera,
    polygons: Polygons,
    stop: f64,
    cue: Option<Cue>,
}

impl<'a> Rays<'a> {
    fn through<T: Texel>(
        self,
        inputs: &'a Inputs,
        layout: Layout,
        (medium, gel, ambient): (&'a Medium, &'a Texels<T>, Option<&'a Texels<T>>),
        watch: &Watch,
    ) -> Result<Samples, Error> {
        let distance =
            inputs.sampling.distance_mm.unwrap_or_else(|| medium.grid.spacing().min_element());
        let walk = Walk::new(&medium.grid, self.camera, distance)
            .map_err(|problem| Error::entity("view", problem))?;
        let ratio = distance / medium.unit;
        let ratio = if (ratio - 1.0).abs() < 1e-12 { 1.0 } else { ratio };
        let pyramid = medium.pyramid.as_ref();
        let dust = Dust::new(&inputs.shafts, self.camera, distance)
            .map_err(|problem| Error::entity("shaft", problem))?;
        let clear = dust.is_none();
        let volume = Volume {
            walk,
            gel: gel.slices(),
            ambient: ambient.map(Texels::slices),
            pyramid: pyramid.map(Pyramid::slices),
            ratio,
            distance,
            cue: self.cue,
            dust,
        };
        let occupied = pyramid.filter(|_| clear).map(|pyramid| {
            Beams::new(layout).occupied(gel, pyramid, &medium.grid, self.camera, distance)
        });
        self.refine(inputs, layout, Some((volume, occupied)), watch)
    }

    fn refine<T: Texel>(
        self,
        inputs: &Inputs,
        layout: Layout,
        volume: Option<(Volume<'_, T>, Option<Occupied>)>,
        watch: &Watch,
    ) -> Result<Samples, Error> {
        let sampling = &inputs.sampling;
        let polygons = !self.polygons.is_empty();
        // Regions down to two pixels' side are split where outlines cross them.
        let outlines = (polygons && sampling.outlines && sampling.coarsest > 4)
            .then(|| self.polygons.outlines(&layout, 8));
        let (volume, occupied) = volume.unzip();
        let supersampled = sampling.finest < 4 && sampling.coarsest > sampling.finest;
        let caster = BeamCaster {
            rays: self,
            volume,
            occupied: occupied.flatten(),
            three_colors: supersampled,
        };
        let array = Refinement::new(layout, sampling, polygons, outlines.as_ref(), &caster)
            .refine(watch)?;
        Ok(Samples(Arc::new(array)))
    }
}

/// Casts rays, a beam at a time.
struct BeamCaster<'a, T> {
    rays: Rays<'a>,
    volume: Option<Volume<'a, T>>,
    occupied: Option<Occupied>,
    three_colors: bool,
}

impl<T: Texel> Caster for BeamCaster<'_, T> {
    type Scratch = Vec<Hit>;

    fn cast(&self, aims: &[Aim], rays: &mut [Ray], hits: &mut Vec<Hit>, counts: &mut Counts) {
        for (aim, ray) in aims.iter().zip(rays) {
            *ray = self.cast_one(*aim, hits, counts);
        }
    }
}

impl<T: Texel> BeamCaster<'_, T> {
    fn cast_one(&self, aim: Aim, hits: &mut Vec<Hit>, counts: &mut Counts) -> Ray {
        let Rays { polygons, stop, .. } = &self.rays;
        if !polygons.is_empty() {
            polygons.meet(aim.beam, aim.window, hits);
        }
        let mut cursor = self.cursor(aim.beam, aim.window);
        if hits.is_empty() {
            let full = self.volume.as_ref().map_or_else(
                || [0.0; 4],
                |volume| volume.march(&mut cursor, *stop, counts).rgba(*stop),
            );
            return Ray { full, ..Ray::default() };
        }
        let shade = |hit: &Hit| polygons.shade(hit, aim);
        let colors = match &self.volume {
            Some(volume) => volume.march_through(&mut cursor, hits, shade, *stop, counts),
            None => march::polygons_alone(hits, shade, *stop, counts),
        };
        let plain = |hit: &Hit| polygons.plain(hit);
        let geometric =
            if self.three_colors { march::geometric(hits, plain, *stop) } else { [0.0; 4] };
        Ray { full: colors.full.rgba(*stop), attenuated: colors.attenuated, geometric }
    }

    /// Where the ray through a window position enters the gel.
    fn cursor(&self, beam: usize, window: DVec2) -> Cursor {
        let Some(volume) = &self.volume else { return Cursor::NOWHERE };
        let range = self.occupied.as_ref().map_or([i64::MIN, i64::MAX], |occupied| occupied[beam]);
        if range[0] >= range[1] {
            return Cursor::NOWHERE;
        }
        let origin = self.rays.camera.origin(window);
        let samples = volume.walk.enter(origin);
        samples.map_or(Cursor::NOWHERE, |samples| Cursor::new(&volume.walk, samples, range, origin))
    }
}
