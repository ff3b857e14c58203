//! The numerical extremes of algorithm §10 through the whole engine: every pixel finite, 0 ≤ α ≤ 1, colours within α.

use gelray::components::{
    Classify, Color, Contour, DepthCue, Form, Light, Material, OpacityUnit, Order, Sampling,
    TexelKind, Toward, View,
};
use gelray::shared::Shared;
use gelray::view::extent::Extent;
use gelray::view::picture::Picture;
use gelray::volume::grid::{Grid, Scalars};
use glam::{DVec3, Vec3};
use hecs::World;

use super::closed_forms::{Formula, off};
use super::support::{
    Mixture, assert_sound, centred, every_pixel, flat, homogeneous, paint, rendered, run, square,
};

const OPACITIES: [f32; 5] = [0.0, 1e-9, 1e-7, 1.0 - f32::EPSILON / 2.0, 1.0];

#[test]
fn extreme_opacities_in_slivers_of_extreme_thickness_match_the_formula() {
    let grid = centred([4; 3], 1.0);
    let mut error = 0.0_f64;
    for (opacity, ratio) in
        OPACITIES.into_iter().flat_map(|o| [1e-6, 1e-3, 0.5, 1.0, 3.0, 1e3].map(|r| (o, r)))
    {
        let gel = homogeneous(&grid, [1.0, 0.6, 0.0, opacity]);
        // Slivers of the slab [0, 1): none, 1e-9 of it, all but an ulp, all.
        for depth in [0.0, 1e-9, 1.0 - f64::EPSILON / 2.0, 1.0, -1e-300] {
            for covering in [1e-7, 0.5, 1.0_f32] {
                let quad = vec![square(DVec3::Y * depth, DVec3::Y, 9.0)];
                let scene = Mixture {
                    unit: 1.0 / ratio,
                    polygons: vec![(quad, flat([0.0, 0.2, 1.0], covering))],
                    sampling: every_pixel(),
                    ..Mixture::of(grid, gel.clone())
                };
                let picture = scene.seen((0.0, 0.0), 1, 0.5).render().picture;
                let what = format!("α {opacity:e}, Δ/u {ratio:e}, depth {depth:e}, α_P {covering}");
                assert_sound(&picture, &what);
                let formula = Formula {
                    color: [1.0, 0.6_f32.into(), 0.0],
                    opacity: opacity.into(),
                    distance: 1.0,
                    unit: 1.0 / ratio,
                    slabs: [-2, 2],
                };
                let expected = formula.color(&[(depth, [0.0, 0.2, 1.0], covering)]);
                assert!(
                    off(picture.pixels[0], expected) < 1e-6,
                    "{what}: {:?} {expected:?}",
                    picture.pixels[0]
                );
                error = error.max(off(picture.pixels[0], expected));
            }
        }
    }
    println!("450 mixtures of extremes: off by {error:.1e} at most");
}

#[test]
fn steps_from_a_millionth_to_a_thousand_units_give_the_opacity_of_the_gel() {
    // Two voxels a side: at the smallest step a ray has a million samples.
    let grid = centred([2; 3], 1.0);
    for opacity in [1e-3, 0.5, 0.999_f32] {
        for step in [1e-6, 1e-5, 1e-3, 0.1, 1.0] {
            let gel = homogeneous(&grid, [1.0, 0.5, 0.0, opacity]);
            let sampling = Sampling { distance_mm: Some(step), ..every_pixel() };
            let scene = Mixture { sampling, ..Mixture::of(grid, gel) }.seen((0.0, 0.0), 1, 0.1);
            let [r, g, _, alpha] = scene.render().picture.pixels[0].map(f64::from);
            // A step of the whole volume has two samples on its borders, which stand for two steps.
            let layers = if step == 1.0 { 2.0 } else { 1.0 };
            let expected = 1.0 - (1.0 - f64::from(opacity)).powf(layers);
            assert!(
                (alpha - expected).abs() < 1e-6 && (r - alpha).abs() < 1e-6,
                "{opacity} {step}: {alpha} {expected}"
            );
            assert!((g - alpha / 2.0).abs() < 1e-6);
        }
        // Beyond that no sample need fall within the volume; what is seen is sound.
        for step in [7.0, 1e3] {
            let gel = homogeneous(&grid, [1.0, 0.5, 0.0, opacity]);
            let sampling = Sampling { distance_mm: Some(step), ..every_pixel() };
            let scene = Mixture { sampling, ..Mixture::of(grid, gel) }.seen((20.0, 0.0), 4, 2.0);
            assert_sound(&scene.render().picture, &format!("Δ = {step}"));
        }
    }
}

