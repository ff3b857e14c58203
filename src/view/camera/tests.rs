//! Facts about cameras: frames and projections.

use super::*;

fn extent() -> Extent {
    Extent { low: DVec3::splat(-10.0), high: DVec3::splat(10.0) }
}

fn camera(azimuth: f64, elevation: f64, roll: f64) -> Camera {
    Camera::new(&View { azimuth, elevation, roll, ..View::default() }, &extent())
}

#[test]
fn the_default_view_looks_along_y_with_z_up_and_x_to_the_right() {
    let camera = camera(0.0, 0.0, 0.0);
    assert_eq!([camera.forward, camera.right, camera.up], [DVec3::Y, DVec3::X, DVec3::Z]);
    assert!(camera.origin(DVec2::ZERO).z > 0.0 && camera.origin(DVec2::ZERO).x < 0.0);
}

#[test]
fn from_above_the_top_of_the_picture_is_the_back() {
    let camera = camera(0.0, 90.0, 0.0);
    assert_eq!([camera.forward, camera.right, camera.up], [-DVec3::Z, DVec3::X, DVec3::Y]);
}

#[test]
fn a_projected_point_comes_back() {
    let camera = camera(33.0, -20.0, 12.0);
    let point = DVec3::new(1.0, -7.0, 3.5);
    let (window, depth) = camera.project(point);
    assert!((camera.origin(window) + camera.forward * depth).distance(point) < 1e-12);
}
