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

use crate::components::{CastsShadow, Light, Name, OpacityUnit};
use crate::error::Error;
use crate::light::shading::toward;
use crate::light::strength::{Buffer, Falloff, LightStrength, ProjectedBy, Shear, Slide, quantize};
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::view::observer;
use crate::volume::bricks::most_bytes;
use crate::volume::grid::Grid;
use crate::volume::layer::{Composite, Coverage, Opacity};
use casters::Casters;
use columns::Columns;
use inputs::{Inputs, hybrid_coverage, lit_volume, reads_buffer, stated_grid};
use voxels::Voxels;

/// Makes the [`LightStrength`] of every light that `casts_shadow`; other lights cost nothing.
pub struct LightSweep;

impl System for LightSweep {
    type Product = LightStrength;
    const NAME: &'static str = "light_sweep";
    const READS: &'static [ProductKey] =
        &[ProductKey::of::<Opacity>(), ProductKey::of::<Coverage>(), ProductKey::of::<Composite>()];

    fn run(world: &World, out: &mut Outbox<'_, LightStrength>) -> Result<(), Error> {
        let Some((volume, grid, opacity)) = lit_volume(world) else {
            return Ok(());
        };
        let polygons = hybrid_coverage(world, &grid)?;
        let unit = world.get::<&OpacityUnit>(volume);
        let unit = unit.map_or_else(|_| grid.spacing().min_element(), |unit| unit.0);
        let mut query =
            world.query::<(Entity, &Light, &CastsShadow, Option<&ProjectedBy>, Option<&Name>)>();
        for (entity, light, shadow, projected, name) in &mut query {
            let inputs = Inputs {
                grid,
                unit,
                opacity: opacity.clone(),
                polygons: polygons.clone(),
                toward: toward(light, observer::direction(world)),
                shadow: *shadow,
                projected: projected.cloned(),
                buffer: reads_buffer(world, entity),
            };
            let watch = out.watch();
            out.derive(entity, inputs, |inputs| {
                let name = name.map_or("light", |name| &name.0);
                sweep(inputs, watch, &|problem| Error::entity(name, problem))
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
        let Some(grid) = stated_grid(world) else {
            return Plan::absent(
                "a light states `casts_shadow`, but there is no volume to cast it through",
            );
        };
        let bytes = |(entity, light, shadow): (Entity, &Light, &CastsShadow)| {
            let toward = toward(light, observer::direction(world));
            (entity, most(&grid, toward, shadow, reads_buffer(world, entity)))
        };
        let makes: Vec<_> = lights.into_iter().map(bytes).collect();
        let why = if makes.iter().any(|(entity, _)| reads_buffer(world, *entity)) {
            "`casts_shadow`, with the 3D light-strength buffer because hybrid polygons or a shaft of light read it"
        } else {
            "`casts_shadow`; only the slices within the bias are kept, since nothing reads a 3D light-strength buffer"
        };
        Plan { makes, why }
    }
}

/// The most bytes that a light's strengths take, and the slices in memory while they are made.
fn most(grid: &Grid, toward: DVec3, shadow: &CastsShadow, buffer: bool) -> u64 {
    let Some(shear) = Shear::new(grid, toward) else {
        return 0;
    };
    let kept = shear.width().iter().map(|&n| n as u64).product::<u64>();
    let ring = depth(bias_slices(grid, &shear, shadow), &shear) * size_of::<f32>();
    let columns = 2 * size_of::<f64>();
    let all = if buffer { shear.size[2] * size_of::<u16>() } else { 0 };
    let columns = kept.saturating_mul((ring + columns + all) as u64);
    most_bytes::<u16>(grid.size).saturating_add(columns)
}

/// The bias along the light, in slices; rounded to 2⁻²⁰, so that a whole number of slices stays one. A bias past the whole
/// volume is no more than that.
fn bias_slices(grid: &Grid, shear: &Shear, shadow: &CastsShadow) -> f64 {
    let slices = shadow.bias_voxels * grid.spacing().min_element() / shear.distance;
    (slices.min((shear.size[2] + 1) as f64) * 1_048_576.0).round() / 1_048_576.0
}

/// Slices that are needed at once.
fn depth(bias: f64, shear: &Shear) -> usize {
    (bias.ceil() as usize).saturating_add(1).min(shear.size[2])
}

/// Sweeps one light through the volume.
fn sweep(
    inputs: &Inputs,
    watch: &Watch,
    wrong: &dyn Fn(String) -> Error,
) -> Result<LightStrength, Error> {
    let Inputs { grid, toward, shadow, .. } = inputs;
    let (shear, falloff, slide) = placed(inputs).map_err(wrong)?;
    let bias = bias_slices(grid, &shear, shadow);
    let casters = Casters::new(&inputs.opacity, &inputs.polygons, grid.size);
    let brightest = slide.as_ref().map_or(1.0, Slide::brightest);
    // A slide of black has no strength to scale by.
    let brightest = if brightest > 0.0 { brightest } else { 1.0 };
    let full = (f64::from(brightest) / falloff.least()) as f32;
    let mut columns =
        Columns::new(&shear, slide.as_ref(), shear.distance / inputs.unit, depth(bias, &shear));
    let mut voxels = Voxels::new(&casters.opacity, &falloff, bias, full);
    let [width, height] = shear.width();
    let kept = if inputs.buffer { width * height * shear.size[2] } else { 0 };
    let mut slices = Vec::with_capacity(kept);
    watch.expect(shear.size[2] as u64);
    for slice in 0..shear.size[2] {
        watch.check()?;
        let swept = columns.sweep(slice, &casters);
        if inputs.buffer {
            let brightest = f64::from(brightest);
            slices.extend(swept.iter().map(|&s| quantize(f64::from(s), brightest)));
        }
        voxels.light(slice, &columns);
        watch.advance();
    }
    drop(columns);
    let bias = *toward * (bias * shear.distance);
    let buffer =
        inputs.buffer.then(|| Buffer::new((shear, falloff), slide, (slices, brightest), bias));
    Ok(LightStrength { voxels: voxels.gather(&shear), full, buffer })
}

/// Where the light goes through the volume; an error is a sentence without a subject.
fn placed(inputs: &Inputs) -> Result<(Shear, Falloff, Option<Slide>), String> {
    let Inputs { grid, unit, toward, shadow, .. } = inputs;
    let CastsShadow { bias_voxels, k1, k2 } = *shadow;
    if !(bias_voxels >= 0.0 && bias_voxels.is_finite()) {
        return Err(format!(
            "`casts_shadow` states a bias of {bias_voxels} voxels; choose 0 or more, 2 is usual"
        ));
    }
    if !(*unit > 0.0 && unit.is_finite()) {
        return Err(format!(
            "it shines through a volume whose opacity unit is {unit}; `opacity_unit_mm` must be above 0"
        ));
    }
    let shear = Shear::new(grid, *toward)
        .ok_or("its `toward` has no direction; state three finite numbers that are not all 0")?;
    let falloff = Falloff::new(grid, *toward, k1, k2)?;
    let slide = inputs.projected.as_ref().map(|p| Slide::new(p, *toward)).transpose()?;
    Ok((shear, falloff, slide))
}
