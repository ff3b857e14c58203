//! The pyramid of binary volumes (paper §6): where the gel is empty, and how far.
//!
//! Level 0 has a bit a cell of 2 × 2 × 2 neighbouring voxels, kept for stored bricks. Of the levels above, what a packet of
//! rays asks is kept: for each block of 4³ cells (level 2), how many blocks away the nearest interesting one is (`blocks`). So
//! a leap is as long as the room around it and not as the aligned cell that it begins in, and it serves packets of any width.
//! For values, which may be looked for around samples, a bit a cell tells whether a packet around it can meet any (`near`).

mod blocks;
mod near;

use std::sync::Arc;

use rayon::prelude::*;

use crate::schedule::Product;
use crate::volume::gel::{CELLS, Texel, Texels};
use crate::volume::interest::Interest;
pub use blocks::BLOCK;
use blocks::FullBlocks;
use near::Near;

/// What steps over empty gel. Shared by pointer, equality is identity.
#[derive(Debug, Clone)]
pub struct Pyramid(Arc<Levels>);

impl Product for Pyramid {}

#[derive(Debug)]
struct Levels {
    /// For each brick: its number among those with cells; empty where the gel's own table tells.
    table: Vec<u32>,
    cells: Vec<[u64; CELLS]>,
    blocks: [usize; 3],
    distances: Vec<u8>,
    /// Of values that are looked for around samples.
    near: Option<Near>,
}

impl PartialEq for Pyramid {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Levels {
    fn of(Interest { counts, table, cells }: Interest) -> Self {
        let full = FullBlocks::of(counts, &table, &cells);
        Self { table, cells, blocks: full.counts, distances: full.distances(), near: None }
    }
}

impl Pyramid {
    /// The pyramid of some gel.
    #[must_use]
    pub fn of<T: Texel>(gel: &Texels<T>) -> Self {
        let cells = (0..gel.bricks().len() as u32).into_par_iter();
        let cells = cells.map(|brick| gel.interesting_cells(brick)).collect();
        Self::of_layer(Interest { counts: gel.counts(), table: gel.table().to_vec(), cells })
    }

    /// The pyramid of the gel that is made of a layer.
    #[must_use]
    pub(crate) fn of_layer(interest: Interest) -> Self {
        // The gel has the same table.
        Self(Arc::new(Levels { table: Vec::new(), ..Levels::of(interest) }))
    }

    /// The pyramid of interesting cells of values, which may be looked for around samples if `around` says so.
    #[must_use]
    pub(crate) fn of_cells(interest: Interest, around: bool) -> Self {
        let Interest { counts, table, cells } = &interest;
        let near = around.then(|| Near::of(*counts, table, cells));
        Self(Arc::new(Levels { near, ..Levels::of(interest) }))
    }

    /// The arrays behind the pointer, for rays.
    #[must_use]
    pub fn slices(&self) -> PyramidSlices<'_> {
        let Levels { table, cells, blocks, distances, near } = &*self.0;
        PyramidSlices { table, cells, blocks: *blocks, distances, near: near.as_ref() }
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let cells = self.0.cells.len() * size_of::<[u64; CELLS]>();
        (cells + self.0.distances.len() + self.0.table.len() * size_of::<u32>()) as u64
            + self.0.near.as_ref().map_or(0, Near::bytes)
    }
}

/// The arrays of a pyramid, a pointer nearer.
#[derive(Debug, Clone, Copy)]
pub struct PyramidSlices<'a> {
    table: &'a [u32],
    cells: &'a [[u64; CELLS]],
    blocks: [usize; 3],
    distances: &'a [u8],
    near: Option<&'a Near>,
}

impl<'a> PyramidSlices<'a> {
    /// Which bits tell of interesting cells within `reach` cells of another, for [`is_near`](Self::is_near); `None` where none
    /// reach so far.
    #[must_use]
    pub(crate) fn reaching(reach: f64) -> Option<usize> {
        Near::reaching(reach)
    }

    /// Whether an interesting cell may be within reach of a cell; `None` if there is none near its brick at all.
    #[must_use]
    #[inline]
    pub(crate) fn is_near(self, reaching: usize, cell: [i64; 3]) -> Option<bool> {
        self.near?.holds(reaching, cell)
    }

    /// The numbers of bricks, and for the numbered ones which of their cells have an interesting one within reach, as
    /// [`reaching`](Self::reaching) tells; `None` of a pyramid that is not looked around in.
    #[must_use]
    pub(crate) fn near(self, reaching: usize) -> Option<(&'a [u32], &'a [[u64; CELLS]])> {
        self.near.map(|near| near.within(reaching))
    }

    /// Whether a cell may be seen, of a pyramid that was made of cells.
    #[must_use]
    #[inline]
    pub fn shows(self, cell: [usize; 3]) -> bool {
        let [x, y, z] = cell.map(|n| n / CELLS);
        let [nx, ny, _] = self.bricks();
        let words = self.table.get((z * ny + y) * nx + x).and_then(|&brick| self.words(brick));
        let [x, y, z] = cell.map(|n| n % CELLS);
        words.is_some_and(|words| words[z] >> (CELLS * y + x) & 1 == 1)
    }

