//! `clip`: parts of a volume that are taken away before it is seen or casts a shadow (the paper's figure 11).

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Half-spaces and a box that are cut out of a volume, in world coordinates.
///
/// The cut is band-limited: opacity falls from whole to none over one voxel, so that a cut face shows no stairs.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Clip {
    /// Planes `[a, b, c, d]`: what lies where `a x + b y + c z > d` is taken away.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub planes: Vec<[f64; 4]>,
    /// A box `[[x, y, z], [x, y, z]]` (two opposite corners) whose inside is taken away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub r#box: Option<[[f64; 3]; 2]>,
}

impl Clip {
    /// How far inside the kept part a point lies, world units; negative inside what is taken away.
    #[must_use]
    pub fn distance(&self, point: DVec3) -> f64 {
        self.faces(point).map(|(distance, _)| distance).fold(f64::INFINITY, f64::min)
    }

    /// For each plane, and for the nearest side of the box: how far on the kept side of it a point lies, world units, and
    /// the unit vector across it.
    pub fn faces(&self, point: DVec3) -> impl Iterator<Item = (f64, DVec3)> {
        let planes = self.planes.iter().map(move |&[a, b, c, d]| {
            let normal = DVec3::new(a, b, c);
            ((d - normal.dot(point)) / normal.length(), normal.normalize_or_zero())
        });
        let outside_box = self.r#box.map(|[p, q]| {
            let (low, high) = (DVec3::from(p).min(q.into()), DVec3::from(p).max(q.into()));
            let outside = (low - point).max(point - high);
            (outside.max_element(), DVec3::AXES[outside.max_position()])
        });
        planes.chain(outside_box)
    }

    /// [`distance`](Self::distance), and the unit vector out of the kept part through the plane or side that it is of; zero
    /// where nothing is taken away.
    #[must_use]
    pub fn nearest(&self, point: DVec3) -> (f64, DVec3) {
        let nothing = (f64::INFINITY, DVec3::ZERO);
        let nearer = |a: (f64, DVec3), b: (f64, DVec3)| if b.0 < a.0 { b } else { a };
        let (distance, across) = self.faces(point).fold(nothing, nearer);
        // Out of what is kept of a box is into it.
        let inward = |[p, q]: [[f64; 3]; 2]| (DVec3::from(p) + DVec3::from(q)) / 2.0 - point;
        let sides = self.planes.len();
        let of_box = self.faces(point).nth(sides).is_some_and(|side| side == (distance, across));
        match self.r#box.filter(|_| of_box) {
            Some(corners) => (distance, across * across.dot(inward(corners)).signum()),
            None => (distance, across),
        }
    }
}
