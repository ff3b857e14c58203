//! `polygon`, `surface`, `voxelize`: planar polygons in the world, how they look, and by which method they are drawn.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;

/// A planar polygon, convex or concave, with holes if stated. Vertices in world coordinates.
///
/// Out of plane by more than 1e-4 of its extent is an error that names the entity.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Polygon {
    /// The outline, at least three vertices in order (either way round).
    #[schemars(length(min = 3))]
    pub vertices: Vec<[f64; 3]>,
    /// Outlines of holes, in the plane of the polygon.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub holes: Vec<Vec<[f64; 3]>>,
}

/// How a polygon or mesh looks: colour, opacity and the coefficients of the shading model.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Surface {
    /// c_P.
    pub color: Color,
    /// α_P in 0..=1, of one crossing.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub opacity: f32,
    /// k_a in 0..=1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub ambient: f32,
    /// k_d in 0..=1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub diffuse: f32,
    /// k_s in 0..=1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub specular: f32,
    /// n, at least 1.
    #[schemars(range(min = 1.0))]
    pub shininess: f32,
    /// Whether the side away from a light answers it too.
    pub two_sided: bool,
}

impl Default for Surface {
    fn default() -> Self {
        Self {
            color: Color::WHITE,
            opacity: 1.0,
            ambient: 0.3,
            diffuse: 0.7,
            specular: 0.0,
            shininess: 20.0,
            two_sided: true,
        }
    }
}

/// Draws a polygon by 3D scan-conversion into the volume instead of by the hybrid ray tracer (the paper's second method).
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Voxelize {
    /// Matting operator: `over`, `under`, `in`, `out` or `atop`.
    #[serde(default)]
    pub matte: Matte,
    /// Opacity spread so that the polygon has its stated opacity at every phase; `false` gives the paper's form, which leaks.
    #[serde(default = "yes")]
    pub calibrated: bool,
}

/// The matting operators of Drebin, Carpenter and Hanrahan 1988, polygon with volume.
///
/// Where a polygon is they act on it as opaque as it is stated, and a triangle that its mesh's file makes less opaque is there as much as
/// one that is opaque: `in` and `out` take the volume away in all of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Matte {
    /// The polygon in front of the volume.
    #[default]
    Over,
    /// The volume in front of the polygon.
    Under,
    /// The polygon where the volume is.
    In,
    /// The polygon where the volume is not.
    Out,
    /// The polygon where the volume is, and the volume where the polygon is not.
    Atop,
}

fn yes() -> bool {
    true
}
