//! The one table of components: what a scene may state, and how it is read. A component more is its file and a row in
//! `components`, and its checks if it has any.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use hecs::{Component, Entity, EntityBuilder, World};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value as Json, json};
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use super::check::{Check, Wrong};
use super::error::Fault;
use super::grammar;
use super::nearest::{list, suggestion};
#[allow(clippy::wildcard_imports, reason = "a component more is no import more")]
use crate::components::*;

/// The entity that is at fault, and the sentence.
type AtFault = (Entity, String);

/// One component of the table.
pub(super) struct Row {
    /// The key that states it.
    pub key: &'static str,
    /// It only makes sense on an entity that states one of these; empty for what an entity *is*.
    pub with: &'static [&'static str],
    schema: fn() -> Json,
    /// The schema, once it was asked for: every entity is checked against it.
    made: OnceLock<Json>,
    read: fn(&Row, &Spanned<DeValue>, &mut EntityBuilder) -> Result<(), Fault>,
    check_world: fn(&Row, &mut World) -> Result<(), AtFault>,
}

/// The table, of the rows that `components` declares.
macro_rules! table {
    ($($how:ident<$($stated:ty),*> $key:literal $with:tt;)*) => {
        /// Every component that a scene may state, in the order in which messages list them.
        pub(super) static COMPONENTS: [Row; [$($key),*].len()] = [$($how::<$($stated),*>($key, &$with)),*];
    };
}
components!(table);

impl Row {
    /// The component that a key states.
    pub fn of(key: &str) -> Option<&'static Self> {
        COMPONENTS.iter().find(|row| row.key == key)
    }

    /// Whether it says what an entity is, rather than how that is done.
    pub fn is_noun(&self) -> bool {
        self.with.is_empty()
    }

    /// Whether an entity's table lacks all that it makes sense with.
    pub fn is_lonely(&self, table: &DeTable) -> bool {
        !self.is_noun() && !self.with.iter().any(|&key| table.contains_key(key))
    }

    /// The JSON schema of the component.
    pub fn schema(&self) -> &Json {
        self.made.get_or_init(self.schema)
    }

    /// Checks the component on every entity of a world that carries it, as [`read`](Self::read) does.
    pub fn check_world(&self, world: &mut World) -> Result<(), AtFault> {
        (self.check_world)(self, world)
    }

    /// Reads the component, checks it and adds it to an entity.
    pub fn read(&self, value: &Spanned<DeValue>, entity: &mut EntityBuilder) -> Result<(), Fault> {
        (self.read)(self, value, entity)
    }
}

/// The sentence about a word that is no component, of those that are `known`: whose key it is, or what may have been meant.
pub(super) fn no_component(word: &str, known: &[&str]) -> String {
    let has = |row: &&Row| row.schema()["properties"].get(word).is_some();
    let owners: Vec<_> = COMPONENTS.iter().filter(has).map(|row| row.key).collect();
    let remedy = match owners[..] {
        [] => suggestion(word, known),
        [owner, ..] => {
            format!("it is a key of {}; write `{owner} = {{ {word} = … }}`", list(&owners))
        }
    };
    format!("there is no component `{word}`; {remedy}")
}

