//! Shadows (paper §4, figure 5): the strength of each light that casts them, in the volume.
//!
//! One light is swept through the volume slice by slice, along the index axis nearest to it, in columns that run along
//! the light ([`Shear`]): strengths are never resampled from slice to slice, and only opacities are interpolated, in the
//! slice. That is one resampling of strengths (columns and slices to voxels) in place of the paper's three steps.

mod casters;
mod columns;
mod inputs;
mod opacities;
mod voxels;

use std::mem::size_of;

use glam::DVec3;
use hecs::{Entity, World};

use crate::components::{CastsShadow, Light, Name};
use crate::error::Error;
use crate::light::shading::toward;
use crate::light::strength::{
    Buffer, Falloff, LightStrength, ProjectedBy, Receding, Shear, Slide, VoxelStrength, quantize,
};
use crate::polygon::may_hold::MayHold;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::view::observer;
use crate::volume::bricks::most_bytes;
use crate::volume::grid::Grid;
use crate::volume::layer::{Composite, Coverage, Opacity};
use crate::volume::scene_volumes::{Content, SceneVolume};
use casters::Casters;
use columns::Columns;
use inputs::{Inputs, LitVolume, lit_volumes, reads_buffer, stated_volumes};
use voxels::{TOGETHER, Voxels};

/// Makes the [`LightStrength`] of every light that `casts_shadow`; other lights cost nothing.
pub struct LightSweep;

impl System for LightSweep {
    type Product = LightStrength;
    const NAME: &'static str = "light_sweep";
    const READS: &'static [ProductKey] =
        &[ProductKey::of::<Opacity>(), ProductKey::of::<Coverage>(), ProductKey::of::<Composite>()];

