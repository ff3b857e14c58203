//! The order of entities, and names for those that are spawned here.

use std::collections::HashSet;

use hecs::{DynamicBundle, Entity, World};

use super::carriers::{carriers, get};
use crate::components::{Light, Name, Order, View};
use crate::polygon::face::Faces;
use crate::volume::grid::Grid;

/// Gives an order to everything that has none: after all that have one, as they were spawned.
pub(super) fn fill_in(world: &mut World) {
    let all = [
        carriers::<Grid>(world),
        carriers::<Faces>(world),
        carriers::<Light>(world),
        carriers::<View>(world),
    ];
    let mut without: Vec<_> = all.concat();
    without.retain(|&entity| get::<Order>(world, entity).is_none());
    without.sort_unstable();
    without.dedup();
    for entity in without {
        let order = next(world);
        let _ = world.insert_one(entity, order);
    }
}

/// The order after all that are taken.
fn next(world: &World) -> Order {
    let mut orders = world.query::<&Order>();
    Order(orders.iter().map(|order| order.0.saturating_add(1)).max().unwrap_or(0))
}

/// Spawns an entity after all others, with a name that is free: the word, else numbered from 2.
pub(super) fn spawn(world: &mut World, word: &str, components: impl DynamicBundle) -> Entity {
    let order = next(world);
    let taken: HashSet<_> =
        world.query_mut::<&Name>().into_iter().map(|name| name.0.clone()).collect();
    let mut name = word.to_owned();
    let mut number = 2;
    while taken.contains(&name) {
        name = format!("{word} {number}");
        number += 1;
    }
    let entity = world.spawn(components);
    let _ = world.insert(entity, (Name(name), order));
    entity
}
