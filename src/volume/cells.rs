//! The cells between the voxels of a brick, a bit each.

use super::bricks::EDGE;

/// The cells of a brick of which one of eight voxels is marked: `marked(z, y)` gives nine bits a
/// row. Bit `8 y + x` of word `z`.
#[inline]
pub(crate) fn marked_cells(marked: impl Fn(usize, usize) -> u64) -> [u64; EDGE] {
    // A cell is meant if a bit of its row or the next one, in its slice or the next, is set.
    let slices: [[u64; EDGE]; EDGE + 1] = std::array::from_fn(|z| {
        let rows: [u64; EDGE + 1] = std::array::from_fn(|y| marked(z, y));
        std::array::from_fn(|y| rows[y] | rows[y + 1])
    });
    std::array::from_fn(|z| {
        (0..EDGE).fold(0, |bits, y| {
            let row = slices[z][y] | slices[z + 1][y];
            bits | ((row | row >> 1) & 0xff) << (8 * y)
        })
    })
}
