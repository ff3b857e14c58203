//! The pyramid of binary volumes (paper §6): where the gel is empty, and how far.
//!
//! Level 0 has a bit a cell of 2 × 2 × 2 neighbouring voxels; a cell of level m + 1 covers 2³ cells of level m. Levels 0
//! to 2 are read off the 8³ bits of a stored brick, level 3 is the brick, and of the levels above only what a ray asks
//! is kept: for each brick, the highest level whose cell around it is empty.

use std::sync::Arc;

use rayon::prelude::*;

use crate::schedule::Product;
use crate::volume::gel::{CELLS, EMPTY, Texel, Texels};

/// What steps over empty gel. Shared by pointer, equality is identity.
#[derive(Debug, Clone)]
pub struct Pyramid(Arc<Levels>);

impl Product for Pyramid {}

#[derive(Debug)]
struct Levels {
    cells: Vec<[u64; CELLS]>,
    empty: Vec<u8>,
}

impl PartialEq for Pyramid {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// The level whose cells are bricks.
pub const BRICK_LEVEL: u32 = 3;

impl Pyramid {
    /// The pyramid of some gel.
    #[must_use]
    pub fn of<T: Texel>(gel: &Texels<T>) -> Self {
        let cells = (0..gel.bricks().len() as u32)
            .into_par_iter()
            .map(|brick| gel.interesting_cells(brick))
            .collect();
        let mut empty: Vec<u8> = vec![0; gel.table().len()];
        let mut full: Vec<bool> = gel.table().iter().map(|&entry| entry != EMPTY).collect();
        let mut counts = gel.counts();
        for level in BRICK_LEVEL.. {
            note_level(&mut empty, gel.counts(), &full, counts, level);
            if counts == [1; 3] {
                break;
            }
            (full, counts) = coarser(&full, counts);
        }
        Self(Arc::new(Levels { cells, empty }))
    }

    /// The arrays behind the pointer, for rays.
    #[must_use]
    pub fn slices(&self) -> PyramidSlices<'_> {
        PyramidSlices { cells: &self.0.cells, empty: &self.0.empty }
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        (self.0.cells.len() * size_of::<[u64; CELLS]>() + self.0.empty.len()) as u64
    }
}

/// The arrays of a pyramid, a pointer nearer.
#[derive(Debug, Clone, Copy)]
pub struct PyramidSlices<'a> {
    cells: &'a [[u64; CELLS]],
    empty: &'a [u8],
}

impl<'a> PyramidSlices<'a> {
    /// The interesting cells of a stored brick: bit `8 y + x` of word `z`.
    #[must_use]
    #[inline]
    pub fn cells(self, brick: u32) -> &'a [u64; CELLS] {
        &self.cells[brick as usize]
    }

    /// Whether a cell, counted from the volume's first, is interesting; `brick` is the stored brick around it, or [`EMPTY`].
    #[must_use]
    #[inline]
    pub fn is_interesting(self, brick: u32, [x, y, z]: [usize; 3]) -> bool {
        let cells = self.cells.get(brick as usize);
        cells.is_some_and(|cells| cells[z % CELLS] >> (y % CELLS * CELLS + x % CELLS) & 1 == 1)
    }

    /// For the brick at `entry` of the gel's table, which is not stored: the highest empty level around it, at least 3.
    #[must_use]
    #[inline]
    pub fn empty_level(self, entry: usize) -> u32 {
        u32::from(self.empty[entry])
    }
}

/// The highest level, 0 to 2, whose cell around `cell` (0..8 on each axis) of a brick holds nothing interesting; the
/// level-0 cell itself must be empty.
#[must_use]
#[inline]
pub fn empty_level_within(cells: &[u64; CELLS], cell: [usize; 3]) -> u32 {
    let [x, y, z] = [cell[0] % CELLS, cell[1] % CELLS, cell[2] % CELLS];
    let four = (0x0f0f_0f0f_u64 << (x & 4)) << (8 * (y & 4));
    let slab = &cells[z & 4..(z & 4) + 4];
    if (slab[0] | slab[1] | slab[2] | slab[3]) & four == 0 {
        return 2;
    }
    let two = (0x0303_u64 << (x & 6)) << (8 * (y & 6));
    u32::from((cells[z & 6] | cells[z | 1]) & two == 0)
}

/// Marks with `level` every brick that lies in an empty cell of that level.
fn note_level(empty: &mut [u8], bricks: [usize; 3], full: &[bool], counts: [usize; 3], level: u32) {
    let shift = level - BRICK_LEVEL;
    for (at, noted) in empty.iter_mut().enumerate() {
        let [x, y, z] = [at % bricks[0], at / bricks[0] % bricks[1], at / (bricks[0] * bricks[1])]
            .map(|b| b >> shift);
        if !full[(z * counts[1] + y) * counts[0] + x] {
            *noted = level as u8;
        }
    }
}

/// The next level: a cell is full if one of its eight children is.
fn coarser(full: &[bool], counts: [usize; 3]) -> (Vec<bool>, [usize; 3]) {
    let next = counts.map(|n| n.div_ceil(2));
    let mut made = vec![false; next.iter().product()];
    for (at, _) in full.iter().enumerate().filter(|(_, full)| **full) {
        let [x, y, z] = [at % counts[0], at / counts[0] % counts[1], at / (counts[0] * counts[1])]
            .map(|c| c / 2);
        made[(z * next[1] + y) * next[0] + x] = true;
    }
    (made, next)
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;

    #[test]
    fn the_highest_empty_level_grows_away_from_the_only_full_brick() {
        let fill = |first: [usize; 3], row: &mut [Vec4]| {
            if first == [0, 0, 0] {
                row[0] = Vec4::ONE;
            }
        };
        let gel = Texels::<[f32; 4]>::make([64, 32, 32], |brick| brick == [0, 0, 0], fill);
        let pyramid = Pyramid::of(&gel);
        let level =
            |x: usize, y: usize, z: usize| pyramid.slices().empty_level((z * 4 + y) * 8 + x);
        assert_eq!([level(1, 0, 0), level(2, 0, 0), level(4, 0, 0), level(0, 0, 3)], [3, 4, 5, 4]);
        assert_eq!(pyramid.slices().cells(0), &[1, 0, 0, 0, 0, 0, 0, 0]);
    }

    #[test]
    fn levels_within_a_brick_are_empty_exactly_where_no_bit_is_set() {
        let mut cells = [0_u64; CELLS];
        cells[5] = 1 << (8 * 2 + 3);
        for (x, y, z) in (0..512).map(|i| (i % 8, i / 8 % 8, i / 64)) {
            if (x, y, z) == (3, 2, 5) {
                continue;
            }
            let shares = |level: u32| {
                (x >> level, y >> level, z >> level) == (3 >> level, 2 >> level, 5 >> level)
            };
            let expected = (1..=2).rev().find(|&level| !shares(level)).unwrap_or(0);
            assert_eq!(empty_level_within(&cells, [x, y, z]), expected, "{x} {y} {z}");
        }
    }
}
