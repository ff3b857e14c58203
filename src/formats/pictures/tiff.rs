//! TIFF: written as 32-bit floats, linear, with associated alpha; read in 8 and 16 bits (sRGB) and 32-bit floats (linear).

use std::borrow::Cow;
use std::io::Cursor;

use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::encoder::colortype::RGBA32Float;
use tiff::encoder::{Compression, DeflateLevel, TiffEncoder, TiffKind, TiffValue};
use tiff::tags::{ExtraSamples, Tag, Type};

use super::encoded::{Alpha, from_codes, from_floats};
use super::{MOST_PIXELS, Notes, Opened, PictureFormat, checked_size, whole, wrong};
use crate::formats::whole::{Failure, Sink};
use crate::view::picture::Picture;

/// Read and written.
pub(crate) const FORMAT: PictureFormat = PictureFormat {
    name: "TIFF",
    extensions: &["tiff", "tif"],
    read: Some(read),
    size: Some(size),
    write: Some(write),
};

/// From here on a file's offsets may not fit 32 bits: it is written as BigTIFF.
const BIG: usize = 0xf000_0000;

/// Writes deflated strips of float RGBA, alpha marked as associated; the notes are lines `name: text` of the image description.
pub fn write(sink: &mut dyn Sink, picture: &Picture, notes: &Notes) -> Result<(), Failure> {
    let notes: Vec<String> = notes.iter().map(|(name, text)| format!("{name}: {text}")).collect();
    let notes = notes.join("\n");
    if picture.pixels.len() * 16 + notes.len() < BIG {
        encode(TiffEncoder::new(sink)?, picture, &notes)
    } else {
        encode(TiffEncoder::new_big(sink)?, picture, &notes)
    }
}

fn encode<K: TiffKind>(
    encoder: TiffEncoder<&mut dyn Sink, K>,
    picture: &Picture,
    notes: &str,
) -> Result<(), Failure> {
    let mut encoder = encoder.with_compression(Compression::Deflate(DeflateLevel::Fast));
    let (width, height) = (u32::try_from(picture.size[0])?, u32::try_from(picture.size[1])?);
    let mut image = encoder.new_image::<RGBA32Float>(width, height)?;
    let tags = image.encoder();
    tags.write_tag(Tag::ExtraSamples, &[ExtraSamples::AssociatedAlpha.to_u16()][..])?;
    if !notes.is_empty() {
        tags.write_tag(Tag::ImageDescription, Utf8(notes))?;
    }
    Ok(image.write_data(picture.pixels.as_flattened())?)
}

/// Text as the bytes of UTF-8, which is what readers make of a description that is not ASCII.
struct Utf8<'a>(&'a str);

impl TiffValue for Utf8<'_> {
    const BYTE_LEN: u8 = 1;
    const FIELD_TYPE: Type = Type::ASCII;

    fn count(&self) -> usize {
        self.0.len() + 1
    }

    fn data(&self) -> Cow<'_, [u8]> {
        Cow::Owned([self.0.as_bytes(), &[0]].concat())
    }
}

/// Reads the first image: grey or RGB, with or without alpha, chunky.
///
/// Alpha of integers is straight unless the file says associated, alpha of floats associated unless it says straight.
pub fn read(bytes: &[u8]) -> Result<Picture, String> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MOST_PIXELS as usize * 16;
    limits.intermediate_buffer_size = limits.decoding_buffer_size;
    let decoder = Decoder::new(Cursor::new(bytes)).map_err(|error| wrong("TIFF", error))?;
    let mut decoder = decoder.with_limits(limits);
    let (width, height) = decoder.dimensions().map_err(|error| wrong("TIFF", error))?;
    let size = checked_size(width.into(), height.into())?;
    let channels = channels(&mut decoder)?;
    let extra = decoder.find_tag_unsigned_vec::<u16>(Tag::ExtraSamples);
    let extra = extra.map_err(|error| wrong("TIFF", error))?.unwrap_or_default();
    let alpha = |stated: ExtraSamples, then: Alpha, otherwise: Alpha| {
        if extra.first() == Some(&stated.to_u16()) { then } else { otherwise }
    };
    let codes = alpha(ExtraSamples::AssociatedAlpha, Alpha::Associated, Alpha::Straight);
    let floats = alpha(ExtraSamples::UnassociatedAlpha, Alpha::Straight, Alpha::Associated);
    let pixels = match decoder.read_image().map_err(|error| wrong("TIFF", error))? {
        DecodingResult::U8(samples) => from_codes(&samples, channels, u8::MAX, codes),
        DecodingResult::U16(samples) => from_codes(&samples, channels, u16::MAX, codes),
        DecodingResult::F32(samples) => from_floats(&samples, channels, floats),
        _ => return Err(unread("other integers or floats")),
    };
    whole(size, pixels)
}

