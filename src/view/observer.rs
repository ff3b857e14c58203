//! The observer whom voxels are made ready for: the first view of a scene.

use glam::DVec3;
use hecs::{Entity, World};

use crate::components::{DepthCue, Matte, Order, Sampling, Skip, View, Voxelize};
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::volume::buried::WIDEST;
use crate::volume::grid::Grid;

/// Where an observer is taken to stand who makes no difference: in front, as at azimuth 0 and elevation 0.
pub(crate) const ANYWHERE: DVec3 = DVec3::NEG_Y;

/// The first view in the order of the scene; `None` without one.
#[must_use]
pub fn first_view(world: &World) -> Option<Entity> {
    let mut views = world.query::<(Entity, &View, Option<&Order>)>();
    views.iter().min_by_key(|(_, _, order)| order.copied()).map(|(entity, ..)| entity)
}

/// The unit vector from the scene towards the observer; `ANYWHERE` without a view.
#[must_use]
pub fn direction(world: &World) -> DVec3 {
    let view = first_view(world).and_then(|entity| world.get::<&View>(entity).ok());
    // Rays are parallel: where they point depends on no extent.
    let somewhere = Extent { low: DVec3::ZERO, high: DVec3::ONE };
    view.map_or(ANYWHERE, |view| -Camera::new(&view, &somewhere).forward)
}

/// How the view samples; the defaults where it states nothing.
#[must_use]
pub fn sampling(world: &World) -> Sampling {
    let sampling = first_view(world).and_then(|entity| world.get::<&Sampling>(entity).ok());
    sampling.map_or_else(Sampling::default, |sampling| (*sampling).clone())
}

/// Whether the view states a depth cue: ambient light, which is not cued, is then kept apart.
#[must_use]
pub(crate) fn is_cued(world: &World) -> bool {
    first_view(world).is_some_and(|entity| world.get::<&DepthCue>(entity).is_ok())
}

/// Whether what is [`buried`](crate::volume::buried) in a volume may be left out: empty space is skipped, rays begin outside,
/// for they are parallel, their samples are close enough, and no polygon is matted so that it takes the volume away around it.
#[must_use]
pub(crate) fn stays_outside(world: &World, grid: &Grid) -> bool {
    let sampling = sampling(world);
    let apart = WIDEST * grid.spacing().min_element();
    let is_close = sampling.distance_mm.is_none_or(|distance| distance <= apart);
    let mut views = world.query::<&View>();
    let is_parallel = views.iter().all(|view| view.field_of_view.is_none());
    let mut polygons = world.query::<&Voxelize>();
    let cuts = polygons.iter().any(|polygon| matches!(polygon.matte, Matte::In | Matte::Out));
    sampling.skip == Skip::Pyramid && is_close && is_parallel && !cuts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_view_in_the_order_of_the_scene_counts() {
        let mut world = World::new();
        assert_eq!(direction(&world), ANYWHERE);
        let side = View { azimuth: 90.0, ..View::default() };
        world.spawn((Order(2), View::default()));
        let first = world.spawn((Order(1), side, DepthCue { k1: 1.0, k2: 0.1 }));
        assert_eq!(first_view(&world), Some(first));
        assert_eq!(direction(&world), DVec3::X);
        assert!(is_cued(&world));
        assert_eq!(sampling(&world), Sampling::default());
    }
}
