//! Cells in which a surface is closed by a flat face: those where the grid ends, and where it is cut, as far as they may be
//! above its value.

use super::{ROUNDING, Seen};
use crate::volume::bricks::EDGE;
use crate::volume::clipping::Left;
use crate::volume::gradients::Gradients;

impl Seen<'_> {
    /// The least value of a surface that is closed; `None` without any.
    pub(super) fn closed_from(&self) -> Option<f32> {
        let closed = self.classifier.surfaces().into_iter().filter(|surface| surface.is_capped);
        closed.map(|surface| surface.value).reduce(f32::min)
    }

    /// Such cells of a brick, of surfaces the least of whose values is `least`: bit `8 y + x` of word `z`.
    pub(super) fn caps(
        &self,
        gradients: &Gradients,
        (brick, counts): ([usize; 3], [usize; 3]),
        least: f32,
    ) -> [u64; EDGE] {
        let none = [0; EDGE];
        let first = brick.map(|b| b * EDGE);
        let extent = self.extent(first);
        let left = self.cut.map_or(Left::Whole, |cut| cut.left(first, extent));
        let size = self.grid.size;
        let ends = |axis: usize, cell: usize| cell == 0 || cell + 2 >= size[axis];
        let border = self.is_at_border(first, extent);
        if left == Left::Nothing || (left == Left::Whole && !border) {
            return none;
        }
        let [low, high] = self.reached(brick, counts);
        let slack = self.bounds(gradients, first).wider * (high - low);
        let slack = slack + ROUNDING * high.abs().max(low.abs());
        if low > high || high + slack < least {
            return none;
        }
        let closed = |cell: [usize; 3]| {
            let is_cut = || self.cut.is_some_and(|cut| cut.left(cell, [2; 3]) == Left::Part);
            (0..3).any(|axis| ends(axis, cell[axis])) || (left == Left::Part && is_cut())
        };
        self.words(first, |y, z| {
            std::array::from_fn(|x| u64::from(closed([first[0] + x, first[1] + y, first[2] + z])))
        })
    }
}