/// Samples as they lie in the file, of up to four channels of floats.
fn size(file: &mut dyn Opened) -> Result<([usize; 2], u64), String> {
    let mut decoder = Decoder::new(file).map_err(|error| wrong("TIFF", error))?;
    let (width, height) = decoder.dimensions().map_err(|error| wrong("TIFF", error))?;
    Ok((checked_size(width.into(), height.into())?, 16))
}

/// Samples a pixel of an image of a kind that is read.
fn channels(decoder: &mut Decoder<Cursor<&[u8]>>) -> Result<usize, String> {
    let layout = decoder.image_buffer_layout().map_err(|error| wrong("TIFF", error))?;
    if layout.planes != 1 {
        return Err(unread("a plane for each channel"));
    }
    match decoder.colortype().map_err(|error| wrong("TIFF", error))? {
        ColorType::Gray(8 | 16 | 32) => Ok(1),
        ColorType::GrayA(8 | 16 | 32) => Ok(2),
        ColorType::RGB(8 | 16 | 32) => Ok(3),
        ColorType::RGBA(8 | 16 | 32) => Ok(4),
        other => Err(unread(&format!("{other:?}"))),
    }
}

fn unread(found: &str) -> String {
    format!(
        "is a TIFF of {found}; grey or RGB(A) of 8 or 16 bits or 32-bit floats is read: convert it"
    )
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "these values are exact")]
mod tests {
    use super::*;
    use tiff::encoder::colortype::{ColorType as Kind, Gray16, RGBA8};

    fn encoded<C: Kind>(samples: &[C::Inner], extra: Option<ExtraSamples>) -> Vec<u8>
    where
        [C::Inner]: TiffValue,
    {
        let mut file = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut file).unwrap();
        let mut image = encoder.new_image::<C>(1, 1).unwrap();
        if let Some(extra) = extra {
            image.encoder().write_tag(Tag::ExtraSamples, &[extra.to_u16()][..]).unwrap();
        }
        image.write_data(samples).unwrap();
        file.into_inner()
    }

    #[test]
    fn integers_are_srgb_and_straight_unless_the_file_says_associated() {
        let straight = encoded::<RGBA8>(&[255, 0, 0, 128], Some(ExtraSamples::UnassociatedAlpha));
        let associated = encoded::<RGBA8>(&[128, 0, 0, 128], Some(ExtraSamples::AssociatedAlpha));
        let half = 128.0 / 255.0;
        assert_eq!(read(&straight).unwrap().pixel(0, 0), [half, 0.0, 0.0, half]);
        assert_eq!(read(&associated).unwrap().pixel(0, 0), [half, 0.0, 0.0, half]);
        let grey = read(&encoded::<Gray16>(&[32768], None)).unwrap().pixel(0, 0);
        assert!((grey[1] - 0.214_048).abs() < 1e-5 && grey[3] == 1.0);
    }

    #[test]
    fn what_is_written_is_marked_as_associated_and_described() {
        let picture = Picture::new([1, 1], vec![[0.1, 0.2, 0.3, 0.4]]).unwrap();
        let mut file = Cursor::new(Vec::new());
        write(&mut file, &picture, &[("scene".to_owned(), "größe".to_owned())]).unwrap();
        let bytes = file.into_inner();
        let mut decoder = Decoder::new(Cursor::new(&bytes)).unwrap();
        assert_eq!(
            decoder.get_tag_u16_vec(Tag::ExtraSamples).unwrap(),
            [ExtraSamples::AssociatedAlpha.to_u16()]
        );
        assert!(bytes.windows(15).any(|w| w == "scene: größe\0".as_bytes()));
    }
}
