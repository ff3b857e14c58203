//! TIFF files of several pages: a slice a page, in 8 to 64 bits, with ImageJ's spacing where its description says it.

use std::io::Cursor;
use std::path::Path;

use glam::{DAffine3, DVec3};
use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::number::{NumberType, Stored};
use super::stream::{Stream, room};
use super::survey::{Promise, of_size};
use super::{Loaded, Stated, Voxels};
use crate::volume::grid::Scalars;

/// No way of packing a page makes it so many times smaller: deflate's most is 1032.
const MOST_PACKED: u64 = 1100;

type Pages<'b> = Decoder<Cursor<&'b [u8]>>;

/// What every page of a stack is.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Page {
    size: [u32; 2],
    kind: NumberType,
}

/// Whether a file starts as TIFF or BigTIFF.
pub(super) fn recognizes(head: &[u8]) -> bool {
    [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|magic| head.starts_with(*magic))
}

/// Whether a file has more pages than one: else it is a picture.
pub(super) fn is_stack(path: &Path) -> bool {
    let file = std::fs::File::open(path).ok();
    let decoder = file.and_then(|file| Decoder::new(std::io::BufReader::new(file)).ok());
    decoder.is_some_and(|pages| pages.more_images())
}

/// Reads the pages from the first, which has z = 0.
pub(super) fn read(mut stream: Stream, _: &Path, stated: &Stated) -> Result<Loaded, String> {
    let bytes = stream.rest()?;
    let (page, count, spacing) = look_through(&bytes)?;
    let size = [page.size[0] as usize, page.size[1] as usize, count];
    let grid = stated.grid(size, DAffine3::from_scale(spacing.unwrap_or(DVec3::ONE)))?;
    let scalars = match page.kind {
        NumberType::U8 => pages::<u8>(&bytes, page, count),
        NumberType::I8 => pages::<i8>(&bytes, page, count),
        NumberType::U16 => pages::<u16>(&bytes, page, count),
        NumberType::I16 => pages::<i16>(&bytes, page, count),
        NumberType::U32 => pages::<u32>(&bytes, page, count),
        NumberType::I32 => pages::<i32>(&bytes, page, count),
        NumberType::U64 => pages::<u64>(&bytes, page, count),
        NumberType::I64 => pages::<i64>(&bytes, page, count),
        NumberType::F32 => pages::<f32>(&bytes, page, count),
        NumberType::F64 => pages::<f64>(&bytes, page, count),
    }?;
    let mut warnings = Vec::new();
    if spacing.is_none() && stated.spacing_mm.is_none() {
        warnings.push(
            "its description states no spacing of slices, and 1 is taken on each axis; state `spacing_mm`"
                .to_owned(),
        );
    }
    Ok(Loaded { grid, voxels: Voxels::Scalars(scalars), warnings })
}

/// Bytes of the voxels of all pages, and of the file that they are read from.
pub(super) fn promised(stream: &mut Stream, _: &Path, _: &Stated) -> Result<Promise, String> {
    let bytes = stream.rest()?;
    let (page, count, _) = look_through(&bytes)?;
    let [width, height] = page.size.map(|n| n as usize);
    let voxels = of_size([width, height, count], page.kind.bytes());
    Ok((voxels.saturating_add(bytes.len() as u64), Vec::new()))
}

fn wrong(error: impl std::fmt::Display) -> String {
    format!("cannot be read as TIFF ({error}); save it again, or fetch the file again")
}

fn open(bytes: &[u8]) -> Result<Pages<'_>, String> {
    Decoder::new(Cursor::new(bytes)).map_err(wrong)
}

/// What the pages are, how many there are, and the spacing that the first describes; nothing is decoded.
fn look_through(bytes: &[u8]) -> Result<(Page, usize, Option<DVec3>), String> {
    let mut pages = open(bytes)?;
    let first = page(&mut pages)?;
    let spacing = spacing(&mut pages);
    let mut count = 1;
    while pages.more_images() {
        pages.next_image().map_err(wrong)?;
        count += 1;
        let next = page(&mut pages)?;
        if next != first {
            return Err(format!(
                "its page {count} is {next:?} and its first {first:?}, and all pages of a stack are alike; save one stack alone"
            ));
        }
    }
    let [width, height] = first.size.map(|n| n as usize);
    let promised = of_size([width, height, count], first.kind.bytes());
    if promised > (bytes.len() as u64).saturating_mul(MOST_PACKED) {
        return Err(format!(
            "is truncated: its {count} pages need {promised} bytes, which its {} cannot hold; fetch the file again",
            bytes.len()
        ));
    }
    Ok((first, count, spacing))
}

