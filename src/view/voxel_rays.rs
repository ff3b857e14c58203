//! Rays through a volume's own voxels: a lattice of them, as it lies in the picture, and what they saw.

use glam::DVec2;

/// What rays saw that lie on a lattice of their own and not on that of the picture's positions.
#[derive(Debug, Clone, PartialEq)]
pub struct VoxelRays {
    /// Rays across and down.
    pub size: [usize; 2],
    /// C of each ray, linear associated RGBA, the first row first.
    pub colors: Vec<[f32; 4]>,
    /// Of each row: the first ray that met anything, and one past the last; none met anything where they are equal.
    pub met: Vec<[u32; 2]>,
    /// By how much the brightest ray is above its opacity, and 0 if none is: above 0 by strong lights.
    pub excess: f32,
    /// Where they are in the picture.
    pub places: LatticePlaces,
}

/// Where the middles of pixels lie on a lattice of rays: an affine map, counted in rays from the first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticePlaces {
    /// The middle of pixel (0, 0).
    pub first: DVec2,
    /// From a pixel to the next on its right.
    pub right: DVec2,
    /// From a pixel to the next below.
    pub down: DVec2,
}

impl LatticePlaces {
    /// Those of a map from window positions, in pixels from the top left corner, which is affine.
    #[must_use]
    pub fn of(place: impl Fn(DVec2) -> DVec2) -> Self {
        let first = place(DVec2::splat(0.5));
        let right = place(DVec2::new(1.5, 0.5)) - first;
        Self { first, right, down: place(DVec2::new(0.5, 1.5)) - first }
    }

    /// The place on the lattice of a window position, in pixels from the top left corner.
    #[must_use]
    pub fn at(&self, window: DVec2) -> DVec2 {
        self.first + self.right * (window.x - 0.5) + self.down * (window.y - 0.5)
    }

    /// The least and the greatest place of a window that reaches `margin` pixels beyond a picture of `size`.
    #[must_use]
    pub fn bounds(&self, size: [usize; 2], margin: f64) -> [DVec2; 2] {
        let [width, height] = size.map(|n| n as f64);
        let ends = [[-margin, -margin], [width + margin, -margin], [-margin, height + margin]];
        let corners = ends.into_iter().chain([[width + margin, height + margin]]);
        let places = corners.map(|corner| self.at(DVec2::from(corner)));
        places.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], place| {
            [low.min(place), high.max(place)]
        })
    }

    /// The window position of a place on the lattice; `None` where the lattice is seen from its edge.
    #[must_use]
    pub fn window(&self, place: DVec2) -> Option<DVec2> {
        let area = self.right.perp_dot(self.down);
        let from = place - self.first;
        let at = DVec2::new(from.perp_dot(self.down), self.right.perp_dot(from)) / area;
        at.is_finite().then(|| at + 0.5)
    }
}

impl VoxelRays {
    /// Whether any ray met anything, however faint.
    #[must_use]
    pub fn meet_anything(&self) -> bool {
        self.met.iter().any(|[from, to]| from < to)
    }

    /// Bytes that they take.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        (size_of_val(&self.colors[..]) + size_of_val(&self.met[..])) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_on_the_lattice_and_its_window_position_lead_to_one_another() {
        let map = |window: DVec2| {
            DVec2::new(3.0 + 0.7 * window.x - 0.2 * window.y, 5.0 + 0.1 * window.x + 1.3 * window.y)
        };
        let places = LatticePlaces::of(map);
        for at in [DVec2::ZERO, DVec2::new(12.5, 3.25), DVec2::new(-4.0, 90.0)] {
            assert!((places.at(at) - map(at)).length() < 1e-12);
            let window = places.window(places.at(at)).unwrap();
            assert!((window - at).length() < 1e-12);
        }
    }

    #[test]
    fn a_lattice_that_is_seen_from_its_edge_has_no_window_positions() {
        let places = LatticePlaces::of(|window| DVec2::new(window.x, 2.0 * window.x));
        assert_eq!(places.window(DVec2::ONE), None);
    }
}
