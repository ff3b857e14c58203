//! The sweep: light goes down its columns, slice by slice, and is attenuated by what it meets (paper §4, equation 3).
//!
//! Between two slices half the slab is of the nearer slice's opacity and half of the farther one's, so the strength at a
//! slice is that at its middle: `T = Π (1 − α_j)^(Δ/u) · (1 − α)^(Δ/2u)` over the nearer slices `j`, where the first slice
//! counts half, its nearer half lying before the domain. In a homogeneous volume that is `(1 − α)^(d/u)` exactly, and
//! elsewhere its error falls with the square of the slices' distance. A column that enters through a side starts with
//! the part of a slab that it has in the volume.

#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use std::ops::Range;

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use super::casters::Casters;
use super::opacities::{Opacities, between};
use crate::light::strength::{Place, Shear, Slide};
use crate::view::composite::{thicken, thicken_each};

/// Rows of columns that one task walks.
const ROWS: usize = 16;
/// Columns of a row that are attenuated side by side.
const COLUMNS: usize = 8;

/// The columns at one slice, and their strengths at the slices within the bias before it.
pub(super) struct Columns<'a> {
    pub shear: &'a Shear,
    slide: Option<&'a Slide>,
    cell: [f64; 2],
    /// Δ/u.
    ratio: f64,
    /// β_0 · T behind the last slice's farther half-slab, at its kept columns; and room for the next.
    leaving: Vec<f64>,
    next: Vec<f64>,
    /// β_0 · T at the last slices.
    ring: Vec<Vec<f32>>,
}

impl<'a> Columns<'a> {
    /// Columns before the volume; `depth` slices are remembered and `ratio` is Δ/u.
    pub fn new(shear: &'a Shear, slide: Option<&'a Slide>, ratio: f64, depth: usize) -> Self {
        let [width, height] = shear.width();
        let kept = width * height;
        let cell = slide.map_or([0.0; 2], |slide| slide.cell(shear));
        let (leaving, next) = (vec![0.0; kept], vec![0.0; kept]);
        Self { shear, slide, cell, ratio, leaving, next, ring: vec![vec![0.0; kept]; depth] }
    }

    /// Lets the light go on to `slice`, the one after the last; β_0 · T at its kept columns.
    pub fn sweep(&mut self, slice: usize, casters: &Casters) -> &[f32] {
        let [width, _] = self.shear.width();
        let mut next = std::mem::take(&mut self.next);
        let slot = slice % self.ring.len();
        let mut strengths = std::mem::take(&mut self.ring[slot]);
        let walk = SweepStep::new(self, slice, casters);
        next.par_chunks_mut(width * ROWS)
            .zip(strengths.par_chunks_mut(width * ROWS))
            .enumerate()
            .for_each(|(chunk, (next, strengths))| walk.rows(chunk * ROWS, next, strengths));
        self.ring[slot] = strengths;
        self.next = std::mem::replace(&mut self.leaving, next);
        &self.ring[slot]
    }

    /// β_0 · T at a place in column `column`, at most the depth before the last slice.
    #[inline]
    pub fn strength(&self, place: Option<&Place>, column: [f64; 2]) -> f64 {
        let plane = |slice: usize| &*self.ring[slice % self.ring.len()];
        self.shear.interpolate(place, plane, || self.initial(column))
    }

    /// [`strength`](Self::strength) at so many places, each a whole column farther across than the one before; `None` where one
    /// of them is near the volume's sides.
    #[inline]
    pub fn strengths<const N: usize>(&self, place: &Place) -> Option<[f64; N]> {
        self.shear.interpolate_row(place, |slice| &*self.ring[slice % self.ring.len()])
    }

    /// β_0 of a column.
    fn initial(&self, column: [f64; 2]) -> f64 {
        let slide = |slide: &Slide| {
            f64::from(slide.at(self.shear.world([column[0], column[1], 0.0]), self.cell))
        };
        self.slide.map_or(1.0, slide)
    }
}

