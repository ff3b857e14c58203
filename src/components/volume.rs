//! `volume`: where the voxels come from and what their opacity means.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A volume of voxels: a file, or a phantom made by formula.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Volume {
    /// A path, relative to the scene's folder or to the data folder; or `phantom:NAME`.
    pub file: String,
    /// What is rendered, with a warning, where the file is not found: another path or `phantom:NAME`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stand_in: Option<String>,
    /// Thickness of the slab that a voxel's opacity is stated for, world units (u in equation 2); default: the smallest spacing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub opacity_unit_mm: Option<f64>,
    /// For a headerless file (`.raw`): voxels on each axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<[usize; 3]>,
    /// For a headerless file: its number type, as NRRD names it (`uint8`, `uint16`, `float`, …).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub voxel_type: Option<String>,
    /// For a headerless file of more than one byte a voxel: `little` or `big`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub endian: Option<String>,
    /// Spacing in world units that replaces the file's own, the first voxel staying where it is; negative flips the axis
    /// about the volume's centre. Like the keys of a headerless file it describes `file`, never the `stand_in`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing_mm: Option<[f64; 3]>,
    /// For a file of several channels (Zarr): which is read, 0 the first; default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channel: Option<usize>,
    /// For a file of several times (Zarr, NIfTI): which is read, 0 the first; default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<usize>,
    /// The world point that the middle of the volume is moved to, of the file and of the stand-in alike; default: where the file puts it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center: Option<[f64; 3]>,
    /// What is interpolated between voxels.
    #[serde(default)]
    pub reconstruct: Reconstruct,
}

/// What of a volume is interpolated between voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Reconstruct {
    /// Voxels are classified and shaded, and their colors and opacities interpolated, as in the paper.
    #[default]
    Colors,
    /// Scalars are interpolated, and classified and shaded where a ray samples them: sharp where the picture magnifies voxels.
    Values,
}

/// u of equation 2, resolved: the thickness in world units of the slab that a voxel's opacity is stated for, above 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpacityUnit(pub f64);
