//! `sampling`: where speed is traded for accuracy; each key is a [knob](super::KNOBS).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How densely a view samples its scene, and when it stops. Equal settings give equal bytes.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sampling {
    /// Δ: distance between samples along a ray, world units, above 0; default: the smallest voxel spacing.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub distance_mm: Option<f64>,
    /// What steps over empty space; lossless.
    pub skip: Skip,
    /// ε_T: a ray stops when what is behind can add no more than this to any channel; 0 = never, below 1. That holds for
    /// colours up to 1: where lights sum to s > 1, what is behind may add s · ε_T.
    #[schemars(range(min = 0.0), extend("exclusiveMaximum" = 1.0))]
    pub stop_at: f32,
    /// ε_C: a region whose corners differ in C by more than this in any channel is split; 0 = always. Either way it splits to
    /// one ray a pixel; what is split further is for `edge_tolerance` to say.
    #[schemars(range(min = 0.0))]
    pub tolerance: f32,
    /// ε_G: below a ray a pixel a region is split only if both C_G and C_A range by more than this.
    #[schemars(range(min = 0.0))]
    pub edge_tolerance: f32,
    /// ω_max: positions between the first rays, a power of two 1..=32; 4 = one ray a pixel.
    #[schemars(range(min = 1, max = 32))]
    pub coarsest: u32,
    /// ω_min: positions between the last rays, a power of two 1..=`coarsest`.
    #[schemars(range(min = 1, max = 32))]
    pub finest: u32,
    /// Rays for each face of a voxel, of a cube of the smallest spacing, 0.5..=16, that go through the voxels' own lattice,
    /// slice by slice, and from there to the pixels: 0.5 = through every second row of voxels; 0 = rays go through the pixels.
    /// Where more is seen than one volume of colors in a parallel view (polygons that are traced, values, projections, dust, a
    /// depth cue, several volumes) they go through the pixels all the same.
    #[schemars(range(min = 0.0, max = 16.0))]
    pub per_voxel: f64,
    /// Whether regions that outlines of polygons cross are split to one ray a pixel from the start, and those of polygons
    /// thinner than a pixel to `finest`.
    pub outlines: bool,
    /// In which numbers the gel is kept.
    pub texel: TexelKind,
    /// What values between voxels are, of a volume that states `reconstruct = "values"`; colors are interpolated linearly.
    pub filter: Filter,
    /// Whether a transfer function of such values is integrated over each slab, from the value at its beginning to that at its
    /// end, in place of what it is in the middle: a sharp one then does not ask for short steps. Where a voxel is no finite
    /// number it is not.
    pub integrate: bool,
    /// What a pixel is of the positions around it.
    pub pixel_filter: PixelFilter,
}

impl Default for Sampling {
    fn default() -> Self {
        Self {
            distance_mm: None,
            skip: Skip::Pyramid,
            stop_at: 0.02,
            tolerance: 0.02,
            edge_tolerance: 0.02,
            coarsest: 8,
            finest: 1,
            per_voxel: 0.0,
            outlines: true,
            texel: TexelKind::Auto,
            filter: Filter::Linear,
            integrate: false,
            pixel_filter: PixelFilter::Box,
        }
    }
}

/// What steps over empty space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Skip {
    /// The pyramid of binary volumes (paper §6).
    Pyramid,
    /// Nothing: every sample of the domain is taken.
    None,
}

/// The numbers that the gel's associated RGBA is kept in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum TexelKind {
    /// 16-bit fixed point where the gel has an opacity above 1/16 and no colour above 4; 32-bit floats else, and for
    /// paint in floats.
    Auto,
    /// 32-bit floats: 16 bytes a voxel.
    F32,
    /// 16-bit fixed point, error 2⁻¹⁷ a channel of the gel and about 3e-5 of a picture: 8 bytes a voxel. Where colours may be
    /// above 1 they are kept in parts of the brightest, and their error is as much greater.
    U16,
    /// 8-bit fixed point, error 2⁻⁹ a channel of the gel and about 0.01 of a picture: 4 bytes a voxel. Colours above 1 are
    /// kept as in 16 bits.
    U8,
}

/// How values between voxels are reconstructed, and their gradients.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Filter {
    /// Tri-linear, of the voxels' values and of their central differences.
    Linear,
    /// The cubic B-spline: twice continuous, and smoother than the voxels.
    Cubic,
    /// The cubic of Catmull and Rom: through the voxels' values, once continuous.
    CatmullRom,
    /// The cubic B-spline that goes through the voxels' values: of coefficients that are made once a volume.
    Interpolating,
}

/// How the positions around a pixel become its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PixelFilter {
    /// The mean over the pixel.
    Box,
    /// A tent two pixels wide.
    Tent,
    /// Mitchell and Netravali 1988, four pixels wide.
    Mitchell,
}

impl PixelFilter {
    /// How far it reaches from a pixel's middle, in positions of the sample array (4 a pixel).
    #[must_use]
    pub fn reach(self) -> usize {
        match self {
            Self::Box => 2,
            Self::Tent => 4,
            Self::Mitchell => 8,
        }
    }

    /// Its weight `distance` pixels from a pixel's middle, not normalised; a box counts its borders half.
    #[must_use]
    pub fn weight(self, distance: f32) -> f32 {
        let x = distance.abs();
        match self {
            Self::Box if x < 0.5 => 1.0,
            Self::Box if x == 0.5 => 0.5,
            Self::Tent => (1.0 - x).max(0.0),
            // B = C = 1/3.
            Self::Mitchell if x < 1.0 => (7.0 * x * x * x - 12.0 * x * x + 16.0 / 3.0) / 6.0,
            Self::Mitchell if x < 2.0 => {
                (-7.0 / 3.0 * x * x * x + 12.0 * x * x - 20.0 * x + 32.0 / 3.0) / 6.0
            }
            Self::Box | Self::Mitchell => 0.0,
        }
    }
}
