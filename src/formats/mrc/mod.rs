//! MRC and CCP4 maps: densities of molecules on a crystal's cell or in a box.

mod cell;
mod header;
#[cfg(test)]
mod tests;

use std::path::Path;

use super::number::{self, Binary, NumberType};
use super::stream::Stream;
use super::survey::{Promise, of_size};
use super::{Loaded, Stated, Voxels};
use crate::shared::Shared;
use crate::volume::grid::Scalars;
use half::f16;
use header::{Header, Mode};

/// Whether a file starts as a map.
pub(super) fn recognizes(head: &[u8]) -> bool {
    head.get(208..212) == Some(b"MAP ")
}

/// Reads the header and the voxels after it and after its symmetry records.
///
/// Coordinates stay those of the map (Å, right-handed): a model of the same structure lies in its density. The voxels
/// stay in the file's order, columns fastest; where columns are not the cell's first axis (MAPCRS) the affine's columns
/// say so, and no voxel is moved.
pub(super) fn read(mut stream: Stream, _: &Path, stated: &Stated) -> Result<Loaded, String> {
    let header = Header::read(&mut stream)?;
    let mut warnings = Vec::new();
    let placed = cell::affine(&header, &mut warnings);
    let grid = stated.grid(header.size, placed)?;
    stream.skip_bytes(header.symmetry_bytes)?;
    let mut source = Binary { stream: &mut stream, order: header.order };
    let mut of = |kind| number::scalars(&mut source, kind, grid.voxels());
    let scalars = match header.mode {
        Mode::Number(kind) => of(kind)?,
        Mode::Half => widened(of(NumberType::U16)?),
    };
    warnings.extend(stream.finish()?);
    Ok(Loaded { grid, voxels: Voxels::Scalars(scalars), warnings })
}

/// Bytes of the voxels that a header promises, with the floats that halves become.
pub(super) fn promised(stream: &mut Stream, _: &Path, _: &Stated) -> Result<Promise, String> {
    let header = Header::read(stream)?;
    let each = match header.mode {
        Mode::Number(kind) => kind.bytes(),
        Mode::Half => size_of::<u16>() + size_of::<f32>(),
    };
    Ok((of_size(header.size, each), Vec::new()))
}

/// Half floats, read as their bits, as floats; each is exact.
fn widened(bits: Scalars) -> Scalars {
    match bits {
        Scalars::U16(bits) => {
            let values = bits.iter().map(|&bits| f16::from_bits(bits).to_f32()).collect();
            Scalars::F32(Shared::new(values))
        }
        other => other,
    }
}
