//! ∇f on demand: central differences, one-sided at the borders, in world units (algorithm §2).
//!
//! Differences are taken in index space, from numbers of the scanner's own type, and brought to the world by the
//! inverse transpose of the grid's matrix: that is right for anisotropic, flipped and sheared grids alike. No array of
//! them is kept: a volume is mostly not seen, and what is seen is near in memory when it is asked for.

use glam::{DMat3, DVec3, Mat3, Vec3};

use super::bricks::EDGE;
use super::grid::{Grid, Scalar, Scalars};
use crate::with_scalars;

/// Takes the gradients of scalars on a grid, in scalar units per world unit, world axes.
///
/// A voxel whose gradient needs a NaN or an infinite scalar has the gradient zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gradients {
    size: [usize; 3],
    to_world: ToWorld,
    /// The length of the gradient whose differences per voxel are all 1, each in its worst direction.
    steepest: f64,
}

/// From differences per voxel to the world.
#[derive(Debug, Clone, Copy, PartialEq)]
enum ToWorld {
    Scale([f32; 3]),
    Matrix(Mat3),
}

/// More than what is lost of a number of 32 bits so small that it has few digits.
const LEAST: f64 = 1e-44;

/// How long the gradients of a block may be.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Steepest {
    /// Of a spread, what the difference per voxel is at most.
    per: f64,
    steepest: f64,
}

impl Steepest {
    /// The length that none exceeds where scalars differ by at most `spread`.
    #[must_use]
    #[inline]
    pub fn of(self, spread: f32) -> f64 {
        // A little more, for what is rounded on the way through 32 bits.
        let most = self.steepest * (f64::from(spread) * self.per * (1.0 + 1e-5) + LEAST) + LEAST;
        if spread <= 0.0 { 0.0 } else { most }
    }
}

impl Gradients {
    /// The gradients on `grid`.
    #[must_use]
    pub fn new(grid: &Grid) -> Self {
        let to_world = grid.index_to_world.matrix3.inverse().transpose();
        let diagonal = DVec3::new(to_world.x_axis.x, to_world.y_axis.y, to_world.z_axis.z);
        let steepest = [to_world.x_axis, to_world.y_axis, to_world.z_axis];
        let steepest = steepest.into_iter().map(DVec3::abs).sum::<DVec3>().length();
        let to_world = if DMat3::from_diagonal(diagonal) == to_world {
            ToWorld::Scale(diagonal.as_vec3().to_array())
        } else {
            ToWorld::Matrix(to_world.as_mat3())
        };
        Self { size: grid.size, to_world, steepest }
    }

    /// No gradient of the voxels in a block of the grid is longer than this, if the scalars that they need differ by at
    /// most `spread`.
    #[must_use]
    #[inline]
    pub fn at_most(&self, spread: f32, first: [usize; 3], extent: [usize; 3]) -> f64 {
        self.at_most_per(first, extent).of(spread)
    }

    /// [`at_most`](Self::at_most) of a block, for any spread.
    #[must_use]
    #[inline]
    pub(crate) fn at_most_per(&self, first: [usize; 3], extent: [usize; 3]) -> Steepest {
        let one_sided =
            |axis: usize| first[axis] == 0 || first[axis] + extent[axis] >= self.size[axis];
        let per = if (0..3).any(one_sided) { 1.0 } else { 0.5 };
        Steepest { per, steepest: self.steepest }
    }

    /// The gradient of one voxel of `scalars`. Panics outside the grid.
    #[must_use]
    pub fn of(&self, scalars: &Scalars, voxel: [usize; 3]) -> [f32; 3] {
        let mut made = [[0.0; 3]];
        with_scalars!(scalars, values => self.row(values, voxel, &mut made));
        made[0]
    }

    /// Fills `row` with the gradients of the voxels of `values`, the grid's scalars, from voxel `first` on along x.
    /// Panics where the row leaves the grid.
    #[inline]
    pub fn row<T: Scalar>(&self, values: &[T], first: [usize; 3], row: &mut [[f32; 3]]) {
        match &self.to_world {
            ToWorld::Scale([x, y, z]) => {
                self.differences(values, first, row, |d| [d[0] * x, d[1] * y, d[2] * z]);
            }
            ToWorld::Matrix(matrix) => {
                self.differences(values, first, row, |d| (*matrix * Vec3::from(d)).to_array());
            }
        }
    }

