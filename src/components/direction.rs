//! Directions as scenes state them: of any length above 0, however great or small.

use glam::DVec3;

/// The unit vector along `stated`; `None` where all of it is 0 or something of it is not finite.
///
/// Squares of coordinates under 1e-154 are 0 and those over 1e154 are infinite: lengths so far from 1 are scaled first.
#[must_use]
pub fn unit(stated: [f64; 3]) -> Option<DVec3> {
    let stated = DVec3::from(stated);
    let most = stated.abs().max_element();
    if !stated.is_finite() || most == 0.0 {
        return None;
    }
    if (1e-100..=1e100).contains(&most) {
        return stated.try_normalize();
    }
    // A power of two keeps every digit; two of them, for one alone would overflow for the least numbers of all.
    let half = libm::exp2(-(libm::log2(most) / 2.0).round());
    (stated * half * half).try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_counts_however_short_or_long_it_is() {
        for length in [5e-324, 1e-310, 1e-200, 1e-120, 1.0, 1e120, 1e200, f64::MAX] {
            let found = unit([0.0, -length, length]).unwrap();
            let expected = DVec3::new(0.0, -0.5_f64.sqrt(), 0.5_f64.sqrt());
            assert!(found.distance(expected) < 1e-15, "{length}: {found}");
        }
        assert_eq!(
            [unit([0.0; 3]), unit([f64::NAN, 1.0, 0.0]), unit([f64::INFINITY; 3])],
            [None; 3]
        );
    }
}
