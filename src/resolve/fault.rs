//! What cannot be rendered, and what was guessed: by entity and component, so that each caller names them in his way.

use hecs::{Entity, World};

use crate::components::Name;
use crate::error::Error;

/// Something stated that cannot be rendered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Whose fault; `None`: of the world as a whole.
    pub entity: Option<Entity>,
    /// The component at fault, by its key in scene files.
    pub component: &'static str,
    /// The dotted path inside the component; empty: all of it.
    pub path: String,
    /// What was found, what was expected and what to do: the rest of a sentence that the entity's name begins.
    pub problem: String,
}

/// Something guessed, or stated without effect: the entity, and the rest of a sentence that its name begins.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notice {
    /// Whom it is about.
    pub entity: Entity,
    /// What was guessed, and what to do about it.
    pub problem: String,
}

impl Fault {
    /// A fault of a component of an entity.
    pub(super) fn of(
        entity: Entity,
        component: &'static str,
        path: impl Into<String>,
        problem: impl Into<String>,
    ) -> Self {
        Self { entity: Some(entity), component, path: path.into(), problem: problem.into() }
    }

    /// A fault of the world as a whole: `problem` is the whole sentence.
    pub(super) fn of_all(problem: impl Into<String>) -> Self {
        let (component, path) = ("", String::new());
        Self { entity: None, component, path, problem: problem.into() }
    }

    /// The error about the entity, by its name in `world`.
    #[must_use]
    pub fn within(self, world: &World) -> Error {
        let name = self.entity.map_or_else(|| "world".to_owned(), |entity| name(world, entity));
        Error::entity(name, self.problem)
    }
}

impl Notice {
    /// The sentence, with the entity's name in `world`.
    #[must_use]
    pub fn within(&self, world: &World) -> String {
        format!("entity `{}`: {}", name(world, self.entity), self.problem)
    }
}

/// What an entity is called: its name, or its number where it has none.
fn name(world: &World, entity: Entity) -> String {
    let name = world.get::<&Name>(entity).map(|name| name.0.clone());
    name.unwrap_or_else(|_| entity.id().to_string())
}
