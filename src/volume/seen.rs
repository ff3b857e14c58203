//! Which cells of a field may be seen: ruled out by the values of the voxels that its filter reaches, and by how far those
//! are apart. Of what is ruled out, no place between the voxels has an opacity above 0.

mod by_values;
mod caps;

use rayon::prelude::*;

use super::bricks::EDGE;
use super::classification::Classifier;
use super::clipping::{Cut, Left};
use super::filter::{overshoot, steepness};
use super::gradients::{Gradients, Steepest};
use super::grid::{Grid, Scalar, Scalars};
use super::hull::{Axes, Hull};
use super::interest::Interest;
use super::pyramid::Pyramid;
use super::ranges::Ranges;
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
    /// Whether it is looked for around samples, too.
    pub around: bool,
}

impl Seen<'_> {
    /// The pyramid of the cells that may be seen. Stops early, with one of no meaning, if `watch` is told to.
    #[must_use]
    pub fn pyramid(&self, watch: &Watch) -> Pyramid {
        let counts = self.grid.size.map(|n| n.div_ceil(EDGE));
        let gradients = Gradients::new(self.grid);
        let (risen, closed) = (self.risen(), self.closed_from());
        let of = |at: usize| {
            let brick = [at % counts[0], at / counts[0] % counts[1], at / (counts[0] * counts[1])];
            if watch.check().is_err() {
                return None;
            }
            let caps = closed.map(|least| self.caps(&gradients, (brick, counts), least));
            let mut cells = caps.unwrap_or_default();
            if self.may_show(&gradients, brick, counts) {
                let own = with_scalars!(self.scalars, values => match &risen {
                    Some(risen) => self.cells_by_values(values, brick, risen),
                    None => self.cells(&gradients, values, brick),
                });
                cells.iter_mut().zip(own).for_each(|(cells, own)| *cells |= own);
            }
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
        Pyramid::of_cells(Interest { counts, table, cells }, self.around)
    }

    /// Whether anything of a brick of cells may be seen, by the ranges of the bricks that it reaches.
    fn may_show(&self, gradients: &Gradients, brick: [usize; 3], counts: [usize; 3]) -> bool {
        let first = brick.map(|b| b * EDGE);
        let extent = self.extent(first);
        if self.cut.is_some_and(|cut| cut.left(first, extent) == Left::Nothing) {
            return false;
        }
        let value = self.reached(brick, counts).map(|end| [end]);
        self.shows(&self.bounds(gradients, first), &value, &value) == [1]
    }

    /// The least and the greatest scalar that the cells of a brick reach.
    fn reached(&self, brick: [usize; 3], counts: [usize; 3]) -> [f32; 2] {
        let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
        for corner in 0..8_usize {
            let next = std::array::from_fn(|axis| {
                (brick[axis] + (corner >> axis & 1)).min(counts[axis] - 1)
            });
            let range = self.ranges.around(next);
            (low, high) = (low.min(range.low), high.max(range.high));
        }
        [low, high]
    }

    /// Voxels of a brick of cells, and those that its last cells share with the next.
    fn extent(&self, first: [usize; 3]) -> [usize; 3] {
        std::array::from_fn(|axis| (EDGE + 1).min(self.grid.size[axis] - first[axis]))
    }

    /// Whether such voxels are among the first or the last of the grid.
    fn is_at_border(&self, first: [usize; 3], extent: [usize; 3]) -> bool {
        (0..3).any(|a| first[a] == 0 || first[a] + extent[a] >= self.grid.size[a])
    }

    fn bounds(&self, gradients: &Gradients, first: [usize; 3]) -> Bounds {
        let extent = self.extent(first);
        let border = self.is_at_border(first, extent);
        // A cubic that leaves the range of its voxels does so from where a straight line continues them, too.
        let (wider, steeper) = match overshoot(self.filter) {
            1.0 => (0.0, 1.0),
            most if border => (1.0 + 1.5 * (most - 1.0), 3.0),
            most => (0.5 * (most - 1.0), 1.0),
        };
        let steeper = steepness(self.filter) * steeper;
        Bounds { wider, steeper, steepest: gradients.at_most_per(first, extent) }
    }

    /// Whether something may be seen whose value is made of voxels between two, and its gradient of such between two others:
    /// 1, else 0.
    #[inline]
    fn shows<const N: usize>(
        &self,
        bounds: &Bounds,
        [least, most]: &[[f32; N]; 2],
        [lowest, highest]: &[[f32; N]; 2],
    ) -> [u64; N] {
        let apart = |low: f32, high: f32| {
            let apart = high - low;
            if apart.is_nan() { f32::INFINITY } else { apart }
        };
        let greatest = |low: f32, high: f32| more(low.abs(), high.abs());
        let (mut low, mut high, mut steepest) = ([0.0; N], [0.0; N], [0.0; N]);
        for n in 0..N {
            let slack = bounds.wider * apart(least[n], most[n]);
            let slack = slack + ROUNDING * greatest(least[n], most[n]);
            (low[n], high[n]) = (least[n] - slack, most[n] + slack);
            let spread = apart(lowest[n], highest[n]) * bounds.steeper;
            let spread = spread + ROUNDING * greatest(lowest[n], highest[n]);
            steepest[n] = bounds.steepest.of(spread);
        }
        let mut shown = self.classifier.show(&low, &high, &steepest);
        for n in 0..N {
            shown[n] &= u64::from(least[n] <= most[n]);
        }
        shown
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
        let hull = (!linear)
            .then(|| Hull::of(values, (self.grid.size, first), (self.filter, slopes)))
            .flatten();
        if let Some(hull) = hull {
            return self.cells_of(&hull, first);
        }
        let around = Around::of(values, (self.grid.size, first), linear, slopes);
        let bounds = self.bounds(gradients, first);
        self.words(first, |y, z| {
            let (value, slopes) = around.row(y, z);
            self.shows(&bounds, &value, &slopes)
        })
    }

    /// The cells that may be seen of a brick of a cubic, by its hull.
    fn cells_of(&self, hull: &Hull, first: [usize; 3]) -> [u64; EDGE] {
        let to_world = self.grid.index_to_world.matrix3.inverse().transpose();
        let axes = Axes::new([to_world.x_axis, to_world.y_axis, to_world.z_axis]);
        self.words(first, |y, z| {
            let [low, high] = hull.values(y, z, ROUNDING);
            self.classifier.show(&low, &high, &hull.gradients(y, z, ROUNDING, &axes))
        })
    }

    /// The bits of a brick, of rows of which each tells 1 for what may be seen, else 0.
    fn words(&self, first: [usize; 3], row: impl Fn(usize, usize) -> [u64; EDGE]) -> [u64; EDGE] {
        let [ex, ey, ez]: [usize; 3] =
            std::array::from_fn(|axis| EDGE.min(self.grid.size[axis] - first[axis]));
        let mut words = [0; EDGE];
        for (z, word) in words.iter_mut().enumerate().take(ez) {
            for y in 0..ey {
                let row = row(y, z).iter().rev().fold(0, |bits, shown| bits << 1 | shown);
                *word |= (row & ((1 << ex) - 1)) << (EDGE * y);
            }
        }
        words
    }
}

