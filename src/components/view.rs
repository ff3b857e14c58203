//! `view`: an observer, at infinity or at a place, and the window that is seen (algorithm §1).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Color;

/// A view, parallel unless a field of view is stated. At azimuth 0 and elevation 0 the observer looks along +y (a patient in LPS is seen from the front).
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct View {
    /// Turn of the observer about +z through the focal point, degrees.
    pub azimuth: f64,
    /// Height of the observer above the xy plane, degrees, −90..=90.
    #[schemars(range(min = -90.0, max = 90.0))]
    pub elevation: f64,
    /// Turn of the picture about the line of sight, degrees.
    pub roll: f64,
    /// The world point in the middle of the window; default: the centre of the scene's bounding box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub focal_point: Option<[f64; 3]>,
    /// Height of the window in world units, above 0; default: what the silhouette of the scene's bounding box fits into, with
    /// 5 % left free on each side.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub height_mm: Option<f64>,
    /// Vertical field of view, degrees, above 0 and below 180: a perspective view. `height_mm` is what it holds at the focal
    /// point, so that a change of it moves the eye and zooms together; absent: a parallel view.
    ///
    /// Highlights and head lights are those of an observer far away on the line of sight, in perspective too, so that voxels
    /// are shaded once.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = 180.0))]
    pub field_of_view: Option<f64>,
    /// Pixels across and down, each 1 to 16384.
    #[schemars(inner(range(min = 1, max = 16384)))]
    pub size: [u32; 2],
    /// What lies behind everything; default: nothing (transparent).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub background: Option<Color>,
}

impl Default for View {
    fn default() -> Self {
        Self {
            azimuth: 0.0,
            elevation: 0.0,
            roll: 0.0,
            focal_point: None,
            height_mm: None,
            field_of_view: None,
            size: [380, 380],
            background: None,
        }
    }
}
