//! `relight`: equation 4, `c_T = Σ c_i β_i`, and the associated gel `c_T · α` that rays meet.

mod lit_layer;
mod planned;

use std::sync::Arc;

use glam::Vec4;
use hecs::{Entity, World};

use crate::components::{Clip, TexelKind, Voxelize};
use crate::error::Error;
use crate::light::shading::Lamps;
use crate::light::strength::{LightStrength, VoxelStrength};
use crate::polygon::may_hold::MayHold;
use crate::schedule::{Outbox, Plan, ProductKey, System};
use crate::view::observer;
use crate::volume::bricks::Bricks;
use crate::volume::gel::{Gel, GelBricks, Shown};
use crate::volume::grid::{Grid, Painted};
use crate::volume::labels::Tint;
use crate::volume::layer::{Composite, LitColors, Opacity};
use crate::volume::painting::Painting;
use crate::volume::scene_volumes::{Content, SceneVolume, gels, with_content};

use lit_layer::LitLayer;
use planned::planned;

/// Makes the [`Gel`] of every volume.
pub(crate) struct Relight;

#[derive(PartialEq)]
struct Inputs {
    unlit: Unlit,
    /// Of each light that casts a shadow, in the order of the scene; `None` is β = 1.
    strengths: Vec<Option<VoxelStrength>>,
    /// What no color is above, where that is known beforehand.
    brightest: Option<f32>,
    texel: TexelKind,
}

/// Where opacity and colours come from.
#[derive(PartialEq)]
enum Unlit {
    Layer(Bricks<f32>, LitColors),
    Painted(Painted, Grid, Option<Clip>),
}

impl System for Relight {
    type Product = Gel;
    const NAME: &'static str = "relight";
    const READS: &'static [ProductKey] = &[
        ProductKey::of::<Opacity>(),
        ProductKey::of::<LitColors>(),
        ProductKey::of::<Composite>(),
        ProductKey::of::<LightStrength>(),
    ];

    fn run(world: &World, out: &mut Outbox<'_, Gel>) -> Result<(), Error> {
        let watch = out.watch();
        let texel = observer::sampling(world).texel;
        for (entity, unlit) in unlit(world) {
            // Painted voxels bring their light with them.
            let shaded = matches!(unlit, Unlit::Layer(..));
            let strengths = if shaded { strengths(world, entity) } else { Vec::new() };
            // The colors of polygons are told sooner brick by brick, as those of a tint are, which has one a voxel.
            let other = world.satisfies::<hecs::Or<&Composite, &Tint>>(entity);
            let brightest = if shaded && !other { planned::brightest(world, entity) } else { None };
            out.derive(entity, Inputs { unlit, strengths, brightest, texel }, |inputs| {
                watch.check()?;
                inputs.relight()
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let texel = observer::sampling(world).texel;
        let cued = observer::is_cued(world);
        let matted = world.query::<&Voxelize>().iter().next().is_some();
        let held = |v: &SceneVolume| {
            let held = MayHold::of(world, v);
            let kind = planned(world, v, &held, texel);
            // Ambient light is kept apart for a depth cue; paint alone has none.
            let apart = cued && (matted || v.content != Content::Painted);
            (held.with_polygons(world, v), kind, 1 + u64::from(apart))
        };
        let made: Vec<_> = gels(world).iter().map(|v| (v.entity, held(v))).collect();
        if made.is_empty() && !with_content(world, Content::Values).is_empty() {
            return Plan::absent("`reconstruct` is values: rays sample the scalars themselves");
        }
        if made.is_empty() {
            return Plan::absent("no volume is stated");
        }
        let most = |(held, kind, parts): &(MayHold, TexelKind, u64)| {
            held.gel_bytes(*kind).saturating_mul(*parts)
        };
        Plan::of(&made, most, |(held, ..)| held.seen(), "rays sample a volume as gel")
    }
}

/// What there is to relight: composites first, then classified volumes, then painted ones.
fn unlit(world: &World) -> Vec<(Entity, Unlit)> {
    type Volume<'a> = (
        Entity,
        &'a Grid,
        Option<&'a Composite>,
        Option<(&'a Opacity, &'a LitColors)>,
        Option<&'a Painted>,
        Option<&'a Clip>,
    );
    let mut volumes = world.query::<Volume>();
    let unlit =
        |(entity, grid, composite, classified, painted, clip): <Volume as hecs::Query>::Item<
            '_,
        >| {
            let layer = match (composite, classified) {
                (Some(Composite(layer)), _) => Some((&layer.opacity, &layer.colors)),
                (None, Some((opacity, colors))) => Some((&opacity.voxels, colors)),
                (None, None) => None,
            };
            let layer =
                layer.map(|(opacity, colors)| Unlit::Layer(opacity.clone(), colors.clone()));
            let painted = || painted.map(|p| Unlit::Painted(p.clone(), *grid, clip.cloned()));
            Some((entity, layer.or_else(painted)?))
        };
    volumes.iter().filter_map(unlit).collect()
}

/// β in a volume of every light that casts a shadow, in the order of the scene; `None` where none was made.
fn strengths(world: &World, volume: Entity) -> Vec<Option<VoxelStrength>> {
    let lamps = Lamps::of(world, observer::ANYWHERE);
    let strength = |light: Entity| world.get::<&LightStrength>(light).ok()?.of(volume).cloned();
    lamps.shadowed.iter().map(|(light, _)| strength(*light)).collect()
}

impl Inputs {
    fn relight(&self) -> Result<Gel, Error> {
        match &self.unlit {
            Unlit::Painted(painted, grid, clip) => {
                let painting = Painting::new(painted, grid, clip.as_ref());
                let holds = |brick| painting.holds(brick);
                let fill = |first, row: &mut [Vec4]| {
                    painting.row(first, row);
                    for voxel in row {
                        *voxel = (voxel.truncate() * voxel.w).extend(voxel.w);
                    }
                };
                let kind =
                    if self.texel == TexelKind::Auto { painting.suited() } else { self.texel };
                let lit = GelBricks::make(kind, grid.size, holds, &fill);
                Ok(Gel { lit, ambient: None, shown: None })
            }
            Unlit::Layer(opacity, colors) => {
                let strengths = || self.strengths.iter().flatten();
                if let Some(other) = strengths().find(|s| s.voxels.size() != opacity.size()) {
                    return Err(Error::Schedule(format!(
                        "a light's strengths of {:?} voxels were made for gel of {:?}",
                        other.voxels.size(),
                        opacity.size()
                    )));
                }
                let shadowed = colors.shadowed.iter().enumerate();
                let strength = |i: usize| self.strengths.get(i).and_then(Option::as_ref);
                let shadowed = shadowed.map(|(i, colors)| (colors, strength(i))).collect();
                let layer = LitLayer::new(opacity, &colors.base, shadowed, self.brightest);
                let (lit, interest) = layer.gel(self.texel);
                let ambient = colors.ambient.as_ref().map(|base| {
                    let layer = LitLayer::new(opacity, base, Vec::new(), self.brightest);
                    // Both parts in the same numbers.
                    layer.in_cells(&interest, lit.kind())
                });
                let shown = Shown { opacity: opacity.clone(), interest: Arc::new(interest) };
                Ok(Gel { lit, ambient, shown: Some(shown) })
            }
        }
    }
}
