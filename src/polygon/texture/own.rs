//! Textures that a mesh's file brings with it: several for one entity, and of each face which.

use super::MappedTexture;
use crate::components::{TextureFilter, Wrap};
use crate::shared::Shared;

/// The textures of a mesh's file, which lie on its faces where the scene states no other; none where it has none.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnTextures {
    textures: Vec<MappedTexture>,
    /// For each face the number of its texture, beyond them for none.
    of: Shared<u32>,
}

impl OwnTextures {
    /// Of each face, the number of its texture; a number beyond them is none.
    #[must_use]
    pub fn new(textures: Vec<MappedTexture>, of: Vec<u32>) -> Self {
        Self { textures, of: Shared::new(of) }
    }

    /// The texture on the face of that number, if it has one.
    #[must_use]
    pub fn on(&self, at: usize) -> Option<&MappedTexture> {
        self.textures.get(*self.of.get(at)? as usize)
    }

    /// All that there are.
    #[must_use]
    pub fn all(&self) -> &[MappedTexture] {
        &self.textures
    }

    /// Another way to look up the same texels, which are shared.
    #[must_use]
    pub fn with(&self, wrap: Wrap, filter: TextureFilter) -> Self {
        let textures = self.textures.iter().map(|texture| texture.with(wrap, filter));
        Self { textures: textures.collect(), of: self.of.clone() }
    }
}
