//! `shade`: what every interesting voxel sends towards the observer, light by light (algorithm §3, Levoy 1988), where it is
//! matted with polygons. Elsewhere `relight` lights voxels as it makes gel of them.

use hecs::{Entity, World};

use crate::components::{CastsShadow, Light};
use crate::error::Error;
use crate::light::lit_bricks::{DARK, LitBricks};
use crate::light::side_by_side;
use crate::light::unlit::Unlit;
use crate::polygon::matted::matted;
use crate::polygon::may_hold::MayHold;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::view::observer;
use crate::volume::bricks::{Bricks, EDGE};
use crate::volume::layer::{LitColors, Opacity};
use crate::volume::scene_volumes::Content;

/// Makes the [`LitColors`] of every volume that is classified.
pub(crate) struct Shade;

impl System for Shade {
    type Product = LitColors;
    const NAME: &'static str = "shade";
    const READS: &'static [ProductKey] = &[ProductKey::of::<Opacity>()];

    fn run(world: &World, out: &mut Outbox<'_, LitColors>) -> Result<(), Error> {
        let (watch, matted) = (out.watch(), matted(world));
        let is_matted = |entity: Entity| matted.iter().any(|volume| volume.entity == entity);
        for (entity, unlit) in
            Unlit::all(world).into_iter().filter(|(entity, _)| is_matted(*entity))
        {
            out.derive(entity, unlit, |unlit| {
                let made = shade(unlit, watch);
                watch.check()?;
                Ok(made)
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let shadows = world.query::<(&Light, &CastsShadow)>().iter().count() as u64;
        let arrays = 1 + shadows + u64::from(observer::is_cued(world));
        let classified = matted(world).into_iter().filter(|v| v.content == Content::Classified);
        let held: Vec<_> = classified.map(|v| (v.entity, MayHold::of(world, &v))).collect();
        if held.is_empty() {
            let why = "no polygon is scan-converted into a volume that is classified at its voxels";
            return Plan::absent(why);
        }
        let most = |held: &MayHold| held.bytes::<[f32; 3]>().saturating_mul(arrays);
        let why = "colors of voxels are matted with those of scan-converted polygons";
        Plan::of(&held, most, MayHold::seen, why)
    }
}

fn shade(unlit: &Unlit, watch: &Watch) -> LitColors {
    let colors = |lit: LitBricks<'_>| per_voxel(unlit, &lit, watch).into();
    LitColors {
        base: colors(LitBricks::base(unlit)),
        shadowed: LitBricks::unshadowed(unlit).into_iter().map(colors).collect(),
        ambient: LitBricks::ambient(unlit).map(colors),
    }
}

/// The colors of every interesting voxel; what is clear has none.
fn per_voxel(unlit: &Unlit, lights: &LitBricks<'_>, watch: &Watch) -> Bricks<[f32; 3]> {
    unlit.opacity.voxels.map(|place, alpha, made| {
        if watch.check().is_err() {
            return;
        }
        let mut lit = DARK;
        lights.fill(place, alpha, &mut lit);
        for (at, made) in made.iter_mut().enumerate().filter(|(at, _)| alpha[*at] > 0.0) {
            *made = side_by_side::one(&lit[at / EDGE], at % EDGE).to_array();
        }
    })
}
