//! JPEG, as sRGB, turned the way its camera was held. Written it is opaque, over black, and of no use to measure.

use std::io::Cursor;

use image::codecs::jpeg::{JpegDecoder, JpegEncoder};
use image::{DynamicImage, ExtendedColorType, ImageDecoder, Limits};

use super::encoded::{Alpha, from_codes, to_bytes};
use super::{MOST_PIXELS, Notes, Opened, PictureFormat, checked_size, whole, wrong};
use crate::formats::moving::opaque::over_black;
use crate::formats::whole::{Failure, Sink};
use crate::view::picture::Picture;

/// Of 100: losses are under what an eye sees.
const QUALITY: u8 = 95;

/// Read and written.
pub(crate) const FORMAT: PictureFormat = PictureFormat {
    name: "JPEG",
    extensions: &["jpg", "jpeg"],
    read: Some(read),
    size: Some(size),
    write: Some(write),
};

/// Writes color in eight bits, over black where the picture is clear; notes are left out.
pub fn write(sink: &mut dyn Sink, picture: &Picture, _: &Notes) -> Result<(), Failure> {
    let [width, height] = picture.size.map(u32::try_from);
    let codes = over_black(&to_bytes(picture));
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, QUALITY).encode(
        codes.as_flattened(),
        width?,
        height?,
        ExtendedColorType::Rgb8,
    )?;
    Ok(sink.write_all(&bytes)?)
}

/// Eight-bit codes, once more as they are turned, and coefficients of a progressive one.
fn size(file: &mut dyn Opened) -> Result<([usize; 2], u64), String> {
    let mut decoder = jpeg_decoder::Decoder::new(file);
    decoder.read_info().map_err(|error| wrong("JPEG", error))?;
    let found = decoder.info().ok_or_else(|| wrong("JPEG", "it states no size"))?;
    Ok((checked_size(found.width.into(), found.height.into())?, 12))
}

/// Reads grey and colour, baseline and progressive, opaque.
pub fn read(bytes: &[u8]) -> Result<Picture, String> {
    // The decoder fills what is missing with grey; a picture of half the file would be taken for the whole.
    if !is_ended(bytes) {
        return Err(wrong("JPEG", "its end is missing or it begins with other bytes"));
    }
    let mut decoder = JpegDecoder::new(Cursor::new(bytes)).map_err(|error| wrong("JPEG", error))?;
    let (width, height) = decoder.dimensions();
    checked_size(width.into(), height.into())?;
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MOST_PIXELS * 4);
    decoder.set_limits(limits).map_err(|error| wrong("JPEG", error))?;
    let orientation = decoder.orientation().map_err(|error| wrong("JPEG", error))?;
    let mut image = DynamicImage::from_decoder(decoder).map_err(|error| wrong("JPEG", error))?;
    image.apply_orientation(orientation);
    let image = image.into_rgb8();
    let size = checked_size(image.width().into(), image.height().into())?;
    whole(size, from_codes(image.as_raw(), 3, u8::MAX, Alpha::Straight))
}

/// Whether the segments of a JPEG run from its start marker to its end marker (ITU T.81, annex B).
fn is_ended(bytes: &[u8]) -> bool {
    let Some(mut rest) = bytes.strip_prefix(&[0xff, 0xd8]) else { return false };
    loop {
        // Entropy-coded data lies between markers: 0xff 0x00 is a value in it, 0xff 0xff a filled one.
        let Some(marker) = rest.windows(2).position(|w| w[0] == 0xff && !matches!(w[1], 0 | 0xff))
        else {
            return false;
        };
        let kind = rest[marker + 1];
        rest = &rest[marker + 2..];
        match kind {
            0xd9 => return true,
            0x01 | 0xd0..=0xd8 => {}
            _ => {
                let Some(&[high, low]) = rest.first_chunk::<2>() else { return false };
                let Some(after) = rest.get(usize::from(u16::from_be_bytes([high, low]))..) else {
                    return false;
                };
                rest = after;
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "these values are exact")]
mod tests {
    use super::*;

    #[test]
    fn an_even_grey_is_read_as_its_linear_light() {
        let mut bytes = Vec::new();
        let grey = image::GrayImage::from_pixel(20, 9, image::Luma([188]));
        image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 100)
            .encode_image(&grey)
            .unwrap();
        let picture = read(&bytes).unwrap();
        assert_eq!(picture.size, [20, 9]);
        assert!(
            picture
                .pixels
                .iter()
                .all(|p| (p[0] - 0.503).abs() < 0.01 && p[3] == 1.0 && p[0] == p[2])
        );
    }

    #[test]
    fn a_thumbnails_end_is_not_the_files_end() {
        let thumbnail =
            [0xff, 0xd8, 0xff, 0xe1, 0, 4, 0xff, 0xd9, 0xff, 0xda, 0, 2, 1, 2, 0xff, 0, 3];
        assert!(!is_ended(&thumbnail));
        assert!(is_ended(&[&thumbnail[..], &[0xff, 0xd9]].concat()));
    }
}
