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

/// Puts hidden products back.
pub type Restore = Box<dyn FnOnce(&mut World)>;

/// The type of a product, as a value: what an order is derived from.
#[derive(Clone, Copy)]
pub struct ProductKey {
    id: TypeId,
    name: fn() -> &'static str,
    hide: fn(&mut World) -> Restore,
}

impl ProductKey {
    /// The key of a product.
    #[must_use]
    pub const fn of<P: Product>() -> Self {
        Self { id: TypeId::of::<P>(), name: type_name::<P>, hide: hide::<P> }
    }

    /// The name of its type, without the path.
    #[must_use]
    pub fn name(self) -> &'static str {
        let path = (self.name)();
        path.rsplit("::").next().unwrap_or(path)
    }

    /// Takes the product off every entity, and says how to put it back: what a system makes without it shows whether it
    /// reads it.
    #[must_use]
    pub fn hide(self, world: &mut World) -> Restore {
        (self.hide)(world)
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

fn hide<P: Product>(world: &mut World) -> Restore {
    let carriers = world.query_mut::<(Entity, &P)>().into_iter();
    let carriers: Vec<_> = carriers.map(|(entity, product)| (entity, product.clone())).collect();
    for (entity, _) in &carriers {
        // It was found there a line ago.
        let _ = world.remove_one::<P>(*entity);
    }
    Box::new(move |world| {
        for (entity, product) in carriers {
            let _ = world.insert_one(entity, product);
        }
    })
}
