//! Makes the picture of every view of its sample array, by [`resampling`](crate::view::resampling).

use hecs::{Entity, World};

use crate::components::{Sampling, View};
use crate::error::Error;
use crate::schedule::{Outbox, Plan, ProductKey, System};
use crate::view::overlay::Overlay;
use crate::view::picture::Frame;
use crate::view::resampling::resample;
use crate::view::samples::Samples;

/// Makes the picture of every view.
pub struct Resample;

impl System for Resample {
    type Product = Frame;
    const NAME: &'static str = "resample";
    const READS: &'static [ProductKey] =
        &[ProductKey::of::<Samples>(), ProductKey::of::<Overlay>()];

    fn run(world: &World, out: &mut Outbox<'_, Frame>) -> Result<(), Error> {
        type Seen<'a> = (Entity, &'a View, &'a Sampling, &'a Samples, Option<&'a Overlay>);
        for (entity, view, sampling, samples, overlay) in &mut world.query::<Seen<'_>>() {
            let (filter, background) = (sampling.pixel_filter, view.background);
            let inputs = (samples.clone(), filter, background, overlay.cloned());
            out.derive(entity, inputs, |(samples, filter, background, overlay)| {
                let picture = resample(&samples.0, *filter, *background);
                Ok(Frame(overlay.as_ref().map_or(picture.clone(), |over| picture.under(&over.0))))
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let mut views = world.query::<(Entity, &View)>();
        let bytes = |view: &View| view.size.iter().map(|&n| u64::from(n)).product::<u64>() * 16;
        let makes = views.iter().map(|(entity, view)| (entity, bytes(view))).collect();
        Plan::of_most(makes, "a view is stated")
    }
}
