//! NIfTI-1 (`.nii`, `.nii.gz`): scalars, or RGBA voxels that are classified and shaded already.

mod header;
mod placement;
#[cfg(test)]
mod tests;

use std::path::Path;

use super::number::{self, Binary, NumberType, Stored};
use super::stream::Stream;
use super::survey::{Promise, of_size};
use super::{Loaded, Stated, Voxels};
use crate::shared::Shared;
use crate::volume::grid::Scalars;
use crate::with_scalars;
use header::{Header, LENGTH};

/// Whether a file starts as NIfTI-1 (or as its relatives, which [`read`] names as what they are).
pub(super) fn recognizes(head: &[u8]) -> bool {
    head.get(344..348).is_some_and(|magic| magic == b"n+1\0" || magic == b"ni1\0")
        || head.get(4..8).is_some_and(|magic| magic == b"n+2\0")
}

/// Reads the header and the voxels after it; its right, anterior, superior become left, posterior, superior.
pub(super) fn read(mut stream: Stream, _: &Path, stated: &Stated) -> Result<Loaded, String> {
    let header = Header::read(&mut stream)?;
    let mut warnings = Vec::new();
    let placed = placement::affine(&header, &mut warnings);
    let grid = stated.grid(header.size, placed)?;
    let (time, said) = stated.chosen("time", header.times, &[])?;
    warnings.extend(said);
    let each = of_size(header.size, header.kind.map_or(4, NumberType::bytes));
    stream.skip_bytes(header.voxel_offset - LENGTH as u64)?;
    stream.skip(each.saturating_mul(time as u64), "the times before its voxels")?;
    let mut source = Binary { stream: &mut stream, order: header.order };
    let voxels = match header.kind {
        None => number::painted(&mut source, NumberType::U8, grid.voxels())?,
        Some(kind) => {
            let scalars = number::scalars(&mut source, kind, grid.voxels())?;
            Voxels::Scalars(scaled(scalars, header.slope, header.intercept, &mut warnings))
        }
    };
    let after = (header.times - 1 - time) as u64;
    stream.skip(each.saturating_mul(after), "the times after its voxels")?;
    warnings.extend(stream.finish()?);
    Ok(Loaded { grid, voxels, warnings })
}

/// Bytes of the voxels that a header promises, with the floats that scaled values become.
pub(super) fn promised(stream: &mut Stream, _: &Path, _: &Stated) -> Result<Promise, String> {
    let header = Header::read(stream)?;
    let each = header.kind.map_or(4, NumberType::bytes);
    let scaled = header.kind.is_some() && (header.slope, header.intercept) != (1.0, 0.0);
    let each = if scaled { each + size_of::<f32>() } else { each };
    Ok((of_size(header.size, each), Vec::new()))
}

/// `slope · value + intercept` as 32-bit floats; the values themselves where that changes nothing.
fn scaled(scalars: Scalars, slope: f64, intercept: f64, warnings: &mut Vec<String>) -> Scalars {
    fn apply<T: Stored>(values: &[T], slope: f64, intercept: f64) -> Vec<f32> {
        values.iter().map(|value| (value.wide() * slope + intercept) as f32).collect()
    }
    #[allow(clippy::float_cmp, reason = "only the exact identity changes nothing")]
    if slope == 1.0 && intercept == 0.0 {
        return scalars;
    }
    warnings.push(format!(
        "its values are scaled, as its header says, by {slope} and {intercept} more, and kept as 32-bit floats"
    ));
    let values = with_scalars!(&scalars, values => apply(values, slope, intercept));
    Scalars::F32(Shared::new(values))
}
