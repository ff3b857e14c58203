//! The coloured, semi-transparent gel that rays sample, in the numbers that suit it.

use std::sync::Arc;

use crate::components::TexelKind;
use crate::schedule::Product;
use crate::volume::bricks::Bricks;
use crate::volume::interest::Interest;
pub use crate::volume::texel::{BRIGHT, CELLS, EMPTY, FAINT, TEXELS, Texel};
pub(crate) use crate::volume::texel::{FACES, ROW};
pub use crate::volume::texels::{Fill, TexelSlices, Texels};

/// The coloured, semi-transparent gel that rays meet: c_T · α_C and α_C (equation 4).
#[derive(Debug, Clone, PartialEq)]
pub struct Gel {
    /// Colour and opacity; the reflected part alone of the colour where `ambient` is apart.
    pub lit: GelBricks,
    /// The ambient part of the colour (and the opacity again), where a depth cue is stated.
    pub ambient: Option<GelBricks>,
    /// What is interesting in it, if that was known before it was made.
    pub shown: Option<Shown>,
}

/// Opacities that gel is made of, and which of its cells are interesting for that: other light on the same makes no others.
#[derive(Debug, Clone)]
pub struct Shown {
    /// The opacities.
    pub opacity: Bricks<f32>,
    /// The cells, in the numbers that the gel is kept in.
    pub(crate) interest: Arc<Interest>,
}

impl PartialEq for Shown {
    /// Of gel in the same numbers.
    fn eq(&self, other: &Self) -> bool {
        self.opacity == other.opacity
    }
}

impl Product for Gel {}

impl Gel {
    /// Its interesting cells, if it is of these opacities in numbers of that kind: other light on the same has no others.
    #[must_use]
    pub(crate) fn interest(&self, of: &Bricks<f32>, kind: TexelKind) -> Option<Arc<Interest>> {
        let shown = self.shown.as_ref().filter(|shown| shown.opacity == *of)?;
        (self.lit.kind() == kind).then(|| Arc::clone(&shown.interest))
    }
}

/// The gel, in the number type that the view's `sampling` states.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs, reason = "the variants are the types")]
pub enum GelBricks {
    F32(Texels<[f32; 4]>),
    U16(Texels<[u16; 4]>),
    U8(Texels<[u8; 4]>),
}

/// Runs an expression on the typed texels inside [`GelBricks`]: `with_texels!(gel, texels => expression)`.
#[macro_export]
macro_rules! with_texels {
    ($gel:expr, $texels:ident => $body:expr) => {
        match $gel {
            $crate::volume::gel::GelBricks::F32($texels) => $body,
            $crate::volume::gel::GelBricks::U16($texels) => $body,
            $crate::volume::gel::GelBricks::U8($texels) => $body,
        }
    };
}

impl GelBricks {
    /// [`Texels::make`] in the type of `kind`; in 32 bits where that is left open.
    pub fn make(
        kind: TexelKind,
        size: [usize; 3],
        holds: impl Fn([usize; 3]) -> bool + Sync,
        made_of: &impl Fill,
    ) -> Self {
        match kind {
            TexelKind::Auto | TexelKind::F32 => Self::F32(Texels::make(size, holds, made_of)),
            TexelKind::U16 => Self::U16(Texels::make(size, holds, made_of)),
            TexelKind::U8 => Self::U8(Texels::make(size, holds, made_of)),
        }
    }

    /// The numbers that it is kept in.
    #[must_use]
    pub fn kind(&self) -> TexelKind {
        match self {
            Self::F32(_) => TexelKind::F32,
            Self::U16(_) => TexelKind::U16,
            Self::U8(_) => TexelKind::U8,
        }
    }

    /// Bytes that the bricks and their table take.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        with_texels!(self, texels => texels.bytes())
    }
}

/// The most bytes of `stored` bricks of gel and of the one of zeros, with the faces of `beside` of them.
#[must_use]
pub(crate) fn bytes_of(kind: TexelKind, stored: u64, beside: u64) -> u64 {
    let texel = match kind {
        TexelKind::Auto | TexelKind::F32 => 16,
        TexelKind::U16 => 8,
        TexelKind::U8 => 4,
    };
    ((stored + 1) * TEXELS as u64 + beside * FACES as u64) * texel
}
