//! The pictures that materials of a mesh's file lay on its triangles: named or held there, and decoded when they are wanted.

use std::borrow::Cow;
use std::fs::File;
use std::io::{BufReader, Cursor};
use std::path::{Path, PathBuf};

use super::super::pictures::{Opened, Weight, read_held, weighed_held};
use super::super::stream::Stream;
use crate::components::Wrap;
use crate::components::color::to_srgb;
use crate::view::picture::Picture;

/// The most pictures of a file.
const MOST_PICTURES: usize = 1024;

/// A picture on triangles, as it is stored: none of it is decoded yet.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshPicture {
    /// What sentences call it.
    pub name: String,
    /// Where its bytes are.
    pub place: PicturePlace,
    /// What becomes of its alpha.
    pub alpha: PictureAlpha,
    /// What lies outside it: to its sides, and above and below.
    pub wrap: [Wrap; 2],
    /// A picture of its opacity beside it, if there is one; it lies where this one does.
    pub veil: Option<Box<MeshPicture>>,
}

/// Where the bytes of a picture are.
#[derive(Debug, Clone, PartialEq)]
pub enum PicturePlace {
    /// In a file of its own, which need not be there.
    Beside(PathBuf),
    /// In the file of the mesh.
    Within(Vec<u8>),
}

/// What the alpha of a picture does to a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PictureAlpha {
    /// Nothing: all of it is opaque.
    Ignored,
    /// It is the surface's opacity, times a factor in 0..=1.
    Opacity(f32),
    /// Times a factor it is held against a least value: what has less is not there, the rest is opaque.
    Cut {
        /// In 0..=1.
        factor: f32,
        /// Above 0.
        least: f32,
    },
    /// The picture is one of opacity, and white: as opaque as its alpha, or, where none of it is less than opaque, as it is bright.
    Veil,
}

impl MeshPicture {
    /// Pixels across and down, and what it takes in memory, by its header alone, without its veil.
    ///
    /// The error is a sentence without a subject: no such file, of no known format, damaged, too large.
    pub fn weighed(&self) -> Result<([usize; 2], Weight), String> {
        let (mut stored, length): (Box<dyn Opened>, u64) = match &self.place {
            PicturePlace::Within(bytes) => (Box::new(Cursor::new(&bytes[..])), bytes.len() as u64),
            PicturePlace::Beside(path) => {
                let found = path.metadata().ok().filter(std::fs::Metadata::is_file);
                let opened = found.and_then(|found| Some((File::open(path).ok()?, found.len())));
                let (file, length) = opened
                    .ok_or_else(|| format!("is not found at {}; put it there", path.display()))?;
                (Box::new(BufReader::new(file)), length)
            }
        };
        let (size, Weight { kept, passing }) =
            weighed_held(&mut *stored, Path::new(&self.name), length)?;
        // Other alpha takes its pixels once more.
        Ok((size, Weight { kept, passing: passing.max(kept) }))
    }

    /// Its pixels, their alpha as it counts, without its veil; errors as those of [`weighed`](Self::weighed).
    pub fn decoded(&self) -> Result<Picture, String> {
        let bytes = match &self.place {
            PicturePlace::Within(bytes) => Cow::Borrowed(&bytes[..]),
            PicturePlace::Beside(path) => Cow::Owned(Stream::open(path)?.rest()?),
        };
        let opaque = self.alpha == PictureAlpha::Ignored;
        Ok(self.alpha.taken(read_held(&bytes, Path::new(&self.name), opaque)?))
    }
}

impl PictureAlpha {
    /// How opaque a triangle is beside its picture, if it has one, whose corners have that mean alpha, 0..=1.
    ///
    /// A picture has the factor in it. One that is cut is cut by its own alpha; what its corners make less than the least
    /// value, whatever it may be, is not there.
    pub(super) fn seen(self, corners: f32, has_picture: bool) -> f32 {
        match self {
            Self::Opacity(_) if has_picture => corners,
            Self::Opacity(factor) => factor * corners,
            Self::Cut { factor, least } if factor * corners < least => 0.0,
            Self::Ignored | Self::Veil | Self::Cut { .. } => 1.0,
        }
    }

    /// What tells it from others, bit for bit.
    pub(super) fn key(self) -> [u32; 3] {
        match self {
            Self::Ignored => [0; 3],
            Self::Opacity(factor) => [1, factor.to_bits(), 0],
            Self::Cut { factor, least } => [2, factor.to_bits(), least.to_bits()],
            Self::Veil => [3, 0, 0],
        }
    }

