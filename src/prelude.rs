//! What a program needs that renders from arrays in memory: `use gelray::prelude::*;`.
//!
//! A world of entities is a [`World`]; what an entity is and how it looks is what is put on it:
//!
//! | entity | components |
//! |---|---|
//! | a volume | [`volume`] or [`painted_volume`] of an array; [`Classify`], [`Material`], [`Clip`], [`Projection`], [`OpacityUnit`], [`Reconstruct`] |
//! | a polygon, a mesh | [`polygon`], [`triangles`], or a [`Polygon`] or [`Mesh`]; [`Surface`], [`Smooth`], [`Voxelize`], [`Textured`] |
//! | a light | [`Light`]; [`CastsShadow`], [`Projects`], [`Shaft`] |
//! | a texture | a [`Name`] and a [`Picture`] |
//! | the view | [`View`]; [`Sampling`], [`DepthCue`], [`Estimate`] |
//! | furniture | a [`Title`], [`ScaleBar`], [`Legend`], [`Callout`], [`Axes`], [`OrientationCube`] or [`BoundingBox`], each on an entity of its own |
//!
//! All of it may be left out but something to see. A [`Renderer`] gives the picture of a world, again and again, and makes
//! only what hangs on what was changed in between; its [`Watch`] tells another thread how far it is, and stops it.

pub use glam;
pub use hecs::{self, Entity, World};

pub use crate::components::{
    Axes, BoundingBox, Callout, CastsShadow, Classify, Clip, Color, Contour, Corner, DepthCue,
    Estimate, Filter, Form, Legend, LegendEntry, Light, Material, Matte, Mesh, Name, OpacityUnit,
    Order, OrientationCube, PixelFilter, Polygon, Projection, Projects, Reconstruct, Sampling,
    ScaleBar, Shaft, Skip, Smooth, Surface, TexelKind, TextureFilter, Textured, Tissue, Title,
    Toward, TransferPoint, View, Voxelize, Wrap,
};
pub use crate::error::Error;
pub use crate::formats::pictures::write_picture;
pub use crate::polygon::arrays::{polygon, triangles};
pub use crate::polygon::face::Faces;
pub use crate::renderer::{Rendered, Renderer};
pub use crate::schedule::Watch;
pub use crate::view::picture::Picture;
pub use crate::volume::arrays::{painted_volume, volume};
pub use crate::volume::grid::{Grid, Painted, Scalars};
