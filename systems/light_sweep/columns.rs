//! The sweep: light goes down its columns, slice by slice, and is attenuated by what it meets (paper §4, equation 3).
//!
//! Between two slices half the slab is of the nearer slice's opacity and half of the farther one's, so the strength at a
//! slice is that at its middle: `T = Π (1 − α_j)^(Δ/u) · (1 − α)^(Δ/2u)` over the nearer slices `j`, where the first slice
//! counts half, its nearer half lying before the domain. In a homogeneous volume that is `(1 − α)^(d/u)` exactly, and
//! elsewhere its error falls with the square of the slices' distance. A column that enters through a side starts with
//! the part of a slab that it has in the volume.

use std::ops::Range;

use rayon::prelude::*;

use super::casters::Casters;
use crate::bricks::EDGE;
use crate::composite::thicken;
use crate::strength::{Shear, Slide};

/// Rows of columns that one task walks.
const ROWS: usize = 16;

/// The columns at one slice, and their strengths at the slices within the bias before it.
pub(super) struct Columns<'a> {
    pub shear: Shear,
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
    pub fn new(shear: Shear, slide: Option<&'a Slide>, ratio: f64, depth: usize) -> Self {
        let [width, height] = shear.width();
        let kept = width * height;
        let cell = slide.map_or([0.0; 2], |slide| slide.cell(&shear));
        let (leaving, next) = (vec![0.0; kept], vec![0.0; kept]);
        Self { shear, slide, cell, ratio, leaving, next, ring: vec![vec![0.0; kept]; depth] }
    }

    /// Lets the light go on to `slice`, the one after the last; β_0 · T at its kept columns.
    pub fn sweep(&mut self, slice: usize, casters: &Casters) -> &[f32] {
        let [width, _] = self.shear.width();
        let mut next = std::mem::take(&mut self.next);
        let slot = slice % self.ring.len();
        let mut strengths = std::mem::take(&mut self.ring[slot]);
        let walk = Walk::new(self, slice, casters);
        next.par_chunks_mut(width * ROWS)
            .zip(strengths.par_chunks_mut(width * ROWS))
            .enumerate()
            .for_each(|(chunk, (next, strengths))| walk.rows(chunk * ROWS, next, strengths));
        self.ring[slot] = strengths;
        self.next = std::mem::replace(&mut self.leaving, next);
        &self.ring[slot]
    }

    /// β_0 · T at a column and a place along it, at most the depth before the last slice.
    pub fn strength(&self, column: [f64; 2], place: f64) -> f64 {
        let read = |slice: usize, at: usize| f64::from(self.ring[slice % self.ring.len()][at]);
        self.shear.interpolate(column, place, read, || self.initial(column))
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
struct Walk<'a> {
    columns: &'a Columns<'a>,
    casters: &'a Casters,
    slice: usize,
    phase: [f32; 2],
    /// The kept columns that are in the volume at this slice, and at the one before.
    entered: [Range<usize>; 2],
    came: [Range<usize>; 2],
    /// What is added to the place of a kept column to get its place at the slice before.
    shift: [isize; 2],
}

impl<'a> Walk<'a> {
    fn new(columns: &'a Columns<'a>, slice: usize, casters: &'a Casters) -> Self {
        let shear = &columns.shear;
        let (window, was) = (shear.window(slice), shear.window(slice.saturating_sub(1)));
        let phase = window.phase.map(|phase| phase as f32);
        let came = if slice == 0 { [0..0, 0..0] } else { shear.entered(slice - 1) };
        let shift = [0, 1].map(|axis| (window.low[axis] - was.low[axis]) as isize);
        Self { columns, casters, slice, phase, entered: shear.entered(slice), came, shift }
    }

    /// Rows of columns from `first` on.
    fn rows(&self, first: usize, next: &mut [f64], strengths: &mut [f32]) {
        let shear = &self.columns.shear;
        let width = shear.width()[0];
        let mut opacities = Opacities::new(shear.size[0]);
        let rows = next.chunks_exact_mut(width).zip(strengths.chunks_exact_mut(width));
        for (y, (next, strengths)) in (first..).zip(rows) {
            let any = self.entered[1].contains(&y) && opacities.read(self, y);
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
        let columns = known.clone().zip(arriving).zip(next.iter_mut().zip(strengths));
        for ((x, &arriving), (next, strength)) in columns {
            let opacity = opacities.at(x, self.phase[0]);
            let half = if opacity > 0.0 { self.through(opacity, 0.5) } else { 1.0 };
            let here = arriving * half;
            (*next, *strength) = (here * half, here as f32);
        }
    }

    /// A column that was not in the volume at the slice before, or is not yet.
    #[cold]
    fn enter(&self, at: [usize; 2], opacities: Option<&Opacities>) -> (f64, f64) {
        let shear = &self.columns.shear;
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

/// A row of opacities at columns' places, interpolated in the slice.
struct Opacities {
    /// The rows of voxels that the row of columns goes between.
    lower: Row,
    upper: Row,
    /// Both interpolated, with one voxel repeated at each end.
    row: Vec<f32>,
}

/// A row of voxels of the slice.
struct Row {
    y: Option<usize>,
    /// Whether any opacity is above 0.
    any: bool,
    opacities: Vec<f32>,
}

impl Row {
    fn read(&mut self, walk: &Walk<'_>, y: usize) {
        if self.y != Some(y) {
            let at = (walk.slice, y);
            self.any = walk.casters.row(&walk.columns.shear, at, &mut self.opacities);
            self.y = Some(y);
        }
    }
}

impl Opacities {
    fn new(across: usize) -> Self {
        let room = across.next_multiple_of(EDGE);
        let row = || Row { y: None, any: false, opacities: vec![0.0; room] };
        Self { lower: row(), upper: row(), row: vec![0.0; across + 2] }
    }

    /// Interpolates between the rows of voxels `y − 1` and `y`, which row `y` of columns goes between; whether anything
    /// is there. Rows that are not there are the border's again.
    fn read(&mut self, walk: &Walk<'_>, y: usize) -> bool {
        let [across, down, _] = walk.columns.shear.size;
        let phase = walk.phase[1];
        std::mem::swap(&mut self.lower, &mut self.upper);
        self.upper.read(walk, y.min(down - 1));
        let mut any = self.upper.any;
        if phase > 0.0 {
            self.lower.read(walk, y.saturating_sub(1));
            any |= self.lower.any;
        }
        if !any {
            return false;
        }
        let (lower, upper) = (&self.lower.opacities, &self.upper.opacities);
        if phase > 0.0 {
            let between = self.row[1..].iter_mut().zip(lower.iter().zip(upper)).take(across);
            between.for_each(|(row, (low, high))| *row = high + phase * (low - high));
        } else {
            self.row[1..=across].copy_from_slice(&upper[..across]);
        }
        self.row[0] = self.row[1];
        self.row[across + 1] = self.row[across];
        true
    }

    /// The opacity where column `x` of the row meets the slice.
    #[inline]
    fn at(&self, x: usize, phase: f32) -> f32 {
        let (before, behind) = (self.row[x], self.row[x + 1]);
        behind + phase * (before - behind)
    }
}
