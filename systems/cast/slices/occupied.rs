//! Which bricks have anything: rows of bits along u, so that a tile goes from one to the next that has.

use rayon::prelude::*;

/// A bit for each brick of a grid, in rows along u, v by v and layer by layer along w.
pub(super) struct Occupied {
    bits: Vec<u64>,
    /// Words of a row, and rows of a layer.
    row: usize,
    layer: usize,
}

impl Occupied {
    /// Of a grid of so many bricks along u, v and w, of which those at `[u, v, w]` that `has` are.
    pub fn of([u, v, w]: [usize; 3], has: impl Fn([usize; 3]) -> bool + Sync) -> Self {
        let row = u.div_ceil(64);
        let mut bits = vec![0; row * v * w];
        bits.par_chunks_mut((row * v).max(1)).enumerate().for_each(|(w, layer)| {
            for (v, row) in layer.chunks_exact_mut(row.max(1)).enumerate() {
                for u in 0..u {
                    row[u / 64] |= u64::from(has([u, v, w])) << (u % 64);
                }
            }
        });
        Self { bits, row, layer: v }
    }

    /// Those from `first` on to `last`, both of the grid, of a row and a layer, and no further than 64: the first is bit 0.
    #[inline]
    pub fn among(&self, [first, last]: [usize; 2], [v, w]: [usize; 2]) -> u64 {
        let row = &self.bits[(w * self.layer + v) * self.row..][..self.row];
        let (word, shift) = (first / 64, first % 64);
        let next = row.get(word + 1).map_or(0, |next| (next << 1) << (63 - shift));
        let beyond = 63_usize.saturating_sub(last - first);
        (row[word] >> shift | next) & (u64::MAX >> beyond)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_a_row_is_told_wherever_it_begins() {
        let has = |[u, v, w]: [usize; 3]| (u * 7 + v * 3 + w * 5) % 11 < 4;
        let size = [150, 3, 4];
        let occupied = Occupied::of(size, has);
        for w in 0..4 {
            for v in 0..3 {
                for first in 0..150 {
                    let last = (first + 9).min(149);
                    let bits = occupied.among([first, last], [v, w]);
                    for n in 0..64 {
                        let expected = first + n <= last && has([first + n, v, w]);
                        assert_eq!(bits >> n & 1 == 1, expected, "{first} {n} {v} {w}");
                    }
                }
            }
        }
    }
}
