//! `classify`: which opacity (and colour) a scalar and its gradient get, in one of four ways (algorithm §2).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;

/// A classification: exactly one of `iso`, `regions`, `transfer` or `materials`.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Classify {
    /// Isovalue contours; several composite as `1 − Π (1 − α_n)`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub iso: Vec<Contour>,
    /// Region boundaries between tissues, in rising order of value.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub regions: Vec<Tissue>,
    /// A piecewise-linear transfer function of the scalar, in rising order of value; constant beyond its ends.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transfer: Vec<TransferPoint>,
    /// With `transfer`: a piecewise-linear factor of the gradient magnitude, as `[magnitude per world unit, factor]` pairs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub gradient: Vec<[f32; 2]>,
    /// A mixture of materials after Drebin, Carpenter and Hanrahan 1988.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<Material>,
}

/// One isovalue contour `(f_v, α_v, r)` of Levoy 1988.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contour {
    /// f_v, in the units of the scalars.
    pub value: f32,
    /// α_v in 0..=1, per opacity unit.
    #[serde(default = "one")]
    pub opacity: f32,
    /// r: thickness of the transition from opaque to clear, in voxels (world: r · opacity unit); above 0.
    #[serde(default = "two")]
    pub thickness_voxels: f32,
    /// Colour of the contour; default: the material's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
}

/// One tissue of the region boundary classification.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tissue {
    /// f_{v_n}, in the units of the scalars.
    pub value: f32,
    /// α_{v_n} in 0..=1, per opacity unit.
    pub opacity: f32,
    /// Colour of the tissue; default: the material's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
}

/// One point of a transfer function.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TransferPoint {
    /// Scalar value.
    pub value: f32,
    /// Opacity in 0..=1, per opacity unit.
    pub opacity: f32,
    /// Colour; default: the material's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
}

/// One material of a mixture: its probability as a function of the scalar, and what it looks like.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Piecewise-linear `[value, probability]` pairs in rising order of value; probabilities of all materials are scaled to sum to at most 1.
    pub probability: Vec<[f32; 2]>,
    /// Opacity of the pure material in 0..=1, per opacity unit.
    pub opacity: f32,
    /// Colour of the pure material; default: the material's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
}

fn one() -> f32 {
    1.0
}

fn two() -> f32 {
    2.0
}
