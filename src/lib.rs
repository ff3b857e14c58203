//! gelray renders mixtures of volumes and polygons as coloured, semi-transparent gel.

pub mod bricks;
pub mod classification;
pub mod clipping;
pub mod components;
pub mod composite;
pub mod coverage;
pub mod error;
pub mod face;
pub mod formats;
pub mod gel;
pub mod grid;
pub mod measure;
pub mod observer;
pub mod painting;
pub mod phantom;
pub mod picture;
pub mod products;
pub mod pyramid;
pub mod ray;
pub mod relit;
pub mod samples;
pub mod scene;
pub mod schedule;
pub mod seen;
pub mod shading;
pub mod strength;
#[path = "../systems/mod.rs"]
pub mod systems;
pub mod texture;

pub use error::Error;
