//! The picture converges as Δ → 0, to the integral along the ray, whatever the step (algorithm §1).

use gelray::components::Sampling;
use gelray::formats::Voxels;
use gelray::phantom::ball;
use gelray::volume::grid::{Grid, Scalars};
use glam::{DVec2, DVec3};

use super::support::{Mixture, Rendered, every_pixel, paint};

const RADIUS: f64 = 12.0;
/// Opacity per unit inside: the whole ball lets half of the light through.
const OPACITY: f32 = 0.03;

/// α at world points by interpolation in 64 bits; 0 outside the domain.
struct Field {
    grid: Grid,
    values: Vec<f32>,
}

impl Field {
    fn ball() -> Self {
        let loaded = ball([33; 3], RADIUS as f32);
        let Voxels::Scalars(Scalars::F32(values)) = loaded.voxels else { unreachable!() };
        Self { grid: loaded.grid, values: values.iter().map(|v| v * OPACITY).collect() }
    }

    fn mixture(&self) -> Mixture {
        let painted = paint(&self.grid, |at| [1.0, 1.0, 1.0, self.values[self.grid.offset(at)]]);
        Mixture::of(self.grid, painted)
    }

    fn at(&self, point: DVec3) -> f64 {
        let index = self.grid.world_to_index().transform_point3(point).to_array();
        let size = self.grid.size;
        if (0..3).any(|a| !(0.0..=(size[a] - 1) as f64).contains(&index[a])) {
            return 0.0;
        }
        (0..8_usize)
            .map(|corner| {
                let mut weight = 1.0;
                let voxel: [usize; 3] = std::array::from_fn(|a| {
                    let cell = (index[a] as usize).min(size[a] - 2);
                    let part = index[a] - cell as f64;
                    weight *= if corner >> a & 1 == 1 { part } else { 1.0 - part };
                    cell + (corner >> a & 1)
                });
                weight * f64::from(self.values[self.grid.offset(voxel)])
            })
            .sum()
    }

    /// −∫ ln(1 − α) along a ray, in units of the opacity inside: the length of gel that it passes.
    fn length(&self, made: &Rendered, window: DVec2) -> f64 {
        const STEP: f64 = 1.0 / 128.0;
        let origin = made.camera.origin(window);
        let depth = |i: i32| (f64::from(i) + 0.5) * STEP;
        let sum: f64 = (-2100..2100)
            .map(|i| -(-self.at(origin + made.camera.forward * depth(i))).ln_1p())
            .sum();
        sum * STEP / density()
    }
}

fn density() -> f64 {
    -(-f64::from(OPACITY)).ln_1p()
}

/// The length of gel that a ray saw, from the opacity of its C.
fn seen(color: [f32; 4]) -> f64 {
    -(-f64::from(color[3])).ln_1p() / density()
}

#[test]
fn a_ball_of_gel_shows_its_chords_and_the_error_falls_with_the_square_of_the_step() {
    let field = Field::ball();
    for view in [(0.0, 0.0), (33.0, 21.0), (45.0, 35.3)] {
        let steps = [1.0, 0.5, 0.25, 0.125];
        let mut errors = Vec::new();
        for step in steps {
            let sampling = Sampling { distance_mm: Some(step), ..every_pixel() };
            // A window within the ball: no ray grazes its border, where a chord has no finite slope.
            let scene = Mixture { sampling, ..field.mixture() }.seen(view, 13, 19.0);
            let made = scene.render();
            let (mut squares, mut worst_chord, mut count) = (0.0, 0.0_f64, 0);
            for ([i, j], window, color) in
                made.rays().filter(|([i, j], ..)| (i / 4 * 7 + j / 4 * 3) % 5 == 0)
            {
                assert_eq!((i % 4, j % 4), (0, 0));
                let off = seen(color) - field.length(&made, window);
                squares += off * off;
                count += 1;
                let aside = (window - 6.5).length() * 19.0 / 13.0;
                if aside < 0.75 * RADIUS {
                    let chord = 2.0 * (RADIUS * RADIUS - aside * aside).sqrt();
                    worst_chord = worst_chord.max((seen(color) - chord).abs());
                }
            }
            errors.push((squares / f64::from(count)).sqrt());
            assert!(worst_chord < 0.25 + 0.1 * step, "{view:?} Δ = {step}: {worst_chord}");
            println!(
                "ball seen from {view:?}, Δ = {step} u: rms error {:.2e} voxels against the integral, {worst_chord:.3} at most against the true chord",
                errors[errors.len() - 1]
            );
        }
        let orders: Vec<f64> = errors.windows(2).map(|w| (w[0] / w[1]).log2()).collect();
        println!("ball seen from {view:?}: orders {orders:.2?}");
        let overall = (errors[0] / errors[3]).log2() / 3.0;
        assert!(overall > 1.7, "{view:?}: {orders:?}");
    }
}

#[test]
fn the_opacity_unit_and_the_step_cancel() {
    // A voxel's opacity is that of a slab of thickness u: twice the unit is half the density, at every step.
    let field = Field::ball();
    let lengths = |unit: f64, step: f64| -> Vec<f64> {
        let sampling = Sampling { distance_mm: Some(step), ..every_pixel() };
        let scene = Mixture { unit, sampling, ..field.mixture() }.seen((20.0, 10.0), 7, 16.0);
        scene.render().rays().map(|(_, _, color)| seen(color) * unit).collect()
    };
    let reference = lengths(1.0, 0.25);
    for (unit, step) in [(0.5, 0.25), (2.0, 0.25), (7.0, 0.25), (1.0, 1.0), (3.0, 0.5)] {
        let pairs = reference.iter().zip(lengths(unit, step));
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("u = {unit}, Δ = {step}: lengths differ by {worst:.1e} voxels at most");
        assert!(worst < if step == 0.25 { 1e-3 } else { 0.1 });
    }
}
