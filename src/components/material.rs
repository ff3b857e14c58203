//! `material`: how the voxels of a volume answer light (algorithm §3).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;

/// The coefficients of Levoy's shading model for a volume.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Material {
    /// c_p where the classification states no colour of its own.
    pub color: Color,
    /// k_a in 0..=1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub ambient: f32,
    /// k_d in 0..=1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub diffuse: f32,
    /// k_s in 0..=1. Above 0 the shading depends on the observer: a turn of the view then shades again.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub specular: f32,
    /// n, at least 1.
    #[schemars(range(min = 1.0))]
    pub shininess: f32,
    /// Whether a surface answers light from behind it too.
    pub two_sided: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            color: Color::WHITE,
            ambient: 0.2,
            diffuse: 0.8,
            specular: 0.0,
            shininess: 20.0,
            two_sided: true,
        }
    }
}
