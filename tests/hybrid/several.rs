//! Facts about several volumes in one scene: where gels overlap optical depths add, in any order and whatever is skipped.

use std::sync::Arc;

use gelray::components::{OpacityUnit, Order, Sampling, Skip, Surface, View};
use gelray::polygon::face::{Face, Faces};
use gelray::view::extent::Extent;
use gelray::volume::grid::{Grid, Painted};
use glam::{DAffine3, DQuat, DVec3};
use hecs::World;

use super::support::{
    Rendered, assert_sound, bits, centred, every_pixel, flat, homogeneous, paint, rendered, run,
    square, worst,
};

/// A gel on a grid, with the thickness that its opacities are stated for.
type Gel = (Grid, Painted, f64);

fn made(gels: &[Gel], polygons: &[(Vec<DVec3>, Surface)], sampling: &Sampling) -> Rendered {
    let mut world = World::new();
    for (order, (grid, painted, unit)) in gels.iter().enumerate() {
        world.spawn((Order(order as u32), *grid, painted.clone(), OpacityUnit(*unit)));
    }
    for (number, (outline, surface)) in polygons.iter().enumerate() {
        let faces = Faces(Arc::new(vec![Face::new(vec![outline.clone()]).unwrap()]));
        world.spawn((Order(100 + number as u32), faces, surface.clone()));
    }
    let extent = Extent::of(gels.iter().flat_map(|(grid, ..)| grid.corners())).unwrap();
    let (focal_point, height_mm) = (Some([0.0; 3]), Some(16.0));
    let base = View { azimuth: 25.0, elevation: 10.0, focal_point, ..View::default() };
    let view = View { height_mm, size: [32; 2], ..base };
    let view = world.spawn((Order(200), view, sampling.clone(), extent));
    run(&mut world);
    rendered(&world, view)
}

/// Colours that vary, in a ball.
fn ball(grid: &Grid) -> Painted {
    let size = grid.size.map(|n| (n - 1) as f64);
    paint(grid, |[x, y, z]| {
        let from = DVec3::new(x as f64, y as f64, z as f64) - DVec3::from(size) / 2.0;
        let alpha = ((9.0 - from.length()) / 9.0).clamp(0.0, 0.9) as f32;
        [0.9, x as f32 / 24.0, 0.3, alpha]
    })
}

#[test]
fn three_overlapping_gels_with_a_polygon_in_them_follow_the_closed_form() {
    let grid = centred([41; 3], 1.0);
    let gels: [([f32; 3], f64, f64); 3] =
        [([1.0, 0.0, 0.0], 0.1, 1.0), ([0.0, 1.0, 0.0], 0.03, 2.0), ([0.0, 0.0, 1.0], 0.4, 9.0)];
    let stated: Vec<Gel> = gels
        .iter()
        .map(|([r, g, b], alpha, unit)| {
            (grid, homogeneous(&grid, [*r, *g, *b, *alpha as f32]), *unit)
        })
        .collect();
    let depths = gels.map(|(_, alpha, unit)| -(-f64::from(alpha as f32)).ln_1p() / unit);
    let sum: f64 = depths.iter().sum();
    let reference = made(&stated[..1], &[], &every_pixel());
    let forward = reference.camera.forward;
    let outline = square(forward * 0.37, forward, 60.0);
    let seen = made(&stated, &[(outline, flat([1.0; 3], 0.5))], &every_pixel());
    for (_, window, color) in seen.rays() {
        let ray = seen.camera.ray(window);
        let inside = |k: i64| ray.at(k as f64 + 0.5).abs().max_element() <= 20.0;
        let slabs: Vec<_> = (-60..60).filter(|&k| inside(k)).collect();
        let (Some(&first), Some(&last)) = (slabs.first(), slabs.last()) else { continue };
        let (before, behind) = (0.37 - first as f64, last as f64 + 1.0 - 0.37);
        let (front, back) = (-(-sum * before).exp_m1(), -(-sum * behind).exp_m1());
        for channel in 0..3 {
            let part = depths[channel] / sum;
            let expected = part * front + (1.0 - front) * (0.5 + 0.5 * part * back);
            let off = (f64::from(color[channel]) - expected).abs();
            assert!(off < 2e-6, "{window} {channel}: {} {expected}", color[channel]);
        }
    }
}

