//! `depth_cue`: how colours fade with distance (algorithm §3).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `depth_cue` of a view: reflected light is divided by `k_1 + k_2 d`, d = distance along the view from the near side of
/// the scene's bounding sphere, world units. Applied while rays are cast; ambient light is not cued.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DepthCue {
    /// k_1, dimensionless.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub k1: f64,
    /// k_2, per world unit; `k1 + k2 d` must stay above 0 over the scene.
    pub k2: f64,
}

fn one() -> f64 {
    1.0
}
