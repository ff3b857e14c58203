//! Pixels as files of 8 and 16 bits hold them: colours in sRGB, alpha linear and straight.

use std::sync::LazyLock;

use rayon::prelude::*;

use crate::components::color::{to_linear, to_srgb};
use crate::view::picture::Picture;

/// The 8-bit code of a linear, associated pixel: sRGB colours and straight alpha, each rounded to nearest.
///
/// Colours are divided by alpha and clamped to 0..=1, as is alpha. A pixel of alpha 0 (or NaN) has colour 0, a channel
/// that is NaN is 0.
#[must_use]
pub(crate) fn to_codes([r, g, b, alpha]: [f32; 4]) -> [u8; 4] {
    let visible = alpha > 0.0;
    let alpha = alpha.min(1.0);
    let code = |channel: f32| (channel * 255.0).round() as u8; // `as` takes NaN to 0 and saturates
    let color = |c: f32| if visible { CURVE.code((c / alpha).clamp(0.0, 1.0)) } else { 0 };
    [color(r), color(g), color(b), if visible { code(alpha) } else { 0 }]
}

/// The curve of sRGB in 8 bits.
static CURVE: LazyLock<ToneCurve> = LazyLock::new(ToneCurve::new);

/// sRGB codes looked up instead of computed: the curve rises, so each code is an interval of intensities.
struct ToneCurve {
    /// The least intensity of each code; beyond the last, none.
    least: [f32; 257],
    /// The code of the least intensity in each of equal parts of 0..=1.
    first: [u8; PARTS + 1],
}

/// So many that a part holds the borders of two codes at the most, at the steep foot of the curve.
const PARTS: usize = 4096;

impl ToneCurve {
    fn new() -> Self {
        let code = |intensity: f32| (to_srgb(intensity) * 255.0).round() as u8;
        let mut least = [f32::INFINITY; 257];
        for (wanted, least) in (0..=255_u8).zip(&mut least) {
            // Floats from 0 up are in the order of their bits: halving finds the first of the code.
            let (mut low, mut high) = (0, 1.0_f32.to_bits());
            while low < high {
                let middle = u32::midpoint(low, high);
                if code(f32::from_bits(middle)) >= wanted {
                    high = middle;
                } else {
                    low = middle + 1;
                }
            }
            *least = f32::from_bits(low);
        }
        Self { least, first: std::array::from_fn(|part| code(part as f32 / PARTS as f32)) }
    }

    /// The code of an intensity in 0..=1; 0 for a NaN.
    fn code(&self, intensity: f32) -> u8 {
        let mut code = self.first[(intensity * PARTS as f32) as usize];
        while intensity >= self.least[usize::from(code) + 1] {
            code += 1;
        }
        code
    }
}

/// All pixels of a picture as `to_codes` has them, row by row from the top, four bytes a pixel.
#[must_use]
pub fn to_bytes(picture: &Picture) -> Vec<u8> {
    let mut bytes = vec![0; picture.pixels.len() * 4];
    let pairs = bytes.as_chunks_mut::<4>().0.par_iter_mut().zip(picture.pixels.par_iter());
    pairs.for_each(|(code, pixel)| *code = to_codes(*pixel));
    bytes
}

/// How the alpha of a file's pixels stands to their colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Alpha {
    /// Colours as if opaque.
    Straight,
    /// Colours multiplied by alpha, as they stand in the file.
    Associated,
    /// Something else than an opacity: every pixel is opaque, in the colour that stands in the file.
    Ignored,
}

/// Linear, associated pixels of sRGB codes in 0..=`white`, 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGBA) a pixel.
pub(super) fn from_codes<T: Copy + Into<u32>>(
    codes: &[T],
    channels: usize,
    white: T,
    kind: Alpha,
) -> Vec<[f32; 4]> {
    let full = white.into();
    let part = |code: u32| code as f32 / full as f32;
    let linear: Vec<f32> = (0..=full).map(|code| to_linear(part(code))).collect();
    let pixel = |sample: &[T]| {
        let [r, g, b, alpha] = rgba(sample, white).map(Into::into);
        let color = |code: u32| match kind {
            Alpha::Straight => linear[code as usize] * part(alpha),
            Alpha::Ignored => linear[code as usize],
            // Such files are multiplied in sRGB, so dividing comes before the curve.
            Alpha::Associated => {
                to_linear((code as f32 / alpha.max(1) as f32).min(1.0)) * part(alpha)
            }
        };
        [color(r), color(g), color(b), if kind == Alpha::Ignored { 1.0 } else { part(alpha) }]
    };
    codes.chunks_exact(channels).map(pixel).collect()
}

