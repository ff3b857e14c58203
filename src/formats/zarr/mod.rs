//! Zarr, versions 2 and 3, and OME-Zarr: a folder of chunks, with files of JSON that say what they are.
//!
//! Chunks are unpacked by `flate2`, `ruzstd` and `lz4_flex`, which are Rust alone and ask for no other crate; `zarrs`, which
//! reads more, asks for 150 and for libraries in C.

mod array;
mod axes;
mod bare;
mod blosc;
mod crc32c;
mod group;
#[cfg(test)]
mod hostile;
mod image;
mod json;
mod keys;
mod node;
mod packing;
mod shard;
mod shuffle;
mod source;
#[cfg(test)]
mod tests;
mod units;
mod unpack;
mod version2;
mod version3;

use std::path::{Path, PathBuf};

use half::f16;

use super::number::{self, NumberSource, NumberType};
use super::numpy::Element;
use super::survey::Promise;
use super::{Loaded, Stated, Voxels};
use crate::shared::Shared;
use crate::volume::grid::Scalars;
use array::Array;
use axes::View;
use bare::bare;
use group::only_volume;
use image::Image;
use node::{METADATA, Node};
use source::Source;

/// Whether a folder holds metadata of Zarr, or is named as if it did.
pub(super) fn recognizes(folder: &Path) -> bool {
    let named = folder.extension().is_some_and(|end| end.eq_ignore_ascii_case("zarr"));
    named || METADATA.iter().any(|name| folder.join(name).is_file())
}

/// The folder that a file of metadata is of.
pub(super) fn folder_of(file: &Path) -> Option<PathBuf> {
    let name = file.file_name()?.to_str()?;
    let folder = file.parent().filter(|folder| *folder != Path::new(""));
    let folder = folder.unwrap_or(Path::new(".")).to_owned();
    (METADATA.contains(&name) && file.is_file()).then_some(folder)
}

/// Reads an array, the finest level of an image, or the one volume of a group.
pub(super) fn read_folder(folder: &Path, stated: &Stated) -> Result<Loaded, String> {
    let (array, view) = opened(folder, stated)?;
    let grid = stated.grid(view.size, view.placed)?;
    let mut source = Source::of(&array, &view)?;
    let count = grid.voxels();
    let voxels = match array.element {
        Element::Number(kind) if view.axes.len() == 4 => number::painted(&mut source, kind, count)?,
        Element::Number(kind) => Voxels::Scalars(number::scalars(&mut source, kind, count)?),
        Element::Half => {
            let bits = source.array::<u16, u16>(count)?;
            let values = bits.into_iter().map(|bits| f16::from_bits(bits).to_f32()).collect();
            Voxels::Scalars(Scalars::F32(Shared::new(values)))
        }
    };
    let (read, expected) = (source.read, source.expected());
    let mut warnings = view.said;
    if read < expected {
        warnings.push(format!(
            "{} of its {expected} chunks are not there, and are its fill value, as the format has it",
            expected - read
        ));
    }
    Ok(Loaded { grid, voxels, warnings })
}

/// What the metadata promise, and the files of metadata and of chunks.
pub(super) fn promised_of_folder(folder: &Path, stated: &Stated) -> Result<Promise, String> {
    let (array, view) = opened(folder, stated)?;
    let source = Source::of(&array, &view)?;
    let bytes = source.bytes();
    let metadata = array.files.iter().filter(|file| file.is_file()).cloned();
    Ok((bytes, metadata.chain(source.found.into_iter().map(|chunk| chunk.path)).collect()))
}

/// The array that a folder stands for, and which of its numbers are voxels.
fn opened(folder: &Path, stated: &Stated) -> Result<(Array, View), String> {
    let inside = |path: &Path, problem: String| format!("its `{}` {problem}", path.display());
    match Node::read(folder)?.ok_or_else(nothing)? {
        Node::Array(array) => viewed(*array, Image::around(folder), stated),
        Node::Group(attributes) => {
            if let Some(image) = Image::of(&attributes)? {
                let level = folder.join(&image.levels[0]);
                let Some(Node::Array(array)) =
                    Node::read(&level).map_err(|problem| inside(&level, problem))?
                else {
                    return Err(inside(
                        &level,
                        "is no array; fetch it, or name another level".to_owned(),
                    ));
                };
                return viewed(*array, Some((image, 0)), stated);
            }
            // An image lists no image among its own, so this ends.
            let only = only_volume(folder)?;
            opened(&only, stated).map_err(|problem| inside(&only, problem))
        }
    }
}

fn nothing() -> String {
    format!("holds no {}; name the folder that does", METADATA[..3].join(", no "))
}

/// The voxels of an array, by what its image says of it or by its own attributes.
fn viewed(
    array: Array,
    image: Option<(Image, usize)>,
    stated: &Stated,
) -> Result<(Array, View), String> {
    if let Some((mut image, level)) = image {
        let axes = image.axes(level, array.shape.len())?;
        let mut view = View::of(axes, &array.shape, &image.labels, stated)?;
        view.said.splice(0..0, image.said);
        return Ok((array, view));
    }
    let shade = [NumberType::U8, NumberType::U16, NumberType::F32].map(Element::Number);
    if let ([z, y, x, 4], [], true) =
        (&array.shape[..], &array.names[..], shade.contains(&array.element))
    {
        let view = View::painted([*z, *y, *x, 4]);
        return Ok((array, view));
    }
    let said = "an array has no spacing, and 1 is taken on each axis; state `spacing_mm` (x, y, z)";
    let (axes, found) = bare(&array);
    let mut view = View::of(axes, &array.shape, &[], stated)?;
    let said = found.or_else(|| stated.spacing_mm.is_none().then(|| said.to_owned()));
    view.said.extend(said);
    Ok((array, view))
}
