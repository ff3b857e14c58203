//! Slides before lights: the picture that `projects` names, and where its middle falls.

use glam::DVec3;
use hecs::{Entity, World};

use super::carriers::{carriers, get};
use super::fault::Fault;
use super::fill::{fill, withdraw};
use super::textures::carrier;
use crate::components::Projects;
use crate::light::strength::ProjectedBy;
use crate::phantom;
use crate::view::extent::Extent;
use crate::view::picture::Picture;
use crate::volume::grid::Grid;

/// What a slide is made of: the statement, the picture of the entity that it names (else it names a formula), and the
/// middle of what it falls on.
type Named = (Projects, Option<Picture>, DVec3);

/// Gives every light that states `projects` the slide itself.
pub(super) fn fill_in(world: &mut World, extent: Extent) -> Result<(), Fault> {
    for entity in carriers::<ProjectedBy>(world) {
        if get::<Projects>(world, entity).is_none() {
            withdraw::<Named, ProjectedBy>(world, entity);
        }
    }
    let middle = middle(world, extent);
    for entity in carriers::<Projects>(world) {
        let Some(projects) = get::<Projects>(world, entity) else { continue };
        let picture = carrier(world, entity, "projects", &projects.texture)?;
        let picture = picture.and_then(|carrier| get(world, carrier));
        fill(world, entity, (projects, picture, middle), |named| slide(entity, named))?;
    }
    Ok(())
}

fn slide(entity: Entity, (projects, picture, middle): &Named) -> Result<ProjectedBy, Fault> {
    let name = &projects.texture;
    let missing = |problem| Fault::of(entity, "projects", "texture", problem);
    let formula = || phantom::texture(name).map_err(missing);
    let picture = picture.clone().map_or_else(formula, Ok)?;
    let center = projects.center.map_or(*middle, DVec3::from);
    let up = projects.up.map_or(DVec3::Z, DVec3::from);
    Ok(ProjectedBy { projects: projects.clone(), picture, center, up })
}

/// The middle of the first volume, or of everything where there is none.
fn middle(world: &World, extent: Extent) -> DVec3 {
    let grid = carriers::<Grid>(world).first().and_then(|&entity| get::<Grid>(world, entity));
    grid.and_then(|grid| Extent::of(grid.corners())).unwrap_or(extent).center()
}
