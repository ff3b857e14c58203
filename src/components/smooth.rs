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
}

impl Default for Smooth {
    fn default() -> Self {
        Self { crease_degrees: 60.0 }
    }
}
