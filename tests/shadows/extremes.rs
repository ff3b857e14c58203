//! Numbers at the ends of their ranges (algorithm §10), and equal bytes from any number of threads.

use gelray::components::CastsShadow;
use gelray::light::strength::LightStrength;
use gelray::shared::Shared;
use gelray::volume::grid::{Grid, Painted};
use gelray::volume::layer::Opacity;
use glam::DVec3;

use crate::setup::{NO_BIAS, Scene, at, beta, cubes, noise, point, voxels};

fn sound(strength: &LightStrength, size: [usize; 3]) -> bool {
    let full = f64::from(strength.volumes[0].1.most());
    let within = |beta: f64| beta.is_finite() && (0.0..=full * (1.0 + 1e-6)).contains(&beta);
    let far = [DVec3::splat(1e12), DVec3::splat(-1e300), DVec3::new(1e5, 0.0, -3.0), DVec3::NAN];
    full.is_finite()
        && full > 0.0
        && voxels(size).all(|v| within(beta(strength, v)))
        && voxels(size).map(point).chain(far).all(|p| within(at(strength, p)))
}

#[test]
fn every_strength_is_finite_and_within_bounds_at_extreme_opacities_and_ratios() {
    let size = [6, 5, 7];
    let shadow = CastsShadow { bias_voxels: 0.7, k1: 1.0, k2: 0.01 };
    for alpha in [0.0, 1e-40, 1e-9, 1e-7, 1.0 - f32::EPSILON / 2.0, 1.0, 7.0, -1.0, f32::NAN] {
        for unit in [1e-300, 1e-3, 1.0, 1e6, 1e300] {
            for toward in [[0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.2, -1.0, 0.4]] {
                let mixed = |v: [usize; 3]| if v[0] % 3 == 1 { alpha } else { 0.3 };
                let scene = Scene::new(cubes(size), toward, shadow, mixed);
                assert!(
                    sound(&scene.unit(unit).buffered().sweep(), size),
                    "{alpha} {unit} {toward:?}"
                );
            }
        }
    }
}

#[test]
fn what_is_opaque_lets_nothing_through_and_what_is_clear_everything() {
    let opaque = |v: [usize; 3]| f32::from(v[2] == 5);
    let strength = Scene::new(cubes([8; 3]), [0.0, 0.0, 1.0], NO_BIAS, opaque).buffered().sweep();
    assert_eq!(at(&strength, DVec3::new(3.0, 3.0, 6.0)), 1.0);
    assert_eq!(at(&strength, DVec3::new(3.0, 3.0, 4.0)), 0.0);
    assert_eq!(at(&strength, DVec3::new(3.0, 3.0, -50.0)), 0.0);
    assert_eq!(at(&strength, DVec3::new(30.0, 3.0, -50.0)), 1.0);
    let strength = Scene::new(cubes([8; 3]), [0.3, 0.5, 1.0], NO_BIAS, |_| 0.0).buffered().sweep();
    assert_eq!(strength.volumes[0].1.voxels.stored().count(), 0);
    assert!(voxels([8; 3]).all(|v| at(&strength, point(v)) == 1.0));
}

#[test]
fn the_smallest_volume_is_swept_from_every_side() {
    for toward in voxels([3; 3]).map(|v| (point(v) - 1.0).to_array()).filter(|&t| t != [0.0; 3]) {
        let strength = Scene::new(cubes([2; 3]), toward, NO_BIAS, |_| 0.5).buffered().sweep();
        assert!(sound(&strength, [2; 3]), "{toward:?}");
        // The voxel nearest to the light has all of it.
        let near = toward.map(|t| usize::from(t > 0.0));
        assert_eq!(beta(&strength, near), 1.0, "{toward:?}");
    }
}

