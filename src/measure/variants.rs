//! A scene's variants, by which the paper says what something costs: the same world without it.

use hecs::{Component, Entity, World};

use crate::components::{CastsShadow, Matte, Sampling, Skip, Voxelize};
use crate::polygon::face::Faces;
use crate::polygon::texture::TexturedBy;

/// Entities that carry a component.
fn carriers<C: Component>(world: &World) -> Vec<Entity> {
    world.query::<Entity>().with::<&C>().iter().collect()
}

/// Takes a component off whatever carries it.
fn take_off<C: Component>(world: &mut World) {
    for entity in carriers::<C>(world) {
        // It was found there a line ago.
        let _ = world.remove_one::<C>(entity);
    }
}

/// Whether anything in a world carries a component.
fn has<C: Component>(world: &World) -> bool {
    !carriers::<C>(world).is_empty()
}

/// Whether there are polygons, traced or scan-converted.
#[must_use]
pub fn has_polygons(world: &World) -> bool {
    has::<Faces>(world)
}

/// Whether a light casts shadows.
#[must_use]
pub fn has_shadows(world: &World) -> bool {
    has::<CastsShadow>(world)
}

/// Whether a polygon is textured.
#[must_use]
pub fn has_textures(world: &World) -> bool {
    has::<TexturedBy>(world)
}

/// The volume alone.
pub fn take_polygons(world: &mut World) {
    for entity in carriers::<Faces>(world) {
        let _ = world.despawn(entity);
    }
}

/// All polygons by the hybrid ray tracer.
pub fn trace_polygons(world: &mut World) {
    take_off::<Voxelize>(world);
}

/// All polygons by 3D scan-conversion; those that state how stay as they are.
pub fn scan_convert_polygons(world: &mut World) {
    let own = carriers::<Voxelize>(world);
    for entity in carriers::<Faces>(world).into_iter().filter(|entity| !own.contains(entity)) {
        let _ = world.insert_one(entity, Voxelize { matte: Matte::Over, calibrated: true });
    }
}

/// No light casts a shadow.
pub fn take_shadows(world: &mut World) {
    take_off::<CastsShadow>(world);
}

/// Polygons without their textures.
pub fn take_textures(world: &mut World) {
    take_off::<TexturedBy>(world);
}

/// Brute force: a ray at every position of the sample array, nothing skipped, nothing stopped.
#[must_use]
pub fn brute_force(sampling: &Sampling) -> Sampling {
    Sampling { skip: Skip::None, texel: sampling.texel, ..sampling.exact() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Source, load};

    fn embedded(name: &str) -> World {
        load(&Source::embedded(name).unwrap(), &[], &[], false).unwrap().world
    }

    #[test]
    fn what_is_taken_is_gone_and_the_rest_stays() {
        let mut world = embedded("figure_09");
        assert!(has_shadows(&world) && has_polygons(&world) && !has_textures(&world));
        take_shadows(&mut world);
        assert!(!has_shadows(&world) && has_polygons(&world));
        trace_polygons(&mut world);
        assert!(!has::<Voxelize>(&world));
        scan_convert_polygons(&mut world);
        assert_eq!(carriers::<Voxelize>(&world).len(), 5);
        take_polygons(&mut world);
        assert!(!has_polygons(&world) && !has::<Voxelize>(&world));
    }

    #[test]
    fn brute_force_skips_and_stops_nowhere_and_keeps_the_texel() {
        let stated = Sampling::default();
        let brute = brute_force(&stated);
        assert_eq!((brute.skip, brute.stop_at, brute.coarsest), (Skip::None, 0.0, 1));
        assert_eq!((brute.texel, brute.distance_mm), (stated.texel, stated.distance_mm));
    }
}
