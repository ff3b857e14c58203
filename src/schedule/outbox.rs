//! The outbox of a system: what it makes of the world, kept if it was made from the same inputs before.

use std::collections::BTreeSet;
use std::marker::PhantomData;

use hecs::{CommandBuffer, Entity, World};

use super::product::{Made, Product, ProductKey};
use super::watch::Watch;
use crate::error::Error;

/// Where a system puts what it makes; applied to the world when its wave is done.
pub struct Outbox<'a, P> {
    world: &'a World,
    watch: &'a Watch,
    commands: &'a mut CommandBuffer,
    derived: BTreeSet<Entity>,
    made: u32,
    reused: u32,
    product: PhantomData<fn() -> P>,
}

impl<'a, P: Product> Outbox<'a, P> {
    pub(super) fn new(world: &'a World, watch: &'a Watch, commands: &'a mut CommandBuffer) -> Self {
        let product = PhantomData;
        Self { world, watch, commands, derived: BTreeSet::new(), made: 0, reused: 0, product }
    }

    /// Lets `entity` carry what `make` makes of `inputs`: the product it has, if that was made of equal inputs.
    ///
    /// An entity for which this is not called loses the product it had; one for which it is called twice is an error.
    pub fn derive<I: PartialEq + Send + Sync + 'static>(
        &mut self,
        entity: Entity,
        inputs: I,
        make: impl FnOnce(&I) -> Result<P, Error>,
    ) -> Result<(), Error> {
        if !self.derived.insert(entity) {
            let name = ProductKey::of::<P>().name();
            return Err(Error::Schedule(format!(
                "a system derives the {name} of one entity twice"
            )));
        }
        let made = self.world.get::<&Made<P>>(entity);
        if made.is_ok_and(|last| last.inputs.downcast_ref() == Some(&inputs))
            && self.world.get::<&P>(entity).is_ok()
        {
            self.reused += 1;
            return Ok(());
        }
        let product = make(&inputs)?;
        let inputs = Made::<P> { inputs: Box::new(inputs), product: PhantomData };
        self.commands.insert(entity, (product, inputs));
        self.made += 1;
        Ok(())
    }

    /// Whom to tell about progress, and to ask whether to stop.
    #[must_use]
    pub fn watch(&self) -> &'a Watch {
        self.watch
    }

    /// Takes the product off every entity that was not derived; how many were made and reused.
    pub(super) fn finish(self) -> (u32, u32) {
        for (entity, _) in &mut self.world.query::<(Entity, &Made<P>)>() {
            if !self.derived.contains(&entity) {
                self.commands.remove::<(P, Made<P>)>(entity);
            }
        }
        (self.made, self.reused)
    }
}
