//! Textures on polygons (paper §5): a mapping from object space to texture space, and the texture filtered there.
//!
//! The view is parallel, so the map from the picture to the polygon's plane and on to the texture is affine: a square
//! of the picture becomes the same parallelogram, the [`Footprint`], wherever on a face it lies. A lookup is the
//! average of the texture over that parallelogram; the filters differ in how exactly they take it.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec4};
use hecs::World;

use crate::components::{TextureFilter, Textured, Wrap};
use crate::polygon::face::Face;
use crate::shared::Shared;
use crate::view::picture::Picture;

mod area;
mod bilinear;
mod ellipse;
mod footprint;
mod mapping;
mod mip;
mod own;

pub use footprint::Footprint;
pub use mapping::Mapping;
use mip::MipLevel;
pub use own::OwnTextures;

/// A texture ready for lookups: linear, associated RGBA and its coarser levels, shared by pointer.
#[derive(Debug, Clone)]
pub struct MappedTexture {
    levels: Arc<[MipLevel]>,
    /// To its sides, and above and below; neither vanishes where the other does not.
    wrap: [Wrap; 2],
    filter: TextureFilter,
}

impl PartialEq for MappedTexture {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.levels, &other.levels)
            && self.wrap == other.wrap
            && self.filter == other.filter
    }
}

impl MappedTexture {
    /// Takes the texels of `picture` and averages them into coarser levels, down to a single texel.
    ///
    /// Colours that are not finite become 0, opacities are held within 0..=1; a picture of no pixels is transparent.
    #[must_use]
    pub fn new(picture: &Picture, wrap: Wrap, filter: TextureFilter) -> Self {
        Self { levels: mip::levels(picture).into(), wrap: [wrap; 2], filter }
    }

    /// Another way to look up the same texels, which are shared.
    #[must_use]
    pub fn with(&self, wrap: Wrap, filter: TextureFilter) -> Self {
        Self { levels: Arc::clone(&self.levels), wrap: [wrap; 2], filter }
    }

    /// The same texels, which go on in one way to their sides and in another above and below; where one of them is that all
    /// vanishes, it does on every side.
    #[must_use]
    pub(crate) fn wrapping(&self, wrap: [Wrap; 2]) -> Self {
        let wrap = if wrap.contains(&Wrap::Vanish) { [Wrap::Vanish; 2] } else { wrap };
        Self { wrap, ..self.clone() }
    }

    /// Texels across and down.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.levels[0].size
    }

    /// Bytes that all levels take.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.levels.iter().map(|level| size_of_val(&*level.texels) as u64).sum()
    }

    /// The texture's mean over `footprint` about `uv` by the filter it was made with: linear, associated RGBA.
    ///
    /// `uv` is (0, 0) at the top left corner of the texture and (1, 1) at the bottom right one. The result is a convex
    /// combination of texels, and of nothing where the texture vanishes: opacity is within 0..=1, never NaN.
    #[must_use]
    pub fn filtered(&self, uv: DVec2, footprint: &Footprint) -> Vec4 {
        let uv = self.placed(uv);
        match self.filter {
            TextureFilter::Area => area::average(&self.levels, self.wrap, uv, footprint),
            TextureFilter::Ellipse => ellipse::average(&self.levels, self.wrap, uv, footprint),
            TextureFilter::Trilinear => bilinear::trilinear(&self.levels, self.wrap, uv, footprint),
            TextureFilter::Bilinear => bilinear::bilinear(&self.levels[0], self.wrap, uv),
            TextureFilter::Nearest => bilinear::nearest(&self.levels[0], self.wrap, uv),
        }
    }

    /// The texture's mean over exactly the parallelogram of `footprint`, at least a texel wide: the reference.
    ///
    /// Each texel counts by the area it shares with the parallelogram, as Feibush, Levoy and Cook weigh texels by a
    /// square pixel. Same units and range as [`MappedTexture::filtered`].
    #[must_use]
    pub fn average(&self, uv: DVec2, footprint: &Footprint) -> Vec4 {
        area::average(&self.levels, self.wrap, self.placed(uv), footprint)
    }

    /// A finite `uv`, within the texture itself (or that and its mirror image) where it repeats, so that fractions of a texel
    /// keep their digits.
    fn placed(&self, uv: DVec2) -> DVec2 {
        let finite = |x: f64| if x.is_nan() { 0.5 } else { x.clamp(-1e9, 1e9) };
        let uv = DVec2::new(finite(uv.x), finite(uv.y));
        let within = |x: f64, wrap: Wrap| {
            wrap.period().map_or(x, |period| x - period * (x / period).floor())
        };
        DVec2::new(within(uv.x, self.wrap[0]), within(uv.y, self.wrap[1]))
    }
}

/// Bytes that all levels of the textures of a world take, each texture once, whoever it is laid on.
#[must_use]
pub fn bytes_of(world: &World) -> u64 {
    let mut each_once: HashMap<_, _> =
        world.query::<&MappedTexture>().iter().map(counted).collect();
    each_once.extend(world.query::<&TexturedBy>().iter().flat_map(|by| by.laid.all()).map(counted));
    each_once.values().sum()
}

/// What tells a texture's levels from those of others, and their bytes.
fn counted(texture: &MappedTexture) -> (*const MipLevel, u64) {
    (texture.levels.as_ptr(), texture.bytes())
}

/// `textured`, resolved: the picture itself and the corners that it is laid between.
#[derive(Debug, Clone, PartialEq)]
pub struct TexturedBy {
    /// As stated.
    pub textured: Textured,
    /// What is laid, ready for lookups.
    pub laid: Laid,
    /// Where it lies.
    pub lies: Lies,
}

/// Which texture is on a face of an entity.
#[derive(Debug, Clone, PartialEq)]
pub enum Laid {
    /// The same on all of them.
    One(MappedTexture),
    /// On each that of its mesh's file, if it has one.
    Each(OwnTextures),
}

impl Laid {
    /// The texture on the face of that number, if there is one.
    #[must_use]
    pub fn on(&self, at: usize) -> Option<&MappedTexture> {
        match self {
            Self::One(texture) => Some(texture),
            Self::Each(own) => own.on(at),
        }
    }

    /// All that there are.
    #[must_use]
    pub fn all(&self) -> &[MappedTexture] {
        match self {
            Self::One(texture) => std::slice::from_ref(texture),
            Self::Each(own) => own.all(),
        }
    }
}

/// Where a texture lies on the faces of an entity.
#[derive(Debug, Clone, PartialEq)]
pub enum Lies {
    /// On all of them alike: the world points of its top left, top right and bottom left corners, never on one line.
    Corners([DVec3; 3]),
    /// On each where the mesh says.
    Places(TexturePlaces),
}

/// For each face of an entity where its three corners lie in a texture: (0, 0) is its top left corner and (1, 1) its bottom
/// right one; no numbers for a face that lies nowhere in it.
#[derive(Debug, Clone, PartialEq)]
pub struct TexturePlaces(pub(crate) Shared<[DVec2; 3]>);

impl TexturedBy {
    /// Where points of `face`, which has that number, lie in the texture; `None` where it shows none of it.
    #[must_use]
    pub fn mapping(&self, at: usize, face: &Face) -> Option<Mapping> {
        match &self.lies {
            Lies::Corners(corners) => {
                let corners = Some(corners.map(|corner| corner.to_array()));
                Mapping::new(face, &Textured { corners, ..self.textured.clone() }).ok()
            }
            Lies::Places(places) => {
                Mapping::of_places(face, *places.0.get(at)?, self.textured.repeats)
            }
        }
    }
}

#[cfg(test)]
mod tests;
