//! Casting rays: the hybrid ray tracer of the paper's §2 with the optimisations of its §6.
//!
//! `inputs` gathers what a view's rays may meet, and this file makes of it what they need. `adaptive` says where rays are
//! cast, `caster` takes them in packets of sixteen, `march` takes a packet through slabs and slivers. `media` is the gel as
//! a packet meets it: nothing, one `medium` (of texels by `kernel`, or of `values`, which have surfaces by `crossing`), or `several` that overlap; `beams` says
//! where it can meet any. `projection` is volumes of which a ray shows one value, `sought` along it. `polygons` says which
//! faces a ray meets, `projected` how deep, `appearance`, `texture`, `cue` and `receiving` how they look.

mod adaptive;
mod appearance;
mod band;
mod beams;
mod caster;
mod crossing;
mod cue;
mod inputs;
mod kernel;
mod lanes;
mod level;
mod march;
mod media;
mod medium;
mod polygons;
mod preview;
mod projected;
mod projection;
mod receiving;
mod several;
mod shaft;
mod sought;
mod targets;
mod texture;
mod values;
mod weight;

use std::sync::Arc;

use fearless_simd::Level;
use hecs::{Entity, World};

use crate::components::{DepthCue, Sampling, Skip, Surface, View};
use crate::error::Error;
use crate::light::strength::LightStrength;
use crate::polygon::face::FaceColors;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::view::samples::{Layout, Samples};
use crate::view::viewer::Viewer;
use crate::view::walk::Walk;
use crate::volume::coefficients::Coefficients;
use crate::volume::gel::{Gel, GelBricks, Texel, Texels};
use crate::volume::grid::smallest_spacing;
use crate::volume::pyramid::{Pyramid, PyramidSlices};
use crate::volume::ranges::Ranges;
use adaptive::Refinement;
use appearance::Appearance;
use beams::Beams;
use caster::BeamCaster;
use cue::Cue;
use inputs::{Inputs, Placed, Sampled};
use march::Slabs;
use media::{Media, Nothing};
use medium::{Medium, Source};
use polygons::Polygons;
use preview::Preview;
use projected::ProjectedFace;
use projection::Projections;
use several::{AnyMedium, Several};
use shaft::Dust;
use targets::Crossed;
use texture::FaceTexture;
use values::Values;

/// Casts the rays of every view.
pub(crate) struct Cast;

impl System for Cast {
    type Product = Samples;
    const NAME: &'static str = "cast";
    const READS: &'static [ProductKey] = &[
        ProductKey::of::<Gel>(),
        ProductKey::of::<Coefficients>(),
        ProductKey::of::<Pyramid>(),
        ProductKey::of::<LightStrength>(),
        ProductKey::of::<Ranges>(),
    ];

    fn run(world: &World, out: &mut Outbox<'_, Samples>) -> Result<(), Error> {
        let watch = out.watch();
        let mut views =
            world
                .query::<(Entity, &View, &Sampling, &Extent, (Option<&DepthCue>, Option<&Viewer>))>(
                );
        for (entity, view, sampling, extent, (cue, viewer)) in &mut views {
            let camera = Camera::new(view, extent);
            let inputs = Inputs::of(world, (view, sampling, *extent, cue.copied()), &camera);
            out.derive(entity, inputs, |inputs| cast(inputs, &camera, (watch, viewer)))?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let mut views = world.query::<(Entity, &View, &Sampling, &Extent)>();
        let weight = |(entity, view, sampling, extent): (Entity, &View, &Sampling, &Extent)| {
            (entity, weight::of(world, &layout(view, sampling), (view, sampling, extent)))
        };
        let found: Vec<_> = views.iter().map(weight).collect();
        Plan::of(&found, |weight| weight.most, |weight| weight.part, "a view is stated")
    }
}

/// Where the positions of a view's sample array are.
fn layout(view: &View, sampling: &Sampling) -> Layout {
    let size = view.size.map(|n| n as usize);
    Layout::new(size, sampling.coarsest as usize, sampling.pixel_filter.reach())
}

/// Δ: as stated, else the smallest spacing of any volume; without a volume it makes no difference.
fn distance(inputs: &Inputs) -> f64 {
    let grids = inputs.volumes.iter().map(|volume| volume.grid);
    let smallest = smallest_spacing(grids.chain(inputs.projections.iter().map(|v| v.grid)));
    inputs.sampling.distance_mm.or(smallest).unwrap_or(inputs.extent.radius())
}