    /// The picture with its alpha as it counts.
    fn taken(self, picture: Picture) -> Picture {
        let is_bright = picture.pixels.iter().all(|pixel| pixel[3] >= 1.0);
        let opaque = |[r, g, b, alpha]: [f32; 4]| {
            let share = if alpha > 0.0 { alpha } else { 1.0 };
            [r / share, g / share, b / share, 1.0]
        };
        let of = |pixel: [f32; 4]| match self {
            Self::Ignored => opaque(pixel),
            Self::Opacity(factor) => pixel.map(|channel| channel * factor),
            Self::Cut { factor, least } if pixel[3] * factor >= least => opaque(pixel),
            Self::Cut { .. } => [0.0; 4],
            // Files of whole numbers store opacities as they are, and not as light.
            Self::Veil if is_bright => [stored_mean(pixel); 4],
            Self::Veil => [pixel[3]; 4],
        };
        let is_as_it_was = match self {
            Self::Ignored => is_bright,
            Self::Opacity(factor) => factor >= 1.0,
            Self::Cut { .. } | Self::Veil => false,
        };
        let changed =
            || Picture::new(picture.size, picture.pixels.iter().copied().map(of).collect());
        if is_as_it_was { None } else { changed() }.unwrap_or(picture)
    }
}

/// The mean of a pixel's colors as files of whole numbers store them, 0..=1.
fn stored_mean([r, g, b, _]: [f32; 4]) -> f32 {
    let stored = |channel: f32| match channel {
        1.0.. => 1.0,
        0.0.. => to_srgb(channel),
        _ => 0.0,
    };
    (stored(r) + stored(g) + stored(b)) / 3.0
}

/// Adds a picture and tells its number; the error is the sentence about one too many.
pub(super) fn add_picture(
    pictures: &mut Vec<MeshPicture>,
    picture: MeshPicture,
) -> Result<u32, String> {
    if pictures.len() == MOST_PICTURES {
        return Err(format!(
            "it has more than {MOST_PICTURES} pictures, and the rest are left out; join them into fewer"
        ));
    }
    pictures.push(picture);
    Ok(pictures.len() as u32 - 1)
}

/// Keeps a sentence that has not been said yet.
pub(super) fn say_once(warnings: &mut Vec<String>, sentence: impl Into<String>) {
    let sentence = sentence.into();
    if !warnings.contains(&sentence) {
        warnings.push(sentence);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::components::color::to_linear;

    #[test]
    fn alpha_is_ignored_taken_or_cut() {
        let picture = || Picture::new([2, 1], vec![[0.2, 0.1, 0.0, 0.4], [0.6; 4]]).unwrap();
        let pixels = |alpha: PictureAlpha| alpha.taken(picture()).pixels.to_vec();
        assert_eq!(pixels(PictureAlpha::Ignored), [[0.5, 0.25, 0.0, 1.0], [1.0; 4]]);
        assert_eq!(pixels(PictureAlpha::Opacity(0.5)), [[0.1, 0.05, 0.0, 0.2], [0.3; 4]]);
        let cut = PictureAlpha::Cut { factor: 1.0, least: 0.5 };
        assert_eq!(pixels(cut), [[0.0; 4], [1.0; 4]]);
        assert_eq!(pixels(PictureAlpha::Veil), [[0.4; 4], [0.6; 4]]);
    }

    #[test]
    fn a_veil_without_alpha_is_as_opaque_as_its_stored_grey() {
        let grey = [to_linear(0.5), to_linear(0.5), to_linear(0.5), 1.0];
        let picture =
            Picture::new([3, 1], vec![grey, [0.0, 0.0, 0.0, 1.0], [f32::NAN, 7.0, 1.0, 1.0]]);
        let pixels = PictureAlpha::Veil.taken(picture.unwrap()).pixels;
        assert!((pixels[0][3] - 0.5).abs() < 1e-6 && pixels[1] == [0.0; 4]);
        assert!((pixels[2][3] - 2.0 / 3.0).abs() < 1e-6 && pixels[2][0] == pixels[2][3]);
    }

    #[test]
    fn the_alpha_of_corners_counts_beside_a_picture_as_without_one() {
        let seen = |alpha: PictureAlpha| {
            [1.0, 0.5].map(|corners| [false, true].map(|pictured| alpha.seen(corners, pictured)))
        };
        assert_eq!(seen(PictureAlpha::Ignored), [[1.0; 2]; 2]);
        assert_eq!(seen(PictureAlpha::Opacity(0.5)), [[0.5, 1.0], [0.25, 0.5]]);
        assert_eq!(seen(PictureAlpha::Cut { factor: 0.8, least: 0.5 }), [[1.0; 2], [0.0; 2]]);
    }
}
