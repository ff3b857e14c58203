//! TOML to entities with the components that they state, every fault at its line and column.

use std::collections::BTreeSet;
use std::ops::Range;

use hecs::{Entity, EntityBuilder, World};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::{Fault, SceneError, Text};
use super::grammar::span_at;
use super::nearest::{list, suggestion};
use super::table::{COMPONENTS, Row};
use crate::components::{Name, Order};

/// A scene as stated: entities with their components, and where in the text each was stated.
pub(super) struct Stated<'t> {
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
pub(super) fn parse(text: Text) -> Result<Stated, SceneError> {
    let root = root(text)?;
    read(text, &root).map_err(|fault| fault.within(text))
}

/// The text as a TOML table.
pub(super) fn root<'t>(text: Text<'t>) -> Result<DeTable<'t>, SceneError> {
    let table = DeTable::parse(text.text).map_err(|e| {
        let message =
            format!("this is not TOML: {}; see toml.io for how it is written", e.message());
        text.error(e.span().unwrap_or(0..0), message)
    })?;
    Ok(table.into_inner())
}

fn read<'t>(text: Text<'t>, root: &DeTable<'t>) -> Result<Stated<'t>, Fault> {
    let mut stated = Stated { text, world: World::new(), entries: Vec::new() };
    let tables = tables(root)?;
    for (order, (table, name)) in tables.iter().zip(names(&tables)).enumerate() {
        let (inner, noun) = entity_table(table, &name)?;
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

/// The names of entities: as stated, or else what they are, numbered where that name is taken.
pub(super) fn names(tables: &[&Spanned<DeValue>]) -> Vec<String> {
    let stated = |table: &Spanned<DeValue>| {
        Some(table.get_ref().get("name")?.get_ref().as_str()?.to_owned())
    };
    let mut taken: BTreeSet<String> = tables.iter().filter_map(|t| stated(t)).collect();
    let name = |table: &&Spanned<DeValue>| {
        stated(table).unwrap_or_else(|| {
            let noun =
                COMPONENTS.iter().find(|r| r.is_noun() && table.get_ref().get(r.key).is_some());
            let name = unused(
                noun.map_or("entity", |row| if row.key == "view" { "observer" } else { row.key }),
                &taken,
            );
            taken.insert(name.clone());
            name
        })
    };
    tables.iter().map(name).collect()
}

/// The name, numbered from 2 where it is taken.
pub(super) fn unused(name: &str, taken: &BTreeSet<String>) -> String {
    let numbered = (2_u32..).map(|n| format!("{name} {n}"));
    let mut candidates = std::iter::once(name.to_owned()).chain(numbered);
    candidates.find(|c| !taken.contains(c)).unwrap_or_default()
}

/// The names of the entities of a document that may be anything; none where it is no scene.
pub(super) fn entity_names(root: &DeTable) -> Vec<String> {
    tables(root).map(|tables| names(&tables)).unwrap_or_default()
}

/// The table of one entity, its keys checked, and the component that says what it is.
fn entity_table<'r, 't>(
    value: &'r Spanned<DeValue<'t>>,
    name: &str,
) -> Result<(&'r DeTable<'t>, &'static str), Fault> {
    let Some(table) = value.get_ref().as_table() else {
        return Err(Fault::new(
            value.span(),
            "an entity must be a table: `[[entity]]`, then a component a line",
        ));
    };
    let mut keys: Vec<_> = table.keys().collect();
    keys.sort_by_key(|key| key.span().start);
    let mut known = vec!["name"];
    known.extend(COMPONENTS.iter().map(|row| row.key));
    if let Some(key) = keys.iter().find(|key| !known.contains(&&**key.get_ref())) {
        let problem = format!(
            "entity `{name}`: there is no component `{}`; {}",
            key.get_ref(),
            suggestion(key.get_ref(), &known)
        );
        return Err(Fault::new(key.span(), problem));
    }
    if let Some(stated) = table.get("name")
        && stated.get_ref().as_str().is_none_or(str::is_empty)
    {
        return Err(Fault::new(stated.span(), "`name` must be a string of at least one letter"));
    }
    let rows: Vec<_> =
        keys.iter().filter_map(|key| Some((*key, Row::of(key.get_ref())?))).collect();
    let lonely = rows
        .iter()
        .find(|(_, row)| !row.is_noun() && !row.with.iter().any(|w| table.contains_key(*w)));
    if let Some((key, row)) = lonely {
        let remedy = format!(
            "add {} or take it away",
            row.with.iter().map(|w| format!("`{w}`")).collect::<Vec<_>>().join(" or ")
        );
        return Err(Fault::new(
            key.span(),
            format!("entity `{name}` states `{}` without what it belongs to; {remedy}", row.key),
        ));
    }
    let nouns: Vec<_> = rows.iter().filter(|(_, row)| row.is_noun()).collect();
    match nouns[..] {
        [(_, row)] => Ok((table, row.key)),
        [] => {
            let all: Vec<_> = COMPONENTS.iter().filter(|r| r.is_noun()).map(|r| r.key).collect();
            Err(Fault::new(
                value.span(),
                format!("entity `{name}` is nothing; state one of {}", list(&all)),
            ))
        }
        [(_, first), (key, second), ..] => Err(Fault::new(
            key.span(),
            format!(
                "entity `{name}` is both `{}` and `{}`; make two entities of it",
                first.key, second.key
            ),
        )),
    }
}

/// Names are unique, and there is one volume and one view at the most.
fn once(stated: &Stated) -> Result<(), Fault> {
    for (i, entry) in stated.entries.iter().enumerate() {
        let before = &stated.entries[..i];
        if before.iter().any(|other| other.name == entry.name) {
            let message = format!(
                "a second entity is called `{}`; names must differ, rename one",
                entry.name
            );
            return Err(Fault::new(entry.span("name", ""), message));
        }
        let twin = before.iter().find(|other| other.noun == entry.noun);
        if let (Some(twin), "volume" | "view") = (twin, entry.noun) {
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
