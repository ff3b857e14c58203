//! Between which values a cubic stays in each cell of a brick, and how steep it is there at most.
//!
//! In a cell a cubic is a Bézier polynomial, along each axis of four control points that are weighted sums of the four voxels
//! around it, and it stays among them. Intervals take the place of numbers from axis to axis, so that it is three passes over
//! rows of cells. Slopes are made of differences of neighbours, each counting no more than is known of the filter.

use super::bricks::EDGE;
use super::grid::Scalar;
use crate::components::Filter;

/// Voxels that the cells of a brick reach along an axis: from the one before it to two behind its last.
const REACH: usize = EDGE + 3;
/// Rows of voxels, y before z; beyond the grid they go on in a straight line, as the field does.
type Voxels = [[f32; REACH]; REACH * REACH];
/// A number for each cell of a row.
type Row = [f32; EDGE];

/// The cells of a brick.
pub(super) struct Hull {
    /// The least value and the greatest, by rows of cells, y before z.
    values: Vec<[Row; 2]>,
    /// The greatest slope along each axis, per voxel; of a classification that does not ask for it, none.
    slopes: Vec<[Row; 3]>,
    /// The greatest number that it is made of.
    greatest: f32,
}

impl Hull {
    /// That of the brick of cells at voxel `first`; `None` where a voxel that it is made of is no finite number.
    pub fn of<T: Scalar>(
        values: &[T],
        (size, first): ([usize; 3], [usize; 3]),
        (filter, slopes): (Filter, bool),
    ) -> Option<Self> {
        let voxels = voxels(values, size, first);
        let greatest = voxels.as_flattened().iter().fold(0.0_f32, |most, v| most.max(v.abs()));
        // A NaN is lost in a greatest number, and not in a sum.
        let is_finite = voxels.as_flattened().iter().map(|v| v * 0.0).sum::<f32>() == 0.0;
        is_finite.then(|| Self {
            values: if filter == Filter::CatmullRom {
                hulls::<true>(&voxels)
            } else {
                hulls::<false>(&voxels)
            },
            slopes: if slopes { steepest(&voxels, filter) } else { Vec::new() },
            greatest,
        })
    }

    /// The least and the greatest values of a row of cells, with so much room for rounding, of the greatest number.
    pub fn values(&self, y: usize, z: usize, rounding: f32) -> [Row; 2] {
        let [low, high] = self.values[z * EDGE + y];
        let room = rounding * self.greatest;
        [low.map(|value| value - room), high.map(|value| value + room)]
    }

    /// The longest gradients of a row of cells, where an axis has its slopes in the world by `to_world`.
    pub fn gradients(&self, y: usize, z: usize, rounding: f32, to_world: &Axes) -> [f64; EDGE] {
        let Some(slopes) = self.slopes.get(z * EDGE + y) else { return [0.0; EDGE] };
        let room = rounding * self.greatest;
        std::array::from_fn(|n| to_world.longest(slopes.map(|slope| f64::from(slope[n] + room))))
    }
}

/// How slopes along the axes of a grid add up to a gradient in the world.
pub(super) struct Axes {
    lengths: [f64; 3],
    are_orthogonal: bool,
}

impl Axes {
    /// By what a slope of 1 a voxel along each axis is in the world.
    pub fn new(axes: [glam::DVec3; 3]) -> Self {
        let apart = |a: usize, b: usize| {
            axes[a].dot(axes[b]).abs() <= 1e-9 * axes[a].length() * axes[b].length()
        };
        let are_orthogonal = apart(0, 1) && apart(1, 2) && apart(0, 2);
        Self { lengths: axes.map(|axis| axis.length() * (1.0 + 1e-6)), are_orthogonal }
    }

    fn longest(&self, slopes: [f64; 3]) -> f64 {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|axis| slopes[axis] * self.lengths[axis]);
        if self.are_orthogonal { (x * x + y * y + z * z).sqrt() } else { x + y + z }
    }
}

/// The voxels around a brick of cells.
fn voxels<T: Scalar>(values: &[T], size: [usize; 3], first: [usize; 3]) -> Voxels {
    let mut made = [[0.0; REACH]; REACH * REACH];
    let near = |axis: usize, n: usize| (first[axis] + n).saturating_sub(1).min(size[axis] - 1);
    for (at, row) in made.iter_mut().enumerate() {
        let line = (near(2, at / REACH) * size[1] + near(1, at % REACH)) * size[0];
        if first[0] > 0 && first[0] + REACH - 1 <= size[0] {
            let voxels = &values[line + first[0] - 1..][..REACH];
            row.iter_mut().zip(voxels).for_each(|(made, voxel)| *made = voxel.value());
        } else {
            row.iter_mut().enumerate().for_each(|(x, v)| *v = values[line + near(0, x)].value());
        }
    }
    // Beyond the grid: the two voxels at its end, and what each counts.
    let beyond = |axis: usize, n: usize| {
        let last = size[axis] - first[axis];
        let before = (n == 0 && first[axis] == 0).then_some([1, 2, 1]);
        before.or((n > last).then(|| [last, last - 1, n - last]))
    };
    for n in 0..REACH {
        if let Some([end, inner, times]) = beyond(0, n) {
            for row in &mut made {
                row[n] = row[end] + times as f32 * (row[end] - row[inner]);
            }
        }
    }
    for (axis, step, other) in [(1, 1, REACH), (2, REACH, 1)] {
        for n in 0..REACH {
            let Some([end, inner, times]) = beyond(axis, n) else { continue };
            for line in (0..REACH).map(|line| line * other) {
                let [end, inner] = [end, inner].map(|at| made[line + at * step]);
                let own = &mut made[line + n * step];
                for x in 0..REACH {
                    own[x] = end[x] + times as f32 * (end[x] - inner[x]);
                }
            }
        }
    }
    made
}

