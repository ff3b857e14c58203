//! How an observer turns about the focal point, and the view that states where he then stands.

use glam::{DQuat, DVec3};

use crate::components::View;
use crate::view::camera::{Camera, sin_cos};
use crate::view::extent::Extent;

/// What an observer turns about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// The world's +z through the focal point: around the scene.
    Azimuth,
    /// The horizontal through the focal point: over the scene, past the poles too.
    Elevation,
    /// Upwards in the picture, wherever that points.
    ViewUp,
}

/// The view of an observer who turned by so many degrees, as a scene can state it.
///
/// Whoever passes a pole stands on the other side, head down: azimuth and roll turn by 180°.
#[must_use]
pub fn turned(view: &View, axis: Axis, degrees: f64) -> View {
    let mut turned = view.clone();
    match axis {
        Axis::Azimuth => turned.azimuth += degrees,
        Axis::Elevation => {
            turned.elevation = (view.elevation + degrees + 180.0).rem_euclid(360.0) - 180.0;
            if turned.elevation.abs() > 90.0 {
                turned.elevation = 180.0_f64.copysign(turned.elevation) - turned.elevation;
                turned.azimuth += 180.0;
                turned.roll += 180.0;
            }
        }
        Axis::ViewUp if degrees % 360.0 == 0.0 => {}
        Axis::ViewUp => about_up(&mut turned, degrees),
    }
    turned
}

/// Turns the frame of a view about its own view-up, and reads the angles off it.
fn about_up(view: &mut View, degrees: f64) {
    // The frame's directions depend on no extent.
    let camera = Camera::new(view, &Extent { low: DVec3::ZERO, high: DVec3::ONE });
    let turn = DQuat::from_axis_angle(camera.up, degrees.to_radians());
    let forward = turn * camera.forward;
    let level = forward.x.hypot(forward.y);
    if level > 1e-9 {
        view.azimuth = libm::atan2(-forward.x, forward.y).to_degrees();
    }
    view.elevation = libm::atan2(-forward.z, level).to_degrees().clamp(-90.0, 90.0);
    let (sin, cos) = sin_cos(view.azimuth);
    let right = DVec3::new(cos, sin, 0.0);
    let (across, along) = (camera.up.dot(right), camera.up.dot(right.cross(forward)));
    view.roll = libm::atan2(across, along).to_degrees();
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Extent = Extent { low: DVec3::ZERO, high: DVec3::ONE };

    fn frame(view: &View) -> [DVec3; 3] {
        let camera = Camera::new(view, &UNIT);
        [camera.right, camera.up, camera.forward]
    }

    fn assert_near(found: [DVec3; 3], expected: [DVec3; 3], what: &str) {
        for (found, expected) in found.iter().zip(expected) {
            assert!(found.distance(expected) < 1e-12, "{what}: {found} against {expected}");
        }
    }

    #[test]
    fn an_azimuth_turns_the_frame_about_z() {
        let view = View { azimuth: 30.0, elevation: 20.0, roll: 10.0, ..View::default() };
        let turn = DQuat::from_rotation_z(70.0_f64.to_radians());
        let expected = frame(&view).map(|axis| turn * axis);
        assert_near(frame(&turned(&view, Axis::Azimuth, 70.0)), expected, "70");
    }

    #[test]
    fn an_elevation_passes_the_poles_without_a_jump_and_stays_a_view_that_can_be_stated() {
        let view = View { azimuth: 30.0, elevation: 18.0, roll: 10.0, ..View::default() };
        for degrees in (-360..=720).step_by(7) {
            let found = turned(&view, Axis::Elevation, f64::from(degrees));
            assert!((-90.0..=90.0).contains(&found.elevation));
            let beyond = View { elevation: view.elevation + f64::from(degrees), ..view.clone() };
            assert_near(frame(&found), frame(&beyond), &format!("{degrees}"));
        }
    }

    #[test]
    fn a_turn_about_view_up_keeps_it_and_comes_back_to_where_it_was() {
        let view = View { azimuth: 30.0, elevation: 40.0, roll: 25.0, ..View::default() };
        let [right, up, forward] = frame(&view);
        for degrees in (0..=360).step_by(15) {
            let found = frame(&turned(&view, Axis::ViewUp, f64::from(degrees)));
            let turn = DQuat::from_axis_angle(up, f64::from(degrees).to_radians());
            assert_near(found, [turn * right, up, turn * forward], &format!("{degrees}"));
        }
    }
}
