//! Volumes: what their opacities are stated for, how their scalars are classified, and of what material they are.

use hecs::{Entity, World};

use super::carriers::{carriers, get};
use super::fault::{Fault, Notice};
use super::fill::{Became, fill, fill_from};
use crate::components::{
    Classify, Color, Contour, Material, OpacityUnit, Projection, TransferPoint,
};
use crate::measure::histogram::{histogram, suggested_isovalues};
use crate::volume::grid::{Grid, Painted, Scalars};

/// Gives every grid its opacity unit, and scalars a classification and a material.
pub(super) fn fill_in(world: &mut World, notices: &mut Vec<Notice>) -> Result<(), Fault> {
    let placeless = "has voxels and no grid that says where they are; put a `Grid` beside them";
    for entity in [carriers::<Scalars>(world), carriers::<Painted>(world)].concat() {
        let (Some(grid), len) = (get::<Grid>(world, entity), len(world, entity)) else {
            return Err(Fault::of(entity, "volume", "", placeless));
        };
        if len != grid.voxels() {
            let problem = format!(
                "has {len} voxels and a grid of {:?}, which are {}; their numbers must agree",
                grid.size,
                grid.voxels()
            );
            return Err(Fault::of(entity, "volume", "size", problem));
        }
    }
    for entity in carriers::<Grid>(world) {
        fill_from(world, entity, |grid: &Grid| Ok(OpacityUnit(grid.spacing().min_element())))?;
        let unit = get::<OpacityUnit>(world, entity).map_or(1.0, |unit| unit.0);
        if !(unit.is_finite() && unit > 0.0) {
            let problem = format!(
                "states its opacities for a thickness of {unit}; state a length above 0 in world units"
            );
            return Err(Fault::of(entity, "volume", "opacity_unit_mm", problem));
        }
        if world.get::<&Scalars>(entity).is_ok() {
            classified(world, entity, notices)?;
        }
    }
    Ok(())
}

/// Voxels of an entity: its scalars, or those that are painted.
fn len(world: &World, entity: Entity) -> usize {
    let painted = || get::<Painted>(world, entity).map_or(0, |painted| painted.len());
    get::<Scalars>(world, entity).map_or_else(painted, |scalars| scalars.len())
}

fn classified(world: &mut World, entity: Entity, notices: &mut Vec<Notice>) -> Result<(), Fault> {
    if world.get::<&Projection>(entity).is_ok() {
        return projected(world, entity);
    }
    let suggested = |scalars: &Scalars| suggested(entity, scalars);
    if fill_from::<Scalars, Classify>(world, entity, suggested)? == Became::Made {
        let value = get::<Classify>(world, entity).map_or(0.0, |made| made.iso[0].value);
        let problem = format!(
            "no `classify` is stated, so its surface is drawn at the isovalue {value} that its histogram suggests"
        );
        notices.push(Notice { entity, problem });
    }
    fill(world, entity, (), |()| Ok(Material::default())).map(|_| ())
}

/// A value is looked up in a transfer function; what asks for gradients has no answer for it.
fn projected(world: &mut World, entity: Entity) -> Result<(), Fault> {
    let of_hues = get::<Projection>(world, entity) == Some(Projection::Sabella);
    let color = |part: f32| if of_hues { hue(part) } else { Color::from_srgb([part; 3]) };
    fill_from::<Scalars, Classify>(world, entity, |scalars| Ok(over_all(scalars, color)))?;
    let classify = get::<Classify>(world, entity).unwrap_or_default();
    if classify.transfer.is_empty() || !classify.gradient.is_empty() {
        let problem = "shows one value a ray, which `classify` colors by `transfer` (without `gradient`) or `colormap`; state one of them or take `projection` away";
        return Err(Fault::of(entity, "projection", "", problem));
    }
    fill(world, entity, (), |()| Ok(Material::default())).map(|_| ())
}

/// A hue of full saturation and value: blue at 0, over green, to red at 1.
fn hue(part: f32) -> Color {
    let from = |at: f32| (2.0 - 4.0 * (part - at).abs()).clamp(0.0, 1.0);
    Color::from_srgb([from(1.0), from(0.5), from(0.0)])
}

/// The colors of 0..=1 over all values but the outermost thousandths, opaque.
fn over_all(scalars: &Scalars, color: impl Fn(f32) -> Color) -> Classify {
    let counted = histogram(scalars, 4096);
    let (low, high) = (counted.quantile(0.001), counted.quantile(0.999));
    let high = if high > low { high } else { low + low.abs().max(1.0) };
    let point = |step: u16| {
        let part = f32::from(step) / 16.0;
        let color = Some(color(part));
        TransferPoint { value: low + part * (high - low), opacity: 1.0, color }
    };
    Classify { transfer: (0..=16).map(point).collect(), ..Classify::default() }
}

/// A contour at the isovalue that the histogram suggests.
fn suggested(entity: Entity, scalars: &Scalars) -> Result<Classify, Fault> {
    let Some(&value) = suggested_isovalues(scalars).first() else {
        let problem = "the volume suggests no isovalue (its voxels are all alike or not numbers); state `classify`";
        return Err(Fault::of(entity, "volume", "", problem));
    };
    Ok(Classify { iso: vec![Contour::at(value)], ..Classify::default() })
}
