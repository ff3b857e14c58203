//! `light` and what it may carry: `casts_shadow` and `shaft`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;

/// A directional light.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// The direction towards the light, world coordinates, any length above 0; or `"observer"` for a head light.
    pub toward: Toward,
    /// Strength, 0 to 1e15; 1 lights a facing white surface to `diffuse`.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0))]
    pub strength: f32,
    /// Colour of the light.
    #[serde(default = "white")]
    pub color: Color,
}

impl Light {
    /// A white light of strength 1 in a direction: from the scene towards the light, of any length above 0.
    #[must_use]
    pub fn from_direction(toward: [f64; 3]) -> Self {
        Self { toward: Toward::Direction(toward), strength: one(), color: white() }
    }

    /// A white light of strength 1 at the observer.
    #[must_use]
    pub fn at_observer() -> Self {
        Self { toward: Toward::Observer(Observer::Observer), strength: one(), color: white() }
    }
}

/// Where a light is.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Toward {
    /// A direction in world coordinates.
    Direction([f64; 3]),
    /// At the observer: shading then depends on the view.
    Observer(Observer),
}

/// The word `observer`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Observer {
    /// The light turns with the view.
    Observer,
}

/// Brings in a light-strength buffer: the light is weakened by what lies between it and a voxel (paper §4).
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CastsShadow {
    /// The strength used at a voxel is that of a point so many voxels nearer to the light; 0 or above.
    #[schemars(range(min = 0.0))]
    pub bias_voxels: f64,
    /// k_1 of the falloff `1 / (k_1 + k_2 d)`.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub k1: f64,
    /// k_2, per world unit of distance from where the light enters the volume's bounding sphere; `k1 + k2 d` must stay above 0 over the scene.
    pub k2: f64,
}

impl Default for CastsShadow {
    fn default() -> Self {
        Self { bias_voxels: 2.0, k1: 1.0, k2: 0.0 }
    }
}

/// Dust that answers this light, everywhere the same: "sculpted shafts of light passing through a dust-filled room"
/// (paper §8). Shafts take their shape from the light's slide ([`Projects`](super::Projects)) and from shadows.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shaft {
    /// Opacity of the dust where the light's strength is 1: 0..=1 per opacity unit; weaker light shows less dust.
    #[schemars(range(min = 0, max = 1))]
    pub opacity: f32,
    /// Colour of the lit dust; default: the light's own colour.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    /// Whether the volume weakens the beam: that asks for the 3D light-strength buffer. `false`: the beam passes through
    /// the volume without attenuation, and is drawn without a shadow pass and without a 3D buffer; unless its light
    /// `casts_shadow`, it then lights no surface.
    #[serde(default = "yes")]
    pub attenuated: bool,
}

fn yes() -> bool {
    true
}

fn one() -> f32 {
    1.0
}

fn white() -> Color {
    Color::WHITE
}
