//! Who carries a component, and what it is there.

use hecs::{Component, Entity, World};

use crate::components::Order;

/// The entities that carry a component, in the order of the scene; those without an order last, as they were spawned.
pub(super) fn carriers<T: Component>(world: &World) -> Vec<Entity> {
    let mut query = world.query::<(Entity, Option<&Order>)>().with::<&T>();
    let mut found: Vec<_> = query.iter().map(|(entity, order)| (order.copied(), entity)).collect();
    found.sort_by_key(|(order, entity)| (order.is_none(), *order, *entity));
    found.into_iter().map(|(_, entity)| entity).collect()
}

/// A copy of a component of an entity, if it carries it.
pub(super) fn get<T: Component + Clone>(world: &World, entity: Entity) -> Option<T> {
    world.get::<&T>(entity).ok().map(|component| (*component).clone())
}
