//! Furniture of a figure: what is written and drawn over a picture, or stands in the gel, so that it can be read. Each is an
//! entity, and absent unless stated.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;

/// A bar of known length in the focal plane, in a corner of the picture.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ScaleBar {
    /// Length, world units, above 0; default: the roundest that takes up to a quarter of the width.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub length_mm: Option<f64>,
    /// What a world unit is called.
    pub unit: String,
    /// Where it stands.
    pub corner: Corner,
    /// Color of bar and letters.
    pub color: Color,
    /// Height of letters, pixels; default: a thirtieth of the picture's height.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 4.0, max = 1000.0))]
    pub letters_pixels: Option<f32>,
}

impl Default for ScaleBar {
    fn default() -> Self {
        let (unit, corner) = ("mm".to_owned(), Corner::BottomRight);
        Self { length_mm: None, unit, corner, color: GRAY, letters_pixels: None }
    }
}

/// A line of text at the top of the picture.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Title {
    /// What it says.
    pub text: String,
    /// Color of the letters.
    #[serde(default = "gray")]
    pub color: Color,
    /// Height of letters, pixels; default: a twentieth of the picture's height.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 4.0, max = 1000.0))]
    pub letters_pixels: Option<f32>,
}

/// What colors mean: a line each, or the colors of a volume's transfer function over its values.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Legend {
    /// Colors and what they mean, from the top down.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub entries: Vec<LegendEntry>,
    /// The name of a volume whose `transfer` or `colormap` is shown as a bar of colors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// Where it stands.
    #[serde(default = "top_right")]
    pub corner: Corner,
    /// Color of the letters.
    #[serde(default = "gray")]
    pub color: Color,
    /// Height of letters, pixels; default: a thirtieth of the picture's height.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 4.0, max = 1000.0))]
    pub letters_pixels: Option<f32>,
}

/// A line of a legend.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LegendEntry {
    /// The color, as in the scene.
    pub color: Color,
    /// What it means.
    pub text: String,
}

/// Text beside a place in the world, and a line to that place, which stands in the gel and is hidden by it; the text is not.
///
/// Where the view states a background, letters of all furniture have a rim of its color; those of callouts have one of black or white
/// where it states none, since they may stand before a volume. The text of a line that begins in the picture lies wholly in it.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Callout {
    /// What it says.
    pub text: String,
    /// Where the line ends, in the world.
    pub at: [f64; 3],
    /// Where it begins, beside the text, in the world.
    pub from: [f64; 3],
    /// Color of line and letters.
    #[serde(default = "gray")]
    pub color: Color,
    /// How thick the line is, world units, above 0; default: a hundredth of its length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub width_mm: Option<f64>,
    /// Height of letters, pixels; default: a thirtieth of the picture's height.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 4.0, max = 1000.0))]
    pub letters_pixels: Option<f32>,
}

/// The edges of the box that all volumes lie in, along the axes of the world, as rods that stand in the gel.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BoundingBox {
    /// Color of the rods.
    pub color: Color,
    /// How thick they are, world units, above 0; default: a three-hundredth of the box's diagonal.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub width_mm: Option<f64>,
}

impl Default for BoundingBox {
    fn default() -> Self {
        Self { color: GRAY, width_mm: None }
    }
}

/// Three axes with ticks and values along edges of the box that all volumes lie in, as rods that stand in the gel.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Axes {
    /// How far ticks are apart, world units, above 0; default: the roundest of which three or more fit in the longest side.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub step_mm: Option<f64>,
    /// What a world unit is called.
    pub unit: String,
    /// Color of rods and letters.
    pub color: Color,
    /// How thick rods are, world units, above 0; default: a three-hundredth of the box's diagonal.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub width_mm: Option<f64>,
    /// Height of letters, pixels; default: a thirty-sixth of the picture's height.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 4.0, max = 1000.0))]
    pub letters_pixels: Option<f32>,
}

impl Default for Axes {
    fn default() -> Self {
        let unit = "mm".to_owned();
        Self { step_mm: None, unit, color: GRAY, width_mm: None, letters_pixels: None }
    }
}

/// A cube in a corner of the picture that is turned as the world is, with the first letter of left, right, anterior,
/// posterior, superior and inferior on its sides.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OrientationCube {
    /// Where it stands.
    pub corner: Corner,
    /// Color of its sides.
    pub color: Color,
    /// Its diagonal, pixels; default: an eighth of the picture's height.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 8.0, max = 4000.0))]
    pub size_pixels: Option<f32>,
}

impl Default for OrientationCube {
    fn default() -> Self {
        let color = Color(glam::Vec3::splat(0.7));
        Self { corner: Corner::BottomLeft, color, size_pixels: None }
    }
}

/// A corner of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the variants are the corners")]
pub enum Corner {
    TopLeft,
    TopRight,
    BottomLeft,
    BottomRight,
}

/// Legible on white and on black.
const GRAY: Color = Color(glam::Vec3::splat(0.2));

fn gray() -> Color {
    GRAY
}

fn top_right() -> Corner {
    Corner::TopRight
}
