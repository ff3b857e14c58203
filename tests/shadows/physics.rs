//! What light does in gel: the exponential law, wedges, falloff, and no trace of the sample distance.

use gelray::components::CastsShadow;
use gelray::volume::grid::Grid;
use glam::DVec3;

use crate::setup::{NO_BIAS, Scene, at, beta, cubes, point, voxels};

#[test]
fn light_in_a_homogeneous_slab_falls_as_one_minus_alpha_to_the_depth_in_opacity_units() {
    println!("alpha      spacing  unit   greatest error of beta");
    for (alpha, spacing, unit) in [
        (0.05_f32, 1.0, 1.0),
        (0.5, 1.0, 1.0),
        (0.999, 1.0, 1.0),
        (1e-4, 1.0, 1.0),
        (0.3, 0.25, 1.0),
        (0.3, 2.5, 1.0),
        (0.02, 1.0, 0.125),
        (0.9, 1.0, 40.0),
    ] {
        let size = [12, 10, 30];
        let grid = Grid::axis_aligned(size, [spacing; 3], [5.0; 3]).unwrap();
        let mut scene = Scene::new(grid, [0.0, 0.0, 1.0], NO_BIAS, |_| alpha).unit(unit);
        let strength = scene.sweep();
        let expected = |z: usize| (1.0 - f64::from(alpha)).powf((29 - z) as f64 * spacing / unit);
        let error = voxels(size).map(|v| (beta(&strength, v) - expected(v[2])).abs());
        let error = error.fold(0.0, f64::max);
        println!("{alpha:<10} {spacing:<8} {unit:<6} {error:.2e}");
        assert!(error < 0.5 / 65535.0 + 1e-6, "{error}");
    }
}

#[test]
fn the_bias_lights_a_voxel_as_the_point_so_much_nearer_to_the_light() {
    for bias in [0.5, 1.0, 2.0, 3.25, 1e9] {
        let shadow = CastsShadow { bias_voxels: bias, ..NO_BIAS };
        let strength = Scene::new(cubes([9, 9, 20]), [0.0, 0.0, -1.0], shadow, |_| 0.1).sweep();
        for z in 0..20 {
            let depth = (z as f64 - bias).max(0.0);
            // Linear between slices.
            let (low, part) = (depth.floor(), depth.fract());
            let expected = 0.9_f64.powf(low) * (1.0 - part * 0.1);
            assert!((beta(&strength, [4, 4, z]) - expected).abs() < 1e-5, "{bias} {z}");
        }
    }
}

#[test]
fn a_step_wedge_casts_the_product_of_its_steps_and_partial_shadows() {
    // Steps across x: 0, 1, 2 … layers of opacity 0.2 under the light; a faint floor receives.
    let wedge = |[x, _, z]: [usize; 3]| match z {
        0 => 0.01,
        z if z >= 30 - 3 * (x / 6) => 0.2,
        _ => 0.0,
    };
    let strength = Scene::new(cubes([36, 8, 31]), [0.0, 0.0, 1.0], NO_BIAS, wedge).sweep();
    println!("layers  beta     expected");
    for step in 0..6 {
        let layers = 3 * step + 1;
        // The first layer is half before the domain, and half of the floor is above its middle.
        let expected = 0.8_f64.powf(f64::from(layers) - 0.5) * 0.99_f64.sqrt();
        let beta = beta(&strength, [6 * step as usize + 3, 4, 0]);
        println!("{layers:<7} {beta:.5}  {expected:.5}");
        assert!((beta - expected).abs() < 1e-5);
        assert!(beta > 0.0 && beta < 1.0);
    }
}

#[test]
fn strength_falls_off_with_distance_from_where_the_light_meets_the_bounding_sphere() {
    let shadow = CastsShadow { bias_voxels: 2.0, k1: 0.5, k2: 0.03 };
    let (size, toward) = ([16, 16, 16], DVec3::new(0.2, 0.5, 0.8));
    let mut scene = Scene::new(cubes(size), toward.to_array(), shadow, |_| 1e-9).buffered();
    let strength = scene.sweep();
    let (radius, along) = (7.5 * 3_f64.sqrt(), -toward.normalize());
    let falloff = |p: DVec3| 1.0 / (0.5 + 0.03 * (along.dot(p - DVec3::splat(7.5)) + radius));
    let corners = [point([15, 15, 15]), point([0, 0, 0])].map(falloff);
    for voxel in voxels(size) {
        let expected = falloff(point(voxel) - along * 2.0).min(corners[0]);
        assert!((beta(&strength, voxel) - expected).abs() < 3e-5, "{voxel:?}");
        assert!((at(&strength, point(voxel)) - falloff(point(voxel))).abs() < 3e-5);
    }
    assert!((f64::from(strength.volumes[0].1.most()) - corners[0]).abs() < 1e-6);
}

