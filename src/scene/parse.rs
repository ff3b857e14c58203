//! TOML to entities with the components that they state, every fault at its line and column.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use hecs::{Entity, EntityBuilder, World};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::entity::{checked, names};
use super::error::{Fault, Text};
use super::grammar::span_at;
use super::nearest::suggestion;
use super::table::{COMPONENTS, Row};
use crate::components::{Name, Order};
use crate::error::SceneError;

/// A scene as stated: entities with their components, and where in the text each was stated.
pub(super) struct ParsedScene<'t> {
    pub text: Text<'t>,
    pub world: World,
    pub entries: Vec<Entry<'t>>,
}

/// One `[[entity]]` table.
pub(super) struct Entry<'t> {
    pub entity: Entity,
    pub name: String,
    /// The component that says what it is: `volume`, `polygon`, …
    pub noun: &'static str,
    table: DeTable<'t>,
}

impl Entry<'_> {
    /// The bytes of what stands at a dotted path inside a component, or of the deepest there is on the way.
    pub fn span(&self, component: &str, path: &str) -> Range<usize> {
        self.table.get(component).map_or(0..0, |value| span_at(value, path))
    }

    /// A fault of a component: `problem` is the rest of a sentence that the entity's name begins.
    pub fn fault(&self, component: &str, path: &str, problem: impl AsRef<str>) -> Fault {
        let message = format!("entity `{}`: {}", self.name, problem.as_ref());
        Fault::new(self.span(component, path), message)
    }
}

/// Reads a scene's text.
pub(super) fn parse(text: Text) -> Result<ParsedScene, SceneError> {
    let root = root(text)?;
    read(text, &root).map_err(|fault| fault.within(text))
}

/// The text as a TOML table.
pub(super) fn root(text: Text<'_>) -> Result<DeTable<'_>, SceneError> {
    let table = DeTable::parse(text.text).map_err(|e| {
        let message =
            format!("this is not TOML: {}; see toml.io for how it is written", e.message());
        text.error(e.span().unwrap_or(0..0), message)
    })?;
    Ok(table.into_inner())
}

fn read<'t>(text: Text<'t>, root: &DeTable<'t>) -> Result<ParsedScene<'t>, Fault> {
    let mut stated = ParsedScene { text, world: World::new(), entries: Vec::new() };
    let tables = tables(root)?;
    for (order, (table, name)) in tables.iter().zip(names(&tables)).enumerate() {
        let (inner, noun) = checked(table, &name)?;
        let mut builder = EntityBuilder::new();
        builder.add(Name(name.clone())).add(Order(order as u32));
        let rows = COMPONENTS.iter().filter_map(|row| Some((row, inner.get(row.key)?)));
        for (row, value) in rows {
            row.read(value, &mut builder)
                .map_err(|f| Fault { message: format!("entity `{name}`: {}", f.message), ..f })?;
        }
        let entity = stated.world.spawn(builder.build());
        stated.entries.push(Entry { entity, name, noun, table: inner.clone() });
    }
    once(&stated)?;
    Ok(stated)
}

/// The entity tables of a document, in the order of the text.
fn tables<'r, 't>(root: &'r DeTable<'t>) -> Result<Vec<&'r Spanned<DeValue<'t>>>, Fault> {
    if let Some((key, _)) = root.iter().find(|(key, _)| &**key.get_ref() != "entity") {
        let remedy = match Row::of(key.get_ref()) {
            Some(_) => {
                "components belong to an entity: write `[[entity]]` on a line before it".to_owned()
            }
            None => suggestion(key.get_ref(), &["entity"]),
        };
        return Err(Fault::new(
            key.span(),
            format!("a scene has no key `{}`; {remedy}", key.get_ref()),
        ));
    }
    let Some(value) = root.get("entity") else {
        return Err(Fault::new(
            0..0,
            "the scene is empty; state an entity: `[[entity]]`, then `volume = { file = \"…\" }`",
        ));
    };
    match value.get_ref().as_array() {
        Some(tables) if !tables.is_empty() => Ok(tables.iter().collect()),
        _ => Err(Fault::new(value.span(), "`entity` must be tables, each begun by `[[entity]]`")),
    }
}

/// The names of the entities of a document that may be anything; none where it is no scene.
pub(super) fn entity_names(root: &DeTable) -> Vec<String> {
    tables(root).map(|tables| names(&tables)).unwrap_or_default()
}

/// Names are unique, and there is one view at the most.
fn once(stated: &ParsedScene) -> Result<(), Fault> {
    let mut called = HashSet::new();
    let mut first: HashMap<&str, &Entry> = HashMap::new();
    for entry in &stated.entries {
        if !called.insert(entry.name.as_str()) {
            let message = format!(
                "a second entity is called `{}`; names must differ, rename one",
                entry.name
            );
            return Err(Fault::new(entry.span("name", ""), message));
        }
        let twin = first.get(entry.noun).copied();
        first.entry(entry.noun).or_insert(entry);
        if let (Some(twin), "view") = (twin, entry.noun) {
            let (a, b) = (&twin.name, &entry.name);
            let message = format!(
                "`{b}` is a second {0}, after `{a}`; a scene has one {0} at the most, take one away",
                entry.noun
            );
            return Err(Fault::new(entry.span(entry.noun, ""), message));
        }
    }
    Ok(())
}
