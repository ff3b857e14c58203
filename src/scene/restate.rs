//! A scene stated anew with other values: one world goes on, and what was made in it stays where nothing touches it.

use std::collections::HashMap;

use hecs::{Entity, World};

use super::kept::Kept;
use super::load::{Loads, Scene, blamed, stated, take_exact_settings};
use super::overrides;
use crate::components::Name;
use crate::error::Error;

impl Scene {
    /// States the scene again, with overrides other than before: components take the place of those of one name, what was
    /// filled in follows them, and products stay, to be made anew only where what they were made of has changed.
    ///
    /// What `kept` holds is not read again. After an error the world may be between what it was and what it was to be.
    pub fn restate(
        &mut self,
        loads: &Loads,
        overrides: &[String],
        kept: &mut Kept,
    ) -> Result<(), Error> {
        let source = &loads.source;
        let resolved = overrides::apply(&source.name, &source.text, overrides)?;
        let changed = resolved != source.text;
        let mut loading = stated(&resolved, loads, kept).map_err(|e| blamed(e, changed))?;
        take_over(&mut self.world, &mut loading.world);
        std::mem::swap(&mut self.world, &mut loading.world);
        let done = loading.resolve();
        if loads.exact {
            take_exact_settings(&mut loading.world);
        }
        std::mem::swap(&mut self.world, &mut loading.world);
        drop(loading);
        done.map_err(|error| blamed(error, changed))?;
        self.resolved = resolved;
        Ok(())
    }
}

/// Moves the components of one world to the entities of another that are called alike.
fn take_over(world: &mut World, stated: &mut World) {
    let own: HashMap<Name, Entity> = named(world).collect();
    let pairs: Vec<_> =
        named(stated).filter_map(|(name, from)| Some((from, *own.get(&name)?))).collect();
    for (from, to) in pairs {
        // Both were found in their worlds a few lines ago.
        if let Ok(components) = stated.take(from) {
            let _ = world.insert(to, components);
        }
    }
}

fn named(world: &mut World) -> impl Iterator<Item = (Name, Entity)> {
    world.query_mut::<(Entity, &Name)>().into_iter().map(|(entity, name)| (name.clone(), entity))
}
