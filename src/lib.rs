//! gelray renders mixtures of volumes and polygons as coloured, semi-transparent gel.

pub mod components;
pub mod error;
pub mod face;
pub mod formats;
pub mod grid;
pub mod measure;
pub mod phantom;
pub mod picture;
pub mod scene;

pub use error::Error;
