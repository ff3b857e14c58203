//! `texture` and its two uses: `textured` on a polygon (paper §5) and `projects` on a light (paper §4).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An image that polygons and lights may name: exactly one of `file` or `formula`.
///
/// In a world, a [`Picture`](crate::view::picture::Picture) on a named entity is such an image.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Texture {
    /// A PNG, JPEG, TIFF or EXR; relative to the scene's folder or to the data folder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The formula that is used, with a warning, where the file is not found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stand_in: Option<String>,
    /// A texture made by formula: `grid`, `checker`, `portrait` or `disc`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
}

/// Maps a texture onto the polygons of an entity, in the hybrid ray tracer only.
///
/// The texture's colour multiplies the surface's colour, its alpha the surface's opacity.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Textured {
    /// The name of an entity with a `texture`, or of a formula; or of the mesh itself, for the pictures that its file (glTF, OBJ) brings.
    pub texture: String,
    /// World points of the texture's top left, top right and bottom left corners; default: the polygon's first, second and last vertex,
    /// or where a mesh's file (OBJ, PLY, glTF, VTK) says that its triangles lie in it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub corners: Option<[[f64; 3]; 3]>,
    /// How many times the texture is laid across and down between those corners, each above 0. Only the first of them
    /// holds the texture where it does not repeat.
    #[serde(default = "once")]
    pub repeats: [f64; 2],
    /// What lies outside the texture.
    #[serde(default)]
    pub wrap: Wrap,
    /// How a pixel's footprint is averaged over it.
    #[serde(default)]
    pub filter: TextureFilter,
}

impl Textured {
    /// The texture of that name, laid once by the polygon's own corners.
    #[must_use]
    pub fn by(name: &str) -> Self {
        let (wrap, filter) = (Wrap::default(), TextureFilter::default());
        Self { texture: name.to_owned(), corners: None, repeats: once(), wrap, filter }
    }
}

/// What lies outside a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Wrap {
    /// The texture again.
    #[default]
    Repeat,
    /// Its mirror image, and then the texture again.
    Mirror,
    /// Its outermost texels.
    Clamp,
    /// Nothing: opacity 0.
    Vanish,
}

impl Wrap {
    /// After how many widths of the texture all is as before; `None` where nothing comes again.
    pub(crate) fn period(self) -> Option<f64> {
        match self {
            Self::Repeat => Some(1.0),
            Self::Mirror => Some(2.0),
            Self::Clamp | Self::Vanish => None,
        }
    }

    /// Where an index of the endless plane lies among `count` texels; `None` where nothing lies.
    #[inline]
    pub(crate) fn texel(self, index: i64, count: usize) -> Option<usize> {
        if let Ok(inside) = usize::try_from(index)
            && inside < count
        {
            return Some(inside);
        }
        let count = count as i64;
        match self {
            Self::Repeat => Some(index.rem_euclid(count) as usize),
            Self::Mirror => {
                let index = index.rem_euclid(2 * count);
                Some(index.min(2 * count - 1 - index) as usize)
            }
            Self::Clamp => Some(index.clamp(0, count - 1) as usize),
            Self::Vanish => None,
        }
    }
}

/// How a footprint is averaged over a texture, from the reference to the cheapest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum TextureFilter {
    /// The mean over exactly the footprint (Feibush, Levoy and Cook 1980): the reference.
    #[default]
    Area,
    /// Elliptical weighted average (Heckbert 1989): softer, and no moiré even where the exact mean lets some through.
    Ellipse,
    /// Two levels of a mip map, each bilinear.
    Trilinear,
    /// The four nearest texels.
    Bilinear,
    /// The nearest texel.
    Nearest,
}

/// A slide in front of a light: the initial light strengths are the luminance of a texture.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Projects {
    /// The name of an entity with a `texture`, or of a formula.
    pub texture: String,
    /// Width and height of the texture in the plane perpendicular to the light, world units.
    pub size_mm: [f64; 2],
    /// A world point that the middle of the texture falls on; default: the centre of the volume.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center: Option<[f64; 3]>,
    /// The direction that the texture's top points to, as near as the light's plane allows; default +z.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub up: Option<[f64; 3]>,
    /// What lies outside the texture: `vanish` is no light.
    #[serde(default)]
    pub wrap: Wrap,
}

fn once() -> [f64; 2] {
    [1.0, 1.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_outside_repeats_is_mirrored_clamps_or_vanishes() {
        let at = |wrap: Wrap| [-4, -1, 0, 2, 3, 7].map(|i| wrap.texel(i, 3));
        assert_eq!(at(Wrap::Repeat), [2, 2, 0, 2, 0, 1].map(Some));
        assert_eq!(at(Wrap::Mirror), [2, 0, 0, 2, 2, 1].map(Some));
        assert_eq!(at(Wrap::Clamp), [0, 0, 0, 2, 2, 2].map(Some));
        assert_eq!(at(Wrap::Vanish), [None, None, Some(0), Some(2), None, None]);
    }
}
