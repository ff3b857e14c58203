//! What a volume file would take, from its header alone: before a voxel of it is read.

use std::path::PathBuf;

/// What a header says of the voxels that follow it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Survey {
    /// The name of its format, as in `FORMATS`.
    pub format: &'static str,
    /// The file, and those that hold its voxels where it does not, or not alone.
    pub files: Vec<PathBuf>,
    /// The most bytes that its voxels take in memory, inflated, while they are read.
    pub bytes: u64,
}

/// What a header promises: the bytes of its voxels in memory, and the files beside it that hold them.
pub(super) type Promise = (u64, Vec<PathBuf>);

/// Bytes of voxels of `each` bytes.
pub(super) fn of_size(size: [usize; 3], each: usize) -> u64 {
    size.iter().fold(each as u64, |bytes, &n| bytes.saturating_mul(n as u64))
}
