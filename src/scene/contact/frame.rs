//! The window around what is seen of a volume: its picture is filled by it, and not by the air around it.

use glam::DVec3;

use crate::components::View;
use crate::formats::Voxels;
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::volume::grid::{Grid, Scalar, Scalars};
use crate::with_scalars;

/// The part of what is seen that may lie beyond each side of its box: speckle far from it.
const SPECKLE: f64 = 0.0005;

/// Voxels around the box, for the transition of the surface that it holds.
const MARGIN: f64 = 2.0;

/// How much of the window the box fills.
const FILLED: f64 = 0.94;

/// A box around what is seen.
pub(super) struct Frame {
    /// Its middle, world.
    pub center: DVec3,
    corners: [DVec3; 8],
}

impl Frame {
    /// The box of the voxels of `from` and above; of the whole domain where nothing or all is seen.
    pub fn around(grid: &Grid, voxels: &Voxels, from: Option<f32>) -> Self {
        let last = grid.size.map(|n| (n - 1) as f64);
        let mut ends = last.map(|last| [0.0, last]);
        if let (Voxels::Scalars(scalars), Some(from)) = (voxels, from) {
            let counts = counts(grid, scalars, from);
            for axis in 0..3 {
                if let Some([low, high]) = trimmed(&counts[axis]) {
                    ends[axis] =
                        [(low as f64 - MARGIN).max(0.0), (high as f64 + MARGIN).min(last[axis])];
                }
            }
        }
        let at = |corner: usize| -> DVec3 {
            let index = std::array::from_fn(|axis| ends[axis][corner >> axis & 1]);
            grid.index_to_world.transform_point3(DVec3::from_array(index))
        };
        let corners: [DVec3; 8] = std::array::from_fn(at);
        Self { center: (corners[0] + corners[7]) / 2.0, corners }
    }

    /// The height of the window that just holds the box in a view of that azimuth and elevation, world units.
    pub fn height(&self, [azimuth, elevation]: [f64; 2], [width, height]: [u32; 2]) -> f64 {
        // Directions depend on no extent.
        let somewhere = Extent { low: DVec3::ZERO, high: DVec3::ONE };
        let view = View { azimuth, elevation, ..View::default() };
        let Camera { right, up, .. } = Camera::new(&view, &somewhere);
        let reach = |way: DVec3| {
            let along = self.corners.iter().map(|&corner| (corner - self.center).dot(way).abs());
            2.0 * along.fold(0.0, f64::max)
        };
        let across = reach(right) * f64::from(height) / f64::from(width);
        reach(up).max(across) / FILLED
    }
}

/// Voxels of `from` and above in each slice of each axis.
fn counts(grid: &Grid, scalars: &Scalars, from: f32) -> [Vec<u64>; 3] {
    with_scalars!(scalars, values => count(grid, values, from))
}

fn count<T: Scalar>(grid: &Grid, values: &[T], from: f32) -> [Vec<u64>; 3] {
    let mut counts = grid.size.map(|n| vec![0; n]);
    for (row, values) in values.chunks(grid.size[0]).enumerate() {
        let mut seen = 0;
        for (x, value) in values.iter().enumerate() {
            if value.value() >= from {
                counts[0][x] += 1;
                seen += 1;
            }
        }
        counts[1][row % grid.size[1]] += seen;
        counts[2][row / grid.size[1]] += seen;
    }
    counts
}

/// The first and last slice, but for speckle; `None` where nothing is seen.
fn trimmed(counts: &[u64]) -> Option<[usize; 2]> {
    let all: u64 = counts.iter().sum();
    let most = (all as f64 * SPECKLE) as u64;
    let past = |sum: &mut u64, count: u64| {
        *sum += count;
        Some(*sum <= most)
    };
    let before = |within: &bool| *within;
    let skipped =
        |counts: &mut dyn Iterator<Item = u64>| counts.scan(0, past).take_while(before).count();
    let low = skipped(&mut counts.iter().copied());
    let high = skipped(&mut counts.iter().rev().copied());
    // Nothing but speckle is nothing.
    (all > 0).then(|| [low, counts.len() - 1 - high])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::phantom::ball;

    #[test]
    fn a_ball_fills_the_window_and_the_air_around_it_does_not() {
        let ball = ball([64; 3], 12.0);
        let frame = Frame::around(&ball.grid, &ball.voxels, Some(0.5));
        assert!(frame.center.length() < 0.5);
        let height = frame.height([0.0, 0.0], [100, 100]);
        assert!((24.0..32.0).contains(&height), "{height}");
        let tall = frame.height([0.0, 0.0], [50, 100]);
        assert!((tall - 2.0 * height).abs() < 1e-9);
    }

    #[test]
    fn where_nothing_is_seen_the_window_holds_the_whole_domain() {
        let ball = ball([64; 3], 12.0);
        for from in [None, Some(2.0), Some(f32::NAN)] {
            let frame = Frame::around(&ball.grid, &ball.voxels, from);
            assert!((frame.height([0.0, 0.0], [100, 100]) - 63.0 / FILLED).abs() < 1e-9);
        }
    }
}
