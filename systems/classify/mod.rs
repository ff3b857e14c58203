//! `classify`: the opacity of every voxel from its scalar and gradient (algorithm §2), weakened where a clip cuts.

use hecs::{Entity, World};

use crate::components::{self, Clip, OpacityUnit};
use crate::error::Error;
use crate::polygon::may_hold::MayHold;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::view::observer;
use crate::volume::bricks::{self, BrickPlace, Bricks};
use crate::volume::grid::{Grid, Scalars};
use crate::volume::labels::Tint;
use crate::volume::layer::Opacity;
use crate::volume::opacities::Opacities;
use crate::volume::ranges::Ranges;
use crate::volume::scene_volumes::with_opacities;

/// Makes the [`Opacity`] of every volume that states how it is classified.
pub struct ClassifyVoxels;

#[derive(PartialEq)]
struct Inputs {
    scalars: Scalars,
    ranges: Ranges,
    grid: Grid,
    classify: components::Classify,
    unit: OpacityUnit,
    clip: Option<Clip>,
    tint: Option<Tint>,
    /// Whether what no ray comes to is left out, if there can be any.
    unburied: bool,
}

impl System for ClassifyVoxels {
    type Product = Opacity;
    const NAME: &'static str = "classify";
    const READS: &'static [ProductKey] = &[ProductKey::of::<Ranges>()];

    fn run(world: &World, out: &mut Outbox<'_, Opacity>) -> Result<(), Error> {
        type Volume<'a> = (
            Entity,
            &'a Scalars,
            &'a Ranges,
            &'a Grid,
            &'a components::Classify,
            &'a OpacityUnit,
            Option<&'a Clip>,
            Option<&'a Tint>,
        );
        let watch = out.watch();
        let asked: Vec<_> = with_opacities(world).into_iter().map(|volume| volume.entity).collect();
        for (entity, scalars, ranges, grid, classify, unit, clip, tint) in
            &mut world.query::<Volume>()
        {
            if !asked.contains(&entity) {
                continue;
            }
            let made = Opacities::new((scalars, grid), (classify, unit.0), clip, tint);
            let unburied = made.may_bury(ranges) && observer::stays_outside(world, grid);
            let inputs = Inputs {
                scalars: scalars.clone(),
                ranges: ranges.clone(),
                grid: *grid,
                classify: classify.clone(),
                unit: *unit,
                clip: clip.cloned(),
                tint: tint.cloned(),
                unburied,
            };
            out.derive(entity, inputs, |inputs| {
                let opacity = inputs.classify(watch);
                watch.check()?;
                Ok(opacity)
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let held: Vec<_> =
            with_opacities(world).iter().map(|v| (v.entity, MayHold::of(world, v))).collect();
        if held.is_empty() {
            return Plan::absent(
                "no volume of scalars is classified at its voxels, and no light asks for their opacities",
            );
        }
        let most = |held: &MayHold| held.bytes::<f32>();
        Plan::of(&held, most, MayHold::seen, "`classify` states which scalars are seen")
    }
}

impl Inputs {
    fn classify(&self, watch: &Watch) -> Opacity {
        let Self { scalars, ranges, grid, classify, unit, clip, tint, unburied } = self;
        let opacities =
            Opacities::new((scalars, grid), (classify, unit.0), clip.as_ref(), tint.as_ref());
        let held = opacities.held(ranges, *unburied);
        let [nx, ny, _] = bricks::counts(grid.size);
        let may_hold = |place: BrickPlace| {
            let [x, y, z] = place.brick;
            held[(z * ny + y) * nx + x]
        };
        let voxels = Bricks::make_where(grid.size, may_hold, |place, brick| {
            watch.check().is_ok() && opacities.fill(ranges, place, brick)
        });
        Opacity { voxels, nan_voxels: ranges.nan_voxels() }
    }
}
