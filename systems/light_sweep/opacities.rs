//! Opacities where columns meet a slice: the only thing that a sweep interpolates, bilinearly within the slice.

use std::ops::Range;

use super::casters::Casters;
use crate::light::strength::Shear;
use crate::volume::bricks::EDGE;

/// A row of opacities for columns to meet.
pub(super) struct Opacities {
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
    fn read(&mut self, (casters, shear): (&Casters, &Shear), (slice, y): (usize, usize)) {
        if self.y != Some(y) {
            self.any = casters.row(shear, (slice, y), &mut self.opacities);
            self.y = Some(y);
        }
    }
}

impl Opacities {
    /// Room for slices of so many voxels across; for one slice.
    pub fn new(across: usize) -> Self {
        let room = across.next_multiple_of(EDGE);
        let row = || Row { y: None, any: false, opacities: vec![0.0; room] };
        Self { lower: row(), upper: row(), row: vec![0.0; across + 2] }
    }

    /// Interpolates between the rows of voxels `y − 1` and `y` of a slice, which row `y` of columns goes between: it lies
    /// `phase` before the latter. Whether anything is there. Rows that are not there are the border's again.
    pub fn read(
        &mut self,
        from: (&Casters, &Shear),
        (slice, y): (usize, usize),
        phase: f32,
    ) -> bool {
        let [across, down, _] = from.1.size;
        std::mem::swap(&mut self.lower, &mut self.upper);
        self.upper.read(from, (slice, y.min(down - 1)));
        let mut any = self.upper.any;
        if phase > 0.0 {
            self.lower.read(from, (slice, y.saturating_sub(1)));
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

    /// The opacities that some columns meet the slice between: one more than columns, the first is of the voxel before them.
    pub fn around(&self, columns: Range<usize>) -> &[f32] {
        &self.row[columns.start..=columns.end]
    }

    /// The opacity where column `x` of the row meets the slice.
    #[inline]
    pub fn at(&self, x: usize, phase: f32) -> f32 {
        between(self.row[x], self.row[x + 1], phase)
    }
}

/// The opacity so far before a voxel, on the way to it from the one before.
#[allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]
#[inline(always)]
pub(super) fn between(before: f32, behind: f32, phase: f32) -> f32 {
    behind + phase * (before - behind)
}