#[test]
fn scaling_and_moving_the_world_changes_no_strength() {
    let size = [11, 13, 9];
    let opacity = |v: [usize; 3]| noise((v[2] * 169 + v[1] * 13 + v[0]) as u64) as f32 * 0.4;
    for toward in [[0.0, 1.0, 0.0], [0.3, 0.4, -0.8]] {
        let plain = Scene::new(cubes(size), toward, CastsShadow::default(), opacity).sweep();
        for scale in [1e-6, 1e-3, 1e3, 1e6] {
            for moved in [0.0, 1e6] {
                let grid = Grid::axis_aligned(size, [scale; 3], [moved; 3]).unwrap();
                let scene = Scene::new(grid, toward, CastsShadow::default(), opacity);
                let strength = scene.unit(scale).sweep();
                let worst = voxels(size).map(|v| (beta(&strength, v) - beta(&plain, v)).abs());
                assert!(worst.fold(0.0, f64::max) < 3e-5, "{toward:?} {scale} {moved}");
            }
        }
    }
}

#[test]
fn one_two_and_seven_threads_make_equal_bytes() {
    let size = [70, 50, 40];
    let opacity = |v: [usize; 3]| noise((v[2] * 3500 + v[1] * 70 + v[0]) as u64) as f32 * 0.1;
    for toward in [[0.3, 0.4, 0.8], [0.9, 0.1, -0.2]] {
        let sweep = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                Scene::new(cubes(size), toward, CastsShadow::default(), opacity).buffered().sweep()
            })
        };
        let [one, two, seven] = [1, 2, 7].map(sweep);
        for other in [two, seven] {
            assert!(
                one.volumes[0].1.voxels.stored().map(|b| b.1).eq(other.volumes[0]
                    .1
                    .voxels
                    .stored()
                    .map(|b| b.1))
            );
            assert!(voxels(size).all(|v| at(&one, point(v) + 0.3) == at(&other, point(v) + 0.3)));
        }
    }
}

#[test]
fn painted_voxels_cast_shadows_by_their_alpha() {
    let size = [9, 8, 12];
    let made = Scene::new(cubes(size), [0.2, 0.1, 1.0], NO_BIAS, |_| 51.0 / 255.0).sweep();
    let count = 9 * 8 * 12;
    let kinds = [
        Painted::U8(Shared::new(vec![[1, 2, 3, 51]; count])),
        Painted::U16(Shared::new(vec![[1, 2, 3, 51 * 257]; count])),
        Painted::F32(Shared::new(vec![[1.0, 2.0, 3.0, 51.0 / 255.0]; count])),
    ];
    for painted in kinds {
        let mut scene = Scene::new(cubes(size), [0.2, 0.1, 1.0], NO_BIAS, |_| 0.0);
        scene.world.remove_one::<Opacity>(scene.volume).unwrap();
        scene.world.insert_one(scene.volume, painted).unwrap();
        let strength = scene.sweep();
        assert!(voxels(size).all(|v| beta(&strength, v) == beta(&made, v)));
    }
}

#[test]
fn what_cannot_be_swept_is_told_with_the_lights_name_and_a_remedy() {
    let problem = |toward, shadow, unit| {
        let mut scene = Scene::new(cubes([3; 3]), toward, shadow, |_| 0.5).unit(unit);
        scene.try_sweep().unwrap_err().to_string()
    };
    let up = [0.0, 0.0, 1.0];
    let bias = |bias_voxels| CastsShadow { bias_voxels, ..NO_BIAS };
    assert!(problem([0.0; 3], NO_BIAS, 1.0).starts_with("entity `key`: its `toward`"));
    assert!(problem([f64::NAN; 3], NO_BIAS, 1.0).contains("no direction"));
    assert!(problem(up, bias(-1.0), 1.0).contains("bias of -1 voxels"));
    assert!(problem(up, bias(f64::NAN), 1.0).contains("choose 0 or more"));
    assert!(problem(up, CastsShadow { k2: -1.0, ..NO_BIAS }, 1.0).contains("choose `k1` and `k2`"));
    assert!(problem(up, NO_BIAS, 0.0).contains("opacity_unit_mm"));
}
