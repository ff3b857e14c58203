//! Which cells of a field may be seen: ruled out by the values of the voxels that its filter reaches, and by how far those
//! are apart. Of what is ruled out, no place between the voxels has an opacity above 0.

use rayon::prelude::*;

use super::bricks::EDGE;
use super::classification::Classifier;
use super::clipping::{Cut, Left};
use super::filter::{overshoot, steepness};
use super::gradients::Gradients;
use super::grid::{Grid, Scalar, Scalars};
use super::pyramid::Pyramid;
use super::ranges::{Range, Ranges};
use crate::components::Filter;
use crate::schedule::Watch;
use crate::with_scalars;

/// Voxels that the cells of a brick reach along an axis: from the one before it to two behind its last.
const REACH: usize = EDGE + 3;
/// What rounding may do to a value, of the greatest number it is made of: more than ten times what it does.
const ROUNDING: f32 = 1e-5;
/// Room of a row: of whole vectors.
const WIDTH: usize = 12;
/// Rows of voxels, y before z.
type Block = [[f32; WIDTH]; REACH * REACH];

/// What decides which cells are seen.
pub struct Seen<'a> {
    /// What is interpolated.
    pub scalars: &'a Scalars,
    /// Of those scalars.
    pub ranges: &'a Ranges,
    /// Where they are.
    pub grid: &'a Grid,
    /// How they are interpolated.
    pub filter: Filter,
    /// What is seen of them.
    pub classifier: &'a Classifier,
    /// What is cut away.
    pub cut: Option<&'a Cut>,
}

impl Seen<'_> {
    /// The pyramid of the cells that may be seen. Stops early, with one of no meaning, if `watch` is told to.
    #[must_use]
    pub fn pyramid(&self, watch: &Watch) -> Pyramid {
        let counts = self.grid.size.map(|n| n.div_ceil(EDGE));
        let gradients = Gradients::new(self.grid);
        let of = |at: usize| {
            let brick = [at % counts[0], at / counts[0] % counts[1], at / (counts[0] * counts[1])];
            if watch.check().is_err() || !self.may_show(&gradients, brick, counts) {
                return None;
            }
            let cells =
                with_scalars!(self.scalars, values => self.cells(&gradients, values, brick));
            cells.iter().any(|word| *word != 0).then_some(cells)
        };
        let found: Vec<_> = (0..counts.iter().product()).into_par_iter().map(of).collect();
        let mut cells = Vec::new();
        let stored = |found: Option<[u64; EDGE]>| {
            found.map_or(u32::MAX, |found| {
                cells.push(found);
                cells.len() as u32 - 1
            })
        };
        let table = found.into_iter().map(stored).collect();
        Pyramid::of_cells(counts, table, cells)
    }

    /// Whether anything of a brick of cells may be seen, by the ranges of the bricks that it reaches.
    fn may_show(&self, gradients: &Gradients, brick: [usize; 3], counts: [usize; 3]) -> bool {
        let first = brick.map(|b| b * EDGE);
        let extent = std::array::from_fn(|axis| (EDGE + 1).min(self.grid.size[axis] - first[axis]));
        if self.cut.is_some_and(|cut| cut.left(first, extent) == Left::Nothing) {
            return false;
        }
        let mut all = Range { low: f32::INFINITY, high: f32::NEG_INFINITY, spread: 0.0 };
        for corner in 0..8_usize {
            let next = std::array::from_fn(|axis| {
                (brick[axis] + (corner >> axis & 1)).min(counts[axis] - 1)
            });
            let Range { low, high, .. } = self.ranges.around(next);
            (all.low, all.high) = (all.low.min(low), all.high.max(high));
        }
        self.shows(gradients, all, [all.low, all.high], (first, extent))
    }

    /// Whether something may be seen whose value is made of voxels in `value`, and its gradient of such in `slopes`.
    fn shows(
        &self,
        gradients: &Gradients,
        value: Range,
        slopes: [f32; 2],
        (first, extent): ([usize; 3], [usize; 3]),
    ) -> bool {
        let Range { low, high, .. } = value;
        if low > high {
            return false;
        }
        let border = (0..3).any(|a| first[a] == 0 || first[a] + extent[a] >= self.grid.size[a]);
        // A cubic that leaves the range of its voxels does so from where a straight line continues them, too.
        let (wider, steeper) = match overshoot(self.filter) {
            1.0 => (0.0, 1.0),
            most if border => (1.0 + 1.5 * (most - 1.0), 3.0),
            most => (0.5 * (most - 1.0), 1.0),
        };
        let apart = |low: f32, high: f32| {
            let apart = high - low;
            if apart.is_nan() { f32::INFINITY } else { apart }
        };
        let slack = wider * apart(low, high) + ROUNDING * low.abs().max(high.abs());
        let spread = apart(slopes[0], slopes[1]) * steepness(self.filter) * steeper;
        let rounding = ROUNDING * slopes[0].abs().max(slopes[1].abs());
        let range = Range { low: low - slack, high: high + slack, spread };
        self.classifier.may_show(range, gradients.at_most(spread + rounding, first, extent))
    }

    /// The cells of a brick that may be seen: bit `8 y + x` of word `z`.
    fn cells<T: Scalar>(
        &self,
        gradients: &Gradients,
        values: &[T],
        brick: [usize; 3],
    ) -> [u64; EDGE] {
        let first = brick.map(|b| b * EDGE);
        let slopes = self.classifier.is_of_gradient();
        let linear = self.filter == Filter::Linear;
        let around = Around::of(values, (self.grid.size, first), linear, slopes);
        let [ex, ey, ez]: [usize; 3] =
            std::array::from_fn(|axis| EDGE.min(self.grid.size[axis] - first[axis]));
        let shows = |[x, y, z]: [usize; 3], extent: [usize; 3]| {
            let (value, slopes) = around.extremes([x, y, z], extent);
            let range = Range { low: value[0], high: value[1], spread: 0.0 };
            let first = [first[0] + x, first[1] + y, first[2] + z];
            self.shows(gradients, range, slopes, (first, extent.map(|n| n + 1)))
        };
        let mut words = [0; EDGE];
        // Whole slices and rows first, of which most are far from what is seen.
        for z in (0..ez).filter(|&z| shows([0, 0, z], [ex, ey, 1])) {
            for y in (0..ey).filter(|&y| shows([0, y, z], [ex, 1, 1])) {
                for x in (0..ex).filter(|&x| shows([x, y, z], [1; 3])) {
                    words[z] |= 1 << (EDGE * y + x);
                }
            }
        }
        words
    }
}

