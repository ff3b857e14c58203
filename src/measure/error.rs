//! The error between two pictures: how large, and where; in linear light and beside it in sRGB.

use rayon::prelude::*;
use serde::Serialize;

use super::ssim::ssim;
use crate::components::color::to_srgb;
use crate::view::picture::Picture;

/// What luminances are cut off at before structures are compared: beyond, squares would lose the digits that matter.
const BRIGHTEST: f64 = 1000.0;

/// The error between two pictures, over all pixels that are finite in both and all four channels, peak 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Errors {
    /// The greatest difference of a channel, 0 and up.
    pub max: f64,
    /// The root of the mean squared difference, 0 and up.
    pub rmse: f64,
    /// −20 log₁₀ of `rmse`, decibels; infinite (in JSON: null) when `rmse` is 0.
    pub psnr_db: f64,
    /// Mean structural similarity of the luminances over black, at most 1, which equal pictures have.
    ///
    /// Wang 2004: Gaussian windows of 11 × 11 pixels wholly inside, σ = 1.5, K₁ = 0.01, K₂ = 0.03. The weights of red, green
    /// and blue are those of Rec. 709. Luminances are cut off at ±1000.
    pub ssim: f64,
}

/// How two pictures differ, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Over associated channels in linear light, which are the picture over black.
    pub linear: Errors,
    /// Over the picture over black, each colour clamped to 0..=1 and taken to sRGB, and alpha clamped to 0..=1 as it is.
    ///
    /// Luminance is then the same weighted sum of the sRGB channels.
    pub srgb: Errors,
    /// An opaque map of each pixel's worst channel in linear light: black is equal, white is `linear.max`.
    ///
    /// The ramp between is proportional in linear light, so that sRGB on a screen lifts what is small. Equal pictures give
    /// black. Pixels that are not finite in one of the pictures are red.
    pub worst: Picture,
    /// Column and row of the (first) pixel that has `linear.max`.
    pub worst_at: [usize; 2],
    /// Pixels with a channel that is infinite or not a number, in the first and in the second picture.
    ///
    /// Where either has one, both count as empty in the structures, and the pixel is left out of everything else.
    pub non_finite: [usize; 2],
}

/// Compares two pictures of one size.
///
/// The error is a sentence: sizes differ, or there is no pixel that is finite in both.
pub fn compare(a: &Picture, b: &Picture) -> Result<Difference, String> {
    same_size(a, b)?;
    let pairs: Vec<Option<Pair>> =
        a.pixels.par_iter().zip(b.pixels.par_iter()).map(finite).collect();
    let count = pairs.iter().flatten().count();
    if count == 0 {
        return Err("no pixel is finite in both pictures; there is nothing to compare".to_owned());
    }
    let linear = errors(&pairs, a.size, count);
    let encoded: Vec<Option<Pair>> =
        pairs.par_iter().map(|pair| pair.map(|pair| pair.map(encode))).collect();
    let place =
        pairs.iter().position(|pair| pair.is_some_and(|pair| worst_channel(pair) >= linear.max));
    let place = place.unwrap_or(0);
    let broken =
        |picture: &Picture| picture.pixels.iter().filter(|pixel| !is_finite(pixel)).count();
    Ok(Difference {
        linear,
        srgb: errors(&encoded, a.size, count),
        worst: map(&pairs, a.size, linear.max)?,
        worst_at: [place % a.size[0], place / a.size[0]],
        non_finite: [broken(a), broken(b)],
    })
}

/// A pixel of the first picture and the same of the second, both finite.
type Pair = [[f32; 4]; 2];

fn same_size(a: &Picture, b: &Picture) -> Result<(), String> {
    let ([aw, ah], [bw, bh]) = (a.size, b.size);
    if a.size == b.size {
        return Ok(());
    }
    Err(format!(
        "the first picture has {aw} × {ah} pixels and the second {bw} × {bh}; only pictures of one size can be compared: render both with the same `size`"
    ))
}

