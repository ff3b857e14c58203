//! The linear approximation of a light's falloff with distance: the divisor of equation 3.

use glam::DVec3;

use crate::volume::grid::Grid;

/// `k_1 + k_2 d`, with `d` the distance along the light from where it enters the volume's bounding sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Falloff {
    /// Unit vector along the light, away from it.
    along: DVec3,
    /// `along · p` of a point `p` at distance 0.
    enter: f64,
    k1: f64,
    k2: f64,
    /// The least and the greatest distance in the volume's domain; outside it the distance stops there.
    range: [f64; 2],
}

impl Falloff {
    /// The falloff of a light towards `toward` (unit vector) over the volumes on `grids`, at least one.
    ///
    /// `k_1 + k_2 d` must be finite and above 0 everywhere in them; the error is a sentence without a subject.
    pub fn new(grids: &[Grid], toward: DVec3, k1: f64, k2: f64) -> Result<Self, String> {
        let corners: Vec<_> = grids.iter().flat_map(Grid::corners).collect();
        let center = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let radius = corners.iter().map(|c| c.distance(center)).fold(0.0, f64::max);
        let along = -toward;
        let enter = along.dot(center) - radius;
        let distances = corners.iter().map(|c| along.dot(*c) - enter);
        let range =
            [distances.clone().fold(f64::INFINITY, f64::min), distances.fold(0.0, f64::max)];
        let falloff = Self { along, enter, k1, k2, range };
        for d in range {
            let divisor = falloff.divisor(d);
            if !(1e-12..=1e30).contains(&divisor) {
                return Err(format!(
                    "`casts_shadow` states the falloff 1 / ({k1} + {k2} d), whose divisor is {divisor:.3e} at distance {d:.3e} in the volume; choose `k1` and `k2` so that it is above 0 everywhere, by 1e-12 at least"
                ));
            }
        }
        Ok(falloff)
    }

    /// A light that does not fall off: equation 3 divides it by 1.
    pub const NONE: Self =
        Self { along: DVec3::ZERO, enter: 0.0, k1: 1.0, k2: 0.0, range: [0.0; 2] };

    /// Whether the light does not fall off: then every divisor is 1.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.k1 == 1.0 && self.k2 == 0.0
    }

    /// Distance `d` of a world point, before it is held within the volume.
    #[must_use]
    #[inline]
    pub fn distance(&self, world: DVec3) -> f64 {
        self.along.dot(world) - self.enter
    }

    /// `k_1 + k_2 d`, above 0.
    #[must_use]
    #[inline]
    pub(crate) fn divisor(&self, distance: f64) -> f64 {
        // A distance that is no number is the least.
        let held =
            if distance > self.range[0] { distance.min(self.range[1]) } else { self.range[0] };
        self.k1 + self.k2 * held
    }

    /// The least divisor in the volume.
    #[must_use]
    pub fn least(&self) -> f64 {
        self.divisor(self.range[0]).min(self.divisor(self.range[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        Grid::axis_aligned([11, 11, 11], [1.0; 3], [0.0; 3]).unwrap()
    }

    #[test]
    fn distance_counts_from_the_bounding_sphere_along_the_light() {
        let falloff = Falloff::new(&[grid()], DVec3::Z, 1.0, 0.5).unwrap();
        let radius = 75.0_f64.sqrt();
        assert!((falloff.distance(DVec3::splat(5.0)) - radius).abs() < 1e-12);
        let top = falloff.divisor(falloff.distance(DVec3::new(3.0, 4.0, 10.0)));
        assert!((top - (1.0 + 0.5 * (radius - 5.0))).abs() < 1e-12 && top == falloff.least());
        assert_eq!(falloff.divisor(-1e9), top);
    }

    #[test]
    fn a_falloff_that_reaches_zero_in_the_volume_is_refused() {
        let problem = |k1, k2| Falloff::new(&[grid()], DVec3::Z, k1, k2).unwrap_err();
        assert!(problem(1.0, -0.1).contains("above 0"));
        assert!(problem(0.0, 0.0).contains("k1"));
        assert!(problem(f64::NAN, 0.0).contains("NaN"));
        Falloff::new(&[grid()], DVec3::X, 1.0, -0.05).unwrap();
    }
}
