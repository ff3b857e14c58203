//! `ranges`: between which scalars each brick of a volume lies. Made once a volume: no edit of what is seen makes it again.

use hecs::{Entity, World};

use crate::components::{Classify, OpacityUnit};
use crate::error::Error;
use crate::schedule::{Outbox, Plan, ProductKey, System};
use crate::volume::grid::{Grid, Scalars};
use crate::volume::ranges::{self, Ranges};
use crate::volume::scene_volumes::{SceneVolume, scanned};

/// Makes the [`Ranges`] of every volume that is to be classified.
pub struct FindRanges;

impl System for FindRanges {
    type Product = Ranges;
    const NAME: &'static str = "ranges";
    const READS: &'static [ProductKey] = &[];

    fn run(world: &World, out: &mut Outbox<'_, Ranges>) -> Result<(), Error> {
        let watch = out.watch();
        let mut volumes =
            world.query::<(Entity, &Scalars, &Grid)>().with::<(&Classify, &OpacityUnit)>();
        for (entity, scalars, grid) in &mut volumes {
            out.derive(entity, (scalars.clone(), grid.size), |(scalars, size)| {
                let found = Ranges::of(scalars, *size, watch);
                watch.check()?;
                Ok(found)
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let bytes = |v: &SceneVolume| (v.entity, ranges::bytes(v.size()));
        let makes: Vec<_> = scanned(world).iter().map(bytes).collect();
        if makes.is_empty() {
            return Plan::absent("no volume of scalars states `classify`");
        }
        Plan::of_most(makes, "bricks whose scalars rule out that they are seen are not classified")
    }
}
