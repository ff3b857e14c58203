//! `relight`: equation 4, `c_T = Σ c_i β_i`, and the associated gel `c_T · α` that rays meet.

mod lit_layer;
mod planned;
mod sent;

use std::sync::Arc;

use glam::Vec4;
use hecs::{Entity, World};

use crate::components::{Clip, TexelKind};
use crate::error::Error;
use crate::light::lit_bricks::LitBricks;
use crate::light::shading::Lamps;
use crate::light::strength::{LightStrength, VoxelStrength};
use crate::light::unlit::Unlit;
use crate::polygon::matted::is_matted;
use crate::polygon::may_hold::MayHold;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::view::observer;
use crate::volume::bricks::Bricks;
use crate::volume::gel::{Gel, GelBricks, Shown};
use crate::volume::grid::{Grid, Painted};
use crate::volume::layer::{Composite, LitColors, Opacity};
use crate::volume::painting::Painting;
use crate::volume::scene_volumes::{Content, SceneVolume, gels, with_content};

use lit_layer::LitLayer;
use planned::planned;
use sent::Sent;

/// Makes the [`Gel`] of every volume.
pub(crate) struct Relight;

#[derive(PartialEq)]
struct Inputs {
    voxels: Voxels,
    /// Of each light that casts a shadow, in the order of the scene; `None` is β = 1.
    strengths: Vec<Option<VoxelStrength>>,
    texel: TexelKind,
}

/// Where opacity and colours come from.
#[derive(PartialEq)]
enum Voxels {
    /// A composite of a volume and polygons.
    Colored(Bricks<f32>, LitColors),
    Unlit(Arc<Unlit>),
    Painted(Painted, Grid, Option<Clip>),
}

impl System for Relight {
    type Product = Gel;
    const NAME: &'static str = "relight";
    const READS: &'static [ProductKey] = &[
        ProductKey::of::<Opacity>(),
        ProductKey::of::<Composite>(),
        ProductKey::of::<LightStrength>(),
    ];

    fn run(world: &World, out: &mut Outbox<'_, Gel>) -> Result<(), Error> {
        let watch = out.watch();
        let texel = observer::sampling(world).texel;
        for (entity, voxels) in voxels(world) {
            // Painted voxels bring their light with them.
            let shaded = !matches!(voxels, Voxels::Painted(..));
            let strengths = if shaded { strengths(world, entity) } else { Vec::new() };
            let before = world.get::<&Gel>(entity).ok();
            out.derive(entity, Inputs { voxels, strengths, texel }, |inputs| {
                watch.check()?;
                let gel = inputs.relight(before.as_deref(), watch)?;
                watch.check()?;
                Ok(gel)
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let texel = observer::sampling(world).texel;
        let cued = observer::is_cued(world);
        let held = |v: &SceneVolume| {
            let held = MayHold::of(world, v);
            let kind = planned(world, v, &held, texel);
            // Ambient light is kept apart for a depth cue; paint alone has none.
            let apart = cued && (v.content != Content::Painted || is_matted(world, v.entity));
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

/// What there is to make gel of: composites, then classified volumes, then painted ones.
fn voxels(world: &World) -> Vec<(Entity, Voxels)> {
    let mut composites = world.query::<(Entity, &Composite)>().with::<&Grid>();
    let composite = |(entity, Composite(layer)): (Entity, &Composite)| {
        (entity, Voxels::Colored(layer.opacity.clone(), layer.colors.clone()))
    };
    let mut made: Vec<_> = composites.iter().map(composite).collect();
    let is_new = |made: &[(Entity, Voxels)], entity| made.iter().all(|(other, _)| *other != entity);
    for (entity, unlit) in Unlit::all(world) {
        if is_new(&made, entity) {
            made.push((entity, Voxels::Unlit(unlit)));
        }
    }
    let mut painted = world.query::<(Entity, &Grid, &Painted, Option<&Clip>)>();
    for (entity, grid, painted, clip) in &mut painted {
        if is_new(&made, entity) {
            made.push((entity, Voxels::Painted(painted.clone(), *grid, clip.cloned())));
        }
    }
    made
}

/// β in a volume of every light that casts a shadow, in the order of the scene; `None` where none was made.
fn strengths(world: &World, volume: Entity) -> Vec<Option<VoxelStrength>> {
    let lamps = Lamps::of(world, observer::ANYWHERE);
    let strength = |light: Entity| world.get::<&LightStrength>(light).ok()?.of(volume).cloned();
    lamps.shadowed.iter().map(|(light, _)| strength(*light)).collect()
}

impl Inputs {
    /// The gel; of opacities that are those of `before`, its interesting cells are not looked for again.
    fn relight(&self, before: Option<&Gel>, watch: &Watch) -> Result<Gel, Error> {
        match &self.voxels {
            Voxels::Painted(painted, grid, clip) => {
                Ok(self.of_paint(&Painting::new(painted, grid, clip.as_ref()), grid.size))
            }
            Voxels::Unlit(unlit) => {
                let opacity = &unlit.opacity.voxels;
                self.check(opacity)?;
                let lit = Sent::Lit(LitBricks::shadowed(unlit, &self.strengths).into());
                Ok(self.of_layer(
                    opacity,
                    lit,
                    LitBricks::ambient(unlit).map(|lit| Sent::Lit(lit.into())),
                    (before, watch),
                ))
            }
            Voxels::Colored(opacity, colors) => {
                self.check(opacity)?;
                let strength = |i: usize| self.strengths.get(i).and_then(Option::as_ref);
                let shadowed = colors.shadowed.iter().enumerate();
                let shadowed = shadowed.map(|(i, colors)| (colors, strength(i))).collect();
                let lit = Sent::Made { base: &colors.base, shadowed };
                let alone = |base| Sent::Made { base, shadowed: Vec::new() };
                Ok(self.of_layer(opacity, lit, colors.ambient.as_ref().map(alone), (before, watch)))
            }
        }
    }

    /// An error where a light's strengths are of other voxels.
    fn check(&self, opacity: &Bricks<f32>) -> Result<(), Error> {
        let mut strengths = self.strengths.iter().flatten();
        let Some(other) = strengths.find(|s| s.voxels.size() != opacity.size()) else {
            return Ok(());
        };
        Err(Error::Schedule(format!(
            "a light's strengths of {:?} voxels were made for gel of {:?}",
            other.voxels.size(),
            opacity.size()
        )))
    }

    fn of_paint(&self, painting: &Painting<'_>, size: [usize; 3]) -> Gel {
        let fill = |first, row: &mut [Vec4]| {
            painting.row(first, row);
            for voxel in row {
                *voxel = (voxel.truncate() * voxel.w).extend(voxel.w);
            }
        };
        let kind = if self.texel == TexelKind::Auto { painting.suited() } else { self.texel };
        let lit = GelBricks::make(kind, size, |brick| painting.holds(brick), &fill);
        Gel { lit, ambient: None, shown: None }
    }

    fn of_layer<'a>(
        &self,
        opacity: &'a Bricks<f32>,
        lit: Sent<'a>,
        ambient: Option<Sent<'a>>,
        (before, watch): (Option<&Gel>, &'a Watch),
    ) -> Gel {
        let (lit, interest) = LitLayer::new(opacity, lit, watch).gel(self.texel, before);
        // Both parts in the same numbers.
        let alone = |sent| LitLayer::new(opacity, sent, watch).in_cells(&interest, lit.kind());
        let ambient = ambient.map(alone);
        let shown = Shown { opacity: opacity.clone(), interest };
        Gel { lit, ambient, shown: Some(shown) }
    }
}