/// Polygons in every awkward place of a cube of half side 4.
fn awkward() -> Vec<(&'static str, Vec<Vec<DVec3>>)> {
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let (o, x, y, z) = (DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z);
    let strip =
        |x: f64| [(x, -3.0), (x + 1.0, -3.0), (x + 1.0, 3.0), (x, 3.0)].map(|(x, z)| at(x, 0.0, z));
    let backwards = square(o, y, 3.0).into_iter().rev().collect();
    let needle = vec![at(-3.0, 0.0, 0.0), at(3.0, 0.1, 0.0), at(3.0, 0.1, 1e-6)];
    vec![
        ("coincident", vec![square(o, y, 3.0), square(o, y, 3.0)]),
        ("coincident, the other way round", vec![square(o, y, 3.0), backwards]),
        ("edge-on", vec![square(o, x, 3.0), square(o, z, 3.0)]),
        ("on a sample plane", vec![square(y * 0.5, y, 3.0)]),
        ("on a voxel plane", vec![square(y, y, 3.0)]),
        ("on the volume's own faces", vec![square(y * 4.0, y, 4.0), square(y * -4.0, y, 4.0)]),
        ("sharing an edge", vec![strip(-1.0).to_vec(), strip(0.0).to_vec()]),
        ("smaller than a pixel", vec![square(at(0.1, 0.2, 0.3), at(0.3, 1.0, 0.2), 1e-3)]),
        ("larger than the volume", vec![square(o, at(0.3, 1.0, 0.2), 1e5)]),
        ("a needle", vec![needle]),
        ("grazing", vec![square(o, at(1.0, 1e-5, 0.0), 3.0)]),
        ("far outside", vec![square(y * 1e4, y, 3.0), square(x * 1e4, y, 3.0)]),
        ("crossing", vec![square(o, x + y, 3.0), square(o, y - x, 3.0)]),
    ]
}

#[test]
fn polygons_in_every_awkward_place_are_sound_from_everywhere() {
    let grid = centred([9; 3], 1.0);
    let gel =
        paint(&grid, |[x, y, z]| [1.0, 0.5, 0.1, if (x + y + z) % 3 == 0 { 0.0 } else { 0.3 }]);
    for (what, outlines) in awkward() {
        for (view, opacity) in
            [(0.0, 0.0), (90.0, 0.0), (0.0, 90.0), (45.0, 0.0), (45.0, 35.264), (123.0, -47.0)]
                .into_iter()
                .flat_map(|view| [0.5, 1.0].map(|o| (view, o)))
        {
            let polygons =
                outlines.iter().map(|o| (vec![o.clone()], flat([0.2, 0.9, 1.0], opacity)));
            let polygons: Vec<_> = polygons.collect();
            for (scene, distance) in
                [(Mixture::of(grid, gel.clone()), 0.37), (Mixture::polygons(Vec::new()), 1.0)]
            {
                let sampling = Sampling { distance_mm: Some(distance), ..Sampling::default() };
                let scene = Mixture { polygons: polygons.clone(), sampling, ..scene };
                let made = scene.seen(view, 14, 11.0).render();
                assert_sound(&made.picture, &format!("{what} from {view:?}"));
            }
        }
    }
}