/// The extremes of the voxels that each cell of a brick is made of.
struct Around {
    /// For values: the least, and the most.
    values: [Block; 2],
    /// For slopes; those for values where there is nothing else.
    slopes: Option<[Block; 2]>,
}

impl Around {
    fn of<T: Scalar>(
        values: &[T],
        (size, first): ([usize; 3], [usize; 3]),
        linear: bool,
        slopes: bool,
    ) -> Self {
        let [least, most] = blocks(values, size, first);
        let (low, high) = (halved(&least, less, 1), halved(&most, more, 1));
        let far = || [halved(&low, less, 2), halved(&high, more, 2)];
        // The voxels of a linear cell begin one behind those that its slopes need.
        let own = |block: Block| {
            let mut moved = block;
            for at in 0..REACH * REACH - REACH - 1 {
                moved[at][..REACH].copy_from_slice(&block[at + REACH + 1][1..=REACH]);
            }
            moved
        };
        if linear {
            Self { values: [own(low), own(high)], slopes: slopes.then(far) }
        } else {
            Self { values: far(), slopes: None }
        }
    }

    /// Those of some cells together: of their values, and of their slopes.
    fn extremes(&self, [x, y, z]: [usize; 3], [nx, ny, nz]: [usize; 3]) -> ([f32; 2], [f32; 2]) {
        let of = |[least, most]: &[Block; 2]| {
            let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
            for at in (z..z + nz).flat_map(|z| (y..y + ny).map(move |y| z * REACH + y)) {
                low = least[at][x..x + nx].iter().fold(low, |a, b| less(a, *b));
                high = most[at][x..x + nx].iter().fold(high, |a, b| more(a, *b));
            }
            [low, high]
        };
        let values = of(&self.values);
        (values, self.slopes.as_ref().map_or(values, of))
    }
}

fn less(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

fn more(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The values around a brick of cells, of which those beyond the grid are its nearest: a NaN as what is never the least, and
/// as what is never the most.
fn blocks<T: Scalar>(values: &[T], size: [usize; 3], first: [usize; 3]) -> [Block; 2] {
    let mut least = [[0.0; WIDTH]; REACH * REACH];
    let near = |axis: usize, n: usize| (first[axis] + n).saturating_sub(1).min(size[axis] - 1);
    let inside = first[0] > 0 && first[0] + REACH - 1 <= size[0];
    for (at, row) in least.iter_mut().enumerate() {
        let line = (near(2, at / REACH) * size[1] + near(1, at % REACH)) * size[0];
        if inside {
            let voxels = &values[line + first[0] - 1..][..REACH];
            row.iter_mut().zip(voxels).for_each(|(made, voxel)| *made = voxel.value());
        } else {
            let row = row.iter_mut().take(REACH).enumerate();
            row.for_each(|(x, made)| *made = values[line + near(0, x)].value());
        }
    }
    let mut most = least;
    if T::HAS_NAN {
        for (low, high) in least.as_flattened_mut().iter_mut().zip(most.as_flattened_mut()) {
            if low.is_nan() {
                (*low, *high) = (f32::INFINITY, f32::NEG_INFINITY);
            }
        }
    }
    [least, most]
}

/// The better of each voxel and that `step` behind it, along every axis; at the block's end it means nothing.
#[inline]
fn halved(block: &Block, better: impl Fn(f32, f32) -> f32, step: usize) -> Block {
    let mut made = *block;
    for row in &mut made {
        for x in 0..WIDTH - step {
            row[x] = better(row[x], row[x + step]);
        }
    }
    for step in [step, step * REACH] {
        for at in 0..REACH * REACH - step {
            let behind = made[at + step];
            made[at].iter_mut().zip(behind).for_each(|(own, behind)| *own = better(*own, behind));
        }
    }
    made
}
