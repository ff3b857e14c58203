//! A field as a density of emitters (Sabella 1988): the greatest value's color, paler the deeper it lies, as bright as the way is dense.

use gelray::prelude::*;
use glam::Vec3;

use crate::projecting::{ball, every_pixel, noise};
use crate::{EVERY_PIXEL, KEY, level, pixels, rendered, view};

/// The colors of values 0 and 1.
const COLORS: [Vec3; 2] = [Vec3::new(0.1, 0.2, 0.9), Vec3::new(0.9, 0.3, 0.05)];

/// Values without order, and their picture.
fn emitted(
    size: [usize; 3],
    seed: usize,
    (view, sampling): (View, Sampling),
    clip: Option<Clip>,
) -> (Vec<f32>, Picture) {
    let values: Vec<f32> = (0..size.iter().product()).map(|at| noise(at + (seed << 20))).collect();
    let picture = seen(values.clone(), size, (view, sampling), clip);
    (values, picture)
}

/// The picture of values.
fn seen(
    values: Vec<f32>,
    size: [usize; 3],
    (view, sampling): (View, Sampling),
    clip: Option<Clip>,
) -> Picture {
    let (grid, scalars) = volume(values, [size[2], size[1], size[0]], [1.0; 3]).unwrap();
    let point = |value: u8| {
        let color = Some(Color(COLORS[usize::from(value)]));
        TransferPoint { value: f32::from(value), opacity: 1.0, color }
    };
    let classify: Classify = Classify { transfer: vec![point(0), point(1)], ..Classify::default() };
    let mut world = World::new();
    let entity = world.spawn((grid, scalars, classify, Projection::Sabella));
    if let Some(clip) = clip {
        world.insert_one(entity, clip).unwrap();
    }
    world.spawn((view, sampling));
    Renderer::new().unwrap().render(&mut world).unwrap().picture
}

/// A view along y, a pixel a voxel.
fn along_y(size: [usize; 3]) -> View {
    let pixels = [size[0] as u32, size[2] as u32];
    View { height_mm: Some(size[2] as f64), size: pixels, ..View::default() }
}

/// What Sabella's ray shows of samples half a unit apart, the first a quarter behind the volume's front: its greatest value's
/// color, paled, times the integral of what each of its slabs emits and those before it let through.
fn integrated(samples: &[f64], whole: usize, longest: f64, depth: f64) -> [f64; 3] {
    let tau = 4.0 / longest;
    let (mut through, mut light, mut best) = (1.0_f64, 0.0, (-1.0, 0));
    for (k, &value) in samples.iter().enumerate().skip(samples.len() - whole) {
        // Ten thin slabs each, the second half of each of them behind the first.
        for _ in 0..10 {
            light += through * (-0.5 * tau * value * 0.05).exp() * tau * value * 0.05;
            through *= (-tau * value * 0.05).exp();
        }
        best = if value > best.0 { (value, k) } else { best };
    }
    let deep = (best.1 as f64 * 0.5 + 0.25) / depth;
    let color = (COLORS[0].as_dvec3() * (1.0 - best.0) + COLORS[1].as_dvec3() * best.0).to_array();
    let most = color.iter().copied().fold(0.0, f64::max);
    color.map(|channel| (channel + (most - channel) * 0.9 * deep) * light)
}

/// Whether each pixel is the mean over the rays around it of what [`integrated`] finds of the last `whole` samples of each.
fn agrees((size, seed): ([usize; 3], usize), clip: Option<Clip>, whole: usize) {
    let (values, picture) = emitted(size, seed, (along_y(size), every_pixel()), clip);
    let longest = size.map(|n| (n - 1) as f64).into_iter().fold(0.0, f64::max);
    let ray = |x: usize, z: usize| {
        let value = |y: usize| f64::from(values[(z * size[1] + y) * size[0] + x]);
        let sample = |k: usize| {
            let y = k as f64 * 0.5 + 0.25;
            value(y as usize) * (1.0 - y.fract()) + value(y as usize + 1) * y.fract()
        };
        let samples: Vec<_> = (0..2 * (size[1] - 1)).map(sample).collect();
        integrated(&samples, whole.min(samples.len()), longest, (size[1] - 1) as f64)
    };
    let (mut rays, inner) = (0, |p: usize, n: usize| (1..n - 1).contains(&p));
    for [x, row] in pixels(&picture).filter(|&[x, row]| inner(x, size[0]) && inner(row, size[2])) {
        let found = picture.pixel(x, row);
        assert!((found[3] - 1.0).abs() < 1e-6);
        // The box over a pixel weighs the rays around it: 6/8 and 1/8 on either side, along both axes.
        let weights = [0.125, 0.75, 0.125];
        for channel in 0..3 {
            let part = |n: usize| {
                let z = size[2] - 1 - (row + n / 3 - 1);
                weights[n % 3] * weights[n / 3] * ray(x + n % 3 - 1, z)[channel]
            };
            let expected = (0..9).map(part).sum::<f64>();
            let off = (f64::from(found[channel]) - expected).abs();
            assert!(off < 2e-5, "{size:?} {x} {row}: {found:?} {expected}");
        }
        rays += 1;
    }
    assert!(rays > 60);
}

