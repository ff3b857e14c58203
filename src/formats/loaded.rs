//! What a volume file held, whatever its format.

use crate::volume::grid::{Grid, Painted, Scalars};

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
