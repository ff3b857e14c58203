//! Casting rays: the hybrid ray tracer of the paper's §2 with the optimisations of its §6.
//!
//! `inputs` gathers what a view's rays may meet, `rays` makes of it what they need, and sends them on an errand: that of a
//! picture, or `judge`'s, who casts `exact_pixel`s to tell how far a picture is off. `adaptive` says where rays are cast, by
//! what `edges` keeps of them too, `gathered` puts them together to packets of sixteen, `caster` takes those, `march` takes a
//! packet through slabs and slivers, `gathering` is what each of its rays has seen. `media` is the gel as a packet meets it:
//! nothing, one `medium` (of texels by `kernel`, or of `values`, which have surfaces by `crossing` and slabs that are
//! `integrated`), or `several` that overlap. A packet leaps as a `bundle` over what is empty, and looks through a `window` at
//! what may not be. `polygons` says which faces a ray meets: `projected` says where on the picture each is and how deep,
//! `beams` which rays may be in it, `binned` which faces a beam is near to, `seen` asks them of all faces; `looks`,
//! `appearance`, `texture`, `cue` and `receiving` say how they look. `projection` is volumes of which a ray shows one value,
//! `sought` along it, or what `emitters` show.

mod adaptive;
mod appearance;
mod band;
mod beams;
mod binned;
mod bundle;
mod caps;
mod caster;
mod crossing;
mod cue;
mod edges;
mod emitters;
mod exact_pixel;
mod gathered;
mod gathering;
mod inputs;
mod integrated;
mod judge;
mod kernel;
mod lanes;
mod level;
mod looks;
mod march;
mod media;
mod medium;
mod part;
mod polygons;
mod preview;
mod projected;
mod projection;
mod rays;
mod receiving;
mod seen;
mod several;
mod shaft;
mod slices;
mod sought;
mod targets;
mod texture;
mod thick;
mod values;
mod weight;
mod window;

use std::sync::Arc;

use hecs::{Entity, World};

use crate::components::{DepthCue, Sampling, View};
use crate::error::Error;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::view::samples::{Layout, Samples};
use crate::view::viewer::Viewer;
use adaptive::Refinement;
use caster::BeamCaster;
use inputs::Inputs;
pub use judge::Judge;
use media::Media;
use preview::Preview;
use rays::Errand;
use targets::Crossed;
pub use weight::keeps_edges;

/// Casts the rays of every view.
pub(crate) struct Cast;

impl System for Cast {
    type Product = Samples;
    const NAME: &'static str = "cast";
    const READS: &'static [ProductKey] = &inputs::READS;

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

/// Whom a view's rays are cast for: who asks how far they are, and who looks on.
type Onlookers<'a> = (&'a Watch, Option<&'a Viewer>);

fn cast(inputs: &Inputs, camera: &Camera, onlookers: Onlookers<'_>) -> Result<Samples, Error> {
    if let Some(gel) = slices::asked(inputs, camera) {
        let layout = layout(&inputs.view, &inputs.sampling);
        let array = slices::cast(inputs, camera, gel, (layout, onlookers.0))?;
        return Ok(Samples(Arc::new(array)));
    }
    // The first pictures for who looks on reach further beyond the picture's own edges.
    let coarsest = onlookers.1.map_or(1, |_| preview::FIRST).max(inputs.sampling.coarsest);
    let widest = layout(&inputs.view, &Sampling { coarsest, ..inputs.sampling.clone() });
    let finest = inputs.sampling.finest as usize;
    rays::send(inputs, camera, (widest, finest), Refine { inputs, onlookers })
}

/// The errand of a picture: its sample array.
struct Refine<'a> {
    inputs: &'a Inputs,
    onlookers: Onlookers<'a>,
}

impl Errand for Refine<'_> {
    type Done = Samples;

    fn run<M: Media>(self, caster: BeamCaster<'_, M>) -> Result<Samples, Error> {
        let Self { inputs, onlookers: (watch, viewer) } = self;
        let sampling = &inputs.sampling;
        let layout = layout(&inputs.view, sampling);
        let edges = caster.has_edges();
        let most = caster.media.has_surfaces().then(|| targets::most_opened(&layout));
        let crossed = Crossed { most, ..caster.polygons.crossed(&layout, sampling) };
        let mut preview = viewer.map(|viewer| Preview::new(viewer, &inputs.view, sampling));
        if let Some(preview) = &mut preview {
            for first in preview::before(sampling) {
                let layout = self::layout(&inputs.view, &first);
                let free = Crossed::default();
                let sketch = Refinement::new(layout, &first, edges, &free, &caster);
                preview.level(&sketch.refine(watch, None)?);
            }
        }
        let array = Refinement::new(layout, sampling, edges, &crossed, &caster)
            .refine(watch, preview.as_mut())?;
        Ok(Samples(Arc::new(array)))
    }
}
