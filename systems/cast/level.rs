//! Which regions of one level of the refinement are split (paper §6).

use crate::view::samples::POSITIONS;

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
        let none = vec![false; across * down];
        Self { side, across, split: none.clone(), edges: none }
    }

    /// Whether a region is split, and whether it is whatever textures show.
    pub fn at(&self, x: usize, y: usize) -> [bool; 2] {
        [&self.split, &self.edges].map(|flags| flags[y * self.across + x])
    }

    /// Whether a region is split; not outside the level.
    pub fn split(&self, x: usize, y: usize) -> bool {
        x < self.across && self.split.get(y * self.across + x).is_some_and(|split| *split)
    }

    /// Whether the position `(a, b)` of the lattice twice as fine is new and a corner of a split region's child.
    pub fn asks(&self, a: usize, b: usize) -> bool {
        let (x, y) = (a / 2, b / 2);
        match (a % 2, b % 2) {
            (1, 1) => self.split(x, y),
            (1, 0) => self.split(x, y) || (y > 0 && self.split(x, y - 1)),
            (0, 1) => self.split(x, y) || (x > 0 && self.split(x - 1, y)),
            _ => false,
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
