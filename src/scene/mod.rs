//! Scenes: TOML to entities with components, names and overrides.
//!
//! A scene is `[[entity]]` tables: a `name` and a key for each component that the entity states. One table of components
//! ([`schema`] is made of it) is where a component is added. Every error points to its line and column.

mod check;
mod entity;
mod error;
mod grammar;
mod handed_over;
mod load;
mod loading;
mod nearest;
mod overrides;
mod parse;
mod source;
mod table;
#[cfg(test)]
mod tests;
mod textures;
mod volume;

pub use handed_over::check_world;
pub use load::{Scene, load, load_within};
pub use source::{EMBEDDED, Source};
pub use table::schema;