fn is_finite(pixel: &[f32; 4]) -> bool {
    pixel.iter().all(|channel| channel.is_finite())
}

fn finite((a, b): (&[f32; 4], &[f32; 4])) -> Option<Pair> {
    (is_finite(a) && is_finite(b)).then_some([*a, *b])
}

/// A pixel over black in sRGB, and its alpha.
fn encode([r, g, b, alpha]: [f32; 4]) -> [f32; 4] {
    let [r, g, b] = [r, g, b].map(|channel| to_srgb(channel.clamp(0.0, 1.0)));
    [r, g, b, alpha.clamp(0.0, 1.0)]
}

fn differences([a, b]: Pair) -> [f64; 4] {
    std::array::from_fn(|channel| (f64::from(a[channel]) - f64::from(b[channel])).abs())
}

fn worst_channel(pair: Pair) -> f64 {
    differences(pair).into_iter().fold(0.0, f64::max)
}

fn luminance([r, g, b, _]: [f32; 4]) -> f64 {
    let luminance = 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
    luminance.clamp(-BRIGHTEST, BRIGHTEST)
}

/// The errors over `count` pairs that are there. Sums run in the order of the pixels, so that they are equal on any machine.
fn errors(pairs: &[Option<Pair>], size: [usize; 2], count: usize) -> Errors {
    let there = || pairs.iter().flatten();
    let max = there().map(|pair| worst_channel(*pair)).fold(0.0, f64::max);
    let squares: f64 = there().flat_map(|pair| differences(*pair)).map(|d| d * d).sum();
    let rmse = (squares / (4 * count) as f64).sqrt();
    let grey = |which: usize| -> Vec<f64> {
        pairs.iter().map(|pair| pair.map_or(0.0, |pair| luminance(pair[which]))).collect()
    };
    let psnr_db = if rmse == 0.0 { f64::INFINITY } else { -20.0 * libm::log10(rmse) };
    Errors { max, rmse, psnr_db, ssim: ssim(&grey(0), &grey(1), size) }
}

fn map(pairs: &[Option<Pair>], size: [usize; 2], white: f64) -> Result<Picture, String> {
    let pixel = |pair: &Option<Pair>| match pair {
        None => [1.0, 0.0, 0.0, 1.0],
        Some(_) if white == 0.0 => [0.0, 0.0, 0.0, 1.0],
        Some(pair) => {
            let grey = (worst_channel(*pair) / white) as f32;
            [grey, grey, grey, 1.0]
        }
    };
    Picture::new(size, pairs.iter().map(pixel).collect())
        .ok_or_else(|| "a picture has another number of pixels than its size".to_owned())
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "these values are exact")]
mod tests {
    use super::*;

    const SIZE: [usize; 2] = [37, 23];

    fn of(pixel: impl Fn(usize) -> [f32; 4]) -> Picture {
        Picture::new(SIZE, (0..SIZE[0] * SIZE[1]).map(pixel).collect()).unwrap()
    }

    fn waves(i: usize) -> [f32; 4] {
        let wave = |step: usize| 0.5 + 0.4 * libm::sinf((i * step) as f32 * 0.07);
        [wave(1), wave(3), wave(7), 1.0]
    }

    /// `waves` and a noise of `strength` at the most, by a fixed sequence.
    fn noisy(strength: f32) -> Picture {
        of(|i| waves(i).map(|c| c + strength * ((i * 7919 % 1009) as f32 / 504.5 - 1.0)))
    }

    #[test]
    fn equal_pictures_have_no_error_and_a_similarity_of_exactly_1() {
        let found = compare(&of(waves), &of(waves)).unwrap();
        let none = Errors { max: 0.0, rmse: 0.0, psnr_db: f64::INFINITY, ssim: 1.0 };
        assert_eq!((found.linear, found.srgb, found.non_finite), (none, none, [0, 0]));
        assert!(found.worst.pixels.iter().all(|p| *p == [0.0, 0.0, 0.0, 1.0]));
    }

