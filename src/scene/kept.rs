//! What one loading of a scene leaves for the next: voxels and pictures that were read, and what was measured of them.
//!
//! Products are kept where their inputs are the very same arrays, so a scene that is loaded again with other numbers takes
//! over the arrays of the time before wherever what they were made of is stated as before.

use std::cell::OnceCell;
use std::collections::HashMap;
use std::path::PathBuf;

use crate::components::{Texture, Volume};
use crate::formats::Loaded;
use crate::measure::sigma::{Sigma, sigma};
use crate::view::picture::Picture;
use crate::volume::grid::Scalars;

/// Arrays that were read for a scene, to be taken over when it is loaded again with other values.
///
/// Files are taken to stay as they are: they are read the first time alone.
#[derive(Default)]
pub struct Kept {
    pub(super) volumes: HashMap<String, KeptVolume>,
    pub(super) pictures: HashMap<String, KeptPicture>,
    measured: Vec<(Scalars, OnceCell<Option<Sigma>>)>,
}

/// The voxels of an entity.
#[derive(Clone)]
pub(super) struct KeptVolume {
    pub stated: Volume,
    pub loaded: Loaded,
    pub stands_in: bool,
    pub files: Vec<PathBuf>,
}

/// The picture of an entity.
#[derive(Clone)]
pub(super) struct KeptPicture {
    pub stated: Texture,
    pub picture: Picture,
    pub files: Vec<PathBuf>,
}

impl Kept {
    /// [`sigma`] of some voxels, computed once.
    pub(super) fn sigma(&mut self, scalars: &Scalars) -> Option<Sigma> {
        let found = self.measured.iter().position(|(measured, _)| measured == scalars);
        let at = found.unwrap_or_else(|| {
            self.measured.push((scalars.clone(), OnceCell::new()));
            self.measured.len() - 1
        });
        *self.measured[at].1.get_or_init(|| sigma(scalars))
    }
}