/// One step of the sweep, from a slice to the next.
struct SweepStep<'a> {
    columns: &'a Columns<'a>,
    casters: &'a Casters,
    slice: usize,
    phase: [f32; 2],
    /// The kept columns that are in the volume at this slice, and at the one before.
    entered: [Range<usize>; 2],
    came: [Range<usize>; 2],
    /// What is added to the place of a kept column to get its place at the slice before.
    shift: [isize; 2],
    /// The instructions that columns are attenuated with; no bit depends on them.
    level: Level,
}

impl<'a> SweepStep<'a> {
    fn new(columns: &'a Columns<'a>, slice: usize, casters: &'a Casters) -> Self {
        let shear = columns.shear;
        let (window, was) = (shear.window(slice), shear.window(slice.saturating_sub(1)));
        let phase = window.phase.map(|phase| phase as f32);
        let came = if slice == 0 { [0..0, 0..0] } else { shear.entered(slice - 1) };
        let shift = [0, 1].map(|axis| (window.low[axis] - was.low[axis]) as isize);
        let (entered, level) = (shear.entered(slice), Level::new());
        Self { columns, casters, slice, phase, entered, came, shift, level }
    }

    /// Rows of columns from `first` on.
    fn rows(&self, first: usize, next: &mut [f64], strengths: &mut [f32]) {
        let shear = self.columns.shear;
        let width = shear.width()[0];
        let mut opacities = Opacities::new(shear.size[0]);
        let rows = next.chunks_exact_mut(width).zip(strengths.chunks_exact_mut(width));
        for (y, (next, strengths)) in (first..).zip(rows) {
            let any = self.entered[1].contains(&y)
                && opacities.read((self.casters, shear), (self.slice, y), self.phase[1]);
            let opacities = any.then_some(&opacities);
            let (known, arriving) = self.arriving(y);
            for x in (0..known.start).chain(known.end..width) {
                let (strength, leaving) = self.enter([x, y], opacities);
                (strengths[x], next[x]) = (strength as f32, leaving);
            }
            self.pass(
                &known,
                arriving,
                opacities,
                (&mut next[known.clone()], &mut strengths[known.clone()]),
            );
        }
    }

    /// Which columns of a row were in the volume at the slice before and are now, and what left that slice along them.
    fn arriving(&self, y: usize) -> (Range<usize>, &[f64]) {
        let none = (0..0, &[] as &[f64]);
        let above = y.checked_add_signed(self.shift[1]).filter(|y| self.came[1].contains(y));
        let Some(above) = above.filter(|_| self.entered[1].contains(&y)) else {
            return none;
        };
        let before = |x: usize| x.saturating_add_signed(-self.shift[0]);
        let from = before(self.came[0].start).max(self.entered[0].start);
        let to = before(self.came[0].end).min(self.entered[0].end);
        if from >= to {
            return none;
        }
        let width = self.columns.shear.width()[0];
        let first = (above * width + from).saturating_add_signed(self.shift[0]);
        (from..to, &self.columns.leaving[first..first + (to - from)])
    }

    /// Attenuates what arrives along the columns of a row: β_0 · T at the slice, and behind its farther half-slab.
    fn pass(
        &self,
        known: &Range<usize>,
        arriving: &[f64],
        opacities: Option<&Opacities>,
        (next, strengths): (&mut [f64], &mut [f32]),
    ) {
        let Some(opacities) = opacities else {
            next.copy_from_slice(arriving);
            strengths.iter_mut().zip(arriving).for_each(|(s, &arriving)| *s = arriving as f32);
            return;
        };
        let met = opacities.around(known.clone());
        let columns = (met, arriving);
        dispatch!(self.level, _simd => self.attenuate(columns, (next, strengths)));
    }

