//! `animate`: how stated numbers and colors of an entity change over a sequence of pictures.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;

/// What of an entity changes over a sequence; a single picture shows what is stated beside it.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Animate {
    /// The values that change, each by a track of its own.
    pub tracks: Vec<Track>,
}

/// One stated value at some moments, and how it goes from one to the next.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Track {
    /// The value within the entity, as `--set` names it: `view.azimuth`, `classify.iso.0.value`, `clip.planes.0`.
    pub key: String,
    /// The values, one for each moment: numbers, colors `"#rrggbb"`, or arrays of numbers.
    #[schemars(length(min = 1))]
    pub to: Vec<Keyed>,
    /// The moments as parts of the sequence, 0..=1, each after the one before; default: at equal distances from 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub at: Option<Vec<f64>>,
    /// How it goes from one value to the next.
    #[serde(default)]
    pub ease: Ease,
}

/// A value at a moment.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Keyed {
    /// A number.
    Number(f64),
    /// Numbers, each of which goes its own way: a plane, a vertex, a direction.
    Numbers(Vec<f64>),
    /// A color; between two of them light is mixed.
    Color(Color),
}

/// How a value goes from one moment to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Ease {
    /// At an even pace.
    #[default]
    Linear,
    /// Without a jerk: it sets out from rest, passes the moments between smoothly, comes to rest, and never overshoots.
    Smooth,
}
