//! How strong a light still is, in the volume (paper §4).
//!
//! `β(d) = β_0 · T(d) / (k_1 + k_2 d)` at distance `d` along the light, with `T` what the opacities on the way let
//! through. Equation 3 as printed divides by `k_1 + k_2 d` at every sample, which compounds with their number; divided
//! once, the strength does not depend on how finely a volume is sampled.

mod buffer;
mod falloff;
mod shear;
mod slide;

use crate::schedule::Product;
use crate::volume::bricks::Bricks;
pub use buffer::Buffer;
pub use falloff::Falloff;
pub use shear::{Place, Shear, Window};
pub use slide::{ProjectedBy, Slide};

/// β of one light at every interesting voxel: 0 ..= 65535 stands for 0..=1 times `full`.
#[derive(Debug, Clone, PartialEq)]
pub struct LightStrength {
    /// The strengths, in the bricks of what is relit; 0 where a voxel of such a brick is not interesting.
    pub voxels: Bricks<u16>,
    /// The strength that 65535 stands for: finite and above 0.
    pub full: f32,
    /// β anywhere in space, where something asks for it: hybrid polygons that receive shadows, or a shaft of light.
    pub buffer: Option<Buffer>,
}

impl Product for LightStrength {}

impl LightStrength {
    /// Bytes that the product takes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.voxels.bytes() + self.buffer.as_ref().map_or(0, Buffer::bytes)
    }
}

/// A strength in 16 bits: 65535 stands for `full`, which is above 0; more than that, and less than 0, are clamped.
#[must_use]
#[inline]
pub fn quantize(strength: f64, full: f64) -> u16 {
    (strength / full * 65535.0 + 0.5) as u16
}