    /// The same of columns among opacities, `COLUMNS` at a time; of those there is one more than columns.
    #[inline(always)]
    fn attenuate(
        &self,
        (opacities, arriving): (&[f32], &[f64]),
        (next, strengths): (&mut [f64], &mut [f32]),
    ) {
        for first in (0..arriving.len()).step_by(COLUMNS) {
            let (opacities, arriving) = (&opacities[first..], &arriving[first..]);
            let (next, strengths) = (&mut next[first..], &mut strengths[first..]);
            let (mut here, mut behind) = ([0.0; COLUMNS], [0.0; COLUMNS]);
            if let Some(arriving) = arriving.first_chunk::<COLUMNS>()
                && let Some(opacities) = opacities.first_chunk::<{ COLUMNS + 1 }>()
            {
                self.side_by_side(opacities, arriving, (&mut here, &mut behind));
            } else {
                let (mut last, mut light) = ([0.0; COLUMNS + 1], [0.0; COLUMNS]);
                last[..=arriving.len()].copy_from_slice(opacities);
                light[..arriving.len()].copy_from_slice(arriving);
                self.side_by_side(&last, &light, (&mut here, &mut behind));
            }
            let count = COLUMNS.min(arriving.len());
            next[..count].copy_from_slice(&behind[..count]);
            for n in 0..count {
                strengths[n] = here[n] as f32;
            }
        }
    }

    /// What is left at the slice of what arrives, and behind its farther half-slab.
    #[inline(always)]
    fn side_by_side(
        &self,
        opacities: &[f32; COLUMNS + 1],
        arriving: &[f64; COLUMNS],
        (here, behind): (&mut [f64; COLUMNS], &mut [f64; COLUMNS]),
    ) {
        let (mut met, mut most) = ([0.0; COLUMNS], 0.0_f32);
        for n in 0..COLUMNS {
            let opacity = between(opacities[n], opacities[n + 1], self.phase[0]);
            met[n] = f64::from(opacity.max(0.0));
            most = most.max(opacity);
        }
        if most <= 0.0 {
            (*here, *behind) = (*arriving, *arriving);
            return;
        }
        let halves = thicken_each(&met, &[self.columns.ratio * 0.5; COLUMNS]);
        for n in 0..COLUMNS {
            let half = 1.0 - halves[n];
            here[n] = arriving[n] * half;
            behind[n] = here[n] * half;
        }
    }

    /// A column that was not in the volume at the slice before, or is not yet.
    #[cold]
    fn enter(&self, at: [usize; 2], opacities: Option<&Opacities>) -> (f64, f64) {
        let shear = self.columns.shear;
        let low = shear.window(self.slice).low;
        let column = [at[0] as f64 + low[0] as f64, at[1] as f64 + low[1] as f64];
        let initial = self.columns.initial(column);
        match opacities.map(|opacities| opacities.at(at[0], self.phase[0])) {
            Some(opacity) if opacity > 0.0 && self.entered[0].contains(&at[0]) => {
                let strength = initial * self.through(opacity, shear.depth(self.slice, at));
                (strength, strength * self.through(opacity, 0.5))
            }
            _ => (initial, initial),
        }
    }

    /// What comes through a part of a slab between two slices.
    #[inline]
    fn through(&self, opacity: f32, part: f64) -> f64 {
        1.0 - thicken(f64::from(opacity), self.columns.ratio * part)
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DVec3};

    use super::super::inputs::LitOpacity;
    use super::*;
    use crate::volume::bricks::Bricks;
    use crate::volume::grid::Grid;

    #[test]
    fn in_homogeneous_gel_strengths_follow_the_law_to_a_millionth() {
        let size = [10, 12, 300];
        let grid = Grid::new(size, DAffine3::IDENTITY).unwrap();
        for (alpha, ratio) in
            [(0.004_f32, 1.0), (0.004, 0.37), (0.5, 1e-3), (1e-9, 900.0), (0.9, 0.1)]
        {
            let bricks = Bricks::make(size, |_, brick| {
                brick.fill(alpha);
                true
            });
            let casters = Casters::new(&LitOpacity::Made(bricks), &[], &grid);
            let shear = Shear::new(&grid, DVec3::NEG_Z).unwrap();
            let mut columns = Columns::new(&shear, None, ratio, 1);
            for slice in 0..size[2] {
                let expected = libm::exp(slice as f64 * ratio * libm::log1p(-f64::from(alpha)));
                let swept = columns.sweep(slice, &casters);
                assert!(
                    swept.iter().all(|&s| (f64::from(s) - expected).abs() < 1e-6),
                    "{alpha} {slice}"
                );
            }
        }
    }
}
