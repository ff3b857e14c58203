//! `smooth`: triangles are lit as the curved surface that they stand for, and not as flat facets.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Lights each triangle of a mesh or molecule by a normal that runs smoothly between those of its corners; without it, all of a
/// triangle has one. Outlines stay those of the triangles, and so do shadows that fall and scan-converted triangles.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Smooth {
    /// Triangles that meet at a greater angle than this meet in an edge that is seen, degrees: 0 leaves all flat, 180 shows none.
    #[schemars(range(min = 0.0, max = 180.0))]
    pub crease_degrees: f64,
    /// Which normals its corners have.
    pub normals: SmoothNormals,
}

/// Where normals at the corners of triangles are from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SmoothNormals {
    /// The mesh's file (OBJ, PLY, glTF, VTK), whatever the angle, and the triangles where it states none.
    #[default]
    File,
    /// The triangles that meet there, at no greater angle than `crease_degrees`.
    Triangles,
}

impl Default for Smooth {
    fn default() -> Self {
        Self { crease_degrees: 60.0, normals: SmoothNormals::default() }
    }
}