#[test]
fn a_light_that_falls_off_steeply_keeps_all_its_digits_far_away() {
    let (size, toward) = ([16, 16, 16], DVec3::Z);
    let radius = 7.5 * 3_f64.sqrt();
    for k1 in [0.1, 1e-2, 1e-4] {
        // Right at the light, beside it a hundred or ten thousand times darker, and behind gel darker still.
        let enter = 0.02 * (7.5 - radius);
        let shadow = CastsShadow { bias_voxels: 0.0, k1: k1 + enter, k2: 0.02 };
        let gel = |v: [usize; 3]| if v[0] < 8 { 0.1 } else { 1e-9 };
        let bright = CastsShadow { bias_voxels: 0.0, k1: 1.0, k2: 0.0 };
        let [steep, even] = [shadow, bright]
            .map(|shadow| Scene::new(cubes(size), toward.to_array(), shadow, gel).sweep());
        for voxel in voxels(size) {
            let distance = radius - (point(voxel).z - 7.5);
            let expected = beta(&even, voxel) / (k1 + enter + 0.02 * distance);
            let error = (beta(&steep, voxel) - expected).abs();
            assert!(error <= 1e-6 * expected, "{k1} {voxel:?}: {error:e} of {expected}");
        }
    }
}

#[test]
fn the_strength_does_not_depend_on_the_sample_distance() {
    // The same gel in the world, sampled finer and finer, with one opacity unit: a soft slab and a soft ball.
    let gel = |p: DVec3| {
        let soft = |inside: f64| {
            let t = (0.5 + inside / 5.0).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        };
        let slab = soft(3.0 - (p.z - 22.0).abs());
        let ball = soft(7.0 - p.distance(DVec3::new(14.0, 17.0, 13.0)));
        // Where gel met a side of the domain, light slipping in below it would cut a sharp edge.
        let aside = (p.x - 16.0).abs().max((p.y - 16.0).abs());
        (0.12 * slab * soft(9.0 - aside) + 0.1 * ball) as f32
    };
    let sampled = |toward: [f64; 3], fine: usize| {
        let spacing = 1.0 / fine as f64;
        let size = [32 * fine + 1; 3];
        let grid = Grid::axis_aligned(size, [spacing; 3], [0.0; 3]).unwrap();
        let opacity = move |voxel: [usize; 3]| gel(point(voxel) * spacing);
        Scene::new(grid, toward, NO_BIAS, opacity).buffered().sweep()
    };
    println!(
        "light                  difference of beta from that at 1/4 voxel: greatest and mean at 1, at 1/2"
    );
    for toward in [[0.0, 0.0, 1.0], [0.5, 0.3, 0.8], [1.0, 0.0, 1.0]] {
        let [coarse, middle, fine] = [1, 2, 4].map(|fine| sampled(toward, fine));
        let difference = |strength| {
            let inner = voxels([25; 3]).map(|v| point(v) + DVec3::splat(4.0));
            let differences = inner.map(|p| (at(strength, p) - at(&fine, p)).abs());
            let (most, sum) = differences.fold((0.0_f64, 0.0), |(m, s), d| (m.max(d), s + d));
            (most, sum / 25.0_f64.powi(3))
        };
        let ((most, mean), (less, least)) = (difference(&coarse), difference(&middle));
        println!("{:<22} {most:.4} {mean:.4}  {less:.4} {least:.4}", format!("{toward:?}"));
        // Across slices penumbras are as sharp as columns are near; along an axis points lie on columns, and only the
        // sample distance is left.
        let across = if toward[0] == 0.0 { 0.01 } else { 0.05 };
        assert!(
            most < across && mean < 0.005 && less < most / 2.0,
            "{toward:?}: {most} {mean} {less}"
        );
    }
}
