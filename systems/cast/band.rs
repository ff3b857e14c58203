//! Bands: the rows of the sample array that one row of beams owns, so that bands are written side by side.

use super::beams::{Beams, SIDE};
use super::targets::RayColors;
use crate::view::samples::{Colors, Counts, Layout, NONE, POSITIONS};

/// Rows of blocks in a band.
const BLOCKS: usize = SIDE / POSITIONS;

/// The part of a sample array that one row of beams owns.
pub struct Band<'b> {
    /// Which row of beams.
    pub number: usize,
    /// What was counted in it.
    pub counts: Counts,
    /// C, and C_A and C_G where they are kept.
    colors: Vec<Part<'b>>,
    opened: &'b [u32],
    /// The number of its first opened block.
    first: u32,
    cast: &'b mut [u16],
}

struct Part<'b> {
    lattice: &'b mut [[f32; 4]],
    fine: &'b mut [[[f32; 4]; POSITIONS * POSITIONS]],
}

/// Cuts the colours of a sample array into bands.
pub fn cut<'b>(
    beams: &Beams,
    colors: Vec<&'b mut Colors>,
    opened: &'b [u32],
    cast: &'b mut [u16],
) -> Vec<Band<'b>> {
    let rows = BLOCKS * beams.layout.blocks()[0];
    let mut left: Vec<Part<'b>> = colors
        .into_iter()
        .map(|Colors { lattice, fine }| Part { lattice: &mut lattice[..], fine: &mut fine[..] })
        .collect();
    let mut first = 0;
    let mut bands = Vec::with_capacity(beams.counts[1]);
    for (number, (opened, cast)) in opened.chunks(rows).zip(cast.chunks_mut(rows)).enumerate() {
        let fine = opened.iter().filter(|&&block| block != NONE).count();
        let colors = left.iter_mut().map(|part| part.take(opened.len(), fine)).collect();
        bands.push(Band { number, counts: Counts::default(), colors, opened, first, cast });
        first += fine as u32;
    }
    bands
}

impl Part<'_> {
    /// Takes the first blocks off.
    fn take(&mut self, lattice: usize, fine: usize) -> Self {
        Part {
            lattice: self.lattice.split_off_mut(..lattice).unwrap_or_default(),
            fine: self.fine.split_off_mut(..fine).unwrap_or_default(),
        }
    }
}

impl Band<'_> {
    /// Puts into `into` the positions of the lattice of `step` positions in beam `x` of the band, block by block or row by
    /// row; those between the blocks' first positions in opened blocks alone.
    pub fn positions(&self, layout: &Layout, x: usize, step: usize, into: &mut Vec<[usize; 2]>) {
        into.clear();
        let ([across, down], first) = (layout.positions(), [x * SIDE, self.number * SIDE]);
        let end = [(first[0] + SIDE).min(across), (first[1] + SIDE).min(down)];
        if step >= POSITIONS {
            return lattice(first, end, step, into);
        }
        let row = layout.blocks()[0];
        for j in (first[1]..end[1]).step_by(POSITIONS) {
            for i in (first[0]..end[0]).step_by(POSITIONS) {
                if self.opened[(j - first[1]) / POSITIONS * row + i / POSITIONS] != NONE {
                    let end = [(i + POSITIONS).min(across), (j + POSITIONS).min(down)];
                    lattice([i, j], end, step, into);
                }
            }
        }
    }

    /// Keeps what a ray at a position of the band saw.
    pub fn write(&mut self, layout: &Layout, i: usize, j: usize, ray: &RayColors) {
        let (within, block) = layout.place(i, j - self.number * SIDE);
        for (part, color) in self.colors.iter_mut().zip([ray.full, ray.attenuated, ray.geometric]) {
            if within == 0 {
                part.lattice[block] = color;
            } else {
                part.fine[(self.opened[block] - self.first) as usize][within] = color;
            }
        }
        self.cast[block] |= 1 << within;
        self.counts.rays += 1;
    }
}

/// The positions from `first` to before `end` that are multiples of `step`, row by row.
fn lattice(first: [usize; 2], end: [usize; 2], step: usize, into: &mut Vec<[usize; 2]>) {
    let from = first.map(|n| n.next_multiple_of(step));
    for j in (from[1]..end[1]).step_by(step) {
        into.extend((from[0]..end[0]).step_by(step).map(|i| [i, j]));
    }
}
