//! Homogeneous gel with polygons anywhere in it is what the formula says (paper §2, equations 2a and 2b).

use gelray::components::{
    Classify, Color, Material, OpacityUnit, Order, Sampling, TransferPoint, View,
};
use gelray::shared::Shared;
use gelray::view::extent::Extent;
use gelray::volume::grid::{Grid, Scalars};
use glam::{DVec2, DVec3, Vec3};
use hecs::World;

use super::support::{
    Mixture, Rendered, centred, every_pixel, flat, homogeneous, rendered, run, square,
};

/// Views along the axes.
const ALONG: [(f64, f64); 4] = [(0.0, 0.0), (90.0, 0.0), (180.0, 0.0), (0.0, 90.0)];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];

/// Gel of which every ray sees slabs `first..end`, and polygons at depths; C by the formula, in 64 bits.
pub struct Formula {
    pub color: [f64; 3],
    /// α_v per opacity unit.
    pub opacity: f64,
    /// Δ.
    pub distance: f64,
    pub unit: f64,
    pub slabs: [i64; 2],
}

impl Formula {
    /// What a ray sees that meets polygons `(depth, colour, opacity)`, in order.
    pub fn color(&self, polygons: &[(f64, [f32; 3], f32)]) -> [f64; 4] {
        let slabs = self.slabs.map(|k| k as f64 * self.distance);
        let (mut color, mut through, mut depth) = (DVec3::ZERO, 1.0, slabs[0]);
        let pass = |from: f64, to: f64, through: &mut f64, color: &mut DVec3| {
            // e^(thickness · ln(1 − α)), by its powers where α = 1.
            let thickness = (to - from).max(0.0) / self.unit;
            let left = if thickness == 0.0 { 1.0 } else { (1.0 - self.opacity).powf(thickness) };
            *color += DVec3::from(self.color) * (*through * (1.0 - left));
            *through *= left;
        };
        for (at, c, opacity) in polygons {
            let at = at.clamp(slabs[0], slabs[1]);
            pass(depth, at, &mut through, &mut color);
            let alpha = f64::from(*opacity);
            color += Vec3::from(*c).as_dvec3() * (through * alpha);
            through *= 1.0 - alpha;
            depth = at;
        }
        pass(depth, slabs[1], &mut through, &mut color);
        [color.x, color.y, color.z, 1.0 - through]
    }
}

pub fn off(seen: [f32; 4], expected: [f64; 4]) -> f64 {
    seen.iter().zip(expected).map(|(s, e)| (f64::from(*s) - e).abs()).fold(0.0, f64::max)
}

/// The slabs whose samples lie within ±`half` of the plane of depth 0.
fn slabs(half: f64, distance: f64) -> [i64; 2] {
    let inside = |k: &i64| ((*k as f64 + 0.5) * distance).abs() <= half;
    let most = (half / distance) as i64 + 2;
    let first = (-most..most).find(inside).unwrap();
    [first, (first..=most).find(|k| !inside(k)).unwrap()]
}

#[test]
fn k_slabs_of_homogeneous_gel_have_the_opacity_of_one_to_the_kth() {
    let grid = centred([12; 3], 0.75);
    let mut error = 0.0_f64;
    for opacity in [1e-9_f32, 1e-7, 1e-3, 0.1, 0.5, 0.9, 0.999, 1.0 - f32::EPSILON / 2.0, 1.0] {
        let gel = homogeneous(&grid, [0.9, 0.5, 0.1, opacity]);
        for (ratio, view) in [1.0, 0.5, 2.0, 1.0 / 3.0, 0.7, std::f64::consts::SQRT_2, 3.1]
            .into_iter()
            .flat_map(|ratio| ALONG.map(|view| (ratio, view)))
        {
            let distance = 0.75 * ratio;
            let sampling = Sampling { distance_mm: Some(distance), ..every_pixel() };
            let scene = Mixture { sampling, ..Mixture::of(grid, gel.clone()) }.seen(view, 3, 3.0);
            let formula = Formula {
                color: [0.9_f32, 0.5, 0.1].map(f64::from),
                opacity: f64::from(opacity),
                distance,
                unit: 0.75,
                slabs: slabs(5.5 * 0.75, distance),
            };
            let expected = formula.color(&[]);
            for pixel in scene.render().picture.pixels.iter() {
                error = error.max(off(*pixel, expected));
            }
        }
    }
    println!("homogeneous gel, 9 opacities × 7 ratios × 4 views: off by {error:.1e} at most");
    assert!(error < 1e-6);
}