/// Linear, associated pixels of linear floats, 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGBA) a pixel.
pub(super) fn from_floats(values: &[f32], channels: usize, kind: Alpha) -> Vec<[f32; 4]> {
    let pixel = |sample: &[f32]| {
        let [r, g, b, alpha] = rgba(sample, 1.0);
        match kind {
            Alpha::Straight => [r * alpha, g * alpha, b * alpha, alpha],
            Alpha::Associated => [r, g, b, alpha],
            Alpha::Ignored => [r, g, b, 1.0],
        }
    };
    values.chunks_exact(channels).map(pixel).collect()
}

/// The four channels of one pixel that may have fewer.
fn rgba<T: Copy>(sample: &[T], opaque: T) -> [T; 4] {
    match *sample {
        [] => [opaque; 4],
        [grey] => [grey, grey, grey, opaque],
        [grey, alpha] => [grey, grey, grey, alpha],
        [r, g, b] => [r, g, b, opaque],
        [r, g, b, alpha, ..] => [r, g, b, alpha],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_those_computed_by_hand() {
        // 0.25 of opacity 0.5 is straight 0.5: 1.055 · 0.5^(1/2.4) − 0.055 = 0.73536, × 255 = 187.5; 0.1 is straight 0.2,
        // 0.48453 in sRGB, × 255 = 123.6; 0.001 is straight 0.002, below the knee: 0.02584 × 255 = 6.6.
        assert_eq!(to_codes([0.25, 0.1, 0.001, 0.5]), [188, 124, 7, 128]);
        assert_eq!(to_codes([1.0, 0.0, 0.215_9, 1.0]), [255, 0, 128, 255]);
    }

    #[test]
    fn codes_are_looked_up_as_the_curve_has_them() {
        let curve = |c: f32| (to_srgb(c) * 255.0).round() as u8;
        let borders =
            CURVE.least[..256].iter().flat_map(|c| [c.next_down().max(0.0), *c, c.next_up()]);
        let spread = (0..300_000).map(|i| i as f32 / 300_000.0);
        for intensity in borders.chain(spread).map(|c: f32| c.min(1.0)) {
            assert_eq!(CURVE.code(intensity), curve(intensity), "{intensity}");
        }
    }

    #[test]
    fn nothing_visible_has_colour_0_and_too_bright_or_not_a_number_stays_in_range() {
        assert_eq!(to_codes([0.3, 0.2, 0.1, 0.0]), [0; 4]);
        assert_eq!(to_codes([0.3, 0.2, 0.1, f32::NAN]), [0; 4]);
        assert_eq!(to_codes([9.0, f32::NAN, -1.0, 2.0]), [255, 0, 0, 255]);
        assert_eq!(to_codes([f32::INFINITY; 4]), [255; 4]);
    }

    #[test]
    fn every_code_of_every_alpha_above_0_survives_linear_light() {
        for alpha in 1..=255_u8 {
            let codes: Vec<[u8; 4]> = (0..=255).map(|c| [c, 255 - c, c / 2, alpha]).collect();
            let pixels = from_codes(codes.as_flattened(), 4, 255, Alpha::Straight);
            assert!(pixels.iter().map(|p| to_codes(*p)).eq(codes));
        }
    }

    #[test]
    fn associated_codes_are_divided_before_the_curve() {
        let straight = from_codes(&[200_u8, 100, 50, 255], 4, 255, Alpha::Straight)[0];
        let [r, g, b, alpha] = from_codes(&[100_u8, 50, 25, 128], 4, 255, Alpha::Associated)[0];
        for (associated, whole) in [r, g, b].iter().zip(straight) {
            assert!((associated / alpha - whole).abs() < 0.01);
        }
    }

    #[test]
    fn fewer_channels_are_grey_or_opaque() {
        assert_eq!(from_codes(&[255_u16 * 257], 1, u16::MAX, Alpha::Straight), [[1.0; 4]]);
        assert_eq!(from_floats(&[0.5, 0.5], 2, Alpha::Straight), [[0.25, 0.25, 0.25, 0.5]]);
        assert_eq!(from_floats(&[0.5, 0.2, 0.1], 3, Alpha::Associated), [[0.5, 0.2, 0.1, 1.0]]);
    }
}
