//! The one table of components: what a scene may state. A component more is a struct, its checks and a line here.

use std::sync::OnceLock;

use hecs::EntityBuilder;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde::de::DeserializeOwned;
use serde_json::{Value as Json, json};
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use super::check::Check;
use super::error::Fault;
use super::grammar;
use crate::components::{
    CastsShadow, Classify, Clip, DepthCue, Level, Light, Material, Mesh, Polygon, Projects,
    Sampling, Shaft, Surface, Texture, Textured, View, Volume, Voxelize,
};

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
}

/// Every component that a scene may state, in the order in which messages list them.
pub(super) static COMPONENTS: [Row; 17] = [
    row::<Volume>("volume", &[]),
    row::<Classify<Level>>("classify", &["volume"]),
    row::<Material>("material", &["volume"]),
    row::<Clip>("clip", &["volume"]),
    row::<Polygon>("polygon", &[]),
    row::<Mesh>("mesh", &[]),
    row::<Surface>("surface", &["polygon", "mesh"]),
    row::<Voxelize>("voxelize", &["polygon", "mesh"]),
    row::<Textured>("textured", &["polygon", "mesh"]),
    row::<Light>("light", &[]),
    row::<CastsShadow>("casts_shadow", &["light"]),
    row::<Projects>("projects", &["light"]),
    row::<Shaft>("shaft", &["light"]),
    row::<Texture>("texture", &[]),
    row::<View>("view", &[]),
    row::<Sampling>("sampling", &["view"]),
    row::<DepthCue>("depth_cue", &["view"]),
];

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

    /// Reads the component, checks it and adds it to an entity.
    pub fn read(&self, value: &Spanned<DeValue>, entity: &mut EntityBuilder) -> Result<(), Fault> {
        (self.read)(self, value, entity)
    }
}

const fn row<T>(key: &'static str, with: &'static [&'static str]) -> Row
where
    T: DeserializeOwned + JsonSchema + Check + Send + Sync + 'static,
{
    Row { key, with, schema: schema_of::<T>, made: OnceLock::new(), read: read::<T> }
}

fn schema_of<T: JsonSchema>() -> Json {
    let settings = SchemaSettings::draft2020_12().with(|s| s.inline_subschemas = true);
    let mut schema: Json = T::json_schema(&mut SchemaGenerator::new(settings)).into();
    shorten(&mut schema);
    schema
}

fn read<T>(row: &Row, value: &Spanned<DeValue>, entity: &mut EntityBuilder) -> Result<(), Fault>
where
    T: DeserializeOwned + Check + Send + Sync + 'static,
{
    grammar::check(value, row.schema(), row.key)?;
    let component = T::deserialize(ValueDeserializer::from(value.clone())).map_err(|e| {
        let message = format!("`{}` cannot be used: {}", row.key, e.message());
        Fault::new(e.span().unwrap_or_else(|| value.span()), message)
    })?;
    component.check().map_err(|wrong| {
        Fault::new(grammar::span_at(value, &wrong.at), format!("`{}` {}", row.key, wrong.problem))
    })?;
    entity.add(component);
    Ok(())
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
        properties.insert(row.key.to_owned(), row.schema().clone());
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