/// A volume of scalars with a contour at 8 under some lights.
fn contoured(
    grid: Grid,
    values: Vec<f32>,
    lights: &[DVec3],
    view: View,
    texel: TexelKind,
) -> Picture {
    let mut world = World::new();
    let contour = Contour { opacity: 0.9, form: Form::Around, ..Contour::at(8.0) };
    let classify = Classify { iso: vec![contour], ..Classify::default() };
    let material = Material { diffuse: 0.6, specular: 0.2, ..Material::default() };
    world.spawn((
        Order(0),
        grid,
        Scalars::F32(Shared::new(values)),
        classify,
        material,
        OpacityUnit(1.0),
    ));
    for (i, toward) in lights.iter().enumerate() {
        let toward = Toward::Direction(toward.to_array());
        let light = Light { toward, strength: 1.0 / lights.len() as f32, color: Color(Vec3::ONE) };
        world.spawn((Order(1 + i as u32), light));
    }
    let cue = DepthCue { k1: 1.0, k2: 0.01 };
    // A ray a pixel: coarser rays may all pass by so small a volume.
    let sampling = Sampling { texel, coarsest: 4, ..Sampling::default() };
    let extent = Extent::of(grid.corners()).unwrap();
    let view = world.spawn((Order(99), view, sampling, extent, cue));
    run(&mut world);
    rendered(&world, view).picture
}

#[test]
fn the_least_the_flattest_and_the_emptiest_volumes_are_sound_under_every_light() {
    let directions = (0..27)
        .map(|i| DVec3::new(f64::from(i % 3 - 1), f64::from(i / 3 % 3 - 1), f64::from(i / 9 - 1)));
    let directions: Vec<_> = directions.filter(|d| *d != DVec3::ZERO).collect();
    for size in [[2, 2, 2], [2, 9, 17], [8, 8, 8]] {
        let grid = centred(size, 1.0);
        let n = grid.voxels();
        let ramp = (0..n).map(|i| (i % size[0]) as f32 * 5.0).collect();
        let mixed = (0..n).map(|i| [f32::NAN, 8.0, f32::INFINITY, -f32::MAX, 0.0][i % 5]).collect();
        for (what, values) in [
            ("isovalue", vec![8.0; n]),
            ("constant", vec![3.0; n]),
            ("NaN", vec![f32::NAN; n]),
            ("ramp", ramp),
            ("mixed", mixed),
        ] {
            for (i, toward) in directions.iter().enumerate() {
                let (azimuth, elevation) = ((i % 8) as f64 * 45.0, (i % 5) as f64 * 45.0 - 90.0);
                let view = View {
                    azimuth,
                    elevation,
                    size: [5; 2],
                    height_mm: Some(3.0),
                    ..View::default()
                };
                let texel = [TexelKind::F32, TexelKind::U16, TexelKind::U8][i % 3];
                let picture = contoured(grid, values.clone(), &[*toward, -*toward], view, texel);
                let what = format!("{size:?} {what} lit from {toward}");
                assert_sound(&picture, &what);
                let empty = picture.pixels.iter().all(|pixel| *pixel == [0.0; 4]);
                assert_eq!(empty, what.contains("constant") || what.contains("NaN"), "{what}");
            }
        }
    }
}

#[test]
fn a_volume_all_at_the_isovalue_is_lit_by_ambient_light_alone() {
    let grid = centred([5; 3], 1.0);
    let view = View { size: [5, 5], height_mm: Some(2.0), ..View::default() };
    let picture = contoured(grid, vec![8.0; 125], &[DVec3::Y], view, TexelKind::F32);
    for pixel in picture.pixels.iter() {
        // Four slabs of 0.9 are stopped at 0.02 and taken as opaque; ambient light is 0.2 and is not cued.
        assert!((pixel[0] - 0.2).abs() < 1e-6 && pixel[3] == 1.0, "{pixel:?}");
    }
}
