//! Bands: rows of the sample array, as high as a row of packets, so that bands are written side by side.

use super::lanes::{LANES, Lanes, SIDE, each};
use super::targets::RayColors;
use crate::view::samples::{Colors, Counts, Layout, NONE, POSITIONS};

/// The least rows of positions in a band.
pub(crate) const LEAST: usize = 64;

/// The part of a sample array that one row of packets of the coarser levels, or some of the finer, lies in.
pub(crate) struct Band<'b> {
    /// Which of the bands.
    pub number: usize,
    /// Its first position down.
    top: usize,
    /// One past its last.
    bottom: usize,
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

/// Cuts the colours of a sample array into bands for packets of rays `step` positions apart.
pub fn cut<'b>(
    layout: &Layout,
    step: usize,
    colors: Vec<&'b mut Colors>,
    opened: &'b [u32],
    cast: &'b mut [u16],
) -> Vec<Band<'b>> {
    let height = (SIDE * step).max(LEAST);
    let rows = height / POSITIONS * layout.blocks()[0];
    let mut left: Vec<Part<'b>> = colors
        .into_iter()
        .map(|Colors { lattice, fine }| Part { lattice: &mut lattice[..], fine: &mut fine[..] })
        .collect();
    let mut first = 0;
    let mut bands = Vec::with_capacity(opened.len().div_ceil(rows));
    let down = layout.positions()[1];
    for (number, (opened, cast)) in opened.chunks(rows).zip(cast.chunks_mut(rows)).enumerate() {
        let fine = opened.iter().filter(|&&block| block != NONE).count();
        let colors = left.iter_mut().map(|part| part.take(opened.len(), fine)).collect();
        let (top, bottom) = (number * height, ((number + 1) * height).min(down));
        let counts = Counts::default();
        bands.push(Band { number, top, bottom, counts, colors, opened, first, cast });
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
    /// Calls `cast` with every packet of rays `step` positions apart of which some are `wanted`, by where its first is on their
    /// lattice; those between the blocks' first positions in opened blocks alone.
    pub fn packets(
        &mut self,
        layout: &Layout,
        step: usize,
        wanted: impl Fn(usize, usize) -> Lanes,
        mut cast: impl FnMut(&mut Self, [usize; 2], Lanes),
    ) {
        let (across, shift) = (layout.positions()[0], step.trailing_zeros());
        // Down before across: what is below one another lies in the same bricks.
        for i in (0..across).step_by(SIDE * step) {
            for j in (self.top..self.bottom).step_by(SIDE * step) {
                let mut lanes = wanted(i >> shift, j >> shift);
                let last = (SIDE - 1) * step;
                let whole = i + last < across && j + last < self.bottom && step >= POSITIONS;
                if lanes != 0 && !whole {
                    lanes = each(lanes)
                        .map(|lane| (lane, i + lane % SIDE * step, j + lane / SIDE * step))
                        .filter(|&(_, x, y)| x < across && y < self.bottom)
                        .filter(|&(_, x, y)| step >= POSITIONS || self.is_open(layout, x, y))
                        .fold(0, |lanes, (lane, ..)| lanes | 1 << lane);
                }
                if lanes != 0 {
                    cast(self, [i, j], lanes);
                }
            }
        }
    }

    /// Its first row of positions.
    pub fn top(&self) -> usize {
        self.top
    }

    /// One past its last row of positions.
    pub fn bottom(&self) -> usize {
        self.bottom
    }

    fn is_open(&self, layout: &Layout, i: usize, j: usize) -> bool {
        self.opened[layout.place(i, j - self.top).1] != NONE
    }

    /// Keeps what the `wanted` rays of a packet saw, of which `at` gives the positions.
    #[inline]
    pub fn write(
        &mut self,
        layout: &Layout,
        at: impl Fn(usize) -> [usize; 2],
        wanted: Lanes,
        rays: &[RayColors; LANES],
    ) {
        for lane in each(wanted) {
            let [x, y] = at(lane);
            let (within, block) = layout.place(x, y - self.top);
            let ray = &rays[lane];
            for (part, color) in
                self.colors.iter_mut().zip([&ray.full, &ray.attenuated, &ray.geometric])
            {
                if within == 0 {
                    part.lattice[block] = *color;
                } else {
                    part.fine[(self.opened[block] - self.first) as usize][within] = *color;
                }
            }
            self.cast[block] |= 1 << within;
        }
        self.counts.rays += u64::from(wanted.count_ones());
    }
}
