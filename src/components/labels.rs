//! `labels`: a segmentation gives each of its labels a color and an opacity, by itself or as mask and tint of a volume.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;

/// What the labels of a segmentation look like. Without `file` the volume itself holds the labels, and takes no `classify`;
/// with `file` they color and mask what the volume's `classify` lets be seen.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Labels {
    /// A volume of labels, looked for like the volume's own file; each voxel has the label that is nearest in the world.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// A table of colors in a file, of 3D Slicer (`.ctbl`) or ITK-SNAP.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colors: Option<String>,
    /// What labels look like, in place of what the file of colors says. Labels that neither names are clear; where there
    /// is neither, every label but 0 is opaque, in colors that are told apart.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub table: Vec<Label>,
    /// How wide boundaries are smoothed: the standard deviation of a Gaussian, voxels; 0 shows the voxels as steps.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 8.0))]
    pub smooth_voxels: f32,
    /// With `file`: what the opacity is multiplied by where there is no label, 0..=1; default 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub outside: Option<f32>,
}

/// How one label looks.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Label {
    /// The value of its voxels.
    pub label: u32,
    /// c_p; default: as the file of colors says, or one that is told apart from other labels'.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Color>,
    /// Opacity per opacity unit; as a mask: what the volume's own is multiplied by. 0..=1; default 1.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub opacity: f32,
}

fn one() -> f32 {
    1.0
}