#[test]
fn a_volume_stated_twice_at_half_its_optical_depth_is_the_volume_in_either_order() {
    let grid = centred([25; 3], 1.0);
    let other = paint(&grid, |[x, ..]| [0.2, 0.9, 0.1, if x < 9 { 0.3 } else { 0.0 }]);
    let whole = made(&[(grid, ball(&grid), 1.0)], &[], &every_pixel());
    let half = (grid, ball(&grid), 2.0);
    let twice = made(&[half.clone(), half.clone()], &[], &every_pixel());
    let off = worst(&whole.picture, &twice.picture);
    assert!(off < 1e-5, "{off}");
    let (a, b) = ((grid, ball(&grid), 1.0), (grid, other, 1.0));
    let orders = [[&a, &b, &half], [&half, &a, &b], [&b, &half, &a]];
    let pictures = orders
        .map(|order| bits(&made(&order.map(Clone::clone), &[], &Sampling::default()).picture));
    assert!(pictures[0] == pictures[1] && pictures[0] == pictures[2]);
}

#[test]
fn a_volume_cut_in_two_is_the_whole_within_the_slab_at_the_seam() {
    let grid = centred([25; 3], 1.0);
    let painted = ball(&grid);
    let Painted::F32(voxels) = &painted else { panic!("the ball is in floats") };
    let part = |from: usize, to: usize| {
        let origin = grid.index_to_world.transform_point3(DVec3::new(0.0, 0.0, from as f64));
        let grid =
            Grid::axis_aligned([25, 25, to - from + 1], [1.0; 3], origin.to_array()).unwrap();
        let slices = voxels[from * 625..(to + 1) * 625].to_vec();
        (grid, Painted::F32(gelray::shared::Shared::new(slices)), 1.0)
    };
    let whole = made(&[(grid, painted.clone(), 1.0)], &[], &every_pixel());
    let cut = made(&[part(0, 12), part(12, 24)], &[], &every_pixel());
    let off = worst(&whole.picture, &cut.picture);
    println!("a volume cut in two is off by {off:.2e}");
    assert!(off < 1e-6, "{off}");
}

#[test]
fn skipping_threads_and_grids_of_any_rotation_change_no_bit() {
    let grid = centred([30, 26, 22], 0.8);
    let sparse = paint(&grid, |[x, y, z]| {
        let on = (x * 5 + y * 11 + z * 17) % 23 == 0 && (x / 8 + z / 8) % 2 == 0;
        [0.9, y as f32 / 30.0, 0.2, if on { 0.6 } else { 0.0 }]
    });
    let turned =
        DAffine3::from_quat(DQuat::from_axis_angle(DVec3::new(0.3, 0.8, 0.5).normalize(), 0.7));
    let rotated = Grid::new(grid.size, turned * grid.index_to_world).unwrap();
    let gels = [(grid, sparse.clone(), 1.0), (rotated, sparse, 0.5)];
    let polygon = (
        square(DVec3::new(0.0, 1.0, 0.5), DVec3::new(0.2, 1.0, 0.4), 5.0),
        flat([0.1, 0.2, 1.0], 0.6),
    );
    let seen = |skip, threads| {
        let sampling = Sampling { skip, ..Sampling::default() };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let picture =
            pool.install(|| made(&gels, std::slice::from_ref(&polygon), &sampling).picture);
        assert_sound(&picture, "two volumes");
        bits(&picture)
    };
    let one = seen(Skip::Pyramid, 1);
    assert!(one == seen(Skip::None, 2) && one == seen(Skip::Pyramid, 7));
}