#[test]
fn each_pixel_is_what_the_attenuated_integral_along_its_ray_says() {
    agrees(([12, 9, 16], 0), None, usize::MAX);
    agrees(([16, 19, 12], 1), None, usize::MAX);
    agrees(([10, 40, 10], 2), None, usize::MAX);
}

#[test]
fn what_is_clipped_away_neither_emits_nor_attenuates_nor_is_the_greatest() {
    // The middle of 18 cells is the world's: what lies before it, half of the samples, is taken away.
    let front = Clip { planes: vec![[0.0, -1.0, 0.0, 0.0]], ..Clip::default() };
    agrees(([16, 19, 12], 3), Some(front), 18);
    let all = Clip { planes: vec![[0.0, 1.0, 0.0, -1e3]], ..Clip::default() };
    let (_, nothing) = emitted([9; 3], 0, (along_y([9; 3]), every_pixel()), Some(all));
    assert!(nothing.pixels.iter().all(|pixel| *pixel == [0.0; 4]));
}

#[test]
fn neither_threads_nor_leaps_change_a_bit_and_all_is_finite_and_in_range() {
    for (seed, field_of_view) in [(4, None), (5, Some(40.0))] {
        let picture = |skip, threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let view = View { azimuth: 25.0, elevation: 20.0, field_of_view, ..View::default() };
            let view = View { size: [48, 40], ..view };
            let sampling = Sampling { skip, ..Sampling::default() };
            pool.install(|| emitted([40, 30, 50], seed, (view, sampling), None).1)
        };
        let walked = picture(Skip::None, 1);
        for (skip, threads) in [(Skip::Pyramid, 1), (Skip::Pyramid, 2), (Skip::None, 2)] {
            assert_eq!(picture(skip, threads).pixels[..], walked.pixels[..]);
        }
        let in_range = |channel: &f32| (0.0..=1.0).contains(channel);
        assert!(walked.pixels.iter().flatten().all(in_range));
        assert!(walked.pixels.iter().any(|pixel| pixel[3] > 0.99 && pixel[0] > 0.1));
    }
}

#[test]
fn an_infinite_value_is_the_greatest_and_what_lies_behind_it_counts() {
    let mut values = vec![0.5; 17 * 40 * 17];
    // Between a finite value and an infinite one is either: the rays go through the middle of a block.
    for [z, y, x] in (0..32).map(|n| [7 + n / 8, 4 + n / 4 % 2, 7 + n % 4]) {
        values[(z * 40 + y) * 17 + x] = f32::INFINITY;
    }
    values[(8 * 40 + 9) * 17 + 8] = f32::NAN;
    let picture = |skip| {
        let sampling = Sampling { skip, ..every_pixel() };
        seen(values.clone(), [17, 40, 17], (along_y([17, 40, 17]), sampling), None)
    };
    let (leapt, walked) = (picture(Skip::Pyramid), picture(Skip::None));
    assert_eq!(leapt.pixels[..], walked.pixels[..]);
    assert!(walked.pixels.iter().flatten().all(|channel| channel.is_finite()));
    // Of an optical depth of two, all but e⁻² of the greatest channel.
    assert!((walked.pixel(8, 8)[0] - 0.9 * 0.865).abs() < 0.1, "{:?}", walked.pixel(8, 8));
}

#[test]
fn room_without_density_is_leapt_over_and_that_changes_no_bit() {
    let seen = |skip: &str| {
        let sampling = format!("skip = \"{skip}\", {EVERY_PIXEL}");
        rendered(&[&ball("sabella"), &view(20.0, 30.0, 40, 80.0, &sampling)])
    };
    assert_eq!(seen("pyramid").pixels[..], seen("none").pixels[..]);
}

#[test]
fn behind_an_opaque_polygon_nothing_emits_and_before_it_it_is_covered_by_the_greatest_value() {
    let above = view(0.0, 90.0, 32, 50.0, EVERY_PIXEL);
    let opaque = "surface = { color = \"red\", ambient = 1, diffuse = 0 }";
    // Opaque wherever something is, so that the plane itself is not seen.
    let solid = ball("sabella").replace("opacity = 0", "opacity = 1");
    let cut = rendered(&[&solid, &level("plane", 0.0, 60.0, opaque), KEY, &above]);
    let clipped = format!("{solid}clip = {{ planes = [[0, 0, -1, 0]] }}\n");
    let alone = rendered(&[&clipped, KEY, &above]);
    for [x, y] in pixels(&cut) {
        assert_eq!(cut.pixel(x, y), alone.pixel(x, y), "{x} {y}");
    }
    let covered = rendered(&[&solid, &level("plane", 90.0, 60.0, opaque), KEY, &above]);
    assert!(pixels(&covered).all(|[x, y]| covered.pixel(x, y) == [1.0, 0.0, 0.0, 1.0]));
}

#[test]
fn without_a_classification_the_greatest_value_is_a_hue() {
    let ball = "[[entity]]\nvolume = { file = \"phantom:ball\" }\nprojection = \"sabella\"\n";
    let picture = rendered(&[ball, &view(0.0, 20.0, 32, 60.0, EVERY_PIXEL)]);
    let [r, g, b, alpha] = picture.pixel(16, 16);
    assert!(alpha == 1.0 && r > 2.0 * g.max(b) && r > 0.3, "{r} {g} {b}");
}
