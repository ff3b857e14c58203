//! What a volume file would take, from its header alone: before a voxel of it is read.

use std::path::{Path, PathBuf};

use super::number::NumberType;
use super::stream::Stream;
use super::{HEAD, Stated, by_name, mrc, nifti, nrrd};
use crate::error::Error;

/// What a header says of the voxels that follow it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Survey {
    /// The file, and the data file that its header names, where it names one.
    pub files: Vec<PathBuf>,
    /// The most bytes that its voxels take in memory, inflated, while they are read.
    pub bytes: u64,
}

/// Surveys a volume of any format in [`super::FORMATS`]; fails where the header cannot be read.
pub fn survey(path: &Path, stated: &Stated) -> Result<Survey, Error> {
    Stream::open(path)
        .and_then(|stream| of_stream(stream, path, stated))
        .map_err(|problem| Error::file(path, problem))
}

fn of_stream(stream: Stream, path: &Path, stated: &Stated) -> Result<Survey, String> {
    let own = vec![path.to_owned()];
    if by_name(path).is_some_and(|format| format.recognizes.is_none()) {
        return Ok(Survey { files: own, bytes: raw(stated)? });
    }
    let mut stream = stream.inflated_if_gzip()?;
    let head = stream.peek(HEAD)?;
    if nrrd::recognizes(&head) {
        let (bytes, beside) = nrrd::promised(&mut stream, path)?;
        return Ok(Survey { files: own.into_iter().chain(beside).collect(), bytes });
    }
    let bytes = if nifti::recognizes(&head) {
        nifti::promised(&mut stream)?
    } else if mrc::recognizes(&head) {
        mrc::promised(&mut stream)?
    } else {
        0 // of no known format: whoever reads it says so
    };
    Ok(Survey { files: own, bytes })
}

/// The bytes of a headerless file as it is stated; where too little is stated, whoever reads it says so.
fn raw(stated: &Stated) -> Result<u64, String> {
    let (Some(size), Some(name)) = (stated.size, &stated.voxel_type) else { return Ok(0) };
    Ok(of_size(size, NumberType::named(name)?.bytes()))
}

/// Bytes of voxels of `each` bytes.
pub(super) fn of_size(size: [usize; 3], each: usize) -> u64 {
    size.iter().fold(each as u64, |bytes, &n| bytes.saturating_mul(n as u64))
}
