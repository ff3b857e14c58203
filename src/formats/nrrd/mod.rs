//! NRRD, attached and detached: scalars of every type, or RGBA voxels that are classified and shaded already.

mod header;
mod placement;
#[cfg(test)]
mod tests;
pub(super) mod words;
mod write;

use std::path::Path;

use super::data_file;
use super::number::{self, Binary, Order};
use super::stream::Stream;
use super::survey::{Promise, of_size};
use super::{Loaded, Stated, Voxels};
use header::{Encoding, Header, Skip};
use words::Words;
pub(super) use write::write;

/// Whether a file starts as NRRD.
pub(super) fn recognizes(head: &[u8]) -> bool {
    head.starts_with(b"NRRD")
}

/// Reads the header, and the voxels after it or in the file that it names, relative to its own folder.
pub(super) fn read(mut stream: Stream, path: &Path, stated: &Stated) -> Result<Loaded, String> {
    let header = Header::read(&mut stream)?;
    let mut warnings = Vec::new();
    let placed = placement::affine(&header, &mut warnings)?;
    let grid = stated.grid(header.size, placed)?;
    let numbers = grid.voxels() * if header.painted { 4 } else { 1 };
    let (voxels, excess) =
        data_file::read(stream, (path, header.data_file.as_deref()), |stream| {
            voxels(stream, &header, numbers)
        })?;
    warnings.extend(excess);
    Ok(Loaded { grid, voxels, warnings })
}

/// Bytes of the voxels that a header promises, and the data file that it names.
pub(super) fn promised(stream: &mut Stream, path: &Path, _: &Stated) -> Result<Promise, String> {
    let header = Header::read(stream)?;
    let each = header.kind.bytes() * if header.painted { 4 } else { 1 };
    let beside = header.data_file.as_deref().map(|name| data_file::beside(path, name));
    Ok((of_size(header.size, each), beside.into_iter().collect()))
}

/// The voxels of a stream that stands at the start of its data, and a warning where bytes are left over.
fn voxels(
    mut stream: Stream,
    header: &Header,
    numbers: usize,
) -> Result<(Voxels, Option<String>), String> {
    stream.skip_lines(header.line_skip)?;
    if header.encoding == Encoding::Gzip {
        stream = stream.inflated();
    }
    match header.byte_skip {
        Skip::Bytes(bytes) => stream.skip_bytes(bytes)?,
        Skip::ToLast => stream.skip_to_last((numbers * header.kind.bytes()) as u64)?,
    }
    let voxels = match header.encoding {
        Encoding::Text => decoded(&mut Words::new(&mut stream), header, numbers)?,
        Encoding::Raw | Encoding::Gzip => {
            let order = order(header)?;
            decoded(&mut Binary { stream: &mut stream, order }, header, numbers)?
        }
    };
    let excess = match header.encoding {
        Encoding::Text => Words::new(&mut stream).finish()?,
        Encoding::Raw | Encoding::Gzip => stream.finish()?,
    };
    Ok((voxels, excess))
}

fn decoded(
    source: &mut impl number::NumberSource,
    header: &Header,
    numbers: usize,
) -> Result<Voxels, String> {
    if header.painted {
        number::painted(source, header.kind, numbers / 4)
    } else {
        number::scalars(source, header.kind, numbers).map(Voxels::Scalars)
    }
}

fn order(header: &Header) -> Result<Order, String> {
    match header.order {
        Some(order) => Ok(order),
        None if header.kind.bytes() == 1 => Ok(Order::Little),
        None => Err(format!(
            "its header lacks the field `endian`, which {:?} voxels need; add `endian: little` or `endian: big`",
            header.kind
        )),
    }
}
