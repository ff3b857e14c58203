//! The coefficients of the cubic B-spline that goes through the voxels: a smooth field that is not smoother than the data.
//!
//! Along a line of voxels they solve `(c₋₁ + 4 c₀ + c₁) / 6 = f` with a straight continuation at both ends, where so `c = f`:
//! a tridiagonal system, solved by elimination (Unser, Aldroubi and Eden 1993 solve it by recursion).

use rayon::prelude::*;

use super::grid::{Grid, Scalars};
use super::ranges::Ranges;
use crate::schedule::{Product, Watch};
use crate::shared::Shared;

/// Coefficients as many as voxels, and between which of them each brick lies. Equality is identity.
#[derive(Debug, Clone, PartialEq)]
pub struct Coefficients {
    /// In 32-bit floats.
    pub values: Scalars,
    /// Of the coefficients.
    pub ranges: Ranges,
}

impl Product for Coefficients {}

impl Coefficients {
    /// The coefficients of scalars on a grid. What the line of a voxel that is no number goes through is none either.
    ///
    /// Stops early, with coefficients of no meaning, if `watch` is told to.
    #[must_use]
    pub fn of(scalars: &Scalars, grid: &Grid, watch: &Watch) -> Self {
        let [nx, ny, nz] = grid.size;
        let mut made: Vec<f32> = (0..scalars.len()).map(|at| scalars.value(at)).collect();
        let factors = [nx, ny, nz].map(factors);
        made.par_chunks_mut(nx * ny).for_each(|slice| {
            if watch.check().is_ok() {
                slice.chunks_mut(nx).for_each(|row| solve(row, 1, &factors[0]));
                solve(slice, nx, &factors[1]);
            }
        });
        if watch.check().is_ok() {
            solve(&mut made, nx * ny, &factors[2]);
        }
        let values = Scalars::F32(Shared::new(made));
        let ranges = Ranges::of(&values, grid.size, watch);
        Self { values, ranges }
    }
}

/// The most bytes that they take, for a plan.
#[must_use]
pub fn bytes(size: [usize; 3]) -> u64 {
    let voxels = size.iter().fold(4_u64, |bytes, &n| bytes.saturating_mul(n as u64));
    voxels.saturating_add(super::ranges::bytes(size))
}

/// What elimination divides by at each voxel of a line: 1 at its ends.
fn factors(n: usize) -> Vec<f64> {
    let mut factors = vec![0.0; n];
    for at in 1..n.saturating_sub(1) {
        factors[at] = 1.0 / (4.0 - factors[at - 1]);
    }
    factors
}

/// Lines that are solved together: what they need in 64 bits stays small.
const TOGETHER: usize = 4096;

/// Solves lines side by side, `width` numbers apart from voxel to voxel; in 64 bits, so that what is constant stays constant
/// to the last bit and has no gradient.
fn solve(lines: &mut [f32], width: usize, factors: &[f64]) {
    let n = factors.len();
    let mut exact = Vec::new();
    for first in (0..width).step_by(TOGETHER) {
        let count = TOGETHER.min(width - first);
        exact.clear();
        for row in lines.chunks_exact(width) {
            exact.extend(row[first..][..count].iter().map(|value| f64::from(*value)));
        }
        for at in 1..n - 1 {
            let (before, own) = exact.split_at_mut(at * count);
            let before = &before[(at - 1) * count..];
            for (own, before) in own[..count].iter_mut().zip(before) {
                *own = (6.0 * *own - before) * factors[at];
            }
        }
        for at in (1..n - 1).rev() {
            let (own, behind) = exact.split_at_mut((at + 1) * count);
            for (own, behind) in own[at * count..].iter_mut().zip(&behind[..count]) {
                *own -= behind * factors[at];
            }
        }
        for (row, exact) in lines.chunks_exact_mut(width).zip(exact.chunks_exact(count)) {
            let solved = exact.iter().map(|value| *value as f32);
            row[first..][..count].iter_mut().zip(solved).for_each(|(own, solved)| *own = solved);
        }
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::Level;

    use super::*;
    use crate::components::Filter;
    use crate::volume::field::{Field, Sampled, Spot};

    #[test]
    fn the_spline_of_the_coefficients_goes_through_every_voxel() {
        for size in [[2, 3, 4], [9, 5, 12]] {
            let grid = Grid::axis_aligned(size, [1.0; 3], [0.0; 3]).unwrap();
            let value = |at: usize| (at * at % 251) as u8;
            let voxels: Vec<u8> = (0..grid.voxels()).map(value).collect();
            let made = Coefficients::of(&voxels.into(), &grid, &Watch::default());
            let field = Field::new(&made.values, &grid, Filter::Interpolating);
            for at in 0..grid.voxels() {
                let cell = [at % size[0], at / size[0] % size[1], at / (size[0] * size[1])];
                let mut found = [Sampled::default()];
                field.sample(Level::new(), &[Spot { cell, part: [0.0; 3] }], &mut found);
                assert!((found[0].value - f32::from(value(at))).abs() < 1e-3, "{cell:?}");
            }
            assert_eq!(bytes(size), made.values.bytes() + made.ranges.bytes());
        }
    }
}