/// Whom a view's rays are cast for: who asks how far they are, and who looks on.
type Onlookers<'a> = (&'a Watch, Option<&'a Viewer>);

fn cast(inputs: &Inputs, camera: &Camera, watch: Onlookers<'_>) -> Result<Samples, Error> {
    let layout = layout(&inputs.view, &inputs.sampling);
    // The first pictures for who looks on reach further beyond the picture's own edges.
    let coarsest = watch.1.map_or(1, |_| preview::FIRST).max(inputs.sampling.coarsest);
    let beams =
        Beams::new(self::layout(&inputs.view, &Sampling { coarsest, ..inputs.sampling.clone() }));
    let cue = inputs.cue.map(|cue| {
        let near = camera.depth(inputs.extent.center()) - inputs.extent.radius();
        Cue { k1: cue.k1, k2: cue.k2, near }
    });
    let polygons = polygons(inputs, camera, &beams, cue);
    // A transparency is never under 0: a ray that is not to stop goes on behind what is opaque.
    let stop_at = f64::from(inputs.sampling.stop_at);
    let stop = if stop_at > 0.0 { stop_at } else { f64::NEG_INFINITY };
    let eye = camera.eye.map_or(f64::NEG_INFINITY, |eye| -eye);
    let slabs = Slabs { distance: distance(inputs), stop, eye };
    let dust = Dust::new(&inputs.shafts, camera).map_err(|p| Error::entity("shaft", p))?;
    let dust = dust.as_ref();
    let mut media = Vec::new();
    // Where dust is, nothing is stepped over; several volumes have one dust.
    let alone = dust.filter(|_| inputs.volumes.len() == 1);
    let view = SharedView { camera, slabs, cue, skips: dust.is_none(), level: Level::new() };
    for placed in &inputs.volumes {
        media.extend(view.medium(placed, alone)?);
    }
    let skips = inputs.sampling.skip != Skip::None;
    let projections = Projections::new(&inputs.projections, camera, slabs.distance, skips);
    let projections = projections.map_err(|problem| Error::entity("view", problem))?;
    let rays = Rays { polygons, projections, slabs };
    match media.len() {
        0 => rays.refine(inputs, layout, &Nothing, watch),
        1 => match media.swap_remove(0) {
            AnyMedium::F32(medium) => rays.refine(inputs, layout, &medium, watch),
            AnyMedium::U16(medium) => rays.refine(inputs, layout, &medium, watch),
            AnyMedium::U8(medium) => rays.refine(inputs, layout, &medium, watch),
            AnyMedium::Values(medium) => rays.refine(inputs, layout, &*medium, watch),
        },
        _ => {
            let several = Several { media, dust };
            rays.refine(inputs, layout, &several, watch)
        }
    }
}

/// The polygons of a scene on a view.
fn polygons(inputs: &Inputs, camera: &Camera, beams: &Beams, cue: Option<Cue>) -> Polygons {
    let lamps = &inputs.lamps;
    let projected = inputs.polygons.iter().flat_map(|traced| {
        traced.faces.0.iter().enumerate().filter_map(|(at, face)| {
            let texture =
                traced.textured.as_ref().and_then(|by| FaceTexture::new(by, face, camera));
            let offsets = traced.grid.as_ref().map_or_else(Vec::new, |grid| {
                receiving::shadow_offsets(face.normal, lamps, &inputs.strengths, grid)
            });
            let own = FaceColors::of(traced.colors.as_ref(), at);
            let color = own.unwrap_or(traced.surface.color);
            let surface = Surface { color, ..traced.surface };
            let looks = Appearance::new(&surface, face.normal, lamps, offsets, texture);
            ProjectedFace::new(face, camera, looks, traced.faces.0.len())
        })
    });
    // What rounding may do to the depth of a plane, in a scene of that size so far from the world's origin.
    let slack = 1e-9 * inputs.extent.radius() + 1e-14 * inputs.extent.center().abs().max_element();
    Polygons::new(projected.collect(), beams, slack, *camera, cue, inputs.strengths.clone())
}

/// What the volumes of a view have in common.
struct SharedView<'a> {
    camera: &'a Camera,
    slabs: Slabs,
    cue: Option<Cue>,
    /// Whether empty gel is stepped over.
    skips: bool,
    level: Level,
}

