//! What stages make of voxels, from the opacity to the matted layer: a product a system, carried by the volume or polygon.

use super::bricks::Bricks;
use super::voxel_colors::VoxelColors;
use crate::schedule::Product;

/// α_V of every voxel, 0..=1 per opacity unit, after clipping; bricks without an interesting voxel are not stored.
#[derive(Debug, Clone, PartialEq)]
pub struct Opacity {
    /// The opacities.
    pub voxels: Bricks<f32>,
    /// How many voxels of the volume hold a NaN; their opacity is 0.
    pub nan_voxels: u64,
}

impl Product for Opacity {}

/// What the interesting voxels send towards the observer: linear light, not associated, where the opacity is above 0.
#[derive(Debug, Clone, PartialEq)]
pub struct LitColors {
    /// Ambient and every light that casts no shadow, summed; without ambient where `ambient` is stated apart.
    pub base: VoxelColors,
    /// One for each light that casts a shadow, in the order of the scene.
    pub shadowed: Vec<VoxelColors>,
    /// Ambient alone, kept apart where a depth cue is stated: it is not cued.
    pub ambient: Option<VoxelColors>,
}

/// An opacity and a colour at every voxel: a volume, a scan-converted polygon, or both matted.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// α, 0..=1 per opacity unit.
    pub opacity: Bricks<f32>,
    /// c_1 … c_L, where it is above 0.
    pub colors: LitColors,
}

/// A scan-converted polygon (paper §3): c_G and α_G at every voxel within one voxel of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Coverage(pub Layer);

impl Product for Coverage {}

/// Volume and scan-converted polygons, matted in the order of the scene: c_C and α_C.
#[derive(Debug, Clone, PartialEq)]
pub struct Composite(pub Layer);

impl Product for Composite {}