#[test]
fn a_constant_transfer_function_is_homogeneous_gel() {
    let grid = Grid::axis_aligned([9, 12, 7], [1.0, 0.5, 2.0], [-4.0, -2.75, -6.0]).unwrap();
    for opacity in [0.02_f32, 0.3, 0.97] {
        let mut world = World::new();
        let point = TransferPoint { value: 0.0, opacity, color: Some(Color(Vec3::from(GREEN))) };
        let classify: Classify = Classify { transfer: vec![point], ..Classify::default() };
        let material = Material { ambient: 1.0, diffuse: 0.0, ..Material::default() };
        let scalars = Scalars::U8(Shared::new(vec![77; grid.voxels()]));
        world.spawn((Order(0), grid, scalars, classify, material, OpacityUnit(0.5)));
        let view = View { size: [4, 4], height_mm: Some(2.0), ..View::default() };
        let extent = Extent::of(grid.corners()).unwrap();
        let view = world.spawn((Order(1), view, every_pixel(), extent));
        run(&mut world);
        // 12 voxels: samples from the first to the last of them, both on the border of the domain.
        let alpha = 1.0 - (1.0 - f64::from(opacity)).powi(12);
        for pixel in rendered(&world, view).picture.pixels.iter() {
            assert!(off(*pixel, [0.0, alpha, 0.0, alpha]) < 1e-6, "{opacity}: {pixel:?} {alpha}");
        }
    }
}

/// Gel of 16 voxels a side and spacing 1 with polygons, against the formula at every ray that was cast; the worst error.
fn against_formula(view: (f64, f64), ratio: f64, opacity: f32, planes: &[(DVec3, DVec3)]) -> f64 {
    let grid = centred([17; 3], 1.0);
    let colors = [[1.0, 0.0, 0.0], [0.2, 0.3, 0.9], [0.9, 0.9, 0.1]];
    let look = |i: usize| (colors[i % 3], 0.5 + 0.45 * (i as f32 * 2.3).sin());
    let polygons = planes.iter().enumerate().map(|(i, (center, normal))| {
        (vec![square(*center, *normal, 600.0)], flat(look(i).0, look(i).1))
    });
    let scene = Mixture {
        polygons: polygons.collect(),
        sampling: Sampling { distance_mm: Some(ratio), ..every_pixel() },
        ..Mixture::of(grid, homogeneous(&grid, [0.1, 0.8, 0.3, opacity]))
    };
    let made = scene.seen(view, 6, 5.0).render();
    let mut error = 0.0_f64;
    for (_, window, seen) in made.rays() {
        let mut hits: Vec<_> = (0..planes.len())
            .map(|i| (depth(&made, window, planes[i]), look(i).0, look(i).1))
            .collect();
        hits.sort_by(|a, b| a.0.total_cmp(&b.0));
        let formula = Formula {
            color: [0.1_f32, 0.8, 0.3].map(f64::from),
            opacity: f64::from(opacity),
            distance: ratio,
            unit: 1.0,
            slabs: inside(&made, window, ratio),
        };
        error = error.max(off(seen, formula.color(&hits)));
    }
    error
}

/// The depth of a plane under a window position.
fn depth(made: &Rendered, window: DVec2, (center, normal): (DVec3, DVec3)) -> f64 {
    normal.dot(center - made.camera.origin(window)) / normal.dot(made.camera.forward)
}

/// The slabs whose samples lie in the cube of half side 8.
fn inside(made: &Rendered, window: DVec2, distance: f64) -> [i64; 2] {
    let origin = made.camera.origin(window);
    let holds = |k: &i64| {
        let sample = origin + made.camera.forward * ((*k as f64 + 0.5) * distance);
        sample.abs().max_element() <= 8.0
    };
    let most = (15.0 / distance) as i64;
    let first = (-most..most).find(holds).unwrap();
    [first, (first..=most).find(|k| !holds(k)).unwrap()]
}

#[test]
fn a_polygon_at_any_depth_of_a_slab_of_gel_matches_the_formula() {
    let mut error = 0.0_f64;
    let mut depths: Vec<f64> = (-80..=80).map(|i| f64::from(i) / 8.0).collect();
    depths.extend([1e-9, -1e-9, 3.0 - 1e-12, 7.999_999_999, 8.0, 0.123_456_789, 1e3, -1e3]);
    for depth in depths {
        for ratio in [1.0, 0.5, 0.75] {
            let plane = [(DVec3::Y * depth, DVec3::Y)];
            error = error.max(against_formula((0.0, 0.0), ratio, 0.08, &plane));
        }
    }
    println!("a polygon at 169 depths × 3 sample distances: off by {error:.1e} at most");
    assert!(error < 1e-6);
}

#[test]
fn oblique_polygons_and_views_match_the_formula_at_every_ray() {
    let mut error = 0.0_f64;
    for i in 0..60 {
        let turn = f64::from(i);
        let normal = DVec3::new((turn * 0.7).sin(), 0.9, (turn * 1.3).cos());
        let center = DVec3::new(0.3, (turn * 0.37).sin() * 4.0, -0.2);
        let view = (turn * 17.3, (turn * 0.9).sin() * 60.0);
        let ratio = [1.0, 0.5, 0.37, 2.0][i as usize % 4];
        let camera = gelray::view::camera::Camera::new(
            &View { azimuth: view.0, elevation: view.1, ..View::default() },
            &Extent { low: DVec3::ZERO, high: DVec3::ONE },
        );
        if camera.forward.dot(normal.normalize()).abs() > 0.05 {
            error = error.max(against_formula(view, ratio, 0.05, &[(center, normal)]));
        }
    }
    println!("oblique polygons and views: off by {error:.1e} at most");
    assert!(error < 1e-6);
}

