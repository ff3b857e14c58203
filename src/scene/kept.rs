//! What one loading of a scene leaves for the next: voxels, pictures, meshes and molecules that were read, and what was made and measured
//! of them.
//!
//! Products are kept where their inputs are the very same arrays, so a scene that is loaded again with other numbers takes
//! over the arrays of the time before wherever what they were made of is stated as before.

use std::cell::OnceCell;
use std::collections::HashMap;
use std::path::PathBuf;

use crate::components::{Classify, Labels, Mesh, Molecule, Texture, Volume};
use crate::formats::Loaded;
use crate::measure::sigma::{Sigma, sigma};
use crate::polygon::face::{FaceColors, FaceOpacities, Faces};
use crate::polygon::smooth::StatedNormals;
use crate::polygon::texture::{OwnTextures, TexturePlaces};
use crate::view::picture::Picture;
use crate::volume::grid::{Grid, Scalars};
use crate::volume::labels::Tint;

/// Arrays that were read for a scene, to be taken over when it is loaded again with other values.
///
/// Files are taken to stay as they are: they are read the first time alone.
#[derive(Default)]
pub struct Kept {
    pub(super) volumes: HashMap<String, KeptVolume>,
    pub(super) pictures: HashMap<String, KeptPicture>,
    pub(super) meshes: HashMap<String, KeptMesh>,
    pub(super) molecules: HashMap<String, KeptMolecule>,
    pub(super) labels: HashMap<String, KeptLabels>,
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

/// The faces of an entity's mesh, of a file.
#[derive(Clone)]
pub(super) struct KeptMesh {
    pub stated: Mesh,
    /// Whether its normals were asked for, its places in a texture, and its own pictures.
    pub asked: [bool; 3],
    pub faces: Faces,
    pub colors: Option<FaceColors>,
    pub opacities: Option<FaceOpacities>,
    pub normals: Option<StatedNormals>,
    pub places: Option<TexturePlaces>,
    pub own: OwnTextures,
    pub files: Vec<PathBuf>,
}

/// The faces of an entity's molecule.
#[derive(Clone)]
pub(super) struct KeptMolecule {
    pub stated: Molecule,
    pub faces: Faces,
    pub colors: FaceColors,
    pub files: Vec<PathBuf>,
}

/// What an entity's labels are made into.
#[derive(Clone)]
pub(super) struct KeptLabels {
    pub stated: Labels,
    /// Where the voxels are that they belong to.
    pub grid: Grid,
    /// The labels, where they are the volume's own.
    pub own: Option<Scalars>,
    pub labeled: Labeled,
    pub files: Vec<PathBuf>,
}

/// Labels as what is seen of them.
#[derive(Clone)]
pub(super) struct Labeled {
    /// What is to be classified in place of labels by themselves, and how.
    pub classified: Option<(Scalars, Classify)>,
    pub tint: Tint,
    /// Whether any voxel has a label that is seen.
    pub is_seen: bool,
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
