//! Facts about walks: the samples that a ray meets.

use glam::DVec2;

use super::*;
use crate::components::View;
use crate::view::extent::Extent;

fn extent() -> Extent {
    Extent { low: DVec3::splat(-10.0), high: DVec3::splat(10.0) }
}

fn camera(azimuth: f64, elevation: f64, roll: f64) -> Camera {
    Camera::new(&View { azimuth, elevation, roll, ..View::default() }, &extent())
}

#[test]
fn the_samples_of_a_ray_are_those_within_the_domain() {
    let grid = Grid::axis_aligned([9, 17, 5], [2.0, 1.0, -3.0], [-8.0, -8.0, 6.0]).unwrap();
    for (azimuth, elevation) in [(0.0, 0.0), (90.0, 0.0), (45.0, 35.0), (200.0, -80.0), (0.0, 90.0)]
    {
        let camera = camera(azimuth, elevation, 0.0);
        let walk = Walk::new(&grid, &camera, 0.25).unwrap();
        let origin = camera.origin(DVec2::new(190.0, 190.0));
        let samples = walk.enter(&camera.ray(DVec2::new(190.0, 190.0))).unwrap();
        let place = |k: i64| {
            let world = origin + camera.forward * (0.25 * (k as f64 + 0.5));
            grid.world_to_index().transform_point3(world)
        };
        let outside = |k: i64| {
            let last = DVec3::from(grid.size.map(|n| (n - 1) as f64));
            (-place(k)).max(place(k) - last).max_element()
        };
        assert!(outside(samples.first - 1) > -1e-9 && outside(samples.end) > -1e-9);
        assert!(outside(samples.first) < 1e-9 && outside(samples.end - 1) < 1e-9);
        let first = samples.at.as_dvec3() / UNIT;
        assert!(first.distance(place(samples.first)) < 1e-9);
    }
}

#[test]
fn a_ray_beside_the_domain_meets_no_sample() {
    let grid = Grid::axis_aligned([5; 3], [1.0; 3], [-2.0; 3]).unwrap();
    let camera = camera(0.0, 0.0, 0.0);
    let walk = Walk::new(&grid, &camera, 1.0).unwrap();
    let ray = |origin: DVec3| Ray { origin, along: camera.forward };
    assert_eq!(walk.enter(&ray(DVec3::new(2.001, 0.0, 0.0))), None);
    let along_the_face = walk.enter(&ray(DVec3::new(2.0, 0.0, 0.0))).unwrap();
    assert_eq!(along_the_face.end - along_the_face.first, 4);
}

#[test]
fn a_step_too_small_or_too_large_is_refused_with_a_remedy() {
    let grid = Grid::axis_aligned([5; 3], [1.0; 3], [0.0; 3]).unwrap();
    for distance in [1e-14, 1e9, f64::NAN] {
        let refused = Walk::new(&grid, &camera(0.0, 0.0, 0.0), distance).unwrap_err();
        assert!(refused.contains("sampling.distance_mm"));
    }
}
