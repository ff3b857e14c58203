//! `projection`: a volume as one value a ray, in the colors that its `classify` gives that value, instead of as gel.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which value of a volume a ray shows. It is neither lit nor in anyone's light: a value is a measurement and no surface.
///
/// `classify` (a `transfer` or a `colormap`; default: gray over the values that there are, opaque) says what the value looks
/// like. Rays end at the first opaque polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Projection {
    /// The greatest on the ray, seen where it is first: polygons before it cover it, those behind are covered by it.
    Maximum,
    /// The least on the ray, seen where it is first.
    Minimum,
    /// The mean along the ray's way through the volume, as of an X-ray; it has no depth, and every translucent polygon within
    /// the volume is seen before it.
    Mean,
}
