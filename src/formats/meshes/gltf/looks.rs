//! The parts of a glTF's JSON that say how surfaces look: materials, and the pictures of their base color.

use serde::Deserialize;

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SurfaceLooks {
    #[serde(rename = "pbrMetallicRoughness")]
    pub pbr: Option<Pbr>,
    /// `OPAQUE` (where it is left out), `MASK` or `BLEND`.
    pub alpha_mode: Option<String>,
    /// The least alpha that is there, of `MASK`; 0.5 where it is left out.
    pub alpha_cutoff: Option<f32>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Pbr {
    /// Linear RGBA.
    #[serde(rename = "baseColorFactor")]
    pub base_color: Option<[f32; 4]>,
    #[serde(rename = "baseColorTexture")]
    pub picture: Option<PictureUse>,
}

/// How a material uses one of the file's `textures`.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct PictureUse {
    pub index: usize,
    #[serde(default)]
    tex_coord: usize,
    #[serde(default)]
    extensions: UseExtensions,
}

#[derive(Debug, Default, Deserialize)]
struct UseExtensions {
    #[serde(rename = "KHR_texture_transform")]
    moved: Option<Moved>,
}

/// How places in a picture are moved before they are looked up.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Moved {
    pub offset: Option<[f64; 2]>,
    /// Radians.
    pub rotation: Option<f64>,
    pub scale: Option<[f64; 2]>,
    pub tex_coord: Option<usize>,
}

impl PictureUse {
    /// How its places are moved, if they are.
    pub fn moved(&self) -> Option<Moved> {
        self.extensions.moved
    }

    /// The number of the set of places that it lies by.
    pub fn set(&self) -> usize {
        self.moved().and_then(|moved| moved.tex_coord).unwrap_or(self.tex_coord)
    }
}

/// One of the file's `textures`: an image, and how it goes on outside itself.
#[derive(Debug, Deserialize)]
pub(super) struct SampledImage {
    source: Option<usize>,
    pub sampler: Option<usize>,
    #[serde(default)]
    extensions: ImageExtensions,
}

#[derive(Debug, Default, Deserialize)]
struct ImageExtensions {
    #[serde(rename = "EXT_texture_webp")]
    webp: Option<SourceOnly>,
}

#[derive(Debug, Deserialize)]
struct SourceOnly {
    source: usize,
}

impl SampledImage {
    /// The number of its image: a WebP where there is one.
    pub fn image(&self) -> Option<usize> {
        self.extensions.webp.as_ref().map(|webp| webp.source).or(self.source)
    }
}

/// By OpenGL's numbers, what lies outside a picture: 10497 the picture again, 33071 its outermost texels, 33648 its mirror image.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Outside {
    pub wrap_s: Option<u32>,
    pub wrap_t: Option<u32>,
}

/// An image: a file beside, base64, or a view of a buffer.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct StoredImage {
    pub uri: Option<String>,
    pub buffer_view: Option<usize>,
    pub name: Option<String>,
}
