//! Filling in: a component that an entity does not state is made of what it does, and follows it.

use hecs::{Entity, World};

use super::fault::Fault;

/// A component that a world may be given; equality tells whether it was changed since.
pub(crate) trait Filling: hecs::Component + Clone + PartialEq {}

impl<T: hecs::Component + Clone + PartialEq> Filling for T {}

/// Beside a component that was filled in: what it was made of, and what was made.
struct Filled<I, T> {
    of: I,
    made: T,
}

/// What became of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Became {
    /// The caller states it, or it was made of the very same before.
    Kept,
    /// It was made just now.
    Made,
}

/// Puts on an entity what is made `of` something else, unless the entity states it by itself.
///
/// What was put there before stays where it was made of the same, is made again where it was made of something else, and
/// counts as stated from the moment that the caller changes it.
pub fn fill<I: Filling, T: Filling>(
    world: &mut World,
    entity: Entity,
    of: I,
    make: impl FnOnce(&I) -> Result<T, Fault>,
) -> Result<Became, Fault> {
    if stays::<I, T>(world, entity, &of) {
        return Ok(Became::Kept);
    }
    let made = make(&of)?;
    // Callers walk over entities that are there.
    let _ = world.insert(entity, (made.clone(), Filled { of, made }));
    Ok(Became::Made)
}

/// [`fill`] with what is made of another component of the entity, which is copied only where something is made.
pub(crate) fn fill_from<I: Filling, T: Filling>(
    world: &mut World,
    entity: Entity,
    make: impl FnOnce(&I) -> Result<T, Fault>,
) -> Result<Became, Fault> {
    let of = {
        let Ok(stated) = world.get::<&I>(entity) else { return Ok(Became::Kept) };
        if stays::<I, T>(world, entity, &stated) {
            return Ok(Became::Kept);
        }
        (*stated).clone()
    };
    fill(world, entity, of, make)
}

/// Whether a component is stated, or was made of this.
fn stays<I: Filling, T: Filling>(world: &World, entity: Entity, of: &I) -> bool {
    let stale = || world.get::<&Filled<I, T>>(entity).is_ok_and(|filled| filled.of != *of);
    world.get::<&T>(entity).is_ok() && !(stale() && is_filled::<I, T>(world, entity))
}

/// Whether a component is what was filled in, unchanged.
pub(crate) fn is_filled<I: Filling, T: Filling>(world: &World, entity: Entity) -> bool {
    let filled = world.get::<&Filled<I, T>>(entity);
    let present = world.get::<&T>(entity);
    filled.is_ok_and(|filled| present.is_ok_and(|present| *present == filled.made))
}

/// Takes what was filled in off an entity that no longer states what it was made of.
pub(crate) fn withdraw<I: Filling, T: Filling>(world: &mut World, entity: Entity) {
    if is_filled::<I, T>(world, entity) {
        let _ = world.remove::<(T, Filled<I, T>)>(entity);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Text = String;

    fn twice(world: &mut World, entity: Entity) -> Became {
        let of = *world.get::<&i32>(entity).unwrap();
        fill(world, entity, of, |n| Ok((2 * n).to_string())).unwrap()
    }

    #[test]
    fn what_was_filled_in_follows_what_it_was_made_of_until_it_is_stated() {
        let mut world = World::new();
        let entity = world.spawn((3_i32,));
        let text = |world: &World| world.get::<&Text>(entity).unwrap().to_string();
        assert_eq!(twice(&mut world, entity), Became::Made);
        assert_eq!(twice(&mut world, entity), Became::Kept);
        world.insert_one(entity, 4_i32).unwrap();
        assert_eq!((twice(&mut world, entity), text(&world)), (Became::Made, "8".to_owned()));
        world.insert_one(entity, "stated".to_owned()).unwrap();
        world.insert_one(entity, 5_i32).unwrap();
        assert_eq!((twice(&mut world, entity), text(&world)), (Became::Kept, "stated".to_owned()));
        withdraw::<i32, Text>(&mut world, entity);
        assert_eq!(text(&world), "stated");
    }

    #[test]
    fn what_was_filled_in_goes_with_what_it_was_made_of() {
        let mut world = World::new();
        let entity = world.spawn((3_i32,));
        twice(&mut world, entity);
        withdraw::<i32, Text>(&mut world, entity);
        assert!(world.get::<&Text>(entity).is_err());
    }
}
