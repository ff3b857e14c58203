//! Products are told apart by their type: there is no list of them.

use std::any::{Any, TypeId, type_name};
use std::marker::PhantomData;

use hecs::{Entity, World};

/// What a system makes; declared where the type is.
pub trait Product: hecs::Component + Clone {}

/// Beside a product: what it was made from.
pub struct Made<P> {
    pub(super) inputs: Box<dyn Any + Send + Sync>,
    pub(super) product: PhantomData<fn() -> P>,
}

/// The type of a product, as a value: what an order is derived from.
#[derive(Clone, Copy)]
pub struct ProductKey {
    id: TypeId,
    name: fn() -> &'static str,
    take_off: fn(&mut World),
}

impl ProductKey {
    /// The key of a product.
    #[must_use]
    pub const fn of<P: Product>() -> Self {
        Self { id: TypeId::of::<P>(), name: type_name::<P>, take_off: take_off::<P> }
    }

    /// The name of its type, without the path.
    #[must_use]
    pub fn name(self) -> &'static str {
        let path = (self.name)();
        path.rsplit("::").next().unwrap_or(path)
    }

    /// Takes the product off every entity; what was stated stays.
    pub fn take_off(self, world: &mut World) {
        (self.take_off)(world);
    }
}

impl PartialEq for ProductKey {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl std::fmt::Debug for ProductKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

fn take_off<P: Product>(world: &mut World) {
    let carriers: Vec<Entity> =
        world.query_mut::<(Entity, &P)>().into_iter().map(|(e, _)| e).collect();
    for entity in carriers {
        // A product that somebody put there by hand has no inputs beside it.
        let _ = world.remove_one::<P>(entity);
        let _ = world.remove_one::<Made<P>>(entity);
    }
}
