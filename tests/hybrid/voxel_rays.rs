//! Facts about rays through voxels: near the exact picture, the same on any threads, and not cast where they see too little.

use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use gelray::components::{PixelFilter, Sampling, Skip, Surface, TexelKind, View};
use gelray::measure::error::compare;
use glam::DVec3;

use super::support::{
    Mixture, Shown, assert_sound, bits, centred, homogeneous, sampling_of_the_head, square,
};

static PLANES: LazyLock<Mutex<Shown>> =
    LazyLock::new(|| Mutex::new(Shown::embedded("figure_06b", &[])));

/// The phantom of a head with planes that are scan-converted into it: volumes alone are met.
fn planes() -> MutexGuard<'static, Shown> {
    PLANES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A cube of so many voxels a side, all alike.
fn even(side: usize) -> Mixture {
    let grid = centred([side; 3], 1.0);
    Mixture::of(grid, homogeneous(&grid, [0.2, 0.5, 0.1, 0.05]))
}

fn through_voxels(per_voxel: f64) -> Sampling {
    Sampling { per_voxel, ..sampling_of_the_head() }
}

/// Of six sides, and askew.
const SIDES: [[f64; 2]; 7] =
    [[0.0, 0.0], [90.0, 0.0], [180.0, 0.0], [270.0, 0.0], [0.0, 90.0], [0.0, -90.0], [25.0, 15.0]];

#[test]
fn a_head_is_near_its_exact_picture_from_all_sides_and_nearer_with_more_rays() {
    let mut shown = planes();
    for [azimuth, elevation] in SIDES {
        let mut turned = |sampling: Sampling| {
            let turn = |view: &mut View| {
                (view.azimuth, view.elevation, view.size) = (azimuth, elevation, [120; 2]);
            };
            shown.render(turn, sampling)
        };
        let exact = turned(sampling_of_the_head().exact()).picture;
        let errors = [0.5, 1.0, 2.0, 4.0].map(|rays| {
            let made = turned(through_voxels(rays));
            assert!(made.array.voxel_rays.is_some());
            assert_sound(&made.picture, "rays through voxels");
            compare(&exact, &made.picture).unwrap().linear.psnr_db
        });
        println!("{azimuth} {elevation}: {errors:.1?} dB");
        let least = [28.0, 34.0, 35.0, 37.0];
        let is_near = errors.iter().zip(least).all(|(error, least)| *error > least);
        // Beyond 50 dB what is left is not the distance between rays, but when they stop.
        let nearer = errors.windows(2).all(|pair| pair[0] < pair[1] || pair[0] > 50.0);
        assert!(is_near && nearer, "{azimuth} {elevation}: {errors:?}");
    }
}

#[test]
fn threads_and_skipping_change_no_bit_of_rays_through_voxels() {
    let mut held = planes();
    let shown: &mut Shown = &mut held;
    for texel in [TexelKind::F32, TexelKind::U16, TexelKind::U8] {
        let settings = Sampling { texel, stop_at: 0.05, ..through_voxels(4.0) };
        let mut on = |threads: usize, skip: Skip| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let size = |size: u32| move |view: &mut View| view.size = [size; 2];
            // A view of its own each time, so that nothing is kept from the time before.
            pool.install(|| shown.render(size(8), settings.clone()));
            let made =
                pool.install(|| shown.render(size(90), Sampling { skip, ..settings.clone() }));
            (bits(&made.picture), made.array.counts.rays)
        };
        let made = on(1, Skip::Pyramid);
        assert!(made == on(2, Skip::Pyramid) && made == on(7, Skip::None), "{texel:?}");
    }
}

#[test]
fn a_part_of_the_volume_that_is_magnified_takes_its_own_rays_alone() {
    let mut shown = planes();
    let near = |view: &mut View| (view.height_mm, view.size) = (Some(60.0), [100; 2]);
    let mut whole = None;
    let nearer = |view: &mut View| {
        whole = view.height_mm;
        near(view);
    };
    let every = Sampling { coarsest: 4, finest: 4, ..through_voxels(0.0) };
    let by_pixels = shown.render(nearer, every);
    let made = shown.render(near, through_voxels(4.0));
    shown.render(|view: &mut View| view.height_mm = whole, through_voxels(1.0));
    // Of 256 × 256 × 113 voxels, four rays a face, those within 60 mm and a few beside them.
    assert!(made.array.counts.rays < 40_000, "{:?}", made.array.counts);
    let error = compare(&by_pixels.picture, &made.picture).unwrap().linear.psnr_db;
    assert!(error > 30.0, "{error} dB");
}

#[test]
fn what_is_even_is_even_in_every_pixel_filter_and_size() {
    for filter in [PixelFilter::Box, PixelFilter::Tent, PixelFilter::Mitchell] {
        for height in [8.0, 40.0] {
            let mut mixture = even(24).seen((90.0, 0.0), 16, height);
            mixture.sampling = Sampling { pixel_filter: filter, ..through_voxels(1.0) };
            mixture.sampling.distance_mm = Some(0.5);
            let by_voxels = mixture.render();
            mixture.sampling.per_voxel = 0.0;
            let by_pixels = mixture.render();
            let middle = 8 * 16 + 8;
            let pixels = [&by_voxels, &by_pixels].map(|made| made.picture.pixels[middle]);
            for (a, b) in pixels[0].iter().zip(pixels[1]) {
                assert!((a - b).abs() < 0.02, "{filter:?} {height}: {pixels:?}");
            }
        }
    }
}

#[test]
fn beside_polygons_and_in_perspective_rays_go_through_pixels() {
    let volume = || even(16).seen((30.0, 20.0), 20, 24.0);
    let polygon = (vec![square(DVec3::ZERO, DVec3::Y, 5.0)], Surface::default());
    let beside = Mixture { polygons: vec![polygon], ..volume() };
    let mut perspective = volume();
    perspective.view.field_of_view = Some(30.0);
    for mut mixture in [beside, perspective] {
        let without = mixture.render();
        mixture.sampling.per_voxel = 4.0;
        let with = mixture.render();
        assert!(with.array.voxel_rays.is_none());
        assert!(bits(&with.picture) == bits(&without.picture));
    }
    // What is seen of the volume alone is asked for as stated, and tells where its rays were.
    let mut alone = volume();
    alone.sampling.per_voxel = 1.0;
    let made = alone.render();
    assert!(made.array.meets_anything() && made.array.voxel_rays.is_some());
    let map = made.array.ray_map();
    let marked = map.iter().filter(|ray| **ray).count();
    assert!(marked > 100 && marked as u64 <= made.array.counts.rays, "{marked}");
}
