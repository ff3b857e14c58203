//! Projections: of a volume a ray shows one value, at a depth among polygons.

use gelray::prelude::*;
use gelray::scene::{Source, load};

use crate::{EVERY_PIXEL, KEY, at, difference, level, made, pixels, run, stated, view};

/// Numbers without order.
pub(crate) fn noise(at: usize) -> f32 {
    let mixed = (at as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    ((mixed ^ mixed >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 40) as f32 / (1 << 24) as f32
}

/// A picture, a pixel a voxel, of values without order that are projected along y; white at 1 and black at 0 as light.
fn along_y(shows: Projection, size: [usize; 3], sampling: Sampling) -> (Vec<f32>, Picture) {
    let values: Vec<f32> = (0..size.iter().product()).map(noise).collect();
    let (grid, scalars) = volume(values.clone(), [size[2], size[1], size[0]], [1.0; 3]).unwrap();
    let point = |value: f32| {
        let color = Some(Color(glam::Vec3::splat(value)));
        TransferPoint { value, opacity: 1.0, color }
    };
    let transfer = vec![point(0.0), point(1.0)];
    let classify: Classify = Classify { transfer, ..Classify::default() };
    let mut world = World::new();
    world.spawn((grid, scalars, classify, shows));
    let view = View {
        height_mm: Some(size[2] as f64),
        size: [size[0] as u32, size[2] as u32],
        ..View::default()
    };
    world.spawn((view, sampling));
    (values, Renderer::new().unwrap().render(&mut world).unwrap().picture)
}

pub(crate) fn every_pixel() -> Sampling {
    Sampling {
        coarsest: 4,
        finest: 4,
        tolerance: 0.0,
        distance_mm: Some(0.5),
        ..Sampling::default()
    }
}

#[test]
fn each_pixel_is_the_greatest_least_or_mean_of_the_samples_on_its_ray() {
    let size = [16, 19, 16];
    for shows in [Projection::Maximum, Projection::Minimum, Projection::Mean] {
        let (values, picture) = along_y(shows, size, every_pixel());
        // Rays go through the middles of pixels, which are voxels; a half step apart, from a quarter on.
        let ray = |x: usize, z: usize| -> f32 {
            let value = |y: usize| values[(z * size[1] + y) * size[0] + x];
            let samples = (0..2 * (size[1] - 1)).map(|k| {
                let y = k as f32 * 0.5 + 0.25;
                let (cell, part) = (y as usize, y.fract());
                value(cell) * (1.0 - part) + value(cell + 1) * part
            });
            match shows {
                Projection::Maximum => samples.fold(0.0, f32::max),
                Projection::Minimum => samples.fold(1.0, f32::min),
                Projection::Mean => samples.clone().sum::<f32>() / samples.count() as f32,
                Projection::Sabella => unreachable!("not one value alone"),
            }
        };
        // The box over a pixel weighs the rays around it: 6/8 and 1/8 on either side, along both axes.
        for (x, row) in pixels(&picture)
            .filter(|p| p.iter().all(|&n| (1..15).contains(&n)))
            .map(|[x, y]| (x, y))
        {
            let weights = [0.125, 0.75, 0.125];
            let expected: f32 = (0..9)
                .map(|n| {
                    weights[n % 3] * weights[n / 3] * ray(x + n % 3 - 1, 15 - (row + n / 3 - 1))
                })
                .sum();
            let found = picture.pixel(x, row);
            assert!(
                (found[0] - expected).abs() < 2e-5,
                "{shows:?} {x} {row}: {found:?} {expected}"
            );
            assert!((found[3] - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn leaping_over_bricks_changes_no_bit_on_any_number_of_threads() {
    for shows in [Projection::Maximum, Projection::Minimum] {
        let picture = |skip, threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                along_y(shows, [40, 70, 40], Sampling { skip, ..Sampling::default() }).1
            })
        };
        let walked = picture(Skip::None, 1);
        assert_eq!(picture(Skip::Pyramid, 1).pixels[..], walked.pixels[..]);
        assert_eq!(picture(Skip::Pyramid, 2).pixels[..], walked.pixels[..]);
    }
}

/// A ball of values that are greatest within it, as one value a ray.
pub(crate) fn ball(shows: &str) -> String {
    format!(
        "[[entity]]\nname = \"ball\"\nvolume = {{ file = \"phantom:ball\" }}\nprojection = \"{shows}\"\n\
         classify = {{ transfer = [{{ value = 0, opacity = 0, color = \"white\" }}, {{ value = 1, opacity = 1, color = \"white\" }}] }}\n"
    )
}

#[test]
fn a_volume_ends_in_the_picture_where_its_box_does_whatever_the_distance_of_samples() {
    let (grid, scalars) = volume(vec![1.0_f32; 24 * 24 * 24], [24; 3], [1.0; 3]).unwrap();
    let picture = |shows, distance: f64, field_of_view| {
        let opaque = |value| TransferPoint { value, opacity: 1.0, color: Some(Color::WHITE) };
        let transfer = vec![opaque(0.0), opaque(1.0)];
        let classify: Classify = Classify { transfer, ..Classify::default() };
        let mut world = World::new();
        world.spawn((grid, scalars.clone(), classify, shows));
        let (azimuth, elevation, size) = (45.0, 8.0, [120, 120]);
        let view = View { azimuth, elevation, size, field_of_view, ..View::default() };
        world.spawn((view, Sampling { distance_mm: Some(distance), ..every_pixel() }));
        Renderer::new().unwrap().render(&mut world).unwrap().picture
    };
    for shows in [Projection::Maximum, Projection::Minimum, Projection::Mean] {
        for field_of_view in [None, Some(40.0)] {
            let [coarse, fine] =
                [2.0, 0.01].map(|distance| picture(shows, distance, field_of_view));
            let unlike = pixels(&fine)
                .filter(|&[x, y]| difference(coarse.pixel(x, y), fine.pixel(x, y)) > 1e-6);
            assert_eq!(unlike.count(), 0, "{shows:?} {field_of_view:?}");
        }
    }
    // What emitters make of a way that no sample lies on is what they make of that way, not of a step: thin as it is, it is dark.
    let [coarse, fine] = [2.0, 0.01].map(|distance| picture(Projection::Sabella, distance, None));
    let covered =
        |picture: &Picture| pixels(picture).filter(|&[x, y]| picture.pixel(x, y)[3] > 0.0).count();
    assert_eq!(covered(&coarse), covered(&fine));
}

#[test]
fn a_polygon_is_before_or_behind_the_greatest_value_of_its_ray() {
    let red = |opacity: f64| {
        format!("surface = {{ color = \"red\", opacity = {opacity}, ambient = 1, diffuse = 0 }}")
    };
    let seen = |z: f64, opacity: f64| {
        let plane = level("plane", z, 30.0, &red(opacity));
        at(
            &made(&[&ball("maximum"), &plane, &view(0.0, 90.0, 32, 60.0, EVERY_PIXEL)]),
            [0.3, 0.3, 0.0],
        )
    };
    let [before, within, behind] = [seen(28.0, 0.5), seen(-1.0, 1.0), seen(-20.0, 1.0)];
    // From above: a half of red, and behind it white.
    assert!(difference(before, [1.0, 0.5, 0.5, 1.0]) < 0.02, "{before:?}");
    // As great as it gets at its surface, which is nearer than both.
    assert!(difference(within, [1.0; 4]) < 0.05 && difference(behind, [1.0; 4]) < 0.02);
    // Behind an opaque polygon no value counts.
    assert!(difference(seen(31.0, 1.0), [1.0, 0.0, 0.0, 1.0]) < 1e-6);
}

#[test]
fn no_gel_is_made_of_what_is_projected_and_it_casts_no_shadow() {
    let mut world = stated(&[&ball("mean"), KEY, &view(0.0, 20.0, 16, 60.0, "")], &[]);
    let ran = run(&mut world);
    let names: Vec<_> = ran.iter().filter(|ran| ran.made > 0).map(|ran| ran.name).collect();
    assert_eq!(names, ["ranges", "cast", "resample"]);
}

#[test]
fn a_contour_has_no_answer_for_one_value_and_the_sentence_says_so() {
    let text = ball("minimum").replace("transfer = [", "iso = [{ value = 1 }] } #");
    let Err(error) = load(&Source::inline("x", text.as_str()), &[], &[], false) else { panic!() };
    assert!(error.to_string().contains("`transfer` (without `gradient`) or `colormap`"), "{error}");
}
