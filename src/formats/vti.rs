//! VTK ImageData (`.vti`): an image of one piece, its points' values as text, base64 or raw bytes, plain or packed by zlib.

#[cfg(test)]
mod tests;

use std::path::Path;

use glam::{DAffine3, DMat3, DVec3};

use super::number::{self, NumberType};
use super::stream::Stream;
use super::survey::{Promise, of_size};
use super::vtk_file::{Tag, VtkFile, before, tag};
use super::{Loaded, Stated, Voxels};

/// What a file says of its image and of the values of its points.
struct Header<'b> {
    file: VtkFile<'b>,
    size: [usize; 3],
    placed: DAffine3,
    kind: NumberType,
    painted: bool,
    values: Tag<'b>,
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
    let mut source = header.file.source(&header.values, count * header.bytes_of_voxel())?;
    let voxels = if header.painted {
        number::painted(&mut source, header.kind, count)?
    } else {
        number::scalars(&mut source, header.kind, count).map(Voxels::Scalars)?
    };
    Ok(Loaded { grid, voxels, warnings: Vec::new() })
}

/// Bytes of the voxels that a header promises, unpacked and as numbers, and of the file.
pub(super) fn promised(stream: &mut Stream, _: &Path, _: &Stated) -> Result<Promise, String> {
    let bytes = stream.rest()?;
    let header = Header::of(&bytes)?;
    let voxels = of_size(header.size, header.bytes_of_voxel()).saturating_mul(2);
    Ok((voxels.saturating_add(bytes.len() as u64), Vec::new()))
}

impl<'b> Header<'b> {
    fn of(bytes: &'b [u8]) -> Result<Self, String> {
        let file = VtkFile::of(bytes)?;
        let image = tag(bytes, "ImageData").ok_or("has no `ImageData`; save the image alone")?;
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
        Ok(Self { file, size, placed, kind: NumberType::named(&word)?, painted, values: array })
    }

    fn bytes_of_voxel(&self) -> usize {
        self.kind.bytes() * if self.painted { 4 } else { 1 }
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
    let inner = before(points.rest, b"</PointData").ok_or(none)?;
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