impl<'a> SharedView<'a> {
    /// A volume as the rays of the view meet it, whatever it is made of; `None` where it is too small to be met.
    fn medium(
        &self,
        placed: &'a Placed,
        dust: Option<&'a Dust>,
    ) -> Result<Option<AnyMedium<'a>>, Error> {
        let Gel { lit, ambient } = match &placed.content {
            Sampled::Gel(gel) => gel,
            Sampled::Values(stated) => {
                let values = Values::new(stated, (&placed.grid, placed.unit), self.steps(placed));
                let medium = self.of(placed, values, dust)?;
                return Ok(medium.map(|medium| AnyMedium::Values(Box::new(medium))));
            }
        };
        Ok(match (lit, ambient) {
            (GelBricks::F32(lit), None) => self.gel(placed, lit, None, dust)?.map(AnyMedium::F32),
            (GelBricks::F32(lit), Some(GelBricks::F32(ambient))) => {
                self.gel(placed, lit, Some(ambient), dust)?.map(AnyMedium::F32)
            }
            (GelBricks::U16(lit), None) => self.gel(placed, lit, None, dust)?.map(AnyMedium::U16),
            (GelBricks::U16(lit), Some(GelBricks::U16(ambient))) => {
                self.gel(placed, lit, Some(ambient), dust)?.map(AnyMedium::U16)
            }
            (GelBricks::U8(lit), None) => self.gel(placed, lit, None, dust)?.map(AnyMedium::U8),
            (GelBricks::U8(lit), Some(GelBricks::U8(ambient))) => {
                self.gel(placed, lit, Some(ambient), dust)?.map(AnyMedium::U8)
            }
            _ => {
                let problem = "the two parts of the gel are of different texels";
                return Err(Error::Schedule(problem.to_owned()));
            }
        })
    }

    fn gel<T: Texel>(
        &self,
        placed: &'a Placed,
        lit: &'a Texels<T>,
        ambient: Option<&'a Texels<T>>,
        dust: Option<&'a Dust>,
    ) -> Result<Option<Medium<'a, kernel::GelSlices<'a, T>>>, Error> {
        let (texels, ambient) = (lit.slices(), ambient.map(Texels::slices));
        let pyramid = self.steps(placed);
        self.of(placed, kernel::GelSlices { texels, ambient, pyramid }, dust)
    }

    /// What steps over empty parts of a volume.
    fn steps(&self, placed: &'a Placed) -> Option<PyramidSlices<'a>> {
        placed.pyramid.as_ref().filter(|_| self.skips).map(Pyramid::slices)
    }

    fn of<S: Source>(
        &self,
        placed: &'a Placed,
        source: S,
        dust: Option<&'a Dust>,
    ) -> Result<Option<Medium<'a, S>>, Error> {
        let distance = self.slabs.distance;
        let walk = Walk::new(&placed.grid, self.camera, distance)
            .map_err(|problem| Error::entity("view", problem))?;
        let pyramid = self.steps(placed);
        Ok(walk.map(|walk| Medium {
            walk,
            camera: self.camera,
            source,
            pyramid,
            ratio: distance / placed.unit,
            distance,
            cue: self.cue,
            dust,
            level: self.level,
        }))
    }
}

/// What the rays of a view share, whatever they meet.
struct Rays<'a> {
    polygons: Polygons,
    projections: Projections<'a>,
    slabs: Slabs,
}

impl Rays<'_> {
    fn refine<M: Media>(
        self,
        inputs: &Inputs,
        layout: Layout,
        media: &M,
        (watch, viewer): Onlookers<'_>,
    ) -> Result<Samples, Error> {
        let sampling = &inputs.sampling;
        let polygons = !self.polygons.is_empty();
        let crossed = self.polygons.crossed(&layout, sampling);
        let Self { polygons: faces, projections, slabs } = self;
        let supersampled = sampling.finest < 4 && sampling.coarsest > sampling.finest;
        let caster =
            BeamCaster { polygons: faces, projections, slabs, media, three_colors: supersampled };
        let mut preview = viewer.map(|viewer| Preview::new(viewer, &inputs.view, sampling));
        if let Some(preview) = &mut preview {
            for first in preview::before(sampling) {
                let layout = self::layout(&inputs.view, &first);
                let free = Crossed::default();
                let sketch = Refinement::new(layout, &first, polygons, &free, &caster);
                preview.level(&sketch.refine(watch, None)?);
            }
        }
        let array = Refinement::new(layout, sampling, polygons, &crossed, &caster)
            .refine(watch, preview.as_mut())?;
        Ok(Samples(Arc::new(array)))
    }
}
