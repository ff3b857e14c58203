//! WebP without loss, as eight-bit sRGB with straight alpha: smaller than PNG, and read by every browser.

use std::io::Cursor;

use image::codecs::webp::{WebPDecoder, WebPEncoder};
use image::{DynamicImage, ExtendedColorType, ImageDecoder, Limits};

use super::encoded::{Alpha, from_codes, to_bytes};
use super::{MOST_PIXELS, Notes, Opened, PictureFormat, checked_size, whole, wrong};
use crate::formats::whole::{Failure, Sink};
use crate::view::picture::Picture;

/// The longest side that the format has room for, pixels.
const LONGEST_SIDE: usize = 16_384;

/// Read and written.
pub(crate) const FORMAT: PictureFormat = PictureFormat {
    name: "WebP",
    extensions: &["webp"],
    read: Some(read),
    size: Some(size),
    write: Some(write),
};

/// Writes color and alpha in eight bits, as a PNG has them; notes are left out.
pub fn write(sink: &mut dyn Sink, picture: &Picture, _: &Notes) -> Result<(), Failure> {
    let [width, height] = picture.size;
    if width.max(height) > LONGEST_SIDE {
        return Err(format!(
            "a WebP has sides of at most {LONGEST_SIDE} pixels, and these are {width} × {height}; choose .png"
        )
        .into());
    }
    let codes = to_bytes(picture);
    let mut bytes = Vec::new();
    WebPEncoder::new_lossless(&mut bytes).encode(
        &codes,
        width as u32,
        height as u32,
        ExtendedColorType::Rgba8,
    )?;
    Ok(sink.write_all(&bytes)?)
}

/// Eight-bit codes, once more as they are decoded and with an alpha that the file lacks.
fn size(file: &mut dyn Opened) -> Result<([usize; 2], u64), String> {
    let decoder = WebPDecoder::new(file).map_err(|error| wrong("WebP", error))?;
    let (width, height) = decoder.dimensions();
    Ok((checked_size(width.into(), height.into())?, 12))
}

/// Reads a picture, with losses or without; of an animation the first frame.
pub fn read(bytes: &[u8]) -> Result<Picture, String> {
    // The decoder does without the end of what is cut short.
    let stated = bytes.get(4..8).and_then(|four| four.first_chunk()).copied();
    if stated.is_none_or(|stated| (u32::from_le_bytes(stated) as usize) + 8 > bytes.len()) {
        return Err(wrong("WebP", "it is shorter than it says"));
    }
    let mut decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(|e| wrong("WebP", e))?;
    let (width, height) = decoder.dimensions();
    let size = checked_size(width.into(), height.into())?;
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MOST_PIXELS * 4);
    decoder.set_limits(limits).map_err(|error| wrong("WebP", error))?;
    let image = DynamicImage::from_decoder(decoder).map_err(|error| wrong("WebP", error))?;
    whole(size, from_codes(image.into_rgba8().as_raw(), 4, u8::MAX, Alpha::Straight))
}
