//! `classify`: which opacity (and colour) a scalar and its gradient get, in one of four ways (algorithm §2).

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

use super::{Color, Colormap, Preset};

/// A classification: exactly one of `iso`, `regions`, `transfer`, `materials`, `preset` or `colormap`.
///
/// `L` is how the levels of contours are known: a [`Level`] as stated, a number once the volume is read.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, bound(deserialize = "L: Deserialize<'de>"))]
pub struct Classify<L = f32> {
    /// Isovalue contours; several composite as `1 − Π (1 − α_n)`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub iso: Vec<Contour<L>>,
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
    pub materials: Vec<MixtureMaterial>,
    /// One of the classifications that have names.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preset: Option<Preset>,
    /// The colors of the field by name, with an opacity that rises across the window from 0 to `peak_opacity`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colormap: Option<Colormap>,
    /// With `colormap`: the value in the middle of the window; default: the middle of all but the outermost hundredths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<f32>,
    /// With `colormap`: the values that the colors span, above 0; default: as far as all but the outermost hundredths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub window: Option<f32>,
    /// With `colormap`: the opacity at the window's end, per opacity unit; default 0.25. With `projection`: of all values; default 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub peak_opacity: Option<f32>,
}

/// The level of a contour, as a scene states it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Level {
    /// In the units of the scalars.
    Value(f32),
    /// `"1.5sigma"`: so many standard deviations of the scalars above their mean, as crystallographers contour maps.
    Sigma(f64),
}

impl<'de> Deserialize<'de> for Level {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Value(f32),
            Sigma(String),
        }
        const EXPECTED: &str =
            "a level is a number or, like \"1.5sigma\", standard deviations above the mean";
        match Written::deserialize(deserializer).map_err(|_| D::Error::custom(EXPECTED))? {
            Written::Value(value) => Ok(Self::Value(value)),
            Written::Sigma(text) => text
                .strip_suffix("sigma")
                .and_then(|number| number.trim().parse().ok())
                .filter(|deviations: &f64| deviations.is_finite())
                .map(Self::Sigma)
                .ok_or_else(|| D::Error::custom(format!("\"{text}\" is no level; {EXPECTED}"))),
        }
    }
}

impl Serialize for Level {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Value(value) => serializer.serialize_f32(*value),
            Self::Sigma(deviations) => serializer.collect_str(&format_args!("{deviations}sigma")),
        }
    }
}

impl JsonSchema for Level {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Level".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "in the units of the scalars, or, like \"1.5sigma\", standard deviations above their mean",
            "anyOf": [
                { "type": "number", "format": "float" },
                { "type": "string", "pattern": "^[-+]?[0-9.]+ *sigma$" }
            ]
        })
    }
}

/// One isovalue contour `(f_v, α_v, r)` of Levoy 1988.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contour<L = f32> {
    /// f_v, in the units of the scalars; stated as a [`Level`].
    pub value: L,
    /// α_v in 0..=1, per opacity unit.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub opacity: f32,
    /// r: thickness of the transition between opaque and clear, in voxels (world: r · opacity unit). 0 is a surface
    /// that is found between voxels, of a volume that states `reconstruct = "values"`; of what is above, it is closed by flat
    /// faces where the volume is clipped and where it ends.
    #[serde(default = "two")]
    #[schemars(range(min = 0.0))]
    pub thickness_voxels: f32,
    /// On which sides of the isovalue the contour is seen; default: all that is above it.
    #[serde(default)]
    pub form: Form,
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
    #[schemars(range(min = 0.0, max = 1.0))]
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
    #[schemars(range(min = 0.0, max = 1.0))]
    pub opacity: f32,
    /// Colour; default: the material's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
}

/// One material of a mixture: its probability as a function of the scalar, and what it looks like.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MixtureMaterial {
    /// Piecewise-linear `[value, probability]` pairs in rising order of value; probabilities of all materials are scaled to sum to at most 1.
    #[schemars(length(min = 1))]
    pub probability: Vec<[f32; 2]>,
    /// Opacity of the pure material in 0..=1, per opacity unit.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub opacity: f32,
    /// Colour of the pure material; default: the material's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
}

impl Classify {
    /// An opaque surface at one value of the scalars, in the material's color.
    #[must_use]
    pub fn iso(value: f32) -> Self {
        Self { iso: vec![Contour::at(value)], ..Self::default() }
    }
}

/// On which sides of its isovalue a contour is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// What is above the isovalue: clear at it, opaque from r voxels further in. Nothing below it is seen.
    #[default]
    Above,
    /// The region around the isovalue (Levoy 1988): opaque at it, clear r voxels to either side, so that a steep boundary
    /// which passes the isovalue by is seen as well.
    Around,
}

impl Contour {
    /// An opaque contour of what is above `value`, two voxels from clear to opaque, in the material's colour.
    #[must_use]
    pub fn at(value: f32) -> Self {
        Self { value, opacity: one(), thickness_voxels: two(), form: Form::Above, color: None }
    }
}

fn one() -> f32 {
    1.0
}

fn two() -> f32 {
    2.0
}
