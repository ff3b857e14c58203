//! Adaptive termination: a ray that stops at ε is off by no more than ε in any channel (paper §6; algorithm §6).

use gelray::components::{Sampling, View};
use gelray::volume::grid::Grid;
use glam::DVec3;
use proptest::prelude::*;

use super::support::{Mixture, flat, head, paint, square, worst};

const STOPS: [f32; 3] = [0.1, 0.02, 0.005];

/// One ray a pixel, so that both pictures are made of the same rays.
fn stopping(stop_at: f32, distance: f64) -> Sampling {
    let distance_mm = Some(distance);
    Sampling { distance_mm, stop_at, coarsest: 4, finest: 4, ..Sampling::default() }
}

#[test]
fn the_head_stopped_at_epsilon_is_off_by_no_more_than_epsilon() {
    let mut shown = head();
    let small = |view: &mut View| view.size = [90; 2];
    let whole = shown.render(small, stopping(0.0, 1.0));
    for stop in STOPS {
        let made = shown.render(small, stopping(stop, 1.0));
        let off = worst(&whole.picture, &made.picture);
        let [some, all] = [made.array.counts.samples, whole.array.counts.samples];
        println!("head stopped at {stop}: off by {off:.5} at most, {some} samples of {all}");
        assert!(off <= stop + 1e-6);
        assert!(some < all);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn gel_and_polygons_stopped_at_epsilon_are_off_by_no_more_than_epsilon(
        seed in any::<u32>(),
        (azimuth, elevation) in (-180.0..180.0, -90.0..90.0),
        opacity in 0.05_f32..1.0,
        ratio in 0.3..2.5,
    ) {
        let grid = Grid::axis_aligned([14, 17, 12], [1.0, 0.8, -1.1], [-6.5, -6.4, 6.05]).unwrap();
        let wave = |at: [usize; 3], i: u32| {
            let phase = at.iter().fold(seed.wrapping_mul(i + 1) >> 8, |p, &n| p.wrapping_mul(31).wrapping_add(n as u32 * 7919));
            0.5 + 0.5 * (phase as f32 * 0.001).sin()
        };
        let gel = paint(&grid, |at| [wave(at, 0), wave(at, 1), wave(at, 2), opacity * wave(at, 3).powi(3)]);
        let planes = [DVec3::new(1.0, 0.2, 0.1), DVec3::new(-0.2, 1.0, 0.3), DVec3::new(0.2, 0.1, 1.0)];
        let polygons = planes.map(|normal| (vec![square(normal, normal, 9.0)], flat([1.0, 0.3, 0.0], 0.4)));
        let scene = Mixture { polygons: polygons.to_vec(), ..Mixture::of(grid, gel) }
            .seen((azimuth, elevation), 9, 20.0);
        let made = |stop: f32| {
            Mixture { sampling: stopping(stop, ratio * 0.8), ..scene.clone() }.render().picture
        };
        let whole = made(0.0);
        for stop in STOPS {
            let off = worst(&whole, &made(stop));
            prop_assert!(off <= stop + 1e-6, "stopped at {}: off by {}", stop, off);
        }
    }
}
