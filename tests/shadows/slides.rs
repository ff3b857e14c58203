//! Textures projected through the volume: where they land, how sharp, and never aliased.

use gelray::components::{Projects, Wrap};
use gelray::light::strength::ProjectedBy;
use gelray::view::picture::Picture;
use glam::DVec3;

use crate::setup::{NO_BIAS, Scene, at, beta, cubes};

/// A checkerboard of `checks` texels of `texels²` each; white where column + row is even.
fn checkerboard(checks: usize, texels: usize, size_mm: f64, wrap: Wrap) -> ProjectedBy {
    let side = checks * texels;
    let white = |at: usize| {
        let white = (at % side / texels + at / side / texels).is_multiple_of(2);
        [f32::from(white); 3].map(|c| c).into_iter().chain([1.0]).collect::<Vec<_>>()
    };
    let pixels = (0..side * side).map(|at| white(at).try_into().unwrap()).collect();
    let projects = Projects {
        texture: "checker".to_owned(),
        size_mm: [size_mm; 2],
        center: None,
        up: Some([0.0, 1.0, 0.0]),
        wrap,
    };
    let picture = Picture::new([side, side], pixels).unwrap();
    ProjectedBy { projects, picture, center: DVec3::ZERO, up: DVec3::Y }
}

#[test]
fn a_checkerboard_lands_where_the_light_carries_it_and_keeps_its_contrast() {
    // Checks of 8 mm, projected on a floor at z = 4 by a light that leans to +x; a row through the middle of checks.
    let size = [65, 65, 41];
    println!("degrees  edges found  greatest shift (voxels)  contrast");
    for degrees in [0.0_f64, 30.0, 45.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let floor = |[_, _, z]: [usize; 3]| if z == 4 { 0.5 } else { 0.0 };
        let mut scene = Scene::new(cubes(size), [sin, 0.0, cos], NO_BIAS, floor)
            .projecting(checkerboard(8, 4, 64.0, Wrap::Repeat));
        let strength = scene.sweep();
        let row: Vec<f64> = (0..65).map(|x| beta(&strength, [x, 36, 4])).collect();
        let high = row.iter().copied().fold(0.0, f64::max);
        let low = row.iter().copied().fold(1.0, f64::min);
        let half = high.midpoint(low);
        // An edge falls on the line through the volume's centre along the light, and every 8 mm across the light.
        let middle = 32.0 - (20.0 - 4.0) * sin / cos;
        let (mut edges, mut shift) = (0, 0.0_f64);
        for (x, pair) in row.windows(2).enumerate() {
            if (pair[0] < half) != (pair[1] < half) {
                let edge = x as f64 + (half - pair[0]) / (pair[1] - pair[0]);
                let checks = (edge - middle) * cos / 8.0;
                shift = shift.max((checks - checks.round()).abs() * 8.0 / cos);
                // To the right of the middle and above it (+y) a check is black, as the texture's second is in its row.
                let dark = pair[1] < half;
                assert_eq!(dark, (checks.round() as i64).rem_euclid(2) == 0, "{degrees} {edge}");
                edges += 1;
            }
        }
        let contrast = (high - low) / (high + low);
        println!("{degrees:<8} {edges:<12} {shift:<24.3} {contrast:.4}");
        assert!(
            edges >= 5 && shift < 0.3 && contrast > 0.99,
            "{degrees}: {edges} {shift} {contrast}"
        );
    }
}

#[test]
fn a_texture_finer_than_columns_is_its_mean_everywhere() {
    // Checks of 0.11 mm under columns of 1 mm: nothing but moiré could be seen of them.
    for toward in [[0.0, 0.0, 1.0], [0.5, 0.2, 0.8]] {
        let mut scene = Scene::new(cubes([32; 3]), toward, NO_BIAS, |_| 1e-9)
            .projecting(checkerboard(64, 3, 7.04, Wrap::Repeat));
        let strength = scene.sweep();
        let values: Vec<f64> = (0..32 * 32).map(|v| beta(&strength, [v % 32, v / 32, 9])).collect();
        let spread = values.iter().map(|v| (v - 0.5).abs()).fold(0.0, f64::max);
        println!("toward {toward:?}: {spread:.4} from the mean");
        assert!(spread < 0.03, "{toward:?}: {spread}");
    }
}

#[test]
fn outside_a_vanishing_texture_there_is_no_light_and_outside_a_clamped_one_its_border() {
    let lit = |wrap| {
        let mut scene = Scene::new(cubes([33, 33, 9]), [0.0, 0.0, 1.0], NO_BIAS, |_| 1e-9)
            .projecting(checkerboard(1, 4, 16.0, wrap))
            .buffered();
        scene.sweep()
    };
    let (vanish, clamp) = (lit(Wrap::Vanish), lit(Wrap::Clamp));
    let points = [[16.0, 16.0, 4.0], [2.0, 16.0, 4.0], [16.0, 16.0, 99.0], [500.0, -3.0, 2.0]];
    let seen = |strength| points.map(|p| at(strength, DVec3::from(p)));
    assert_eq!(seen(&vanish), [1.0, 0.0, 1.0, 0.0]);
    assert_eq!(seen(&clamp), [1.0; 4]);
}

#[test]
fn a_black_slide_leaves_no_light_and_no_nan() {
    let mut dark = checkerboard(1, 2, 5.0, Wrap::Repeat);
    dark.picture = Picture::new([1, 1], vec![[0.0, 0.0, 0.0, 1.0]]).unwrap();
    let mut scene = Scene::new(cubes([9; 3]), [0.0, 1.0, 1.0], NO_BIAS, |_| 0.1);
    scene = scene.projecting(dark).buffered();
    let strength = scene.sweep();
    assert!(strength.volumes[0].1.full > 0.0 && strength.volumes[0].1.voxels.value([4, 4, 4]) == 0);
    assert_eq!(at(&strength, DVec3::splat(4.0)), 0.0);
}
