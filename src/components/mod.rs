//! What a scene states: plain data, a component a key, one entity a table. No system changes any of it.
//!
//! Units are in the key or its description; colours are sRGB as written and linear once read ([`Color`]).

mod animate;
mod classify;
mod clip;
pub mod color;
pub mod direction;
mod estimate;
mod furniture;
mod knobs;
mod labels;
mod light;
mod material;
mod mesh;
mod molecule;
mod polygon;
mod preset;
mod projection;
mod sampling;
mod smooth;
mod texture;
mod view;
mod volume;

pub use animate::{Animate, Ease, Keyed, Track};
pub use classify::{Classify, Contour, Form, Level, MixtureMaterial, Tissue, TransferPoint};
pub use clip::Clip;
pub use color::Color;
pub use estimate::Estimate;
pub use furniture::{
    Axes, BoundingBox, Callout, Corner, Legend, LegendEntry, OrientationCube, ScaleBar, Title,
};
pub use knobs::{Bound, KNOBS, Knob, NO_KNOBS, Setting};
pub use labels::{Label, Labels};
pub use light::{CastsShadow, Light, Observer, Shaft, Toward};
pub use material::{DepthCue, Material};
pub use mesh::{Ellipsoid, Mesh, Prism, Space};
pub use molecule::{Molecule, MoleculeStyle};
pub use polygon::{Matte, Polygon, Surface, Voxelize};
pub use preset::{Colormap, Preset};
pub use projection::Projection;
pub use sampling::{Filter, PixelFilter, Sampling, Skip, TexelKind};
pub use smooth::Smooth;
pub use texture::{Projects, Texture, TextureFilter, Textured, Wrap};
pub use view::View;
pub use volume::{OpacityUnit, Reconstruct, Volume};

/// The name of an entity, unique in its scene.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Name(pub String);

/// The place of an entity in its scene: ties in depth are broken by it, and matting follows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Order(pub u32);
