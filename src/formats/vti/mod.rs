//! VTK ImageData (`.vti`): an image of one piece, its points' values as text, base64 or raw bytes, plain or packed by zlib.

mod blocks;
mod tags;
#[cfg(test)]
mod tests;

use std::path::Path;

use glam::{DAffine3, DMat3, DVec3};

use super::nrrd::words::Words;
use super::number::{self, Binary, NumberType, Order};
use super::stream::Stream;
use super::survey::{Promise, of_size};
use super::{Loaded, Stated, Voxels};
use blocks::{Encoding, Written};
use tags::{Tag, tag};

/// What a file says of its image and of the values of its points.
struct Header<'b> {
    size: [usize; 3],
    placed: DAffine3,
    kind: NumberType,
    painted: bool,
    order: Order,
    /// Bytes of the lengths before packed or binary values.
    wide: bool,
    packed: bool,
    values: Values<'b>,
}

/// Where the values stand.
enum Values<'b> {
    Text(&'b [u8]),
    Bytes(&'b [u8], Encoding),
}

/// Whether a file starts as one of VTK's.
pub(super) fn recognizes(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    text.contains("<VTKFile") && text.contains("\"ImageData\"")
}

/// Reads the values that the image names its scalars, or its first; its world is taken as ours.
pub(super) fn read(mut stream: Stream, _: &Path, stated: &Stated) -> Result<Loaded, String> {
    let bytes = stream.rest()?;
    let header = Header::of(&bytes)?;
    let grid = stated.grid(header.size, header.placed)?;
    let count = grid.voxels();
    let voxels = match header.values {
        Values::Text(text) => {
            let mut stream = Stream::of(text.to_vec());
            let mut words = Words::new(&mut stream);
            voxels(&mut words, &header, count)?
        }
        Values::Bytes(bytes, encoding) => {
            let each = header.kind.bytes() * if header.painted { 4 } else { 1 };
            let width = if header.wide { 8 } else { 4 };
            let written = Written { encoding, order: header.order, width };
            let raw = if header.packed {
                blocks::inflated(bytes, written, count * each)?
            } else {
                blocks::plain(bytes, written, count * each)?
            };
            let mut stream = Stream::of(raw);
            voxels(&mut Binary { stream: &mut stream, order: header.order }, &header, count)?
        }
    };
    Ok(Loaded { grid, voxels, warnings: Vec::new() })
}

/// Bytes of the voxels that a header promises, unpacked and as numbers, and of the file.
pub(super) fn promised(stream: &mut Stream, _: &Path, _: &Stated) -> Result<Promise, String> {
    let bytes = stream.rest()?;
    let header = Header::of(&bytes)?;
    let each = header.kind.bytes() * if header.painted { 4 } else { 1 };
    let voxels = of_size(header.size, each).saturating_mul(2);
    Ok((voxels.saturating_add(bytes.len() as u64), Vec::new()))
}

fn voxels(
    source: &mut impl number::NumberSource,
    header: &Header,
    count: usize,
) -> Result<Voxels, String> {
    if header.painted {
        number::painted(source, header.kind, count)
    } else {
        number::scalars(source, header.kind, count).map(Voxels::Scalars)
    }
}

impl<'b> Header<'b> {
    fn of(bytes: &'b [u8]) -> Result<Self, String> {
        let file = tag(bytes, "VTKFile").ok_or("has no `VTKFile`; check that it is one")?;
        let image = tag(bytes, "ImageData").ok_or("has no `ImageData`; save the image alone")?;
        let packed = match file.attribute("compressor").as_deref() {
            None | Some("") => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                return Err(format!("is packed by {other}, and zlib is read; save it with zlib"));
            }
        };
        let array = values(image.rest)?;
        let word = array.attribute("type").unwrap_or_default();
        let components = array.attribute("NumberOfComponents").unwrap_or_else(|| "1".to_owned());
        let painted = match components.trim() {
            "1" => false,
            "4" => true,
            _ => {
                return Err(format!(
                    "its values have {components} components, and 1, or 4 for RGBA, is expected; save one alone"
                ));
            }
        };
        let (size, placed) = place(&image)?;
        Ok(Self {
            size,
            placed,
            kind: NumberType::named(&word)?,
            painted,
            order: if file.attribute("byte_order").as_deref() == Some("BigEndian") {
                Order::Big
            } else {
                Order::Little
            },
            wide: file.attribute("header_type").as_deref() == Some("UInt64"),
            packed,
            values: payload(&array, bytes)?,
        })
    }
}

