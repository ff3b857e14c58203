//! Bricks that no ray comes to: those within so much that is opaque that rays end before. They need not be classified, lit or
//! kept; a head in its skin is mostly such.
//!
//! What lies around a buried brick is a shell of bricks, each of voxels of opacity 1. Next to the buried one their gel is
//! interpolated with nothing; before a ray comes there it has passed seven voxels of the shell, and each sample in them lets
//! through no more than what is rounded. So rays that begin outside the volume, with samples no more than [`WIDEST`] voxels
//! apart, make the same picture, bit for bit, and light comes as far as it did. What is cut away or masked is not opaque.

use rayon::prelude::*;

/// The most voxels between samples for which a shell is thick enough.
pub(crate) const WIDEST: f64 = 2.0;

/// Those of a grid of `counts` bricks, x fastest, that lie within opaque ones on all sides, of which `opaque` are.
#[must_use]
pub(crate) fn buried(counts: [usize; 3], opaque: &[bool]) -> Vec<bool> {
    let [nx, ny, nz] = counts;
    let is_buried = |at: usize| {
        let place = [at % nx, at / nx % ny, at / (nx * ny)];
        let inside = (0..3).all(|axis| place[axis] > 0 && place[axis] + 1 < counts[axis]);
        let row = |y: usize, z: usize| &opaque[(z * ny + y) * nx + place[0] - 1..][..3];
        let near = |n: usize| n - 1..n + 2;
        opaque[at]
            && inside
            && near(place[2]).all(|z| near(place[1]).all(|y| row(y, z).iter().all(|o| *o)))
    };
    (0..nx * ny * nz).into_par_iter().map(is_buried).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brick_is_buried_where_all_around_it_and_itself_are_opaque() {
        let counts = [6, 5, 7];
        let all = vec![true; 6 * 5 * 7];
        let count = |opaque: &[bool]| buried(counts, opaque).iter().filter(|b| **b).count();
        assert_eq!(count(&all), 4 * 3 * 5);
        // One that is clear uncovers the 27 around it, as far as they were buried.
        let mut holed = all.clone();
        holed[(3 * 5 + 2) * 6 + 2] = false;
        assert_eq!(count(&holed), 60 - 27);
        holed = all;
        holed[0] = false;
        assert_eq!(count(&holed), 60 - 1);
    }
}
