//! Which volumes polygons are matted with.

use hecs::{Entity, World};

use super::face::Faces;
use crate::components::{Surface, Voxelize};
use crate::volume::scene_volumes::{SceneVolume, around, volumes};

/// The volumes that polygons are scan-converted into, in the order of the scene.
#[must_use]
pub(crate) fn matted(world: &World) -> Vec<SceneVolume> {
    let mut volumes = volumes(world);
    let mut query = world.query::<&Faces>().with::<(&Voxelize, &Surface)>();
    let into = |faces: &Faces| Some(around(&volumes, || faces.middle())?.entity);
    let into: Vec<Entity> = query.iter().filter_map(into).collect();
    volumes.retain(|volume| into.contains(&volume.entity));
    volumes
}

/// Whether that is one of them.
#[must_use]
pub(crate) fn is_matted(world: &World, volume: Entity) -> bool {
    matted(world).iter().any(|matted| matted.entity == volume)
}
