//! Pictures in memory: what a view sees, what a texture holds, what `compare` compares.

use crate::components::color::to_linear;
use crate::error::Error;
use crate::schedule::Product;
use crate::shared::Shared;

/// An image of linear, associated RGBA: row 0 is the top, x runs fastest, `size[0] · size[1]` texels.
///
/// Colours of light within 0..=1 lie in 0..=alpha; brighter light may exceed it. Alpha is in 0..=1.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Pixels across and down.
    pub size: [usize; 2],
    /// Red, green, blue and alpha of each pixel.
    pub pixels: Shared<[f32; 4]>,
}

impl Picture {
    /// A picture of the given size; `None` unless there are `size[0] · size[1]` pixels.
    #[must_use]
    pub fn new(size: [usize; 2], pixels: Vec<[f32; 4]>) -> Option<Self> {
        (size[0].checked_mul(size[1])? == pixels.len())
            .then(|| Self { size, pixels: Shared::new(pixels) })
    }

    /// A picture of 8-bit sRGB with straight alpha, as image files and windows have it: row 0 is the top, x runs fastest.
    ///
    /// The error is another number of pixels than `size` multiplies to.
    pub fn from_srgb(size: [usize; 2], pixels: &[[u8; 4]]) -> Result<Self, Error> {
        let linear = |&[r, g, b, alpha]: &[u8; 4]| {
            let alpha = f32::from(alpha) / 255.0;
            let [r, g, b] = [r, g, b].map(|code| to_linear(f32::from(code) / 255.0) * alpha);
            [r, g, b, alpha]
        };
        Self::new(size, pixels.iter().map(linear).collect()).ok_or_else(|| {
            let ([width, height], count) = (size, pixels.len());
            let problem = format!(
                "{count} pixels do not fill {width} × {height}; hand over as many as the two sizes multiply to"
            );
            Error::input("picture", problem)
        })
    }

    /// The pixel at column `x` of row `y`; panics outside the picture.
    #[must_use]
    pub fn pixel(&self, x: usize, y: usize) -> [f32; 4] {
        self.pixels[y * self.size[0] + x]
    }

    /// The picture under another of the same size.
    #[must_use]
    pub fn under(&self, other: &Self) -> Self {
        let both = self.pixels.iter().zip(other.pixels.iter());
        let over = |(own, other): (&[f32; 4], &[f32; 4])| {
            let through = 1.0 - other[3];
            std::array::from_fn(|channel| other[channel] + through * own[channel])
        };
        Self { size: self.size, pixels: Shared::new(both.map(over).collect()) }
    }

    /// The picture over a background of one colour, opaque then.
    #[must_use]
    pub fn over(&self, background: glam::Vec3) -> Self {
        let [r, g, b] = background.to_array();
        let over = |&[pr, pg, pb, a]: &[f32; 4]| {
            let through = 1.0 - a;
            [pr + through * r, pg + through * g, pb + through * b, 1.0]
        };
        Self { size: self.size, pixels: Shared::new(self.pixels.iter().map(over).collect()) }
    }
}

/// Mitchell's filter has negative lobes: what they leave of a pixel stays an opacity, and a colour within it unless there is
/// one around that is brighter than its opacity by `excess`.
pub(super) fn within_opacity(sum: glam::Vec4, excess: f32) -> glam::Vec4 {
    let alpha = sum.w.clamp(0.0, 1.0);
    let most = if excess > 1e-6 { f32::INFINITY } else { alpha };
    sum.truncate().clamp(glam::Vec3::ZERO, glam::Vec3::splat(most)).extend(alpha)
}

/// The picture of a view, linear associated RGBA.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame(pub Picture);

impl Product for Frame {}
