//! Bands: rows of the sample array, as high as a row of packets, so that bands are written side by side.

use super::edges::{EdgeColors, EdgePart};
use super::lanes::{LANES, Lanes, SIDE, each};
use super::part::Part;
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
    /// C.
    colors: ColorPart<'b>,
    /// C_A and C_G, where they are kept.
    edges: EdgePart<'b>,
    /// Blocks across.
    across: usize,
    opened: &'b [u32],
    /// The number of its first opened block.
    first: u32,
    cast: &'b mut [u16],
}

/// C of some blocks in a row.
type ColorPart<'b> = Part<'b, [f32; 4], [[f32; 4]; POSITIONS * POSITIONS]>;

/// Cuts the colours of a sample array into bands for packets of rays `step` positions apart.
pub fn cut<'b>(
    layout: &Layout,
    step: usize,
    (colors, edges): (&'b mut Colors, Option<&'b mut EdgeColors>),
    opened: &'b [u32],
    cast: &'b mut [u16],
) -> Vec<Band<'b>> {
    let height = (SIDE * step).max(LEAST);
    let across = layout.blocks()[0];
    let rows = height / POSITIONS * across;
    let mut colors = Part { lattice: &mut colors.lattice[..], fine: &mut colors.fine[..] };
    let mut edges = edges.map(EdgeColors::whole).unwrap_or_default();
    let mut first = 0;
    let mut bands = Vec::with_capacity(opened.len().div_ceil(rows));
    let down = layout.positions()[1];
    for (number, (opened, cast)) in opened.chunks(rows).zip(cast.chunks_mut(rows)).enumerate() {
        let fine = opened.iter().filter(|&&block| block != NONE).count();
        let colors = colors.take(opened.len(), fine);
        let edges = edges.take(opened.len(), fine);
        let (top, bottom) = (number * height, ((number + 1) * height).min(down));
        let counts = Counts::default();
        bands.push(Band {
            number,
            top,
            bottom,
            counts,
            colors,
            edges,
            across,
            opened,
            first,
            cast,
        });
        first += fine as u32;
    }
    bands
}

impl ColorPart<'_> {
    /// Keeps a color at a place in a block, by its number and by that among those that are opened.
    #[inline]
    fn write(&mut self, (within, block, opened): (usize, usize, u32), color: &[f32; 4]) {
        if within == 0 {
            self.lattice[block] = *color;
        } else {
            self.fine[opened as usize][within] = *color;
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
        let mut closed = false;
        for i in (0..across).step_by(SIDE * step) {
            if step < POSITIONS && i % LEAST == 0 {
                closed = !self.any_open([i, self.top], LEAST);
            }
            if closed {
                continue;
            }
            for j in (self.top..self.bottom).step_by(SIDE * step) {
                if step < POSITIONS && !self.any_open([i, j], SIDE * step) {
                    continue;
                }
                let mut lanes = wanted(i >> shift, j >> shift);
                let last = (SIDE - 1) * step;
                let whole = i + last < across && j + last < self.bottom && step >= POSITIONS;
                if lanes != 0 && !whole {
                    lanes = each(lanes)
                        .map(|lane| (lane, i + lane % SIDE * step, j + lane / SIDE * step))
                        .filter(|&(_, x, y)| x < across && y < self.bottom)
                        .filter(|&(_, x, y)| step >= POSITIONS || self.is_open(x, y))
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

    /// Whether any block is opened of those from a position on, `side` positions across and down.
    fn any_open(&self, at: [usize; 2], side: usize) -> bool {
        let (side, first) = (side / POSITIONS, self.place(at).1);
        let column = first % self.across;
        (0..side).any(|row| {
            let row = (first + row * self.across).min(self.opened.len());
            let end = (row + side.min(self.across - column)).min(self.opened.len());
            self.opened[row..end].iter().any(|block| *block != NONE)
        })
    }

    fn is_open(&self, x: usize, y: usize) -> bool {
        self.opened[self.place([x, y]).1] != NONE
    }

    /// Place of a position in its block, and of the block among the band's.
    #[inline]
    fn place(&self, [x, y]: [usize; 2]) -> (usize, usize) {
        let y = y - self.top;
        let within = (y % POSITIONS) * POSITIONS + x % POSITIONS;
        (within, y / POSITIONS * self.across + x / POSITIONS)
    }

    /// Keeps what the `wanted` rays of a packet saw, of which `at` gives the positions; `None`: nothing, as it was kept before.
    #[inline]
    pub fn write(
        &mut self,
        at: impl Fn(usize) -> [usize; 2],
        wanted: Lanes,
        rays: Option<&[RayColors; LANES]>,
    ) {
        for lane in each(wanted) {
            let (within, block) = self.place(at(lane));
            self.cast[block] |= 1 << within;
            let Some(rays) = rays else { continue };
            let place = (within, block, self.opened[block].wrapping_sub(self.first));
            self.colors.write(place, &rays[lane].full);
            self.edges.write(place, &rays[lane]);
        }
        self.counts.rays += u64::from(wanted.count_ones());
    }
}
