//! Cells of a linear field of which values alone decide whether they are seen: a bit a voxel, in place of the extremes around
//! a cell.

use super::{ROUNDING, Seen};
use crate::components::Filter;
use crate::volume::bricks::EDGE;
use crate::volume::cells::marked_cells;
use crate::volume::grid::Scalar;

/// All cells of a slice of a brick.
const ALL: u64 = u64::MAX;

impl Seen<'_> {
    /// The scalars at which anything is seen, if they alone decide: the values of a linear field lie between those of voxels.
    pub(super) fn risen(&self) -> Option<Vec<[f64; 2]>> {
        (self.filter == Filter::Linear).then(|| self.classifier.risen()).flatten()
    }

    /// The cells of a brick that may be seen, of whose eight voxels one is not below and one not above the scalars of one of the
    /// intervals `risen`: bit `8 y + x` of word `z`.
    pub(super) fn cells_by_values<T: Scalar>(
        &self,
        values: &[T],
        brick: [usize; 3],
        risen: &[[f64; 2]],
    ) -> [u64; EDGE] {
        let first = brick.map(|b| b * EDGE);
        let range = self.ranges.around(brick);
        let slack = f64::from(ROUNDING * range.low.abs().max(range.high.abs()));
        let mut words = [0; EDGE];
        for [low, high] in risen {
            // Rounded away from each other.
            let [low, high] = [low - slack, high + slack];
            let [low, high] = [(low as f32).next_down(), (high as f32).next_up()];
            if range.high < low || range.low > high {
                continue;
            }
            // The range does not tell of a NaN, which is neither.
            let [all_above, all_below] =
                [range.low >= low, range.high <= high].map(|all| all && !T::HAS_NAN);
            let not_below = self.marked(values, first, (all_above, |v| v >= low));
            let not_above = self.marked(values, first, (all_below, |v| v <= high));
            for (word, pair) in words.iter_mut().zip(not_below.into_iter().zip(not_above)) {
                *word |= pair.0 & pair.1;
            }
        }
        self.inside(first, words)
    }

    /// The cells of a brick of whose voxels one is marked, which `all` of them may be known to be.
    fn marked<T: Scalar>(
        &self,
        values: &[T],
        first: [usize; 3],
        (all, is_marked): (bool, impl Fn(f32) -> bool),
    ) -> [u64; EDGE] {
        if all {
            return [ALL; EDGE];
        }
        let size = self.grid.size;
        let bits = |voxels: &[T]| {
            let voxels = voxels.iter().enumerate();
            voxels.fold(0, |bits, (x, voxel)| bits | u64::from(is_marked(voxel.value())) << x)
        };
        // What lies outside the grid is its last voxel again, which is marked as that is.
        let within = |axis: usize, n: usize| (first[axis] + n).min(size[axis] - 1);
        let whole = first[0] + EDGE < size[0];
        marked_cells(|z, y| {
            let from = (within(2, z) * size[1] + within(1, y)) * size[0] + first[0];
            match values[from..].first_chunk::<{ EDGE + 1 }>() {
                Some(nine) if whole => bits(nine),
                _ => bits(&values[from..][..size[0] - first[0]]),
            }
        })
    }

    /// Cells of a brick without those outside the grid.
    fn inside(&self, first: [usize; 3], words: [u64; EDGE]) -> [u64; EDGE] {
        let [ex, ey, ez]: [usize; 3] =
            std::array::from_fn(|axis| EDGE.min(self.grid.size[axis] - first[axis]));
        let row = (1_u64 << ex) - 1;
        let slice = (0..ey).fold(0, |bits, y| bits | row << (EDGE * y));
        std::array::from_fn(|z| if z < ez { words[z] & slice } else { 0 })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::components::{Classify, Contour, Form, Material, TransferPoint};
    use crate::schedule::Watch;
    use crate::volume::classification::Classifier;
    use crate::volume::gradients::Gradients;
    use crate::volume::grid::{Grid, Scalars};
    use crate::volume::ranges::Ranges;

    /// An isovalue, and a hill between two values.
    fn ways(value: f32, wide: f32) -> [Classify; 2] {
        let point = |value, opacity| TransferPoint { value, opacity, color: None };
        let contour =
            Contour { value, opacity: 0.5, thickness_voxels: 1.0, form: Form::Above, color: None };
        let hill =
            vec![point(value, 0.0), point(value + wide, 1.0), point(value + 2.0 * wide, 0.0)];
        [
            Classify { iso: vec![contour], ..Classify::default() },
            Classify { transfer: hill, ..Classify::default() },
        ]
    }

    proptest! {
        #[test]
        fn bits_of_voxels_tell_what_the_extremes_around_a_cell_tell(
            size in [2_usize..19, 2_usize..19, 2_usize..19], seed in any::<u32>(),
            value in 0_u8..100, wide in 1_u8..20, holes in any::<bool>(),
        ) {
            let grid = Grid::axis_aligned(size, [1.0, 2.0, 0.5], [0.0; 3]).unwrap();
            let number = |at: usize| (at as u32).wrapping_mul(seed | 1).wrapping_mul(2_654_435_761) >> 9;
            // Neither is near an end of an interval, so that no slack decides.
            let voxel = |at: usize| match number(at) % 128 {
                7 if holes => f32::NAN,
                n => n as f32 + 0.5,
            };
            let voxels: Vec<f32> = (0..grid.voxels()).map(voxel).collect();
            let scalars = Scalars::from(voxels.clone());
            let ranges = Ranges::of(&scalars, size, &Watch::default());
            for classify in ways(f32::from(value), f32::from(wide)) {
                let classifier = &Classifier::new(&classify, &Material::default(), 1.0);
                let (filter, cut, around) = (Filter::Linear, None, false);
                let seen = Seen { scalars: &scalars, ranges: &ranges, grid: &grid, filter, classifier, cut, around };
                let risen = seen.risen().unwrap();
                let counts = size.map(|n| n.div_ceil(EDGE));
                for at in 0..counts.iter().product() {
                    let brick = [at % counts[0], at / counts[0] % counts[1], at / (counts[0] * counts[1])];
                    let made = seen.cells_by_values(&voxels, brick, &risen);
                    let expected = seen.cells(&Gradients::new(&grid), &voxels, brick);
                    prop_assert_eq!(made, expected, "{:?} {:?}", brick, classify);
                }
            }
        }
    }
}
