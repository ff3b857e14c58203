//! Facts about perspective views: ways through gel, polygons at true depths, an eye inside the volume, the parallel limit.

use gelray::components::{Sampling, Skip, View};
use glam::{DVec2, DVec3};

use super::support::{
    Mixture, Rendered, bits, centred, every_pixel, flat, homogeneous, paint, square, worst,
};

const ALPHA: f32 = 0.05;

/// A box of gel from −10 to 10 on each axis, seen along +y under a field of view through a window of `height`.
fn gel(field_of_view: f64, height: f64) -> Mixture {
    let grid = centred([21; 3], 1.0);
    let painted = homogeneous(&grid, [1.0, 0.0, 0.0, ALPHA]);
    let mixture = Mixture::of(grid, painted).seen((0.0, 0.0), 16, height);
    let view = View { field_of_view: Some(field_of_view), ..mixture.view.clone() };
    Mixture { view, sampling: every_pixel(), ..mixture }
}

/// How far a ray's opacity is off `expected`, which is given how long its way is for each unit of depth.
fn off(made: &Rendered, expected: impl Fn(DVec2, f64) -> f64) -> f64 {
    let error = |(_, window, color): (_, DVec2, [f32; 4])| {
        let stretch = made.camera.ray(window).along.length();
        (f64::from(color[3]) - expected(window, stretch)).abs()
    };
    made.rays().map(error).fold(0.0, f64::max)
}

/// The opacity of a way through the gel.
fn through(length: f64) -> f64 {
    -(length * (-f64::from(ALPHA)).ln_1p()).exp_m1()
}

#[test]
fn a_ray_beside_the_line_of_sight_has_the_longer_way_through_a_slab() {
    // From front to back every ray stays inside: the window is 8 high in the middle and less than 16 at the back.
    let made = gel(30.0, 8.0).render();
    let worst = off(&made, |_, stretch| through(20.0 * stretch));
    assert!(worst < 2e-6, "{worst}");
    let corner = made.camera.ray(DVec2::ZERO).along.length();
    assert!(corner > 1.05, "{corner}");
}

#[test]
fn an_eye_inside_the_gel_sees_what_is_before_it_alone() {
    for eye in [9.75, 7.5, 3.1, 0.5] {
        // The height that puts the eye so far before the focal point.
        let height = 2.0 * eye * 20.0_f64.to_radians().tan();
        let made = gel(40.0, height).render();
        let worst = off(&made, |window, stretch| {
            let ray = made.camera.ray(window);
            let side = ray.along.x.abs().max(ray.along.z.abs());
            // Where it leaves: by the back, or before that by a side; there the last slab counts as a whole or not at all.
            let depth = (eye + 10.0).min(10.0 / side) - eye;
            assert!(depth >= 10.0 - 1e-9, "the window is narrow enough");
            through((eye + depth) * stretch)
        });
        assert!(worst < 2e-6, "{eye}: {worst}");
    }
}

#[test]
fn a_polygon_is_met_at_its_true_depth_on_every_ray() {
    for place in [-6.0, -0.3, 0.0, 3.77] {
        let mut mixture = gel(30.0, 8.0);
        let outline = square(DVec3::new(0.0, place, 0.0), DVec3::Y, 30.0);
        mixture.polygons = vec![(vec![outline], flat([0.0, 1.0, 0.0], 0.5))];
        let made = mixture.render();
        for (_, window, [red, green, _, alpha]) in made.rays() {
            let stretch = made.camera.ray(window).along.length();
            let (front, back) =
                (through((place + 10.0) * stretch), through((10.0 - place) * stretch));
            let expected = [
                front + (1.0 - front) * 0.5 * back,
                (1.0 - front) * 0.5,
                1.0 - (1.0 - front) * 0.5 * (1.0 - back),
            ];
            for (seen, expected) in [red, green, alpha].into_iter().zip(expected) {
                assert!(
                    (f64::from(seen) - expected).abs() < 3e-6,
                    "{place} {window}: {seen} {expected}"
                );
            }
        }
    }
}

#[test]
fn an_oblique_polygon_lies_where_it_is_projected() {
    let normal = DVec3::new(0.4, -1.0, 0.3).normalize();
    let center = DVec3::new(1.0, 2.0, -0.5);
    let outline = square(center, normal, 3.0);
    let mixture = Mixture::polygons(vec![(vec![outline.clone()], flat([1.0; 3], 1.0))]);
    let mixture = mixture.seen((20.0, 10.0), 64, 12.0);
    let view = View { field_of_view: Some(50.0), ..mixture.view.clone() };
    let made = Mixture { view, sampling: every_pixel(), ..mixture }.render();
    let (a, b) = (outline[1] - outline[0], outline[3] - outline[0]);
    let mut seen = 0;
    for (_, window, color) in made.rays() {
        let ray = made.camera.ray(window);
        let depth = normal.dot(center - ray.origin) / normal.dot(ray.along);
        let from = ray.at(depth) - outline[0];
        let place = [from.dot(a) / a.length_squared(), from.dot(b) / b.length_squared()];
        let inside = place.iter().map(|p| p.min(1.0 - p)).fold(f64::INFINITY, f64::min);
        if inside.abs() > 1e-9 {
            assert_eq!(color[3] == 1.0, inside > 0.0, "{window}");
            seen += usize::from(inside > 0.0);
        }
    }
    assert!((300..3000).contains(&seen), "{seen}");
}

#[test]
fn a_narrow_field_of_view_is_a_parallel_view() {
    let grid = centred([21; 3], 1.0);
    let painted = paint(&grid, |[x, y, z]| {
        let far = (DVec3::new(x as f64, y as f64, z as f64) - 10.0).length();
        [0.8, 0.3, far as f32 / 20.0, ((8.0 - far) / 10.0).clamp(0.0, 0.5) as f32]
    });
    let parallel = Mixture::of(grid, painted).seen((30.0, 15.0), 32, 24.0);
    let view = View { field_of_view: Some(0.01), ..parallel.view.clone() };
    let sampling = every_pixel();
    let parallel = Mixture { sampling: sampling.clone(), ..parallel };
    let narrow = Mixture { view, sampling, ..parallel.clone() };
    let worst = worst(&parallel.render().picture, &narrow.render().picture);
    assert!(worst < 1e-3, "{worst}");
}

#[test]
fn skipping_and_threads_change_no_bit_in_perspective() {
    let grid = centred([40, 30, 35], 1.0);
    let painted = paint(&grid, |[x, y, z]| {
        let on = (x * 7 + y * 13 + z * 29) % 31 == 0 && (x / 8 + y / 8 + z / 8) % 2 == 0;
        [0.9, x as f32 / 40.0, 0.2, if on { 0.7 } else { 0.0 }]
    });
    for (field_of_view, height) in [(60.0, 30.0), (100.0, 8.0)] {
        let seen = Mixture::of(grid, painted.clone()).seen((40.0, 20.0), 48, height);
        let view = View { field_of_view: Some(field_of_view), ..seen.view.clone() };
        let seen = Mixture { view, ..seen };
        let made = |skip, threads| {
            let sampling = Sampling { skip, ..Sampling::default() };
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| bits(&Mixture { sampling, ..seen.clone() }.render().picture))
        };
        let one = made(Skip::Pyramid, 1);
        assert!(one.iter().any(|pixel| pixel[3] != 0));
        assert!(one == made(Skip::None, 2) && one == made(Skip::Pyramid, 7));
    }
}
