//! What a picture is off by, as a few of its pixels tell of which the exact colors are known.

use glam::Vec4;
use serde::Serialize;

use super::survey::interval;
use crate::schedule::Product;
use crate::shared::Shared;
use crate::view::picture::Picture;

/// Pixels that are drawn together, one from each of as many parts of the picture.
pub const ROUND: usize = 12;
/// How often pixels are drawn at the least, as a part of how often they would be if all were drawn alike.
pub const ANYWHERE: f64 = 0.25;

/// A pixel that was drawn, and its color in the exact picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExactPixel {
    /// Which, row by row.
    pub item: usize,
    /// What it counts in a mean, by its round.
    pub weight: f64,
    /// Linear associated RGBA.
    pub color: [f32; 4],
}

/// The estimated error of a view's picture, over its four channels in linear light, peak 1: against the same picture with a
/// ray at every position, samples at a quarter of its distance, and rays that stop only where what is behind adds no more
/// than 1e-4.
///
/// The rounding of the gel's texels is not in it, for the exact pixels are of the same gel: about 3e-5 of a picture for 16
/// bits and 0.01 for 8.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Judged {
    /// Decibels; infinite (in JSON: null) where no difference was found.
    pub psnr_db: f64,
    /// At least so many decibels, in nine of ten cases together with `high`.
    pub low: f64,
    /// At most so many.
    pub high: f64,
    /// The greatest difference of a channel that was found.
    pub max: f64,
    /// No more of the pixels than this part are off by more than `max`, in nine of ten cases.
    pub beyond: f64,
    /// How many pixels were drawn.
    pub pixels: u64,
    /// Rays that were cast for them.
    pub rays: u64,
    /// Samples that were taken for them.
    pub samples: u64,
    /// The pixels, round by round.
    #[serde(skip)]
    pub exact: Shared<ExactPixel>,
}

impl Product for Judged {}

impl Judged {
    /// What `picture` is off by at pixels that are in it; `rays` and `samples` were taken for them. What is not finite is
    /// left out.
    #[must_use]
    pub fn new(picture: &Picture, exact: Shared<ExactPixel>, [rays, samples]: [u64; 2]) -> Self {
        let off = |pixel: &ExactPixel| {
            let made = picture.pixels.get(pixel.item).copied().unwrap_or(pixel.color);
            let off = Vec4::from(made) - Vec4::from(pixel.color);
            if off.is_finite() { off } else { Vec4::ZERO }
        };
        let squared =
            |pixel: &ExactPixel| pixel.weight * off(pixel).as_dvec4().length_squared() / 4.0;
        let rounds = exact.chunks(ROUND).map(|round| round.iter().map(squared).sum());
        let found = interval(&rounds.collect::<Vec<f64>>());
        let worst = exact.iter().map(|pixel| off(pixel).abs().max_element());
        let pixels = exact.len() as u64;
        Self {
            psnr_db: decibels(found.value),
            low: decibels(found.high),
            high: decibels(found.low),
            max: f64::from(worst.fold(0.0, f32::max)),
            // Of pixels that make up this part, and are drawn as seldom as any, none is met in one of ten cases.
            beyond: (std::f64::consts::LN_10 / (pixels as f64 * ANYWHERE)).min(1.0),
            pixels,
            rays,
            samples,
            exact,
        }
    }

    /// What another picture of the same scene and view is off by, at the same pixels: it costs no rays.
    #[must_use]
    pub fn of_another(&self, picture: &Picture) -> Self {
        Self::new(picture, self.exact.clone(), [self.rays, self.samples])
    }
}

fn decibels(squared: f64) -> f64 {
    if squared > 0.0 { -10.0 * libm::log10(squared) } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat picture that is off by 0.1 in one channel wherever `is_off`.
    fn judged(is_off: impl Fn(usize) -> bool) -> Judged {
        let pixel = |at: usize| [0.5, if is_off(at) { 0.6 } else { 0.5 }, 0.5, 1.0];
        let picture = Picture::new([40, 30], (0..1200).map(pixel).collect()).unwrap();
        let drawn = |at: usize| ExactPixel {
            item: at * 7 % 1200,
            weight: 1.0 / ROUND as f64,
            color: [0.5, 0.5, 0.5, 1.0],
        };
        Judged::new(&picture, Shared::new((0..600).map(drawn).collect()), [0; 2])
    }

    #[test]
    fn a_constant_difference_is_known_exactly() {
        let found = judged(|_| true);
        // One of four channels is off by 0.1: the mean square is 0.01 / 4.
        assert!((found.psnr_db - 26.0206).abs() < 1e-3 && (found.max - 0.1).abs() < 1e-6);
        assert!(found.high - found.low < 1e-9);
        let half = judged(|at| at % 2 == 0);
        assert!((half.psnr_db - 29.0309).abs() < 1e-3, "{:?}", half.psnr_db);
    }

    #[test]
    fn pixels_judge_another_picture() {
        let found = judged(|_| true);
        let equal = Picture::new([40, 30], vec![[0.5, 0.5, 0.5, 1.0]; 1200]).unwrap();
        let other = found.of_another(&equal);
        assert!(other.psnr_db.is_infinite() && other.max == 0.0);
        assert_eq!((other.pixels, other.beyond), (600, found.beyond));
    }
}