    /// The gradients of a brick's row, axis by axis: of its `n` voxels from `first` on, zeros after them; to the last bit those
    /// of [`row`](Self::row). Panics where the row leaves the grid.
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    pub(crate) fn side_by_side<T: Scalar>(
        &self,
        values: &[T],
        first: [usize; 3],
        n: usize,
    ) -> [[f32; EDGE]; 3] {
        let ([x, y, z], [nx, ny, nz]) = (first, self.size);
        let mut made = [[0.0; EDGE]; 3];
        if x == 0 || x + EDGE >= nx {
            let mut row = [[0.0; 3]; EDGE];
            self.row(values, first, &mut row[..n]);
            for (at, gradient) in row.into_iter().enumerate() {
                made.iter_mut().zip(gradient).for_each(|(made, part)| made[at] = part);
            }
            return made;
        }
        let eight = |x: usize, y: usize, z: usize| {
            values[(z * ny + y) * nx + x..].first_chunk::<EDGE>().expect("the row is inside")
        };
        let ((y0, y1, per_y), (z0, z1, per_z)) = (neighbours(y, ny), neighbours(z, nz));
        let pairs = [
            (eight(x + 1, y, z), eight(x - 1, y, z), 0.5),
            (eight(x, y1, z), eight(x, y0, z), per_y),
            (eight(x, y, z1), eight(x, y, z0), per_z),
        ];
        for (made, (high, low, per)) in made.iter_mut().zip(pairs) {
            for at in 0..EDGE {
                made[at] = high[at].minus(low[at]) * per;
            }
        }
        match &self.to_world {
            ToWorld::Scale(scale) => {
                for (made, scale) in made.iter_mut().zip(scale) {
                    for made in made {
                        *made *= scale;
                    }
                }
            }
            ToWorld::Matrix(matrix) => {
                let [x, y, z] = made;
                for (axis, made) in made.iter_mut().enumerate() {
                    let [from_x, from_y, from_z] = matrix.row(axis).to_array();
                    for at in 0..EDGE {
                        made[at] = from_x * x[at] + from_y * y[at] + from_z * z[at];
                    }
                }
            }
        }
        let [x, y, z] = &mut made;
        for at in 0..EDGE {
            // As in `finite`.
            let is_finite = x[at] * 0.0 + y[at] * 0.0 + z[at] * 0.0 == 0.0;
            let kept = |part: f32| if is_finite { part } else { 0.0 };
            (x[at], y[at], z[at]) = (kept(x[at]), kept(y[at]), kept(z[at]));
        }
        made
    }

    /// The differences per voxel of a row, each passed through `to_world`.
    #[inline]
    fn differences<T: Scalar>(
        &self,
        values: &[T],
        [x, y, z]: [usize; 3],
        row: &mut [[f32; 3]],
        to_world: impl Fn([f32; 3]) -> [f32; 3],
    ) {
        let [nx, ny, nz] = self.size;
        let line = |y: usize, z: usize| &values[(z * ny + y) * nx..][..nx];
        let ((y0, y1, per_y), (z0, z1, per_z)) = (neighbours(y, ny), neighbours(z, nz));
        let own = line(y, z);
        // Slices of one length, so that the loop inside checks no bounds and runs in lanes.
        let [low_y, high_y] = [line(y0, z), line(y1, z)].map(|line| &line[x..][..row.len()]);
        let [low_z, high_z] = [line(y, z0), line(y, z1)].map(|line| &line[x..][..row.len()]);
        let gradient = |i: usize, along_x: f32| {
            let [along_y, along_z] = [high_y[i].minus(low_y[i]), high_z[i].minus(low_z[i])];
            finite(to_world([along_x, along_y * per_y, along_z * per_z]))
        };
        let border = |i: usize| {
            let (x0, x1, per_x) = neighbours(x + i, nx);
            own[x1].minus(own[x0]) * per_x
        };
        let begin = usize::from(x == 0).min(row.len());
        let end = (nx - 1).saturating_sub(x).clamp(begin, row.len());
        for i in (0..begin).chain(end..row.len()) {
            row[i] = gradient(i, border(i));
        }
        if begin < end {
            let left = &own[x + begin - 1..][..end - begin];
            let right = &own[x + begin + 1..][..end - begin];
            for (at, (left, right)) in left.iter().zip(right).enumerate() {
                row[begin + at] = gradient(begin + at, right.minus(*left) * 0.5);
            }
        }
    }
}

/// The neighbours of voxel `at` of `n` on an axis, itself at a border, and 1 / the distance between them.
fn neighbours(at: usize, n: usize) -> (usize, usize, f32) {
    let (low, high) = (at.saturating_sub(1), (at + 1).min(n - 1));
    (low, high, if high - low == 2 { 0.5 } else { 1.0 })
}

/// The gradient itself, or zero if it needed a NaN or an infinite scalar.
#[inline]
fn finite(gradient: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = gradient;
    // One test for all three: 0 times a number is 0, times anything else NaN.
    if x * 0.0 + y * 0.0 + z * 0.0 == 0.0 { gradient } else { [0.0; 3] }
}

/// Squares of lengths that 32 bits hold to the last bit: of other vectors lengths are taken in 64.
pub(crate) const MEASURABLE: std::ops::Range<f32> = 1e-24..1e24;

/// N: the unit vector along which the scalars fall, out of what is dense; zero where they do not change.
#[must_use]
pub fn normal(gradient: [f32; 3]) -> Vec3 {
    let turned = -Vec3::from(gradient);
    let square = turned.length_squared();
    if MEASURABLE.contains(&square) {
        return turned * (1.0 / square.sqrt());
    }
    // In 64 bits no gradient of 32 bits is too short or too long to have a direction.
    (-DVec3::from(gradient.map(f64::from))).normalize_or_zero().as_vec3()
}

#[cfg(test)]
mod tests;
