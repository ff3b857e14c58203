//! `projection`: a volume as one value a ray, in the colors that its `classify` gives that value, instead of as gel.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which value of a volume a ray shows. It is neither lit nor in anyone's light: a value is a measurement and no surface.
///
/// `classify` (a `transfer` or a `colormap`; default: gray over the values that there are, opaque) says what the value looks
/// like. Rays end at the first opaque polygon. One whose way through the volume is so short that none of its samples lies on it shows
/// what is in the middle of that way, so that the volume ends in the picture where its box does.
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
    /// The field as a density of glowing particles (Sabella, "A Rendering Algorithm for Visualizing 3D Scalar Fields", SIGGRAPH
    /// 1988): hue, saturation and value of HSV tell the greatest value on the ray, how far away it is and how much the ray meets.
    ///
    /// The color is that of the greatest value, seen where it is first; its saturation falls with that place's depth, from all of
    /// it at the nearest corner of the volume to a tenth at the farthest. It is multiplied by 1 − exp(−τ ∫ρ ds), what is seen
    /// along the ray of emitters ρ that attenuate those behind them by exp(−τ ∫ρ ds), over what is seen of endless ones of density
    /// 1: ρ is 0 at the first value of `transfer` (or below the `window` of a `colormap`) and 1 at the last, and τ is 4 over the
    /// volume's longest side. Where no `classify` is stated, hues go from blue to red over the values that there are.
    Sabella,
}
