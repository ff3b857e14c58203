//! How far away the nearest interesting cell is, block by block.

use rayon::prelude::*;

use crate::volume::gel::{CELLS, EMPTY};

/// Cells along the edge of a block that a distance is known for.
pub const BLOCK: usize = 4;
/// Blocks along the edge of a brick.
const PER_BRICK: usize = CELLS / BLOCK;
/// The greatest distance that is told from greater ones, blocks.
const FARTHEST: u8 = 31;

/// Blocks with an interesting cell, a bit each: rows of words along x.
pub(crate) struct FullBlocks {
    /// Blocks on each axis.
    pub counts: [usize; 3],
    /// Words of a row.
    words: usize,
    bits: Vec<u64>,
}

impl FullBlocks {
    /// The blocks of bricks on a grid of `bricks` of them, whose `table` tells which of `cells` are theirs.
    pub fn of(bricks: [usize; 3], table: &[u32], cells: &[[u64; CELLS]]) -> Self {
        let counts = bricks.map(|n| n * PER_BRICK);
        let words = counts[0].div_ceil(64);
        let mut full = Self { counts, words, bits: vec![0; words * counts[1] * counts[2]] };
        for (at, &stored) in table.iter().enumerate().filter(|(_, stored)| **stored != EMPTY) {
            let brick = [at % bricks[0], at / bricks[0] % bricks[1], at / (bricks[0] * bricks[1])];
            for [x, y, z] in full_blocks(&cells[stored as usize]) {
                let [x, y, z] =
                    [(0, x), (1, y), (2, z)].map(|(axis, n)| brick[axis] * PER_BRICK + n);
                full.bits[(z * counts[1] + y) * words + x / 64] |= 1 << (x % 64);
            }
        }
        full
    }

    /// For each block, x fastest: how far the nearest full one is, by widening them all by a block at a time.
    pub fn distances(mut self) -> Vec<u8> {
        let [across, down, deep] = self.counts;
        let mut distances = vec![FARTHEST; across * down * deep];
        let mut known = vec![0_u64; self.bits.len()];
        for distance in 0..FARTHEST {
            let rows = distances.par_chunks_mut(across).zip(known.par_chunks_mut(self.words));
            let added: usize = rows
                .zip(self.bits.par_chunks(self.words))
                .map(|((distances, known), bits)| note(distances, known, bits, distance))
                .sum();
            if added == 0 {
                break;
            }
            self.widen();
        }
        distances
    }

    /// Adds to the full blocks all that touch one, at a corner too.
    fn widen(&mut self) {
        let words = self.words;
        self.bits.par_chunks_mut(words).for_each(widen_row);
        let slice = words * self.counts[1];
        self.bits.par_chunks_mut(slice).for_each(|slice| widen_lines(slice, words));
        widen_lines(&mut self.bits, slice);
    }
}

/// Notes `distance` for the blocks of a row that are full and were not known; how many those are.
fn note(distances: &mut [u8], known: &mut [u64], bits: &[u64], distance: u8) -> usize {
    let mut added = 0;
    for (word, (known, bits)) in known.iter_mut().zip(bits).enumerate() {
        let mut new = bits & !*known;
        *known |= new;
        while new != 0 {
            let at = 64 * word + new.trailing_zeros() as usize;
            if let Some(noted) = distances.get_mut(at) {
                *noted = distance;
                added += 1;
            }
            new &= new - 1;
        }
    }
    added
}

/// Widens a row of bits by one on both sides.
fn widen_row(row: &mut [u64]) {
    let mut before = 0;
    for at in 0..row.len() {
        let (word, after) = (row[at], row.get(at + 1).copied().unwrap_or(0));
        row[at] = word | word << 1 | before >> 63 | word >> 1 | after << 63;
        before = word;
    }
}

/// Widens lines of `length` words, one after the other, by one line on both sides.
fn widen_lines(lines: &mut [u64], length: usize) {
    let mut before = vec![0; length];
    for at in (0..lines.len()).step_by(length) {
        for word in 0..length {
            let own = lines[at + word];
            let after = lines.get(at + length + word).copied().unwrap_or(0);
            lines[at + word] = own | before[word] | after;
            before[word] = own;
        }
    }
}

/// The blocks of a brick that hold an interesting cell, 0 or 1 along each axis.
fn full_blocks(cells: &[u64; CELLS]) -> impl Iterator<Item = [usize; 3]> {
    (0..8_usize).map(|n| [n % 2, n / 2 % 2, n / 4]).filter(|&[x, y, z]| {
        let four = (0x0f0f_0f0f_u64 << (BLOCK * x)) << (CELLS * BLOCK * y);
        cells[BLOCK * z..][..BLOCK].iter().any(|word| word & four != 0)
    })
}