fn page(pages: &mut Pages) -> Result<Page, String> {
    let (width, height) = pages.dimensions().map_err(wrong)?;
    let format = pages.find_tag_unsigned_vec::<u16>(Tag::SampleFormat).map_err(wrong)?;
    let format = format.and_then(|formats| formats.first().copied()).unwrap_or(1);
    let color = pages.colortype().map_err(wrong)?;
    let kind = match (color, format) {
        (ColorType::Gray(8), 1) => NumberType::U8,
        (ColorType::Gray(16), 1) => NumberType::U16,
        (ColorType::Gray(32), 1) => NumberType::U32,
        (ColorType::Gray(64), 1) => NumberType::U64,
        (ColorType::Gray(8), 2) => NumberType::I8,
        (ColorType::Gray(16), 2) => NumberType::I16,
        (ColorType::Gray(32), 2) => NumberType::I32,
        (ColorType::Gray(64), 2) => NumberType::I64,
        (ColorType::Gray(32), 3) => NumberType::F32,
        (ColorType::Gray(64), 3) => NumberType::F64,
        _ => {
            return Err(format!(
                "its pages are {color:?}, and gray ones of 8 to 64 bits are read; save one channel alone"
            ));
        }
    };
    Ok(Page { size: [width, height], kind })
}

/// ImageJ's: pixels a unit across and down, and the `spacing` of its description.
fn spacing(pages: &mut Pages) -> Option<DVec3> {
    let description = pages.get_tag_ascii_string(Tag::ImageDescription).unwrap_or_default();
    let mut lines = description.lines();
    let slices =
        lines.find_map(|line| line.strip_prefix("spacing="))?.trim().parse::<f64>().ok()?;
    let mut side = |tag| {
        let value = pages.find_tag(tag).ok()??;
        let tiff::decoder::ifd::Value::Rational(parts, of) = value else { return None };
        Some(f64::from(of) / f64::from(parts)).filter(|side| side.is_normal())
    };
    let spacing = DVec3::new(
        side(Tag::XResolution).unwrap_or(1.0),
        side(Tag::YResolution).unwrap_or(1.0),
        slices.abs(),
    );
    (spacing.is_finite() && slices != 0.0).then_some(spacing)
}

/// The voxels of all pages.
fn pages<T: Sample>(bytes: &[u8], page: Page, count: usize) -> Result<Scalars, String> {
    let voxels = page.size[0] as usize * page.size[1] as usize;
    let mut limits = Limits::default();
    limits.decoding_buffer_size = voxels * size_of::<T>();
    limits.intermediate_buffer_size = limits.decoding_buffer_size.max(1 << 20);
    let mut pages = open(bytes)?.with_limits(limits);
    let mut values: Vec<T> = Vec::new();
    for number in 0..count {
        if number > 0 {
            pages.next_image().map_err(wrong)?;
        }
        let decoded = pages.read_image().map_err(wrong)?;
        let slice = T::of(decoded).filter(|slice| slice.len() == voxels);
        let slice = slice.ok_or_else(|| wrong("a page is not as long as it says"))?;
        room(&mut values, slice.len())?;
        values.extend(slice);
    }
    Ok(T::scalars(values))
}

/// A number type as the decoder gives it.
trait Sample: Stored {
    fn of(decoded: DecodingResult) -> Option<Vec<Self>>;
}

macro_rules! sample {
    ($($kind:ty => $variant:ident),*) => {$(
        impl Sample for $kind {
            fn of(decoded: DecodingResult) -> Option<Vec<Self>> {
                match decoded {
                    DecodingResult::$variant(values) => Some(values),
                    _ => None,
                }
            }
        }
    )*};
}
sample!(u8 => U8, i8 => I8, u16 => U16, i16 => I16, u32 => U32, i32 => I32, u64 => U64, i64 => I64, f32 => F32, f64 => F64);

#[cfg(test)]
mod tests {
    use super::super::made::pages;
    use super::*;
    use tiff::encoder::{Rational, TiffEncoder, colortype};

    fn described() -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
        for page in 0..4 {
            let mut image = encoder.new_image::<colortype::Gray16>(3, 2).unwrap();
            let text = "ImageJ=1.53\nimages=4\nslices=4\nspacing=2.5\nunit=micron\n";
            image.encoder().write_tag(Tag::ImageDescription, text).unwrap();
            for tag in [Tag::XResolution, Tag::YResolution] {
                image.encoder().write_tag(tag, Rational { n: 2, d: 1 }).unwrap();
            }
            image.write_data(&[page * 100; 6]).unwrap();
        }
        bytes.into_inner()
    }

    fn of(bytes: Vec<u8>) -> Result<Loaded, String> {
        read(Stream::of(bytes), Path::new(""), &Stated::default())
    }

    #[test]
    fn pages_are_slices_at_the_spacing_that_imagej_describes() {
        let loaded = of(described()).unwrap();
        assert_eq!(loaded.grid.size, [3, 2, 4]);
        assert_eq!(loaded.grid.spacing(), DVec3::new(0.5, 0.5, 2.5));
        let Voxels::Scalars(Scalars::U16(values)) = loaded.voxels else { panic!("not u16") };
        assert_eq!((values[0], values[6], values[23]), (0, 100, 300));
        assert!(loaded.warnings.is_empty());
    }

    #[test]
    fn without_a_description_the_spacing_is_one_and_that_is_said() {
        let loaded = of(pages(2)).unwrap();
        assert!(loaded.warnings[0].contains("spacing_mm"));
        assert!(of(pages(1)).unwrap_err().contains("at least 2"));
    }
}
