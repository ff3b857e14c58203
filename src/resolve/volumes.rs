//! Volumes: what their opacities are stated for, how their scalars are classified, and of what material they are.

use hecs::{Entity, World};

use super::carriers::{carriers, get};
use super::fault::{Fault, Notice};
use super::fill::{Became, fill, fill_from};
use crate::components::{Classify, Contour, Material, OpacityUnit};
use crate::measure::histogram::suggested_isovalues;
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

/// A contour at the isovalue that the histogram suggests.
fn suggested(entity: Entity, scalars: &Scalars) -> Result<Classify, Fault> {
    let Some(&value) = suggested_isovalues(scalars).first() else {
        let problem = "the volume suggests no isovalue (its voxels are all alike or not numbers); state `classify`";
        return Err(Fault::of(entity, "volume", "", problem));
    };
    Ok(Classify { iso: vec![Contour::at(value)], ..Classify::default() })
}
