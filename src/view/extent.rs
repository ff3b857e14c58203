//! How far a scene reaches: what a default view frames, and what its depths are measured against.

use glam::DVec3;

/// The bounding box of everything in a scene: the domain of its volume and the vertices of its polygons. World units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// The corner of least coordinates.
    pub low: DVec3,
    /// The corner of greatest coordinates.
    pub high: DVec3,
}

impl Extent {
    /// The bounding box of some points; `None` for no points.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        points.into_iter().fold(None, |extent, p| {
            let Self { low, high } = extent.unwrap_or(Self { low: p, high: p });
            Some(Self { low: low.min(p), high: high.max(p) })
        })
    }

    /// The box with a part of each side more at both its ends.
    #[must_use]
    pub fn grown(&self, part: f64) -> Self {
        let more = (self.high - self.low) * part;
        Self { low: self.low - more, high: self.high + more }
    }

    /// The middle of the box.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        (self.low + self.high) / 2.0
    }

    /// The eight corners of the box.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        let side = |bit: usize| if bit == 0 { self.low } else { self.high };
        std::array::from_fn(|i| DVec3::new(side(i & 1).x, side(i >> 1 & 1).y, side(i >> 2).z))
    }

    /// How many samples at that distance a ray through the whole scene has at the most.
    #[must_use]
    pub fn samples(&self, distance: f64) -> f64 {
        (2.0 * self.radius() / distance).ceil()
    }

    /// The radius of the box's bounding sphere.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.low.distance(self.high) / 2.0
    }
}