#[test]
fn up_to_eight_polygons_in_one_slab_match_the_formula() {
    let mut error = 0.0_f64;
    for count in 1..=8_u32 {
        for opacity in [0.0, 1e-7, 0.3, 1.0 - f32::EPSILON / 2.0, 1.0] {
            for slope in [0.0, 0.05] {
                // Listed from back to front, so that the scene's order is not the depths'.
                let plane = |j: u32| {
                    let place = 2.0 + f64::from(j * j) / f64::from(count * count);
                    (DVec3::Y * place, DVec3::new(slope, 1.0, -slope / 2.0))
                };
                let planes: Vec<_> = (0..count).rev().map(plane).collect();
                error = error.max(against_formula((0.0, 0.0), 1.0, opacity, &planes));
            }
        }
    }
    println!("one to eight polygons in a slab: off by {error:.1e} at most");
    assert!(error < 1e-6);
}

/// A slab of green gel of transmittance 1/4, 8 slabs thick, with 50 % red quads at parts of its depth.
fn green_with_red(parts: &[f64], ratio: f64) -> [f32; 4] {
    let grid = centred([9; 3], 1.0);
    let alpha = 1.0 - 0.25_f32.powf(1.0 / 8.0);
    let quad = |part: &f64| {
        (vec![square(DVec3::Y * (8.0 * part - 4.0), DVec3::Y, 20.0)], flat([1.0, 0.0, 0.0], 0.5))
    };
    let scene = Mixture {
        polygons: parts.iter().map(quad).collect(),
        sampling: Sampling { distance_mm: Some(ratio), ..every_pixel() },
        ..Mixture::of(grid, homogeneous(&grid, [0.0, 1.0, 0.0, alpha]))
    };
    let picture = scene.seen((0.0, 0.0), 3, 3.0).render().picture;
    assert!(picture.pixels.iter().all(|pixel| *pixel == picture.pixels[0]));
    picture.pixels[0]
}

#[test]
fn translucent_quads_in_translucent_gel_have_the_right_answer_that_peers_miss() {
    for ratio in [1.0, 0.5, 2.0, 0.25] {
        let one = green_with_red(&[0.5], ratio);
        let three = green_with_red(&[0.25, 0.5, 0.75], ratio);
        println!("Δ = {ratio} u: one quad {one:.4?}, three {three:.4?}");
        // Green: 1/2 before the quad and 1/4 of 1/2 behind; red: 1/2 of 1/2.
        assert!(off(one, [0.25, 0.625, 0.0, 0.875]) < 1e-6);
        // Quarters of the gel let q = 2^(−1/2) through, each quad a half.
        let q = 0.5_f64.sqrt();
        let red: f64 = (1..=3).map(|n| q.powi(n) * 0.5_f64.powi(n)).sum();
        let green: f64 = (0..=3).map(|n| (1.0 - q) * (q * 0.5).powi(n)).sum();
        assert!(off(three, [red, green, 0.0, 1.0 - 0.25 / 8.0]) < 1e-6);
        assert!((red - 0.523).abs() < 5e-4 && (green - 0.446).abs() < 5e-4);
    }
}

#[test]
fn coincident_polygons_composite_in_the_order_of_the_scene_at_every_angle() {
    let grid = centred([9; 3], 1.0);
    let gel = homogeneous(&grid, [0.0, 1.0, 0.0, 0.1]);
    for turn in 0..40 {
        let normal = DVec3::new(0.3, 1.0, 0.2 + 0.01 * f64::from(turn));
        let center = DVec3::new(0.1, 0.37, -0.2);
        // A large square, a small one laid on it and a triangle: one plane, no vertex in common.
        let (a, b) = normal.normalize().any_orthonormal_pair();
        let corner = |x: f64, y: f64| center + a * x + b * y;
        let triangle = vec![corner(-9.1, -7.3), corner(8.7, -6.9), corner(0.3, 11.9)];
        let outlines =
            [square(center, normal, 20.0), square(corner(0.7, -0.4), normal, 5.0), triangle];
        let colors = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]];
        for order in [[0, 1, 2], [2, 1, 0], [1, 0, 2]] {
            let polygon = |i: usize| (vec![outlines[i].clone()], flat(colors[i], 0.5));
            let scene = Mixture {
                polygons: order.map(polygon).to_vec(),
                sampling: every_pixel(),
                ..Mixture::of(grid, gel.clone())
            };
            let made = scene.seen((f64::from(turn) * 9.1, f64::from(turn) - 20.0), 5, 2.0).render();
            if made.camera.forward.dot(normal.normalize()).abs() < 0.4 {
                continue;
            }
            for (_, window, seen) in made.rays() {
                // Of the colour that got through the gel before them, a half, a quarter and an eighth.
                let [red, _, blue, _] = seen.map(f64::from);
                let part =
                    |i: usize| 0.5_f64.powi(1 + order.iter().position(|&o| o == i).unwrap() as i32);
                assert!(
                    (red * part(1) - blue * part(0)).abs() < 1e-7,
                    "{turn} {order:?} {window} {seen:?}"
                );
            }
        }
    }
}
