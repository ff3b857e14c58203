//! `pyramid`: the pyramid of binary volumes that rays step over empty gel with (paper §6).

use hecs::{Entity, World};

use crate::components::Skip;
use crate::error::Error;
use crate::schedule::{Outbox, Plan, ProductKey, System};
use crate::view::observer;
use crate::volume::gel::CELLS;
use crate::volume::gel::Gel;
use crate::volume::pyramid::Pyramid;
use crate::volume::scene_volumes::{SceneVolume, gels};
use crate::with_texels;

/// Makes the [`Pyramid`] of every gel, where the view's sampling asks for it.
pub struct StackPyramid;

impl System for StackPyramid {
    type Product = Pyramid;
    const NAME: &'static str = "pyramid";
    const READS: &'static [ProductKey] = &[ProductKey::of::<Gel>()];

    fn run(world: &World, out: &mut Outbox<'_, Pyramid>) -> Result<(), Error> {
        if observer::sampling(world).skip != Skip::Pyramid {
            return Ok(());
        }
        for (entity, gel) in &mut world.query::<(Entity, &Gel)>() {
            // The ambient gel has the same opacities, so one pyramid serves both.
            out.derive(entity, gel.lit.clone(), |gel| {
                Ok(with_texels!(gel, texels => Pyramid::of(texels)))
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        if observer::sampling(world).skip != Skip::Pyramid {
            return Plan::absent("`sampling.skip` is none");
        }
        let bytes = |v: &SceneVolume| {
            let bricks: u64 = v.size().iter().map(|n| n.div_ceil(CELLS) as u64).product();
            // Three bits a cell, a distance for each of eight blocks, and an entry in a table.
            bricks.saturating_mul(3 * size_of::<[u64; CELLS]>() as u64 + 8 + 4)
        };
        let makes: Vec<_> = gels(world).iter().map(|v| (v.entity, bytes(v))).collect();
        if makes.is_empty() {
            return Plan::absent("no volume is stated");
        }
        Plan { makes, why: "`sampling.skip` is the pyramid" }
    }
}
