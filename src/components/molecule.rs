//! `molecule`: the atoms of a file as faces among the density that they were built into.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;

/// A molecule from a PDB or mmCIF file, in the file's own coordinates (Å), which are those of its map.
///
/// Each atom is colored by its element, or where `surface` is stated with `color`, all by that.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Molecule {
    /// A path, relative to the scene's folder or to the data folder.
    pub file: String,
    /// How it is drawn; default `sticks`.
    #[serde(default)]
    pub style: MoleculeStyle,
    /// Radius of sticks and of the tube, Å, above 0; default 0.2 and 0.5. Of balls: what the radii of van der Waals are
    /// multiplied by; default 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub radius: Option<f64>,
    /// Whether water is drawn too.
    #[serde(default)]
    pub water: bool,
    /// Moves all atoms, world units: as far as the map's `center` moved its voxels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shift: Option<[f64; 3]>,
    /// The color of carbon; default: gray.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub carbon: Option<Color>,
}

/// How a molecule is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum MoleculeStyle {
    /// A rod for each bond, half of it in the color of either atom.
    #[default]
    Sticks,
    /// A ball for each atom.
    Balls,
    /// A tube along the alpha carbons of proteins and the phosphorus of nucleic acids, chain by chain.
    Tube,
}