/// A component whose keys may be stated as the schema says.
const fn row<T>(key: &'static str, with: &'static [&'static str]) -> Row
where
    T: DeserializeOwned + JsonSchema + Component + Clone + PartialEq + Serialize,
{
    let made = OnceLock::new();
    let read = |row: &Row, value: &Spanned<DeValue>, entity: &mut EntityBuilder| {
        read::<T>(row, value, entity, |_| Ok(()))
    };
    Row { key, with, schema: schema_of::<T>, made, read, check_world: check_all::<T> }
}

/// A component whose keys must suit each other too.
const fn checked<T>(key: &'static str, with: &'static [&'static str]) -> Row
where
    T: DeserializeOwned + JsonSchema + Check + Component + Clone + PartialEq + Serialize,
{
    read_as::<T, T>(key, with)
}

/// Such a component that a scene states as a `T` and a world carries as a `W`.
const fn read_as<T, W>(key: &'static str, with: &'static [&'static str]) -> Row
where
    T: DeserializeOwned + JsonSchema + Check + Component,
    W: Component + Clone + PartialEq + Serialize,
{
    let made = OnceLock::new();
    let read = |row: &Row, value: &Spanned<DeValue>, entity: &mut EntityBuilder| {
        read::<T>(row, value, entity, T::check)
    };
    Row { key, with, schema: schema_of::<T>, made, read, check_world: check_all::<W> }
}

fn schema_of<T: JsonSchema>() -> Json {
    let settings = SchemaSettings::draft2020_12().with(|s| s.inline_subschemas = true);
    let mut schema: Json = T::json_schema(&mut SchemaGenerator::new(settings)).into();
    shorten(&mut schema);
    schema
}

fn read<T>(
    row: &Row,
    value: &Spanned<DeValue>,
    entity: &mut EntityBuilder,
    check: impl Fn(&T) -> Result<(), Wrong>,
) -> Result<(), Fault>
where
    T: DeserializeOwned + Component,
{
    grammar::check(value, row.schema(), row.key)?;
    let component = T::deserialize(ValueDeserializer::from(value.clone())).map_err(|e| {
        let message = format!("`{}` cannot be used: {}", row.key, e.message());
        Fault::new(e.span().unwrap_or_else(|| value.span()), message)
    })?;
    check(&component).map_err(|wrong| {
        Fault::new(grammar::span_at(value, &wrong.at), format!("`{}` {}", row.key, wrong.problem))
    })?;
    entity.add(component);
    Ok(())
}

/// A component that was found to be in order.
struct Checked<W>(W);

/// Checks the components of one type, by writing each as a scene would state it and reading that.
fn check_all<W>(row: &Row, world: &mut World) -> Result<(), AtFault>
where
    W: Component + Clone + PartialEq + Serialize,
{
    let mut fresh: Vec<(Entity, W)> = Vec::new();
    for (entity, stated, checked) in &mut world.query::<(Entity, &W, Option<&Checked<W>>)>() {
        if checked.is_none_or(|checked| checked.0 != *stated) {
            fresh.push((entity, stated.clone()));
        }
    }
    // Worlds of many polygons have few surfaces.
    let mut last: Option<W> = None;
    for (entity, stated) in fresh {
        if last.as_ref() != Some(&stated) {
            check(row, &stated).map_err(|problem| (entity, problem))?;
            last = Some(stated.clone());
        }
        let _ = world.insert_one(entity, Checked(stated));
    }
    Ok(())
}

fn check<W: Serialize>(row: &Row, stated: &W) -> Result<(), String> {
    let unwritten = |error| format!("`{}` cannot be used: {error}", row.key);
    let text = toml::to_string(&BTreeMap::from([(row.key, stated)])).map_err(unwritten)?;
    let root = DeTable::parse(&text).map_err(|error| error.message().to_owned())?;
    let Some(value) = root.get_ref().get(row.key) else { return Ok(()) };
    row.read(value, &mut EntityBuilder::new()).map_err(|fault| fault.message)
}

/// Writes single-precision defaults as short as they were meant: 0.02, not 0.019999999552965164.
fn shorten(schema: &mut Json) {
    match schema {
        Json::Object(entries) => entries.values_mut().for_each(shorten),
        Json::Array(items) => items.iter_mut().for_each(shorten),
        Json::Number(n) => {
            let short =
                n.as_f64().filter(|x| n.is_f64() && f64::from(*x as f32).to_bits() == x.to_bits());
            if let Some(short) = short.and_then(|x| (x as f32).to_string().parse::<f64>().ok()) {
                *schema = json!(short);
            }
        }
        _ => {}
    }
}

/// The JSON schema of the whole scene format (draft 2020-12), for editors and for programs that write scenes.
#[must_use]
pub fn schema() -> Json {
    let mut properties = serde_json::Map::new();
    let mut dependent = serde_json::Map::new();
    properties.insert("name".to_owned(), json!({ "type": "string", "minLength": 1 }));
    for row in &COMPONENTS {
        let mut schema = row.schema().clone();
        if row.key == "sampling" {
            tell_knobs(&mut schema);
        }
        properties.insert(row.key.to_owned(), schema);
        if !row.is_noun() {
            let choices: Vec<_> = row.with.iter().map(|key| json!({ "required": [key] })).collect();
            dependent.insert(row.key.to_owned(), json!({ "anyOf": choices }));
        }
    }
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "gelray scene",
        "description": "Entities, each a name and the components that it states.",
        "type": "object",
        "required": ["entity"],
        "additionalProperties": false,
        "properties": { "entity": { "type": "array", "minItems": 1, "items": {
            "type": "object",
            "additionalProperties": false,
            "properties": properties,
            "dependentSchemas": dependent,
        }}}
    })
}

/// What the table of knobs says of each: its range as examples, its promise in the description.
fn tell_knobs(schema: &mut Json) {
    for knob in KNOBS {
        let Some(key) = schema.pointer_mut(&format!("/properties/{}", knob.key)) else { continue };
        let said = key.get("description").and_then(Json::as_str).unwrap_or_default();
        let description = format!("{said} {}", knob.promise);
        key["description"] = json!(description.trim());
        let settings = knob.range.iter().filter_map(|setting| match setting {
            Setting::Times(_) => None,
            Setting::Number(number) => number.to_string().parse::<f64>().ok().map(Json::from),
            Setting::Positions(number) => Some(json!(number)),
            Setting::PerVoxel(number) => Some(json!(number)),
            Setting::Truth(truth) => Some(json!(truth)),
            Setting::Skip(_) | Setting::Texel(_) => Some(json!(setting.to_string())),
        });
        let settings: Vec<Json> = settings.collect();
        if !settings.is_empty() {
            key["examples"] = json!(settings);
        }
    }
}
