//! Files in and out, one format a file; the tables here are where a new format is added.

pub mod pictures;
pub mod whole;

use std::path::Path;

use crate::error::Error;
use crate::grid::{Grid, Painted, Scalars};
use crate::picture::Picture;

/// What a volume file held: where its voxels are, and what they are.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// Where the voxels are.
    pub grid: Grid,
    /// What they are.
    pub voxels: Voxels,
    /// Sentences about what was repaired or guessed.
    pub warnings: Vec<String>,
}

/// The voxels of a file.
#[derive(Debug, Clone, PartialEq)]
pub enum Voxels {
    /// One number a voxel: to be classified and shaded.
    Scalars(Scalars),
    /// RGBA: classified and shaded already.
    Painted(Painted),
}

/// Reads a volume of any known format.
pub fn read_volume(path: &Path) -> Result<Loaded, Error> {
    Err(Error::file(path, "no format is known yet"))
}

/// Reads a picture of any known format, as linear associated RGBA.
pub fn read_picture(path: &Path) -> Result<Picture, Error> {
    pictures::read_picture(path)
}
