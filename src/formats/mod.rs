//! Files in and out, one format a file; the tables here are where a new format is added.

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

/// What a scene states about a file: all of it for a headerless one, the spacing for any.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stated {
    /// Voxels on each axis.
    pub size: Option<[usize; 3]>,
    /// Number type, as NRRD names it.
    pub voxel_type: Option<String>,
    /// `little` or `big`.
    pub endian: Option<String>,
    /// Spacing in world units.
    pub spacing_mm: Option<[f64; 3]>,
}

/// Reads a volume of any known format.
pub fn read_volume(path: &Path, _stated: &Stated) -> Result<Loaded, Error> {
    Err(Error::file(path, "no format is known yet"))
}

/// Reads a picture of any known format, as linear associated RGBA.
pub fn read_picture(path: &Path) -> Result<Picture, Error> {
    Err(Error::file(path, "no format is known yet"))
}
