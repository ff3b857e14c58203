//! Points that are the same to the bit, counted as one: what corners of triangles have in common where a file says no such thing.

use std::collections::HashMap;

use glam::DVec3;

/// The number of each point among those that differ, in the order in which they come first, and how many these are.
#[must_use]
pub fn welded(points: impl Iterator<Item = DVec3>) -> (Vec<u32>, usize) {
    let mut known = HashMap::new();
    let number = |point: DVec3| {
        let next = known.len() as u32;
        // −0 is 0.
        *known.entry((point + DVec3::ZERO).to_array().map(f64::to_bits)).or_insert(next)
    };
    let numbers = points.map(number).collect();
    (numbers, known.len())
}
