//! What the table of knobs promises: each bound on every embedded scene and on gels at random; errors that fall along a range.

use gelray::components::{Bound, KNOBS, Knob, OpacityUnit, Sampling, Setting, TexelKind, View};
use gelray::measure::error::compare;
use gelray::scene::EMBEDDED;
use gelray::view::extent::Extent;
use gelray::view::picture::Picture;
use gelray::volume::grid::Grid;
use glam::DVec3;
use proptest::prelude::*;

use super::support::{Mixture, Shown, bits, every_pixel, flat, head, paint, square, worst};

/// Settings of which rays are the same whatever a knob of the ray's own is turned to: one a pixel.
fn fixed_rays(distance: f64) -> Sampling {
    Sampling { distance_mm: Some(distance), tolerance: 0.0, ..every_pixel() }
}

/// Whether a picture keeps what a knob promises at a setting, against that of its exact end; slabs are `slabs` a ray.
fn keeps(knob: &Knob, setting: Setting, [exact, made]: [&Picture; 2], slabs: f64) -> bool {
    let off = f64::from(worst(exact, made));
    match (knob.bound, setting) {
        (Bound::Lossless, _) => bits(exact) == bits(made),
        (Bound::Setting, Setting::Number(number)) => off <= f64::from(number) + 1e-6,
        (Bound::EachSlab([of_16, of_8]), Setting::Texel(texel)) => match texel {
            TexelKind::U8 => off <= of_8 * slabs + 1e-6,
            TexelKind::U16 => off <= of_16 * slabs + 1e-6,
            TexelKind::F32 | TexelKind::Auto => off == 0.0,
        },
        (Bound::Setting | Bound::EachSlab(_), _) => false,
        (Bound::Nothing, _) => true,
    }
}

/// The pictures along a knob's range, from the exact end on.
fn pictures(
    knob: &Knob,
    sampling: &Sampling,
    distance: f64,
    mut render: impl FnMut(Sampling) -> Picture,
) -> Vec<(Setting, Picture)> {
    let turned = |&setting: &Setting| {
        let mut sampling = sampling.clone();
        knob.turn(&mut sampling, setting, distance);
        (setting, render(sampling))
    };
    knob.range.iter().rev().map(turned).collect()
}

/// The most slabs of gel that a ray passes, each as thick as the largest opacity unit: of every volume all that it may be long,
/// and one that it begins in and one that it ends in.
fn slabs(shown: &Shown, distance: f64) -> f64 {
    let volumes = shown.world.query::<&OpacityUnit>().iter().count() as f64;
    let across = shown.world.get::<&Extent>(shown.view).map_or(0.0, |e| e.samples(distance));
    volumes * (across + 2.0)
}

/// The largest opacity unit of a scene's volumes, world units; 1 without a volume.
fn largest_unit(shown: &Shown) -> f64 {
    let units = shown.world.query::<&OpacityUnit>().iter().map(|unit| unit.0).reduce(f64::max);
    units.unwrap_or(1.0)
}

#[test]
fn every_bound_of_the_table_holds_on_every_embedded_scene() {
    for (name, _) in EMBEDDED {
        let mut shown = Shown::embedded(name, &[]);
        for knob in KNOBS.iter().filter(|knob| !matches!(knob.bound, Bound::Nothing)) {
            let distance = largest_unit(&shown);
            let slabs = slabs(&shown, distance);
            let made = pictures(knob, &fixed_rays(distance), distance, |sampling| {
                shown.render(|view: &mut View| view.size = [12, 14], sampling).picture
            });
            for (setting, picture) in &made {
                let pair = [&made[0].1, picture];
                let kept = keeps(knob, *setting, pair, slabs);
                assert!(
                    kept,
                    "{name}: {} = {setting}: off by {}",
                    knob.key,
                    worst(pair[0], pair[1])
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_bound_of_the_table_holds_on_gels_at_random(
        seed in any::<u32>(),
        (azimuth, elevation) in (-180.0..180.0, -90.0..90.0),
        opacity in 0.05_f32..1.0,
    ) {
        let grid = Grid::axis_aligned([14, 17, 12], [1.0, 0.8, -1.1], [-6.5, -6.4, 6.05]).unwrap();
        let wave = |at: [usize; 3], i: u32| {
            let mix = |p: u32, &n: &usize| p.wrapping_mul(31).wrapping_add(n as u32 * 7919);
            let phase = at.iter().fold(seed.wrapping_mul(i + 1) >> 8, mix);
            0.5 + 0.5 * (phase as f32 * 0.001).sin()
        };
        let gel = paint(&grid, |at| [wave(at, 0), wave(at, 1), wave(at, 2), opacity * wave(at, 3).powi(3)]);
        let plane = (vec![square(DVec3::X, DVec3::new(1.0, 0.2, 0.1), 9.0)], flat([1.0, 0.3, 0.0], 0.4));
        let scene = Mixture { polygons: vec![plane], ..Mixture::of(grid, gel) }
            .seen((azimuth, elevation), 9, 20.0);
        // The diagonal in slabs, and one that the ray begins in and one that it ends in.
        let slabs = (14.0_f64.powi(2) + 13.6_f64.powi(2) + 13.2_f64.powi(2)).sqrt() / 0.8 + 2.0;
        for knob in KNOBS {
            let made = pictures(knob, &fixed_rays(0.8), 0.8, |sampling| {
                Mixture { sampling, ..scene.clone() }.render().picture
            });
            for (setting, picture) in &made {
                let kept = keeps(knob, *setting, [&made[0].1, picture], slabs);
                prop_assert!(kept, "{} = {}: off by {}", knob.key, setting, worst(&made[0].1, picture));
            }
        }
    }
}

#[test]
fn errors_fall_along_each_range_that_the_table_says_is_monotone() {
    let mut shown = head();
    // Each knob beside settings that leave it something to do, and against its own exact end.
    let whole = Sampling { distance_mm: Some(1.0), stop_at: 0.0, ..Sampling::default() };
    for knob in KNOBS {
        let made = pictures(knob, &whole, 1.0, |sampling| {
            shown.render(|view: &mut View| view.size = [64; 2], sampling).picture
        });
        let error = |picture: &Picture| compare(&made[0].1, picture).unwrap().linear.rmse;
        let errors: Vec<f64> = made.iter().map(|(_, picture)| error(picture)).collect();
        println!("{}: {errors:.6?}", knob.key);
        let rises = errors.windows(2).all(|pair| pair[1] >= pair[0] * 0.999);
        assert!(rises || !knob.is_monotone, "{}: {errors:?}", knob.key);
    }
}
