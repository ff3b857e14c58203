//! What systems make, a product a system: carried by the entity that it was made for, immutable, shared by pointer.

pub use crate::light::strength::LightStrength;
use crate::schedule::{Kind, Product};
use crate::view::picture::Picture;
pub use crate::view::samples::Samples;
use crate::volume::bricks::Bricks;
use crate::volume::gel::Gel as GelBricks;
use crate::volume::grid::Shared;
pub use crate::volume::pyramid::Pyramid;

/// ∇f at every voxel of a volume (algorithm §2), in scalar units per world unit, world axes; x fastest, dense.
///
/// A voxel whose gradient needs a NaN has the gradient zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Gradient(pub Shared<[f32; 3]>);

/// α_V of every voxel, 0..=1 per opacity unit, after clipping; bricks without an interesting voxel are not stored.
#[derive(Debug, Clone, PartialEq)]
pub struct Opacity {
    /// The opacities.
    pub voxels: Bricks<f32>,
    /// How many voxels held a NaN; their opacity is 0.
    pub nan_voxels: u64,
}

/// What the interesting voxels send towards the observer: linear light, not associated, in the bricks that `Opacity` stores.
#[derive(Debug, Clone, PartialEq)]
pub struct LitColors {
    /// Ambient and every light that casts no shadow, summed; without ambient where `ambient` is stated apart.
    pub base: Bricks<[f32; 3]>,
    /// One for each light that casts a shadow, in the order of the scene.
    pub shadowed: Vec<Bricks<[f32; 3]>>,
    /// Ambient alone, kept apart where a depth cue is stated: it is not cued.
    pub ambient: Option<Bricks<[f32; 3]>>,
}

/// An opacity and a colour at every voxel: a volume, a scan-converted polygon, or both matted.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// α, 0..=1 per opacity unit.
    pub opacity: Bricks<f32>,
    /// c_1 … c_L, in the same bricks.
    pub colors: LitColors,
}

/// A scan-converted polygon (paper §3): c_G and α_G at every voxel within one voxel of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Coverage(pub Layer);

/// Volume and scan-converted polygons, matted in the order of the scene: c_C and α_C.
#[derive(Debug, Clone, PartialEq)]
pub struct Composite(pub Layer);

/// The coloured, semi-transparent gel that rays meet: c_T · α_C and α_C (equation 4).
#[derive(Debug, Clone, PartialEq)]
pub struct Gel {
    /// Colour and opacity; the reflected part alone of the colour where `ambient` is apart.
    pub lit: GelBricks,
    /// The ambient part of the colour (and the opacity again), where a depth cue is stated.
    pub ambient: Option<GelBricks>,
}

/// The picture of a view, linear associated RGBA.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame(pub Picture);

macro_rules! products {
    ($($product:ident)*) => {$(
        impl Product for $product {
            const KIND: Kind = Kind::$product;
        }
    )*};
}
products!(Gradient Opacity LitColors Coverage Composite LightStrength Gel Pyramid Samples Frame);
