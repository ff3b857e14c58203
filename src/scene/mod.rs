//! Scenes: TOML to entities with components, names and overrides.
//!
//! A scene is `[[entity]]` tables: a `name` and a key for each component that the entity states. One table of components
//! ([`schema`] is made of it) is where a component is added. Every error points to its line and column.

mod check;
mod check_animate;
mod check_figure;
mod contact;
mod entity;
mod error;
mod grammar;
mod handed_over;
mod kept;
mod labels;
mod load;
mod loading;
mod mesh_pictures;
mod meshes;
mod molecules;
mod named;
mod nearest;
mod overrides;
mod parse;
mod restate;
mod source;
mod table;
#[cfg(test)]
mod tests;
mod textures;
mod volume;

pub use contact::{Wish, first_contact};
pub use handed_over::check_world;
pub use kept::Kept;
pub use load::{Loads, Scene, load, load_keeping, load_within, overridden};
pub use source::{EMBEDDED, Source};
pub use table::schema;
