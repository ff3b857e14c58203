//! Which regions of one level of the refinement are split (paper §6).

use super::lanes::{Lanes, SIDE};
use crate::view::samples::POSITIONS;

/// The new corners of the children of three by three regions, the middle one of which begins a packet of the lattice twice as
/// fine: those that are in the packet.
const CORNERS: [[Lanes; 3]; 3] = {
    let mut all = [[0; 3]; 3];
    let mut n = 0;
    while n < 45 {
        let (region, corner) = (n / 5, n % 5);
        // The middle of each side, and of the region.
        let [x, y] = [[1, 0], [0, 1], [1, 1], [2, 1], [1, 2]][corner];
        let (x, y) = (x + 2 * (region % 3), y + 2 * (region / 3));
        if x >= 2 && x < 2 + SIDE && y >= 2 && y < 2 + SIDE {
            all[region / 3][region % 3] |= 1 << ((y - 2) * SIDE + x - 2);
        }
        n += 1;
    }
    all
};

/// The regions of `side` positions, x fastest.
pub struct Regions {
    /// Positions along a region's side.
    pub side: usize,
    /// Regions across.
    pub across: usize,
    /// Which are split.
    pub split: Vec<bool>,
    /// Which are split whatever textures show, as all were that they lie in: those alone may split below a pixel.
    pub edges: Vec<bool>,
}

impl Regions {
    /// A level of `across × down` regions, none of them split.
    pub fn new([across, down]: [usize; 2], side: usize) -> Self {
        // Fresh zeros each: what is not split is not touched.
        let [split, edges] = [(); 2].map(|()| vec![false; across * down]);
        Self { side, across, split, edges }
    }

    /// Whether a region is split, and whether it is whatever textures show.
    pub fn at(&self, x: usize, y: usize) -> [bool; 2] {
        [&self.split, &self.edges].map(|flags| flags[y * self.across + x])
    }

    /// Whether a region is split; not outside the level.
    pub fn split(&self, x: usize, y: usize) -> bool {
        x < self.across && self.split.get(y * self.across + x).is_some_and(|split| *split)
    }

    /// Which positions of the lattice twice as fine are new and corners of a split region's children: of a packet of them
    /// whose first is `(a, b)`, both even.
    pub fn asked(&self, a: usize, b: usize) -> Lanes {
        let mut lanes = 0;
        for (down, row) in CORNERS.iter().enumerate() {
            for (across, corners) in row.iter().enumerate() {
                let region = (a / 2 + across).checked_sub(1).zip((b / 2 + down).checked_sub(1));
                if region.is_some_and(|(x, y)| self.split(x, y)) {
                    lanes |= corners;
                }
            }
        }
        lanes
    }

    /// Keeps of the split regions, each of them a block, those of the greatest `contrast`, the first where that is equal: as
    /// many as open no more than `most` of the `blocks`. A region opens the blocks to its right and below it too.
    pub fn spare(
        &mut self,
        most: usize,
        blocks: [usize; 2],
        contrast: impl Fn(usize, usize) -> f32,
    ) {
        let split: Vec<usize> = (0..self.split.len()).filter(|at| self.split[*at]).collect();
        if 3 * split.len() <= most {
            return;
        }
        let place = |at: usize| (at % self.across, at / self.across);
        let clear = |at: usize| contrast(place(at).0, place(at).1);
        let mut ranked: Vec<(f32, usize)> = split.into_iter().map(|at| (clear(at), at)).collect();
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut opened = vec![false; blocks[0] * blocks[1]];
        let mut left = most;
        for (_, at) in ranked {
            let (x, y) = place(at);
            let block = y * blocks[0] + x;
            let new = [block, block + 1, block + blocks[0]];
            let new = new.map(|block| (opened.get(block) == Some(&false)).then_some(block));
            let count = new.iter().flatten().count();
            if count > left {
                (self.split[at], self.edges[at]) = (false, false);
                continue;
            }
            left -= count;
            new.into_iter().flatten().for_each(|block| opened[block] = true);
        }
    }

    /// Notes for the resampling which blocks of 4 × 4 positions are split, and which of their children.
    pub fn note(&self, splits: &mut [u8], blocks_across: usize) {
        if self.side > POSITIONS {
            return;
        }
        let per_block = POSITIONS / self.side;
        for (at, _) in self.split.iter().enumerate().filter(|(_, split)| **split) {
            let (x, y) = (at % self.across, at / self.across);
            let bit = if per_block == 1 { 0 } else { 1 + 2 * (y % 2) + x % 2 };
            splits[(y / per_block) * blocks_across + x / per_block] |= 1 << bit;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_that_are_spared_leave_the_clearest_and_open_no_more_than_they_may() {
        let (across, down) = (9, 7);
        let contrast = |x: usize, y: usize| ((x * 5 + y * 3) % 8) as f32;
        for most in [0, 1, 2, 3, 10, 25, 60, 200] {
            let mut level = Regions::new([across, down], 4);
            level.split.iter_mut().enumerate().for_each(|(at, split)| *split = at % 3 != 1);
            level.edges.clone_from(&level.split);
            let before = level.split.clone();
            level.spare(most, [across + 1, down + 1], contrast);
            assert_eq!(level.split, level.edges);
            let kept: Vec<usize> = (0..across * down).filter(|at| level.split[*at]).collect();
            assert!(kept.iter().all(|at| before[*at]));
            let opens = |at: usize| {
                let block = at / across * (across + 1) + at % across;
                [block, block + 1, block + across + 1]
            };
            let mut opened: Vec<usize> = kept.iter().flat_map(|at| opens(*at)).collect();
            opened.sort_unstable();
            opened.dedup();
            assert!(opened.len() <= most, "{} of {most}", opened.len());
            if most >= 3 {
                let clear = |at: &usize| contrast(at % across, at / across);
                let clearest = (0..across * down).filter(|at| before[*at]).map(|at| clear(&at));
                let most_clear = clearest.fold(0.0, f32::max);
                assert!(kept.iter().any(|at| clear(at) == most_clear));
            }
            assert!(most < 200 || level.split == before);
        }
    }

    #[test]
    fn the_corners_that_a_packet_is_asked_for_are_those_of_split_regions() {
        let (across, down) = (5, 6);
        for seed in 0..200_u64 {
            let mut level = Regions::new([across, down], 8);
            let random =
                |at: usize| (seed * 31 + at as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 61;
            level.split.iter_mut().enumerate().for_each(|(at, split)| *split = random(at) < 3);
            let mut expected = vec![false; (2 * across + 8) * (2 * down + 8)];
            for at in (0..across * down).filter(|at| level.split[*at]) {
                let (x, y) = (at % across * 2, at / across * 2);
                for [right, below] in [[1, 0], [0, 1], [1, 1], [2, 1], [1, 2]] {
                    expected[(y + below) * (2 * across + 8) + x + right] = true;
                }
            }
            for b in (0..=2 * down).step_by(SIDE) {
                for a in (0..=2 * across).step_by(SIDE) {
                    let lanes = level.asked(a, b);
                    for lane in 0..SIDE * SIDE {
                        let (x, y) = (a + lane % SIDE, b + lane / SIDE);
                        let asked = lanes >> lane & 1 == 1;
                        assert_eq!(asked, expected[y * (2 * across + 8) + x], "{x} {y} of {seed}");
                    }
                }
            }
        }
    }
}
