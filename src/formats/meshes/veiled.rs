//! A picture of color and one of its opacity beside it, as an OBJ may name two (`map_Kd`, `map_d`), made into one.

use std::borrow::Cow;

use glam::DVec2;

use crate::components::{TextureFilter, Wrap};
use crate::polygon::texture::{Footprint, MappedTexture};
use crate::view::picture::Picture;

/// A picture as opaque as it is times the alpha of its veil.
///
/// Both span the same square of a texture. It has as many pixels as the one of the two that has more, whose pixels stay as they
/// are; the other is interpolated linearly between the middles of its pixels, the outermost of which go on.
#[must_use]
pub(crate) fn veiled(color: &Picture, veil: &Picture) -> Option<Picture> {
    let count = |picture: &Picture| picture.size[0] * picture.size[1];
    let size = if count(veil) > count(color) { veil.size } else { color.size };
    let (color, veil) = (resized(color, size), resized(veil, size));
    let each = color.pixels.iter().zip(veil.pixels.iter());
    Picture::new(size, each.map(|(pixel, veil)| pixel.map(|channel| channel * veil[3])).collect())
}

/// A picture of another size.
fn resized(picture: &Picture, size: [usize; 2]) -> Cow<'_, Picture> {
    if picture.size == size {
        return Cow::Borrowed(picture);
    }
    let texture = MappedTexture::new(picture, Wrap::Clamp, TextureFilter::Bilinear);
    let point = Footprint::new(DVec2::ZERO, DVec2::ZERO);
    let [width, height] = size;
    let middle = |at: usize, count: usize| (at as f64 + 0.5) / count as f64;
    let places =
        (0..height).flat_map(|y| (0..width).map(move |x| (middle(x, width), middle(y, height))));
    let pixels = places.map(|(u, v)| texture.filtered(DVec2::new(u, v), &point).to_array());
    Picture::new(size, pixels.collect()).map_or(Cow::Borrowed(picture), Cow::Owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn greys(size: [usize; 2], values: &[f32]) -> Picture {
        Picture::new(size, values.iter().map(|&value| [value; 4]).collect()).unwrap()
    }

    #[test]
    fn pictures_of_one_size_are_multiplied_pixel_by_pixel() {
        let color = Picture::new([2, 1], vec![[0.5, 0.25, 0.0, 1.0], [0.25, 0.25, 0.0, 0.5]]);
        let made = veiled(&color.unwrap(), &greys([2, 1], &[0.5, 0.25])).unwrap();
        assert_eq!(made.pixels.to_vec(), [[0.25, 0.125, 0.0, 0.5], [0.0625, 0.0625, 0.0, 0.125]]);
    }

    #[test]
    fn the_smaller_of_two_is_interpolated_to_the_larger() {
        let (white, ramp) = (greys([4, 2], &[1.0; 8]), greys([2, 1], &[0.0, 1.0]));
        let expected = [0.0, 0.25, 0.75, 1.0, 0.0, 0.25, 0.75, 1.0].map(|value| [value; 4]);
        let veil_is_smaller = veiled(&white, &ramp).unwrap();
        assert_eq!(
            (veil_is_smaller.size, veil_is_smaller.pixels.to_vec()),
            ([4, 2], expected.to_vec())
        );
        // And the other way around: a fine veil keeps its pixels.
        let color_is_smaller = veiled(&ramp, &white).unwrap();
        assert_eq!(color_is_smaller.pixels.to_vec(), expected);
    }

    #[test]
    fn long_pictures_across_each_other_make_none_larger_than_either() {
        let made =
            veiled(&greys([4096, 1], &[1.0; 4096]), &greys([1, 4000], &[0.5; 4000])).unwrap();
        assert_eq!(made.size, [4096, 1]);
        assert!(made.pixels.iter().all(|pixel| pixel[3] == 0.5));
    }
}