    /// Whether any cell of some ranges of them along the axes, both ends among them, may be seen, of a pyramid that was made of
    /// cells.
    #[must_use]
    #[inline]
    pub(crate) fn shows_any(self, [[x0, x1], [y0, y1], [z0, z1]]: [[usize; 2]; 3]) -> bool {
        // One number after the other: arrays of them would be put together to be compared.
        if (x0 ^ x1) | (y0 ^ y1) | (z0 ^ z1) >= CELLS {
            let mut rows = (z0..=z1).flat_map(|z| (y0..=y1).map(move |y| (y, z)));
            return rows.any(|(y, z)| (x0..=x1).any(|x| self.shows([x, y, z])));
        }
        let [nx, ny, _] = self.bricks();
        let brick = (z0 / CELLS * ny + y0 / CELLS) * nx + x0 / CELLS;
        let stored = self.table.get(brick);
        let Some(words) = stored.and_then(|&stored| self.words(stored)) else { return false };
        let row = (0xff_u64 >> (CELLS - 1 - (x1 - x0))) << (x0 % CELLS);
        let slice = (y0 % CELLS..=y1 % CELLS).fold(0, |bits, y| bits | row << (CELLS * y));
        words[z0 % CELLS..=z1 % CELLS].iter().any(|word| word & slice != 0)
    }

    /// The interesting cells of a stored brick: bit `8 y + x` of word `z`; `None` for one that is not stored.
    #[must_use]
    #[inline]
    pub fn words(self, brick: u32) -> Option<&'a [u64; CELLS]> {
        self.cells.get(brick as usize)
    }

    /// The interesting cells of all stored bricks.
    #[must_use]
    #[inline]
    pub(crate) fn all_words(self) -> &'a [[u64; CELLS]] {
        self.cells
    }

    /// The bricks' numbers, of a pyramid that was made of cells.
    #[must_use]
    #[inline]
    pub(crate) fn table(self) -> &'a [u32] {
        self.table
    }

    /// Bricks on each axis.
    #[must_use]
    #[inline]
    pub(crate) fn bricks(self) -> [usize; 3] {
        self.blocks.map(|n| n * BLOCK / CELLS)
    }

    /// How many blocks lie between the one around a cell and the nearest with an interesting cell, along the axis on which
    /// they are farthest apart: 0 if it has one itself; at most 31, which stands for more. A cell outside the volume counts
    /// as the nearest one inside.
    #[must_use]
    #[inline]
    pub fn distance(self, cell: [i64; 3]) -> u8 {
        let block = |axis: usize| {
            ((cell[axis] >> BLOCK.trailing_zeros()).max(0) as usize).min(self.blocks[axis] - 1)
        };
        let at = (block(2) * self.blocks[1] + block(1)) * self.blocks[0] + block(0);
        self.distances.get(at).copied().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;

    #[test]
    fn distances_are_those_to_the_nearest_block_that_is_not_empty() {
        let full = [[5_usize, 9, 30], [270, 2, 3], [100, 12, 17]];
        let size = [300, 16, 33];
        let fill = |first: [usize; 3], row: &mut [Vec4]| {
            for (i, texel) in row.iter_mut().enumerate() {
                if full.contains(&[first[0] + i, first[1], first[2]]) {
                    *texel = Vec4::ONE;
                }
            }
        };
        let pyramid = Pyramid::of(&Texels::<[f32; 4]>::make(size, |_| true, &fill));
        // A voxel is a corner of eight cells.
        let cells = full.iter().flat_map(|voxel| {
            (0..8).map(|n| std::array::from_fn(|axis| voxel[axis] - (n >> axis & 1)))
        });
        let blocks: Vec<[usize; 3]> = cells.map(|cell: [usize; 3]| cell.map(|c| c / 4)).collect();
        for cell in
            (0..300_usize).step_by(3).flat_map(|x| (0..48).map(move |n| [x, n % 16, n * 2 / 3]))
        {
            let to = |block: &[usize; 3]| {
                (0..3).map(|axis| (cell[axis] / 4).abs_diff(block[axis])).max().unwrap_or(0)
            };
            let expected = blocks.iter().map(to).min().unwrap_or(0).min(31);
            let found = pyramid.slices().distance(cell.map(|n| n as i64));
            assert_eq!(usize::from(found), expected, "{cell:?}");
        }
        assert_eq!(pyramid.slices().distance([-9, 9, 90]), pyramid.slices().distance([0, 9, 39]));
    }

    #[test]
    fn a_voxel_makes_the_cells_around_it_interesting() {
        let fill = |first: [usize; 3], row: &mut [Vec4]| {
            if first == [0, 1, 0] {
                row[2] = Vec4::ONE;
            }
        };
        let gel = Texels::<[f32; 4]>::make([8; 3], |_| true, &fill);
        let expected = [1 << 1 | 1 << 2 | 1 << 9 | 1 << 10, 0, 0, 0, 0, 0, 0, 0];
        assert_eq!(Pyramid::of(&gel).0.cells, [expected]);
    }
}
