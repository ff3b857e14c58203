//! What all ways of classifying share: numbers held in range, and means of colours.

use glam::DVec3;

/// |∇f|², in 64 bits: neither the smallest nor the largest gradients of 32 bits are lost.
#[inline]
pub(super) fn square(gradient: [f32; 3]) -> f64 {
    let [x, y, z] = gradient.map(f64::from);
    x * x + y * y + z * z
}

/// A stated opacity or probability within 0..=1; 0 for a NaN.
pub(super) fn opacity_in_range(stated: f32) -> f64 {
    fraction(f64::from(stated))
}

/// The nearest number in 0..=1; 0 for a NaN.
#[inline]
pub(super) fn fraction(number: f64) -> f64 {
    if number > 0.0 { number.min(1.0) } else { 0.0 }
}

/// The mean of some colours, each by its weight; `None` if the weights sum to 0.
pub(super) fn weighted_mean(parts: impl Iterator<Item = (f64, DVec3)>) -> Option<DVec3> {
    let (weight, sum) = parts.fold((0.0, DVec3::ZERO), |(weight, sum), (part, color)| {
        (weight + part, sum + color * part)
    });
    (weight > 0.0).then(|| sum / weight)
}
