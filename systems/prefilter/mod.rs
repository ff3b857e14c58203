//! `prefilter`: the coefficients of the B-spline that goes through a volume's voxels; made once a volume, where
//! `sampling.filter` is interpolating.

use hecs::World;

use crate::components::Filter;
use crate::error::Error;
use crate::schedule::{Outbox, Plan, ProductKey, System};
use crate::view::observer;
use crate::volume::coefficients::{self, Coefficients};
use crate::volume::grid::Scalars;
use crate::volume::scene_volumes::{Content, SceneVolume, with_content};

/// Makes the [`Coefficients`] of every volume whose values are sampled, where its filter needs them.
pub(crate) struct Prefilter;

impl System for Prefilter {
    type Product = Coefficients;
    const NAME: &'static str = "prefilter";
    const READS: &'static [ProductKey] = &[];

    fn run(world: &World, out: &mut Outbox<'_, Coefficients>) -> Result<(), Error> {
        let watch = out.watch();
        for SceneVolume { entity, grid, .. } in asked(world) {
            let Ok(scalars) = world.get::<&Scalars>(entity) else { continue };
            out.derive(entity, ((*scalars).clone(), grid), |(scalars, grid)| {
                let made = Coefficients::of(scalars, grid, watch);
                watch.check()?;
                Ok(made)
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let bytes = |v: &SceneVolume| (v.entity, coefficients::bytes(v.size()));
        let makes: Vec<_> = asked(world).iter().map(bytes).collect();
        if makes.is_empty() {
            return Plan::absent("no values are sampled with `sampling.filter` interpolating");
        }
        Plan::of_most(makes, "`sampling.filter` is interpolating: a spline goes through the voxels")
    }
}

/// The volumes that need them.
fn asked(world: &World) -> Vec<SceneVolume> {
    let needed = observer::sampling(world).filter == Filter::Interpolating;
    if needed { with_content(world, Content::Values) } else { Vec::new() }
}