    fn run(world: &World, out: &mut Outbox<'_, LightStrength>) -> Result<(), Error> {
        let mut query =
            world.query::<(Entity, &Light, &CastsShadow, Option<&ProjectedBy>, Option<&Name>)>();
        let lights: Vec<_> = query.iter().collect();
        let volumes = if lights.is_empty() { Vec::new() } else { lit_volumes(world)? };
        for (entity, light, shadow, projected, name) in lights {
            if volumes.is_empty() {
                break;
            }
            let inputs = Inputs {
                volumes: volumes.clone(),
                toward: toward(light, observer::direction(world)),
                shadow: *shadow,
                projected: projected.cloned(),
                buffer: reads_buffer(world, entity),
            };
            let watch = out.watch();
            out.derive(entity, inputs, |inputs| {
                let name = name.map_or("light", |name| &name.0);
                swept(inputs, watch, &|problem| Error::entity(name, problem))
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let mut query = world.query::<(Entity, &Light, &CastsShadow)>();
        let lights: Vec<_> = query.iter().collect();
        if lights.is_empty() {
            return Plan::absent(
                "no light states `casts_shadow`: every light has its full strength everywhere",
            );
        }
        let volumes = stated_volumes(world);
        if volumes.is_empty() {
            return Plan::absent(
                "a light states `casts_shadow`, but there is no volume to cast it through",
            );
        }
        let bytes = |(entity, light, shadow): (Entity, &Light, &CastsShadow)| {
            let toward = toward(light, observer::direction(world));
            // What comes through each of several volumes weakens the light in the others.
            let buffer = volumes.len() > 1 || reads_buffer(world, entity);
            let most = volumes
                .iter()
                .map(|v| lit(world, v).saturating_add(most(&v.grid, toward, shadow, buffer)));
            (entity, most.fold(0, u64::saturating_add))
        };
        let makes: Vec<_> = lights.into_iter().map(bytes).collect();
        let why = if volumes.len() > 1 {
            "`casts_shadow`, with a 3D light-strength buffer for each volume, since what comes through one lights the others"
        } else if makes.iter().any(|(entity, _)| reads_buffer(world, *entity)) {
            "`casts_shadow`, with the 3D light-strength buffer because hybrid polygons, values at samples or a shaft of light read it"
        } else {
            "`casts_shadow`; only the slices within the bias are kept, since nothing reads a 3D light-strength buffer"
        };
        Plan::of_most(makes, why)
    }
}

/// The most bytes of a light's strengths at voxels: those of the volume that may be seen, and those that polygons touch, which
/// cast their shadow whether they are traced or scan-converted. Of what states no classification nothing is known.
fn lit(world: &World, volume: &SceneVolume) -> u64 {
    match volume.content {
        Content::Clear | Content::Projected => most_bytes::<u16>(volume.size()),
        Content::Classified | Content::Values | Content::Painted => {
            MayHold::of(world, volume).with_casters(world, volume).bytes::<u16>()
        }
    }
}

/// The most bytes that columns and slices of a light take, those in memory while strengths are made too.
fn most(grid: &Grid, toward: DVec3, shadow: &CastsShadow, buffer: bool) -> u64 {
    let Some(shear) = Shear::new(grid, toward) else {
        return 0;
    };
    let kept = shear.width().iter().map(|&n| n as u64).product::<u64>();
    let ring = depth(bias_slices(grid, &shear, shadow), &shear) * size_of::<f32>();
    let columns = 2 * size_of::<f64>();
    let all = if buffer { shear.size[2] * size_of::<u16>() } else { 0 };
    kept.saturating_mul((ring + columns + all) as u64)
}

/// The bias along the light, in slices; rounded to 2⁻²⁰, so that a whole number of slices stays one. A bias past the whole
/// volume is no more than that.
fn bias_slices(grid: &Grid, shear: &Shear, shadow: &CastsShadow) -> f64 {
    let slices = shadow.bias_voxels * grid.spacing().min_element() / shear.distance;
    (slices.min((shear.size[2] + 1) as f64) * 1_048_576.0).round() / 1_048_576.0
}

/// Slices that are needed at once: those that are lit together, and those within the bias before them.
fn depth(bias: f64, shear: &Shear) -> usize {
    (bias.ceil() as usize).saturating_add(TOGETHER).min(shear.size[2])
}

const NO_DIRECTION: &str =
    "its `toward` has no direction; state three finite numbers that are not all 0";

/// Sweeps one light through every volume.
///
/// What comes through several volumes is the product of what comes through each: optical depths add. So each is swept
/// alone, and its voxels are weakened by what the buffers of the others let through.
fn swept(
    inputs: &Inputs,
    watch: &Watch,
    wrong: &dyn Fn(String) -> Error,
) -> Result<LightStrength, Error> {
    let Inputs { volumes, toward, shadow, .. } = inputs;
    let grids: Vec<_> = volumes.iter().map(|volume| volume.grid).collect();
    let (falloff, slide) = checked(inputs, &grids).map_err(wrong)?;
    let mut through = Vec::new();
    if volumes.len() > 1 {
        for volume in volumes {
            let (_, buffer) = Sweep { volume, toward, shadow, falloff: Falloff::NONE, slide: None }
                .run(None, true, watch, wrong)?;
            through.extend(buffer);
        }
    }
    let mut strength = LightStrength { volumes: Vec::new(), buffers: Vec::new() };
    for (number, volume) in volumes.iter().enumerate() {
        let others: Vec<&Buffer> =
            through.iter().enumerate().filter(|(n, _)| *n != number).map(|(_, b)| b).collect();
        // One buffer has the slide and the falloff, the others what comes through their volumes alone.
        let sweep = Sweep { volume, toward, shadow, falloff, slide: slide.clone() };
        let buffer = inputs.buffer && number == 0;
        let (voxels, own) = sweep.run(Some(&others), buffer, watch, wrong)?;
        if let Some(own) = own {
            strength.buffers = std::iter::once(own).chain(others.into_iter().cloned()).collect();
        }
        strength.volumes.extend(voxels.map(|voxels| (volume.entity, voxels)));
    }
    Ok(strength)
}

/// One light on its way through one volume.
struct Sweep<'a> {
    volume: &'a LitVolume,
    toward: &'a DVec3,
    shadow: &'a CastsShadow,
    falloff: Falloff,
    slide: Option<Slide>,
}

impl Sweep<'_> {
    /// The strengths at the volume's voxels, if those are asked for by the buffers of the `others` that weaken the light too;
    /// and anywhere, if `buffer` is asked for.
    fn run(
        self,
        others: Option<&[&Buffer]>,
        buffer: bool,
        watch: &Watch,
        wrong: &dyn Fn(String) -> Error,
    ) -> Result<(Option<VoxelStrength>, Option<Buffer>), Error> {
        let Self { volume, toward, shadow, falloff, slide } = self;
        let grid = &volume.grid;
        let shear = Shear::new(grid, *toward).ok_or_else(|| wrong(NO_DIRECTION.to_owned()))?;
        let bias = bias_slices(grid, &shear, shadow);
        let casters = Casters::new(&volume.opacity, &volume.polygons, grid);
        let brightest = slide.as_ref().map_or(1.0, Slide::brightest);
        // A slide of black has no strength to scale by.
        let brightest = if brightest > 0.0 { brightest } else { 1.0 };
        let ratio = shear.distance / volume.unit;
        let mut columns = Columns::new(&shear, slide.as_ref(), ratio, depth(bias, &shear));
        let way = *toward * (bias * shear.distance);
        let mut voxels =
            others.map(|others| Voxels::new(&casters.opacity, (bias, way), brightest, others));
        let [width, height] = shear.width();
        let kept = if buffer { width * height * shear.size[2] } else { 0 };
        let mut slices = Vec::with_capacity(kept);
        watch.expect(shear.size[2] as u64);
        for slice in 0..shear.size[2] {
            watch.check()?;
            let swept = columns.sweep(slice, &casters);
            if buffer {
                let brightest = f64::from(brightest);
                slices.extend(swept.iter().map(|&s| quantize(f64::from(s), brightest)));
            }
            let done = slice + 1;
            if let Some(voxels) = &mut voxels
                && (done.is_multiple_of(TOGETHER) || done == shear.size[2])
            {
                voxels.light(slice / TOGETHER * TOGETHER..done, &columns);
            }
            watch.advance();
        }
        drop(columns);
        let strength = voxels.map(|voxels| VoxelStrength {
            voxels: voxels.gather(&shear),
            full: brightest,
            receding: Receding::new(falloff, grid, way),
        });
        let buffer = buffer.then(|| Buffer::new((shear, falloff), slide, (slices, brightest), way));
        Ok((strength, buffer))
    }
}

/// The falloff and the slide of a light, checked; an error is a sentence without a subject.
fn checked(inputs: &Inputs, grids: &[Grid]) -> Result<(Falloff, Option<Slide>), String> {
    let Inputs { volumes, toward, shadow, .. } = inputs;
    let CastsShadow { bias_voxels, k1, k2 } = *shadow;
    if !(bias_voxels >= 0.0 && bias_voxels.is_finite()) {
        return Err(format!(
            "`casts_shadow` states a bias of {bias_voxels} voxels; choose 0 or more, 2 is usual"
        ));
    }
    if let Some(unit) = volumes.iter().map(|v| v.unit).find(|u| !(*u > 0.0 && u.is_finite())) {
        return Err(format!(
            "it shines through a volume whose opacity unit is {unit}; `opacity_unit_mm` must be above 0"
        ));
    }
    if Shear::new(&grids[0], *toward).is_none() {
        return Err(NO_DIRECTION.to_owned());
    }
    let falloff = Falloff::new(grids, *toward, k1, k2)?;
    let slide = inputs.projected.as_ref().map(|p| Slide::new(p, *toward)).transpose()?;
    Ok((falloff, slide))
}
