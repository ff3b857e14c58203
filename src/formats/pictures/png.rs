//! PNG: written as 8-bit sRGB with straight alpha; read in every depth and kind, always as sRGB.

use std::io::Cursor;

use png::{
    BitDepth, ColorType, Decoder, Encoder, Limits, SrgbRenderingIntent, Transformations, chunk,
};

use super::bands;
use super::encoded::{Alpha, from_codes, to_bytes};
use super::{MOST_PIXELS, Notes, Opened, PictureFormat, checked_size, whole, wrong};
use crate::formats::whole::{Failure, Sink};
use crate::view::picture::Picture;

/// Read and written.
pub(crate) const FORMAT: PictureFormat = PictureFormat {
    name: "PNG",
    extensions: &["png"],
    read: Some(read),
    size: Some(size),
    write: Some(write),
};

/// Writes 8-bit RGBA, marked as sRGB, with each note as an `iTXt` chunk before the pixels, which all threads deflate.
pub fn write(sink: &mut dyn Sink, picture: &Picture, notes: &Notes) -> Result<(), Failure> {
    let mut encoder =
        Encoder::new(sink, u32::try_from(picture.size[0])?, u32::try_from(picture.size[1])?);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    for (name, text) in notes {
        encoder.add_itxt_chunk(name.clone(), text.clone())?;
    }
    let mut writer = encoder.write_header()?;
    for part in bands::zlib(&to_bytes(picture), picture.size[0] * 4, 4)? {
        writer.write_chunk(chunk::IDAT, &part)?;
    }
    Ok(writer.finish()?)
}

/// Reads grey, palette, RGB and RGBA of 1 to 16 bits; of an animation, the first picture. `gAMA` and profiles are not obeyed.
pub fn read(bytes: &[u8]) -> Result<Picture, String> {
    read_as(bytes, Alpha::Straight)
}

/// [`read`], but that alpha is no opacity: every pixel is opaque, in the color that it has where alpha would hide it.
pub(super) fn read_opaque(bytes: &[u8]) -> Result<Picture, String> {
    read_as(bytes, Alpha::Ignored)
}

fn read_as(bytes: &[u8], alpha: Alpha) -> Result<Picture, String> {
    let limits = Limits { bytes: MOST_PIXELS as usize * 8 };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let mut reader = decoder.read_info().map_err(|error| wrong("PNG", error))?;
    let (width, height) = reader.info().size();
    let size = checked_size(width.into(), height.into())?;
    let length = reader.output_buffer_size().ok_or_else(|| wrong("PNG", "it is too large"))?;
    let mut buffer = vec![0; length];
    let frame = reader.next_frame(&mut buffer).map_err(|error| wrong("PNG", error))?;
    reader.finish().map_err(|error| wrong("PNG", error))?;
    let channels = frame.color_type.samples();
    let pixels = if frame.bit_depth == BitDepth::Sixteen {
        let codes: Vec<u16> =
            buffer.as_chunks().0.iter().map(|pair| u16::from_be_bytes(*pair)).collect();
        from_codes(&codes, channels, u16::MAX, alpha)
    } else {
        from_codes(&buffer, channels, u8::MAX, alpha)
    };
    whole(size, pixels)
}

/// Codes of 16 bits are taken apart once more than those of 8.
fn size(file: &mut dyn Opened) -> Result<([usize; 2], u64), String> {
    let mut decoder = Decoder::new(file);
    let found = decoder.read_header_info().map_err(|error| wrong("PNG", error))?;
    let (width, height) = found.size();
    let a_pixel = if found.bit_depth == BitDepth::Sixteen { 16 } else { 4 };
    Ok((checked_size(width.into(), height.into())?, a_pixel))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encoded(color: ColorType, depth: BitDepth, palette: &[u8], data: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if !palette.is_empty() {
            encoder.set_palette(palette);
            encoder.set_trns([255, 0].as_slice());
        }
        encoder.write_header().unwrap().write_image_data(data).unwrap();
        bytes
    }

    #[test]
    fn grey_palette_rgb_and_deep_files_are_read_as_the_same_linear_light() {
        let white_and_black = [[1.0; 4], [0.0, 0.0, 0.0, 1.0]];
        let grey = encoded(ColorType::Grayscale, BitDepth::One, &[], &[0b1000_0000]);
        let rgb = encoded(ColorType::Rgb, BitDepth::Eight, &[], &[255, 255, 255, 0, 0, 0]);
        let deep = encoded(ColorType::Grayscale, BitDepth::Sixteen, &[], &[255, 255, 0, 0]);
        for file in [grey, rgb, deep] {
            assert_eq!(read(&file).unwrap().pixels[..], white_and_black);
        }
        let palette = encoded(ColorType::Indexed, BitDepth::Eight, &[0, 255, 0, 9, 9, 9], &[0, 1]);
        assert_eq!(read(&palette).unwrap().pixels[..], [[0.0, 1.0, 0.0, 1.0], [0.0; 4]]);
    }

    #[test]
    fn sixteen_bits_of_half_alpha_are_associated() {
        let codes = [65535_u16, 0, 32768, 32768, 0, 0, 0, 0].map(u16::to_be_bytes);
        let file = encoded(ColorType::Rgba, BitDepth::Sixteen, &[], codes.as_flattened());
        let [r, g, b, alpha] = read(&file).unwrap().pixel(0, 0);
        assert!((alpha - 0.500_008).abs() < 1e-6 && (r - alpha).abs() < 1e-6 && g.abs() < 1e-9);
        assert!(
            (b - 0.214_048 * alpha).abs() < 1e-5,
            "sRGB 0.500008 is 0.214048 in linear light, {b}"
        );
    }

    #[test]
    fn notes_are_international_text_in_the_order_given() {
        let picture = Picture::new([1, 1], vec![[0.0; 4]]).unwrap();
        let notes = [("scene", "földer/α.toml"), ("counts", "{\"rays\": 1}")]
            .map(|(n, t)| (n.to_owned(), t.to_owned()));
        let mut file = Cursor::new(Vec::new());
        write(&mut file, &picture, &notes).unwrap();
        let reader = Decoder::new(Cursor::new(file.into_inner())).read_info().unwrap();
        let found: Vec<_> = reader
            .info()
            .utf8_text
            .iter()
            .map(|c| (c.keyword.clone(), c.get_text().unwrap()))
            .collect();
        assert_eq!(found, notes);
    }
}