/// The size of the whole, and where its first point is: its extent need not begin at 0.
fn place(image: &Tag) -> Result<([usize; 3], DAffine3), String> {
    let numbers = |key: &str, expected: usize| -> Result<Option<Vec<f64>>, String> {
        let Some(text) = image.attribute(key) else { return Ok(None) };
        let found: Option<Vec<f64>> =
            text.split_whitespace().map(|word| word.parse().ok()).collect();
        found.filter(|found| found.len() == expected).map(Some).ok_or_else(|| {
            format!("its `{key}` is \"{text}\", and {expected} numbers are expected; correct it")
        })
    };
    let extent = numbers("WholeExtent", 6)?.ok_or("its image states no `WholeExtent`; add it")?;
    let first = DVec3::new(extent[0], extent[2], extent[4]);
    let size = [0, 2, 4].map(|at| (extent[at + 1] - extent[at] + 1.0).max(0.0) as usize);
    let spacing = numbers("Spacing", 3)?.unwrap_or(vec![1.0; 3]);
    let origin = numbers("Origin", 3)?.unwrap_or(vec![0.0; 3]);
    let rows = numbers("Direction", 9)?;
    let directions = rows.and_then(|rows| rows.first_chunk::<9>().copied());
    let directions =
        directions.map_or(DMat3::IDENTITY, |rows| DMat3::from_cols_array(&rows).transpose());
    let three = |numbers: &[f64]| DVec3::new(numbers[0], numbers[1], numbers[2]);
    let matrix3 = directions * DMat3::from_diagonal(three(&spacing));
    Ok((size, DAffine3 { matrix3, translation: three(&origin) + matrix3 * first }))
}

/// The array of the points that the image calls its scalars, or the first.
fn values(image: &[u8]) -> Result<Tag<'_>, String> {
    let piece = tag(image, "Piece").ok_or("its image has no `Piece`; save it again")?;
    if tag(piece.rest, "Piece").is_some() {
        return Err("its image is in several pieces; save it in one".to_owned());
    }
    let none =
        "its image has no values of points; make point data of its cell data and save it again";
    let points = tag(piece.rest, "PointData").ok_or(none)?;
    let inner = tags::before(points.rest, b"</PointData").ok_or(none)?;
    let wanted = points.attribute("Scalars");
    let mut first = None;
    let mut rest = inner;
    while let Some(array) = tag(rest, "DataArray") {
        rest = array.rest;
        if wanted.is_some() && array.attribute("Name") == wanted {
            return Ok(array);
        }
        first = first.or(Some(array));
    }
    first.ok_or_else(|| none.to_owned())
}

fn payload<'b>(array: &Tag<'b>, file: &'b [u8]) -> Result<Values<'b>, String> {
    let damaged = "its values do not end; fetch the file again";
    let own = || tags::before(array.rest, b"<").ok_or(damaged);
    match array.attribute("format").as_deref() {
        Some("ascii") => Ok(Values::Text(own()?)),
        Some("binary") => Ok(Values::Bytes(own()?, Encoding::Base64)),
        Some("appended") => {
            let appended = tag(file, "AppendedData").ok_or(damaged)?;
            let encoding = match appended.attribute("encoding").as_deref() {
                Some("base64") => Encoding::Base64,
                _ => Encoding::Raw,
            };
            let start = appended.rest.iter().position(|&byte| byte == b'_').ok_or(damaged)?;
            let offset = array.attribute("offset").and_then(|text| text.trim().parse().ok());
            let offset: usize = offset.ok_or("its values have no `offset`; save it again")?;
            let bytes = appended.rest[start + 1..].get(offset..).ok_or(damaged)?;
            Ok(Values::Bytes(bytes, encoding))
        }
        _ => Err("its values state no `format` that is read; save it again".to_owned()),
    }
}
