//! Perspective against the closed form: a ball of gel off the axis, its chords and its outline, and a sphere of directions.

use gelray::components::{Sampling, View};
use gelray::view::camera::Camera;
use glam::DVec3;

use super::support::{Mixture, Rendered, centred, every_pixel, paint};

const RADIUS: f64 = 8.0;
/// Optical depth a world unit in the middle of the ball.
const DENSE: f64 = 0.15;
const CENTER: DVec3 = DVec3::new(3.0, -1.0, 2.0);

/// A ball whose optical depth falls as `(1 − r² / R²)²`, sampled every `h`: smooth enough for errors of second order.
fn ball(h: f64) -> Mixture {
    let half = (12.0 / h) as usize;
    let grid = centred([2 * half + 1; 3], h);
    let gel = paint(&grid, |voxel| {
        let at = grid.index_to_world.transform_point3(DVec3::from(voxel.map(|v| v as f64)));
        let within = (1.0 - at.distance_squared(CENTER) / (RADIUS * RADIUS)).max(0.0);
        let depth = DENSE * within * within;
        [1.0, 0.5, 0.2, -(-depth).exp_m1() as f32]
    });
    let sampling = Sampling { distance_mm: Some(h), ..every_pixel() };
    Mixture { unit: 1.0, sampling, ..Mixture::of(grid, gel) }
}

/// The optical depth of the ball along a ray from `eye` on, and how near the ray comes to its middle.
fn exact(eye: DVec3, along: DVec3) -> (f64, f64) {
    let along = along.normalize();
    let middle = along.dot(CENTER - eye);
    let near = (eye + along * middle).distance(CENTER);
    let square = RADIUS * RADIUS - near * near;
    if square <= 0.0 {
        return (0.0, near);
    }
    // ∫ (1 − (b² + s²) / R²)², from where the ball, or the way, begins.
    let sum = |s: f64| square * square * s - 2.0 / 3.0 * square * s.powi(3) + s.powi(5) / 5.0;
    let upto = |s: f64| DENSE / RADIUS.powi(4) * sum(s);
    let half = square.sqrt();
    let begin = (-middle).clamp(-half, half);
    (upto(half) - upto(begin), near)
}

fn depth(alpha: f32) -> f64 {
    -(-f64::from(alpha)).ln_1p()
}

/// How far optical depths of rays are off the closed form at the most, the outline checked by the way.
fn off(made: &Rendered, h: f64) -> f64 {
    let (mut worst, mut clear, mut filled) = (0.0_f64, 0, 0);
    for (_, window, color) in made.rays() {
        let ray = made.camera.ray(window);
        let eye = made.camera.focal - made.camera.forward * made.camera.eye.unwrap();
        let (expected, near) = exact(eye, ray.along);
        worst = worst.max((depth(color[3]) - expected).abs());
        // Interpolation reaches a voxel's diagonal beyond the ball, and its rim is thin.
        if near > RADIUS + 1.8 * h {
            assert_eq!(color[3], 0.0, "outside the outline by {}", near - RADIUS);
            clear += 1;
        } else if near < RADIUS - 1.8 * h {
            assert!(color[3] > 0.0, "inside the outline by {}", RADIUS - near);
            filled += 1;
        }
    }
    assert!(clear > 50 && filled > 200, "{clear} {filled}");
    worst
}

#[test]
fn chords_and_outline_of_a_ball_off_the_axis_follow_the_closed_form_to_second_order() {
    let errors = [1.0, 0.5, 0.25].map(|h| {
        let seen = ball(h).seen((25.0, 10.0), 32, 26.0);
        let view = View { field_of_view: Some(50.0), ..seen.view.clone() };
        off(&Mixture { view, ..seen }.render(), h)
    });
    println!("optical depth off by {errors:.5?} at steps of 1, 1/2 and 1/4");
    let orders = [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()];
    assert!(orders.iter().all(|order| (1.7..2.4).contains(order)), "{orders:?}");
    assert!(errors[2] < 2e-3, "{errors:?}");
}

/// The solid angle of all directions from `eye`, and the sums over it of the optical depths that are seen and expected.
fn around(eye: DVec3, h: f64) -> [f64; 3] {
    let mut sums = [0.0; 3];
    let sides = [(0.0, 0.0), (90.0, 0.0), (180.0, 0.0), (270.0, 0.0), (0.0, 90.0), (0.0, -90.0)];
    let ball = ball(h);
    for side in sides {
        let mixture = ball.clone().seen(side, 32, 2.0);
        let looking_at = |focal: DVec3| {
            let (field_of_view, focal_point) = (Some(90.0), Some(focal.to_array()));
            View { field_of_view, focal_point, ..mixture.view.clone() }
        };
        // A window 2 high under a right angle is at a distance of 1.
        let forward = Camera::new(&looking_at(eye), &mixture.extent()).forward;
        let made = Mixture { view: looking_at(eye + forward), ..mixture.clone() }.render();
        for (_, window, color) in made.rays() {
            if [window.x, window.y].iter().all(|at| (0.0..32.0).contains(at)) {
                let along = made.camera.ray(window).along;
                let solid = made.camera.pixel.powi(2) / along.length().powi(3);
                assert!(color.iter().all(|channel| channel.is_finite()), "{color:?}");
                let parts = [1.0, depth(color[3]), exact(eye, along).0];
                sums = std::array::from_fn(|n| sums[n] + solid * parts[n]);
            }
        }
    }
    sums
}

#[test]
fn the_sum_over_a_sphere_of_directions_from_within_is_finite_and_unbiased() {
    let eye = CENTER + DVec3::new(2.0, 1.0, -3.0);
    let bias = [0.5, 0.25].map(|h| {
        let [solid, seen, expected] = around(eye, h);
        assert!((solid / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-3, "{solid}");
        println!(
            "steps of {h}: optical depth {seen:.5} over {solid:.4} sr, expected {expected:.5}"
        );
        (seen / expected - 1.0).abs()
    });
    // What is left is the voxels': it falls with their square.
    assert!(bias[1] < 2e-3 && bias[0] / bias[1] > 3.0, "{bias:?}");
}
