//! C_A and C_G while rays are cast, by which is told where edges are seen: at every pixel, and in blocks that are opened at
//! every second position. Regions of two positions are the smallest that are asked whether they split.

use super::part::Part;
use super::targets::RayColors;
use crate::view::samples::{Layout, POSITIONS};

/// C_A and C_G of a ray, associated RGBA.
pub(crate) type Pair = [[f32; 4]; 2];

/// Positions apart where they are kept below a pixel.
const APART: usize = 2;
/// Of those, in a block.
const HALVES: usize = (POSITIONS / APART) * (POSITIONS / APART);

/// C_A and C_G of the rays of a sample array.
#[derive(Default)]
pub(crate) struct EdgeColors {
    /// At the position (0, 0) of each block, x fastest.
    pub lattice: Vec<Pair>,
    /// At every second position of each opened block, across and down; the first is unused.
    pub halves: Vec<[Pair; HALVES]>,
}

/// Those of some blocks in a row.
pub(crate) type EdgePart<'b> = Part<'b, Pair, [Pair; HALVES]>;

impl EdgeColors {
    /// Zeros, and no block opened.
    pub fn new(layout: &Layout) -> Self {
        let lattice = vec![Pair::default(); layout.blocks().iter().product()];
        Self { lattice, halves: Vec::new() }
    }

    /// Opens so many blocks.
    pub fn open(&mut self, count: usize) {
        self.halves = vec![[Pair::default(); HALVES]; count];
    }

    /// Both at a position, which is even both ways; `opened` tells for each block which of the opened it is, if it is.
    #[inline]
    pub fn at(&self, layout: &Layout, opened: &[u32], [i, j]: [usize; 2]) -> Pair {
        let (within, block) = layout.place(i, j);
        if within == 0 {
            return self.lattice[block];
        }
        let half = half(within).unwrap_or_default();
        self.halves.get(opened[block] as usize).map_or(Pair::default(), |halves| halves[half])
    }

    /// All blocks.
    pub fn whole(&mut self) -> EdgePart<'_> {
        Part { lattice: &mut self.lattice, fine: &mut self.halves }
    }
}

impl EdgePart<'_> {
    /// Keeps what a ray saw at a place in a block, by its number and by that among those that are opened.
    #[inline]
    pub fn write(&mut self, (within, block, opened): (usize, usize, u32), ray: &RayColors) {
        let pair = [ray.attenuated, ray.geometric];
        // There are none where no edges are looked for.
        let kept = if within == 0 {
            self.lattice.get_mut(block)
        } else {
            half(within).zip(self.fine.get_mut(opened as usize)).map(|(half, fine)| &mut fine[half])
        };
        if let Some(kept) = kept {
            *kept = pair;
        }
    }
}

/// Which of a block's halves is at a position of it; `None` between them.
#[inline]
fn half(within: usize) -> Option<usize> {
    let (x, y) = (within % POSITIONS, within / POSITIONS);
    let even = x.is_multiple_of(APART) && y.is_multiple_of(APART);
    even.then_some(y / APART * (POSITIONS / APART) + x / APART)
}
