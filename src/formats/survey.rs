//! What a volume file would take, from its header alone: before a voxel of it is read.

use std::path::PathBuf;

/// What a header says of the voxels that follow it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Survey {
    /// The file, and the data file that its header names, where it names one.
    pub files: Vec<PathBuf>,
    /// The most bytes that its voxels take in memory, inflated, while they are read.
    pub bytes: u64,
}

/// What a header promises: the bytes of its voxels in memory, and the data file that it names beside it.
pub(super) type Promise = (u64, Option<PathBuf>);

/// Bytes of voxels of `each` bytes.
pub(super) fn of_size(size: [usize; 3], each: usize) -> u64 {
    size.iter().fold(each as u64, |bytes, &n| bytes.saturating_mul(n as u64))
}
