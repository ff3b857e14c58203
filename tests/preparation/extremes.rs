//! The numerical extremes of algorithm §10 through the whole of preparation.

use gelray::components::Toward;
use gelray::shared::Shared;
use gelray::volume::gel::Gel;
use gelray::volume::gel::GelBricks;
use gelray::volume::grid::{Grid, Scalars};
use gelray::volume::layer::Opacity;
use glam::{DVec3, Vec3};
use hecs::{Entity, World};

use super::{
    Ball, ball, colors, contour, prepare, sampled, spawn_light, spawn_volume, texel, voxels,
};

#[test]
fn nan_is_clear_and_counted_and_leaves_every_colour_finite() {
    let mut world = World::new();
    let grid = Grid::axis_aligned([20, 12, 9], [1.0; 3], [0.0; 3]).unwrap();
    let hole = |p: DVec3| (p.x as usize + p.y as usize * 3 + p.z as usize * 7).is_multiple_of(11);
    let values = sampled(&grid, |p| if hole(p) { f32::NAN } else { p.x as f32 });
    let count = values.iter().filter(|value| value.is_nan()).count();
    let volume = spawn_volume(&mut world, grid, values, contour(8.0));
    prepare(&mut world);
    let colors = colors(&mut world, volume);
    let opacity = world.get::<&Opacity>(volume).unwrap();
    assert_eq!(opacity.nan_voxels, count as u64);
    for (voxel, point) in voxels(&grid) {
        assert!(Vec3::from(colors.base.value(voxel)).is_finite());
        assert!(!hole(point) || opacity.voxels.value(voxel) == 0.0);
    }
}

fn prepared(grid: Grid, scalars: Scalars) -> (World, Entity) {
    let mut world = World::new();
    let volume = spawn_volume(&mut world, grid, Vec::new(), contour(8.0));
    world.insert_one(volume, scalars).unwrap();
    spawn_light(&mut world, 1, Toward::Direction([0.3, -0.4, 1.0]));
    prepare(&mut world);
    (world, volume)
}

#[test]
fn extremes_are_finite_and_within_bounds() {
    let sizes = [[2, 2, 2], [9, 8, 3], [17, 2, 2]];
    let numbers = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -f32::MAX, 0.0, 1e-40];
    for (size, exponent) in
        sizes.into_iter().flat_map(|size| (-6..=6).step_by(3).map(move |e| (size, e)))
    {
        let h = 10_f64.powi(exponent);
        let grid = Grid::axis_aligned(size, [h, -h, 2.0 * h], [1e6 * h; 3]).unwrap();
        let n = grid.voxels();
        let mixed = (0..n).map(|i| numbers[i * 5 % 7]).collect();
        for values in [vec![8.0; n], vec![3.0; n], vec![f32::NAN; n], mixed] {
            let first = values[0];
            let (world, volume) = prepared(grid, Scalars::F32(Shared::new(values.clone())));
            let opacity = world.get::<&Opacity>(volume).unwrap();
            let gel = world.get::<&Gel>(volume).unwrap();
            for (voxel, _) in voxels(&grid) {
                let rgba = texel(&gel.lit, voxel);
                assert!(rgba.is_finite() && (0.0..=1.0).contains(&rgba.w), "{rgba}");
                assert!(rgba.truncate().max_element() <= rgba.w);
            }
            let constant = values.iter().all(|value| *value == first);
            if constant {
                let expected = if first == 8.0 { 0.9 } else { 0.0 };
                assert_eq!(opacity.voxels.value([1, 1, 1]), expected);
            }
        }
    }
}

#[test]
fn opacity_is_the_same_at_every_scale_of_the_world() {
    let alphas = |h: f64| {
        let mut world = World::new();
        let grid = Grid::axis_aligned([8, 8, 8], [h; 3], [0.0; 3]).unwrap();
        let values = sampled(&grid, |p| (p / h).dot(DVec3::new(1.0, 0.5, 0.25)) as f32);
        let volume = spawn_volume(&mut world, grid, values, contour(6.0));
        prepare(&mut world);
        let opacity = world.get::<&Opacity>(volume).unwrap();
        voxels(&grid).map(|(voxel, _)| opacity.voxels.value(voxel)).collect::<Vec<_>>()
    };
    let here = alphas(1.0);
    assert!(here.iter().any(|alpha| *alpha > 0.5));
    for h in [1e-6, 1e6] {
        let worst = here.iter().zip(alphas(h)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-5, "{h}: {worst}");
    }
}

#[test]
#[allow(clippy::cast_lossless, reason = "one body for all types")]
fn integers_of_every_type_are_classified_alike() {
    let grid = Grid::axis_aligned([9, 5, 4], [1.0; 3], [0.0; 3]).unwrap();
    let values = sampled(&grid, |p| (2.0 * p.x + p.y) as f32);
    let num = |value: f32| value as u8;
    macro_rules! alphas {
        ($($kind:ident)*) => {[$({
            let values = values.iter().map(|v| num(*v) as _).collect();
            let (world, volume) = prepared(grid, Scalars::$kind(Shared::new(values)));
            let opacity = world.get::<&Opacity>(volume).unwrap();
            voxels(&grid).map(|(voxel, _)| opacity.voxels.value(voxel)).collect::<Vec<f32>>()
        }),*]};
    }
    let made = alphas!(U8 I8 U16 I16 U32 I32 U64 I64 F32 F64);
    assert!(made[0].iter().any(|alpha| *alpha > 0.0));
    assert!(made.iter().all(|alphas| *alphas == made[0]));
}

#[test]
fn any_number_of_threads_makes_the_same_bits() {
    let made = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let Ball { mut world, volume, .. } = ball();
        pool.install(|| prepare(&mut world));
        let gel = world.get::<&Gel>(volume).unwrap();
        let GelBricks::F32(texels) = &gel.lit else { panic!("the view states 32 bits") };
        let bits = texels.bricks().iter().flatten().flatten().map(|channel| channel.to_bits());
        (texels.table().to_vec(), bits.collect::<Vec<_>>())
    };
    let one = made(1);
    assert!(one.1.iter().any(|channel| *channel != 0));
    assert!(made(2) == one && made(7) == one);
}
