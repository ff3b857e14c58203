//! What a slab shows along which the scalar goes from one value to another: the integral of the transfer function between
//! them, in place of its value in the middle (Max, Hanrahan and Crawfis 1990; Engel, Kraus and Ertl 2001).
//!
//! No table: a function is straight between its points, so that a stretch is a few straight pieces, each of which has a closed
//! form. An edit of the function costs nothing but the edit.

use glam::DVec3;

/// A straight piece of a transfer function, as a ray goes through it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// The part of the stretch that it takes, above 0.
    pub part: f64,
    /// The mean of −ln (1 − α) per opacity unit: above 0, ∞ where it is opaque.
    pub depth: f64,
    /// The mean colour, by opacity.
    pub color: DVec3,
}

impl Piece {
    /// That of opacities and colours from one end to the other; `None` where nothing is seen.
    pub(super) fn new(part: f64, [from, to]: [f64; 2], colors: [DVec3; 2]) -> Option<Self> {
        let sum = from + to;
        (part > 0.0 && sum > 0.0).then(|| {
            let weight = (2.0 * from + to) / (3.0 * sum);
            let color = colors[0] * weight + colors[1] * (1.0 - weight);
            Self { part, depth: mean_depth(1.0 - from, 1.0 - to), color }
        })
    }
}

/// The mean of −ln u, u going evenly from one number in 0..=1 to another; ∞ if both are 0.
fn mean_depth(a: f64, b: f64) -> f64 {
    let (middle, apart) = (f64::midpoint(a, b), a - b);
    if middle <= 0.0 {
        return f64::INFINITY;
    }
    // The middle is exact enough here, where the closed form loses digits.
    if apart.abs() <= 0.01 * middle {
        return -libm::log(middle) + (apart / middle).powi(2) / 24.0;
    }
    // ∫ −ln u = u − u ln u.
    let integral = |u: f64| if u > 0.0 { u - u * libm::log(u) } else { 0.0 };
    ((integral(a) - integral(b)) / apart).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_depth_is_that_of_many_steps() {
        for (a, b) in
            [(1.0, 1.0), (1.0, 0.995), (0.7, 0.69), (1.0, 0.0), (0.0, 0.3), (0.9, 0.1), (1e-9, 0.0)]
        {
            let steps = 200_000;
            let at = |n: i32| a + (b - a) * (f64::from(n) + 0.5) / f64::from(steps);
            let sum: f64 = (0..steps).map(|n| -at(n).ln()).sum();
            let (mean, expected) = (mean_depth(a, b), sum / f64::from(steps));
            assert!((mean - expected).abs() <= 1e-5 * expected, "{a} {b}: {mean} {expected}");
        }
        assert_eq!(mean_depth(0.0, 0.0), f64::INFINITY);
    }

    #[test]
    fn the_parts_of_a_piece_add_up_to_it() {
        for (a, b) in [(1.0, 0.2), (0.30, 0.299), (0.5, 0.0)] {
            for cut in [0.1, 0.5, 0.9] {
                let middle = a + (b - a) * cut;
                let parts = cut * mean_depth(a, middle) + (1.0 - cut) * mean_depth(middle, b);
                assert!((parts - mean_depth(a, b)).abs() < 1e-9, "{a} {b} {cut}");
            }
        }
    }

    #[test]
    fn what_is_clear_is_no_piece_and_a_clear_end_lends_no_color() {
        assert_eq!(Piece::new(0.5, [0.0; 2], [DVec3::X; 2]), None);
        let piece = Piece::new(1.0, [0.0, 1e-6], [DVec3::X, DVec3::Y]).unwrap();
        assert!(piece.color.distance(DVec3::new(1.0 / 3.0, 2.0 / 3.0, 0.0)) < 1e-12);
    }
}