/// What the filter may make of the voxels of a brick, by their range.
struct Bounds {
    /// How far values may leave the range of theirs, of its width.
    wider: f32,
    /// How much steeper than a central difference a slope may be.
    steeper: f32,
    /// From how far voxels are apart to the longest gradient.
    steepest: Steepest,
}

/// The extremes of the voxels that each cell of a brick is made of: the least, and the most.
struct Around {
    values: [Block; 2],
    /// Where the values of a block's first cell are.
    first: [usize; 2],
    /// For slopes, where they are made of more than values are.
    slopes: Option<[Block; 2]>,
}

impl Around {
    fn of<T: Scalar>(
        values: &[T],
        (size, first): ([usize; 3], [usize; 3]),
        linear: bool,
        slopes: bool,
    ) -> Self {
        let [mut low, mut high] = blocks(values, size, first);
        halve(&mut low, less, 1);
        halve(&mut high, more, 1);
        if !linear {
            halve(&mut low, less, 2);
            halve(&mut high, more, 2);
            return Self { values: [low, high], first: [0; 2], slopes: None };
        }
        // The voxels of a linear cell begin one behind those that its slopes need.
        let first = [REACH + 1, 1];
        let values = [low, high];
        if slopes {
            halve(&mut low, less, 2);
            halve(&mut high, more, 2);
        }
        Self { values, first, slopes: slopes.then_some([low, high]) }
    }

    /// Those of a row of cells: of their values, and of their slopes.
    #[inline]
    fn row(&self, y: usize, z: usize) -> ([[f32; EDGE]; 2], [[f32; EDGE]; 2]) {
        let at = z * REACH + y;
        let of = |block: &Block, [row, x]: [usize; 2]| {
            let mut made = [0.0; EDGE];
            made.copy_from_slice(&block[at + row][x..x + EDGE]);
            made
        };
        let values = [0, 1].map(|end| of(&self.values[end], self.first));
        let far = |blocks: &[Block; 2]| [of(&blocks[0], [0; 2]), of(&blocks[1], [0; 2])];
        (values, self.slopes.as_ref().map_or(values, far))
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

/// Makes each voxel the better of it and that `step` behind it, along every axis; at the block's end it means nothing.
#[inline]
fn halve(block: &mut Block, better: impl Fn(f32, f32) -> f32, step: usize) {
    for row in block.iter_mut() {
        for x in 0..WIDTH - step {
            row[x] = better(row[x], row[x + step]);
        }
    }
    for step in [step, step * REACH] {
        for at in 0..REACH * REACH - step {
            let behind = block[at + step];
            block[at].iter_mut().zip(behind).for_each(|(own, behind)| *own = better(*own, behind));
        }
    }
}
