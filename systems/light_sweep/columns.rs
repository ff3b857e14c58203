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
    /// The kept columns that are in the volume at this slice, and at the one before.
    entered: [Range<usize>; 2],
    came: [Range<usize>; 2],
    /// What is added to the place of a kept column to get its place at the slice before.
    shift: [isize; 2],
}

/// A row of opacities at columns' places, interpolated in the slice.
struct Opacities {
    lower: Vec<f32>,
    upper: Vec<f32>,
    /// Both interpolated, with one voxel repeated at each end.
    row: Vec<f32>,
    occupied: [Vec<bool>; 2],
}

impl<'a> Walk<'a> {
    fn new(columns: &'a Columns<'a>, slice: usize, casters: &'a Casters) -> Self {
        let shear = &columns.shear;
        let entered = shear.entered(slice);
        if slice == 0 {
            return Self { columns, casters, slice, entered, came: [0..0, 0..0], shift: [0; 2] };
        }
        let (low, was) = (shear.window(slice).low, shear.window(slice - 1).low);
        let shift = [low[0] - was[0], low[1] - was[1]].map(|shift| shift as isize);
        Self { columns, casters, slice, entered, came: shear.entered(slice - 1), shift }
    }

    /// Rows of columns from `first` on.
    fn rows(&self, first: usize, next: &mut [f64], strengths: &mut [f32]) {
        let shear = &self.columns.shear;
        let width = shear.width()[0];
        let mut opacities = Opacities::new(shear.size[0]);
        let rows = next.chunks_exact_mut(width).zip(strengths.chunks_exact_mut(width));
        for (y, (next, strengths)) in (first..).zip(rows) {
            let any = self.entered[1].contains(&y) && opacities.read(self, y);
            for (x, (next, strength)) in next.iter_mut().zip(strengths).enumerate() {
                let (at, leaving) = self.step([x, y], any.then_some(&opacities));
                (*strength, *next) = (at as f32, leaving);
            }
        }
    }

    /// β_0 · T of a column at the slice, and behind the slice's farther half-slab.
    #[inline]
    fn step(&self, [x, y]: [usize; 2], opacities: Option<&Opacities>) -> (f64, f64) {
        let inside = self.entered[0].contains(&x) && self.entered[1].contains(&y);
        let opacity = match opacities {
            Some(opacities) if inside => opacities.at(x, self.phase()),
            _ => 0.0,
        };
        let arriving = if inside { self.arriving([x, y]) } else { None };
        match arriving {
            Some(arriving) if opacity > 0.0 => {
                let half = 1.0 - thicken(opacity, self.columns.ratio / 2.0);
                (arriving * half, arriving * half * half)
            }
            Some(arriving) => (arriving, arriving),
            None => self.enter([x, y], opacity),
        }
    }

    /// A column that was not in the volume at the slice before.
    #[cold]
    fn enter(&self, at: [usize; 2], opacity: f64) -> (f64, f64) {
        let Columns { shear, ratio, .. } = self.columns;
        let low = shear.window(self.slice).low;
        let column = [at[0] as f64 + low[0] as f64, at[1] as f64 + low[1] as f64];
        let initial = self.columns.initial(column);
        if opacity <= 0.0 {
            return (initial, initial);
        }
        let strength = initial * (1.0 - thicken(opacity, ratio * shear.depth(self.slice, at)));
        (strength, strength * (1.0 - thicken(opacity, ratio / 2.0)))
    }

    /// What left the slice before along a column, if it was in the volume there.
    #[inline]
    fn arriving(&self, [x, y]: [usize; 2]) -> Option<f64> {
        let x = x.checked_add_signed(self.shift[0]).filter(|x| self.came[0].contains(x))?;
        let y = y.checked_add_signed(self.shift[1]).filter(|y| self.came[1].contains(y))?;
        Some(self.columns.leaving[y * self.columns.shear.width()[0] + x])
    }

    fn phase(&self) -> [f64; 2] {
        self.columns.shear.window(self.slice).phase
    }
}

impl Opacities {
    fn new(across: usize) -> Self {
        let bricks = across.div_ceil(EDGE);
        let row = || vec![0.0; bricks * EDGE];
        let occupied = || vec![false; bricks];
        let (lower, upper) = (row(), row());
        Self { lower, upper, row: vec![0.0; across + 2], occupied: [occupied(), occupied()] }
    }

    /// Interpolates between the two rows of voxels that row `y` of the columns goes between; whether anything is there.
    fn read(&mut self, walk: &Walk<'_>, y: usize) -> bool {
        let shear = &walk.columns.shear;
        let (phase, last) = (walk.phase()[1] as f32, shear.size[1] - 1);
        let [below, above] = &mut self.occupied;
        // Of the voxels y − 1 and y, those that are not there are the border's again.
        let upper = walk.casters.row(shear, (walk.slice, y.min(last)), &mut self.upper, above);
        if phase == 0.0 {
            std::mem::swap(&mut self.lower, &mut self.upper);
        } else {
            let lower = (walk.slice, y.saturating_sub(1));
            let lower = walk.casters.row(shear, lower, &mut self.lower, below);
            if lower || upper {
                for (low, high) in self.lower.iter_mut().zip(&self.upper) {
                    *low = *high + phase * (*low - *high);
                }
            }
            if !(lower || upper) {
                return false;
            }
        }
        let across = shear.size[0];
        self.row[1..=across].copy_from_slice(&self.lower[..across]);
        self.row[0] = self.row[1];
        self.row[across + 1] = self.row[across];
        upper || phase != 0.0
    }

    /// The opacity where column `x` of the row meets the slice.
    #[inline]
    fn at(&self, x: usize, phase: [f64; 2]) -> f64 {
        let (before, behind) = (self.row[x], self.row[x + 1]);
        f64::from(behind + phase[0] as f32 * (before - behind))
    }
}
