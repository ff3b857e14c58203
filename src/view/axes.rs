//! Axes of a figure: which edges of a box they run along for an observer, and where their ticks stand.

use glam::DVec3;

use super::camera::Camera;
use super::extent::Extent;

/// How long ticks are, as a part of the box's diagonal.
pub(crate) const TICK: f64 = 0.02;

/// An axis along an edge of a box.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Axis {
    /// What it is called: x, y or z.
    pub name: &'static str,
    /// Its ends, world; the second is greater.
    pub ends: [DVec3; 2],
    /// The unit vector away from the box along which ticks stand.
    pub out: DVec3,
    /// The values at which ticks stand, world units.
    pub ticks: Vec<f64>,
}

impl Axis {
    /// The point of a tick on the axis.
    #[must_use]
    pub fn at(&self, value: f64) -> DVec3 {
        let mut point = self.ends[0];
        let axis = usize::from(self.name.as_bytes()[0] - b'x');
        point[axis] = value;
        point
    }
}

/// The axes of a box for an observer: x and y along the edges that are nearest to him at the box's foot, z along the edge at
/// the left. Ticks stand at multiples of `step`, or of the roundest number of which three or more fit in the longest side.
#[must_use]
pub(crate) fn axes(around: &Extent, camera: &Camera, step: Option<f64>) -> [Axis; 3] {
    let side = |positive: bool, axis: usize| {
        if positive { around.high[axis] } else { around.low[axis] }
    };
    let near = [0, 1].map(|axis| camera.forward[axis] < 0.0);
    let foot = around.low.z;
    let step = step.unwrap_or_else(|| round((around.high - around.low).max_element() / 3.0));
    let edge = |axis: usize, from: DVec3, out: DVec3| {
        let mut to = from;
        to[axis] = around.high[axis];
        let first = (from[axis] / step).ceil() as i64;
        let last = ((to[axis] / step).floor() as i64).min(first.saturating_add(200));
        let ticks = (first..=last).map(|n| n as f64 * step).collect();
        Axis { name: ["x", "y", "z"][axis], ends: [from, to], out: out.normalize_or_zero(), ticks }
    };
    let sign = |positive: bool| if positive { 1.0 } else { -1.0 };
    let left = [0, 1].map(|axis| camera.right[axis] < 0.0);
    [
        edge(0, DVec3::new(around.low.x, side(near[1], 1), foot), DVec3::Y * sign(near[1])),
        edge(1, DVec3::new(side(near[0], 0), around.low.y, foot), DVec3::X * sign(near[0])),
        edge(2, DVec3::new(side(left[0], 0), side(left[1], 1), foot), -camera.right.with_z(0.0)),
    ]
}

/// The greatest of 1, 2 or 5 times a power of ten that is not above `most`, which is above 0.
#[must_use]
pub(crate) fn round(most: f64) -> f64 {
    let power = 10.0_f64.powi(most.log10().floor() as i32);
    let times = [5.0, 2.0, 1.0].into_iter().find(|times| times * power <= most).unwrap_or(1.0);
    // As it is written, and not as powers round.
    format!("{:.0e}", times * power).parse().unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::components::View;

    #[test]
    fn axes_run_along_the_near_edges_and_ticks_stand_at_round_places() {
        let around = Extent { low: DVec3::new(-64.0, -60.0, -30.0), high: DVec3::splat(64.0) };
        for (azimuth, y_of_x, x_of_y, z_at) in
            [(30.0, -60.0, 64.0, [-64.0, -60.0]), (200.0, 64.0, -64.0, [64.0, 64.0])]
        {
            let view = View { azimuth, elevation: 20.0, ..View::default() };
            let [x, y, z] = axes(&around, &Camera::new(&view, &around), None);
            assert_eq!((x.ends[0].y, y.ends[0].x), (y_of_x, x_of_y), "{azimuth}");
            assert_eq!([z.ends[0].x, z.ends[0].y], z_at, "{azimuth}");
            assert_eq!(x.ticks, [-60.0, -40.0, -20.0, 0.0, 20.0, 40.0, 60.0]);
            assert_eq!((x.at(20.0).x, z.ticks[0]), (20.0, -20.0));
        }
    }

    #[test]
    fn numbers_are_round() {
        assert_eq!([0.0731, 4.9, 50.0, 999.0].map(round), [0.05, 2.0, 50.0, 500.0]);
    }
}
