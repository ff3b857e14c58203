//! `relight`: equation 4, `c_T = Σ c_i β_i`, and the associated gel `c_T · α` that rays meet.

mod relit;

use glam::Vec4;
use hecs::{Entity, World};

use crate::components::{Clip, TexelKind, Voxelize};
use crate::error::Error;
use crate::light::shading::Lamps;
use crate::light::strength::LightStrength;
use crate::schedule::{Outbox, Plan, ProductKey, System};
use crate::view::observer;
use crate::volume::bricks::Bricks;
use crate::volume::gel::Gel;
use crate::volume::gel::{self, GelBricks};
use crate::volume::grid::{Grid, Painted};
use crate::volume::layer::{Composite, LitColors, Opacity};
use crate::volume::painting::Painting;
use crate::volume::seen::{self, Seen};

use relit::Relit;

/// Makes the [`Gel`] of every volume.
pub struct Relight;

#[derive(PartialEq)]
struct Inputs {
    source: Source,
    /// Of each light that casts a shadow, in the order of the scene; `None` is β = 1.
    strengths: Vec<Option<LightStrength>>,
    texel: TexelKind,
}

/// Where opacity and colours come from.
#[derive(PartialEq)]
enum Source {
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
        let (texel, strengths) = (observer::sampling(world).texel, strengths(world));
        for (entity, source) in sources(world) {
            // Painted voxels bring their light with them.
            let lit = matches!(source, Source::Layer(..));
            let strengths = if lit { strengths.clone() } else { Vec::new() };
            out.derive(entity, Inputs { source, strengths, texel }, |inputs| {
                watch.check()?;
                Ok(inputs.relight())
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let texel = observer::sampling(world).texel;
        let cued = observer::is_cued(world);
        let matted = world.query::<&Voxelize>().iter().next().is_some();
        let bytes = |v: &Seen| {
            // Ambient light is kept apart for a depth cue; paint alone has none.
            let apart = cued && (matted || !v.painted);
            gel::most_bytes(texel, v.size).saturating_mul(1 + u64::from(apart))
        };
        let makes: Vec<_> = seen::all(world).iter().map(|v| (v.entity, bytes(v))).collect();
        if makes.is_empty() {
            return Plan::absent("no volume is stated");
        }
        Plan { makes, why: "rays sample a volume as gel" }
    }
}

/// What there is to relight: composites first, then classified volumes, then painted ones.
fn sources(world: &World) -> Vec<(Entity, Source)> {
    type Volume<'a> = (
        Entity,
        &'a Grid,
        Option<&'a Composite>,
        Option<(&'a Opacity, &'a LitColors)>,
        Option<&'a Painted>,
        Option<&'a Clip>,
    );
    let mut volumes = world.query::<Volume>();
    let source =
        |(entity, grid, composite, classified, painted, clip): <Volume as hecs::Query>::Item<
            '_,
        >| {
            let layer = match (composite, classified) {
                (Some(Composite(layer)), _) => Some((&layer.opacity, &layer.colors)),
                (None, Some((opacity, colors))) => Some((&opacity.voxels, colors)),
                (None, None) => None,
            };
            let layer =
                layer.map(|(opacity, colors)| Source::Layer(opacity.clone(), colors.clone()));
            let painted = || painted.map(|p| Source::Painted(p.clone(), *grid, clip.cloned()));
            Some((entity, layer.or_else(painted)?))
        };
    volumes.iter().filter_map(source).collect()
}

/// β of every light that casts a shadow, in the order of the scene; `None` where no buffer was made.
fn strengths(world: &World) -> Vec<Option<LightStrength>> {
    let lamps = Lamps::of(world, observer::ANYWHERE);
    let strength = |entity: Entity| world.get::<&LightStrength>(entity).ok();
    lamps.shadowed.iter().map(|(entity, _)| strength(*entity).map(|s| (*s).clone())).collect()
}

impl Inputs {
    fn relight(&self) -> Gel {
        match &self.source {
            Source::Painted(painted, grid, clip) => {
                let painting = Painting::new(painted, grid, clip.as_ref());
                let holds = |brick| painting.holds(brick);
                let fill = |first, row: &mut [Vec4]| {
                    painting.row(first, row);
                    for voxel in row {
                        *voxel = (voxel.truncate() * voxel.w).extend(voxel.w);
                    }
                };
                Gel { lit: GelBricks::make(self.texel, grid.size, holds, fill), ambient: None }
            }
            Source::Layer(opacity, colors) => {
                let shadowed = colors.shadowed.iter().enumerate().map(|(i, colors)| {
                    let strength = self.strengths.get(i).and_then(Option::as_ref);
                    (colors, strength.filter(|s| s.voxels.size() == opacity.size()))
                });
                let shadowed = shadowed.collect();
                let lit = Relit { opacity, base: &colors.base, shadowed }.gel(self.texel);
                // Both parts in the same numbers.
                let texel = lit.kind();
                let ambient = colors.ambient.as_ref().map(|ambient| {
                    Relit { opacity, base: ambient, shadowed: Vec::new() }.gel(texel)
                });
                Gel { lit, ambient }
            }
        }
    }
}
