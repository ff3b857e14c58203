//! Cells that have an interesting one near them, for packets of rays: one bit answers for all rays of a packet.

use rayon::prelude::*;

use crate::volume::gel::{CELLS, EMPTY};

/// A brick's bits: bit `8 y + x` of word `z`.
type Bits = [u64; CELLS];
/// Cells of a row at one end of it, in every row of a word.
const FIRST: u64 = 0x0101_0101_0101_0101;

/// For cells of bricks that hold interesting cells or touch a brick which does: whether an interesting one is at most so
/// many cells away along every axis.
#[derive(Debug)]
pub(crate) struct Near {
    counts: [usize; 3],
    /// For each brick: its place in the arrays, or [`EMPTY`].
    table: Vec<u32>,
    /// Within 2 cells, and within 4.
    within: [Vec<Bits>; 2],
}

/// The reaches that bits are kept for, cells.
pub(crate) const REACHES: [usize; 2] = [2, 4];

impl Near {
    /// What is near the interesting `cells` of the stored bricks of `table`, on a grid of `counts` bricks.
    pub fn of(counts: [usize; 3], table: &[u32], cells: &[Bits]) -> Self {
        let places = places(counts, table);
        let mut near = vec![EMPTY; table.len()];
        for (number, &place) in places.iter().enumerate() {
            near[place as usize] = number as u32;
        }
        let own = |&place: &u32| {
            let stored = table[place as usize];
            cells.get(stored as usize).copied().unwrap_or([0; CELLS])
        };
        let mut bits: Vec<Bits> = places.par_iter().map(own).collect();
        let mut widened = || {
            for axis in 0..3 {
                bits = widen(&bits, axis, (counts, &near, &places));
            }
            bits.clone()
        };
        let within = [widened(), widened()];
        Self { counts, table: near, within }
    }

    /// Which bits tell of interesting cells within `reach` cells; `None` where none reach so far.
    pub(crate) fn reaching(reach: f64) -> Option<usize> {
        REACHES.iter().position(|&within| reach <= within as f64)
    }

    /// The numbers of bricks, and the bits of those that have one.
    pub fn within(&self, reaching: usize) -> (&[u32], &[Bits]) {
        (&self.table, &self.within[reaching])
    }

    /// Whether an interesting cell is near a cell, which counts as the nearest one inside; `None`: none is near its brick.
    #[inline]
    pub fn holds(&self, reaching: usize, cell: [i64; 3]) -> Option<bool> {
        let inside = |axis: usize| (cell[axis].max(0) as usize).min(self.counts[axis] * CELLS - 1);
        let [x, y, z] = [inside(0), inside(1), inside(2)];
        let brick = (z / CELLS * self.counts[1] + y / CELLS) * self.counts[0] + x / CELLS;
        let place = self.table.get(brick).copied().unwrap_or(EMPTY);
        let words = self.within[reaching].get(place as usize)?;
        Some(words[z % CELLS] >> (y % CELLS * CELLS + x % CELLS) & 1 == 1)
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        let bits: usize = self.within.iter().map(Vec::len).sum();
        (self.table.len() * size_of::<u32>() + bits * size_of::<Bits>()) as u64
    }
}

/// The places in the table of bricks that are stored or touch one which is, in their order.
fn places(counts: [usize; 3], table: &[u32]) -> Vec<u32> {
    let mut near = vec![false; table.len()];
    for (place, _) in table.iter().enumerate().filter(|(_, stored)| **stored != EMPTY) {
        let brick =
            [place % counts[0], place / counts[0] % counts[1], place / (counts[0] * counts[1])];
        let [x, y, z]: [_; 3] = std::array::from_fn(|axis| {
            brick[axis].saturating_sub(1)..(brick[axis] + 2).min(counts[axis])
        });
        for (z, y) in z.flat_map(|z| y.clone().map(move |y| (z, y))) {
            near[(z * counts[1] + y) * counts[0]..][x.clone()].fill(true);
        }
    }
    (0..near.len() as u32).filter(|&place| near[place as usize]).collect()
}

/// Widens the bits of bricks by two cells along an axis, both ways.
fn widen(
    bits: &[Bits],
    axis: usize,
    (counts, table, places): ([usize; 3], &[u32], &[u32]),
) -> Vec<Bits> {
    let stride = [1, counts[0], counts[0] * counts[1]][axis];
    let widened = |(own, &place): (&Bits, &u32)| {
        let (place, number) = (place as usize, place as usize / stride % counts[axis]);
        let of = |exists: bool, place: usize| {
            let near = if exists { table[place] } else { EMPTY };
            bits.get(near as usize).copied().unwrap_or([0; CELLS])
        };
        let before = of(number > 0, place.wrapping_sub(stride));
        let after = of(number + 1 < counts[axis], place + stride);
        match axis {
            0 => std::array::from_fn(|z| along_x(before[z], own[z], after[z])),
            1 => std::array::from_fn(|z| along_y(before[z], own[z], after[z])),
            _ => along_z(&before, own, &after),
        }
    };
    bits.par_iter().zip(places).map(widened).collect()
}

fn along_x(before: u64, own: u64, after: u64) -> u64 {
    let (one, two) = (FIRST, FIRST | FIRST << 1);
    let up = own << 1 & !one | before >> 7 & one | own << 2 & !two | before >> 6 & two;
    let (one, two) = (FIRST << 7, FIRST << 7 | FIRST << 6);
    let down = own >> 1 & !one | after << 7 & one | own >> 2 & !two | after << 6 & two;
    own | up | down
}

fn along_y(before: u64, own: u64, after: u64) -> u64 {
    let up = own << 8 | before >> 56 | own << 16 | before >> 48;
    let down = own >> 8 | after << 56 | own >> 16 | after << 48;
    own | up | down
}

fn along_z(before: &Bits, own: &Bits, after: &Bits) -> Bits {
    let slice = |z: usize| match z {
        0..8 => before[z],
        8..16 => own[z - 8],
        _ => after[z - 16],
    };
    std::array::from_fn(|z| (6..=10).fold(0, |bits, from| bits | slice(z + from)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_near_is_what_lies_within_two_or_four_cells() {
        let counts = [3, 2, 4];
        let interesting = [[0_i64, 0, 0], [7, 8, 15], [9, 3, 30], [23, 15, 31], [12, 9, 3]];
        let mut table = vec![EMPTY; 24];
        let mut cells: Vec<Bits> = Vec::new();
        for [x, y, z] in interesting.map(|cell| cell.map(|n| n as usize)) {
            let entry = &mut table[(z / 8 * 2 + y / 8) * 3 + x / 8];
            if *entry == EMPTY {
                *entry = cells.len() as u32;
                cells.push([0; CELLS]);
            }
            cells[*entry as usize][z % 8] |= 1 << (y % 8 * 8 + x % 8);
        }
        let near = Near::of(counts, &table, &cells);
        for (reaching, reach) in REACHES.into_iter().enumerate() {
            for n in 0..24 * 16 * 32_i64 {
                let cell = [n % 24, n / 24 % 16, n / (24 * 16)];
                let expected = interesting
                    .iter()
                    .any(|at| (0..3).all(|axis| at[axis].abs_diff(cell[axis]) <= reach as u64));
                let found = near.holds(reaching, cell).unwrap_or(false);
                assert_eq!(found, expected, "{cell:?} within {reach}");
            }
        }
        assert_eq!([1.0, 2.0, 2.1, 4.0].map(Near::reaching), [Some(0), Some(0), Some(1), Some(1)]);
        assert_eq!(Near::reaching(4.1), None);
    }
}