    #[test]
    fn a_constant_offset_is_its_own_rmse_and_psnr() {
        for offset in [0.5_f32, 0.125, 1.0 / 1024.0] {
            let found = compare(&of(|_| [0.25; 4]), &of(|_| [0.25 + offset; 4])).unwrap().linear;
            let offset = f64::from(offset);
            assert_eq!((found.max, found.rmse), (offset, offset));
            assert!((found.psnr_db + 20.0 * offset.log10()).abs() < 1e-12);
        }
    }

    #[test]
    fn errors_in_srgb_are_those_that_a_screen_shows() {
        let dark =
            compare(&of(|_| [0.0, 0.0, 0.0, 1.0]), &of(|_| [0.01, 0.01, 0.01, 1.0])).unwrap();
        assert!(
            (dark.srgb.max - 0.099_85).abs() < 1e-4,
            "0.01 is 0.09985 in sRGB: {}",
            dark.srgb.max
        );
        let three_of_four = f64::from(3.0_f32).sqrt() / 2.0;
        assert!((dark.srgb.rmse - dark.srgb.max * three_of_four).abs() < 1e-9);
        let bright = compare(&of(|_| [1.0; 4]), &of(|_| [3.0, 3.0, 3.0, 1.0])).unwrap();
        assert_eq!((bright.srgb.max, bright.linear.max), (0.0, 2.0));
    }

    #[test]
    fn similarity_falls_with_noise() {
        let similarity = |strength| compare(&of(waves), &noisy(strength)).unwrap().linear.ssim;
        let falling: Vec<f64> = [0.0, 0.01, 0.05, 0.2, 0.5].map(similarity).to_vec();
        assert!(falling.windows(2).all(|w| w[1] < w[0]), "{falling:?}");
        assert!(falling[1] > 0.99 && falling[4] < 0.6, "{falling:?}");
    }

    #[test]
    fn the_map_is_white_where_the_worst_is_and_proportional_elsewhere() {
        let mut pixels = of(waves).pixels.to_vec();
        pixels[5 * 37 + 4][1] -= 0.25;
        pixels[6 * 37 + 9][3] -= 0.125;
        let other = Picture::new(SIZE, pixels).unwrap();
        let found = compare(&of(waves), &other).unwrap();
        assert_eq!(found.worst_at, [4, 5]);
        assert_eq!(found.worst.pixel(4, 5), [1.0; 4]);
        assert!((found.worst.pixel(9, 6)[0] - 0.5).abs() < 1e-6);
    }

    #[test]
    fn pixels_that_are_not_finite_are_counted_and_shown_and_spoil_nothing() {
        let mut pixels = of(waves).pixels.to_vec();
        pixels[40][2] = f32::NAN;
        pixels[41][0] = f32::INFINITY;
        let broken = Picture::new(SIZE, pixels).unwrap();
        let found = compare(&of(waves), &broken).unwrap();
        assert_eq!((found.non_finite, found.linear.max, found.srgb.ssim), ([0, 2], 0.0, 1.0));
        assert_eq!(found.worst.pixel(3, 1), [1.0, 0.0, 0.0, 1.0]);
        assert!(compare(&broken, &noisy(0.1)).unwrap().linear.rmse.is_finite());
        assert!(
            compare(&of(|_| [f32::NAN; 4]), &broken).unwrap_err().contains("nothing to compare")
        );
    }

    #[test]
    fn pictures_of_two_sizes_are_not_compared() {
        let small = Picture::new([1, 1], vec![[0.0; 4]]).unwrap();
        assert!(
            compare(&small, &of(waves))
                .unwrap_err()
                .contains("1 × 1 pixels and the second 37 × 23")
        );
    }

    #[test]
    fn the_greatest_floats_do_not_overflow() {
        let found = compare(&of(|_| [f32::MAX; 4]), &of(|_| [f32::MIN; 4])).unwrap();
        assert!(
            found.linear.rmse.is_finite()
                && found.linear.psnr_db < -700.0
                && found.linear.ssim.is_finite()
        );
    }
}