/// Control points of four intervals: between which numbers they lie, of Catmull and Rom's spline or of the others.
#[inline]
fn hull<const CATMULL_ROM: bool>(four: [[f32; 2]; 4]) -> [f32; 2] {
    let [a, b, c, d] = four;
    let points = if CATMULL_ROM {
        let sixth =
            |end: usize, plus: [f32; 2], minus: [f32; 2]| (plus[end] - minus[1 - end]) / 6.0;
        [0, 1].map(|end| [b[end], b[end] + sixth(end, c, a), c[end] - sixth(1 - end, d, b), c[end]])
    } else {
        [0, 1].map(|end| {
            let [a, b, c, d] = [a[end], b[end], c[end], d[end]];
            let middle = |a: f32, b: f32, c: f32| (a + c + 4.0 * b) / 6.0;
            [middle(a, b, c), (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0, middle(b, c, d)]
        })
    };
    let [low, high] = points;
    let least = |a: f32, b: f32| if a < b { a } else { b };
    let most = |a: f32, b: f32| if a > b { a } else { b };
    [
        least(least(low[0], low[1]), least(low[2], low[3])),
        most(most(high[0], high[1]), most(high[2], high[3])),
    ]
}

/// The least and the greatest values of each row of cells.
fn hulls<const CATMULL_ROM: bool>(voxels: &Voxels) -> Vec<[Row; 2]> {
    let along_x = voxels.iter().map(|row| {
        let mut made = [[0.0; EDGE]; 2];
        for x in 0..EDGE {
            let four = [row[x], row[x + 1], row[x + 2], row[x + 3]].map(|v| [v; 2]);
            let [low, high] = hull::<CATMULL_ROM>(four);
            (made[0][x], made[1][x]) = (low, high);
        }
        made
    });
    let along_x: Vec<_> = along_x.collect();
    let along_y = narrow::<CATMULL_ROM>(&along_x, (REACH, REACH));
    // With the axes in turn, z is where y was.
    let turned: Vec<_> =
        (0..EDGE * REACH).map(|at| along_y[at % REACH * EDGE + at / REACH]).collect();
    let along_z = narrow::<CATMULL_ROM>(&turned, (REACH, EDGE));
    (0..EDGE * EDGE).map(|at| along_z[at % EDGE * EDGE + at / EDGE]).collect()
}

/// Of `lines` lines of `reach` rows each, the rows of cells.
fn narrow<const CATMULL_ROM: bool>(
    rows: &[[Row; 2]],
    (reach, lines): (usize, usize),
) -> Vec<[Row; 2]> {
    let mut made = Vec::with_capacity(lines * EDGE);
    for line in 0..lines {
        for cell in 0..EDGE {
            let four = &rows[line * reach + cell..][..4];
            let mut row = [[0.0; EDGE]; 2];
            for x in 0..EDGE {
                let of = |n: usize| [four[n][0][x], four[n][1][x]];
                let [low, high] = hull::<CATMULL_ROM>([of(0), of(1), of(2), of(3)]);
                (row[0][x], row[1][x]) = (low, high);
            }
            made.push(row);
        }
    }
    made
}

/// The greatest slopes of each row of cells.
fn steepest(voxels: &Voxels, filter: Filter) -> Vec<[Row; 3]> {
    // A spline's slope is a mean of differences. Catmull and Rom's leans on its neighbours' by a quarter, and its values do.
    let times = if filter == Filter::CatmullRom { 1.5 * 1.25 * 1.25 } else { 1.0 };
    let mut made = vec![[[0.0; EDGE]; 3]; EDGE * EDGE];
    for axis in 0..3 {
        let step = [0, 1, REACH][axis];
        let mut apart = [[0.0; REACH]; REACH * REACH];
        for at in 0..REACH * REACH - step {
            for x in 0..REACH - usize::from(axis == 0) {
                let behind = if axis == 0 { voxels[at][x + 1] } else { voxels[at + step][x] };
                apart[at][x] = (behind - voxels[at][x]).abs();
            }
        }
        let reach = std::array::from_fn(|other| if other == axis { 3 } else { 4 });
        for (made, most) in made.iter_mut().zip(most_of(&apart, reach)) {
            made[axis] = most.map(|most| most * times);
        }
    }
    made
}

/// The greatest of as many numbers along each axis as each cell reaches, from its own on.
fn most_of(numbers: &Voxels, reach: [usize; 3]) -> Vec<Row> {
    let most = |a: f32, b: f32| if a > b { a } else { b };
    let along_x: Vec<Row> = numbers
        .iter()
        .map(|row| {
            let mut made = [0.0; EDGE];
            for n in 0..reach[0] {
                for x in 0..EDGE {
                    made[x] = most(made[x], row[x + n]);
                }
            }
            made
        })
        .collect();
    let of = |rows: &[Row], first: usize, step: usize, count: usize| {
        let mut made = rows[first];
        for n in 1..count {
            for x in 0..EDGE {
                made[x] = most(made[x], rows[first + n * step][x]);
            }
        }
        made
    };
    let along_y: Vec<Row> = (0..REACH * EDGE)
        .map(|at| of(&along_x, at / EDGE * REACH + at % EDGE, 1, reach[1]))
        .collect();
    (0..EDGE * EDGE).map(|at| of(&along_y, at, EDGE, reach[2])).collect()
}

#[cfg(test)]
mod tests;
