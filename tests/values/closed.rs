//! Surfaces of what is above a value, closed by flat faces where they are cut and where the grid ends.

use gelray::measure::first_hits::{FirstHits, first_hits};
use gelray::prelude::*;

use super::{FILTERS, carrier, floats, rendered, world};

/// A surface at 10, lit from the observer: each pixel shows the cosine to its normal.
fn seen(
    volume: (Grid, Scalars),
    contour: Contour,
    (filter, step): (Filter, f64),
    planes: Vec<[f64; 4]>,
) -> (Picture, FirstHits) {
    let classify = Classify { iso: vec![contour], ..Classify::default() };
    let view = View { size: [150, 150], height_mm: Some(30.0), ..View::default() };
    let (coarsest, finest, distance_mm) = (4, 4, Some(step));
    let sampling =
        Sampling { coarsest, finest, filter, distance_mm, stop_at: 0.0, ..Sampling::default() };
    let mut world = world(volume, classify, (view, sampling));
    let matt = Material { ambient: 0.0, diffuse: 1.0, ..Material::default() };
    let volume = carrier::<Reconstruct>(&world);
    world.insert_one(volume, matt).unwrap();
    if !planes.is_empty() {
        world.insert_one(volume, Clip { planes, r#box: None }).unwrap();
    }
    let light = carrier::<Light>(&world);
    world.insert_one(light, Light::at_observer()).unwrap();
    (rendered(&mut world).picture, first_hits(&world).unwrap())
}

fn surface(opacity: f32, form: Form) -> Contour {
    Contour { thickness_voxels: 0.0, opacity, form, ..Contour::at(10.0) }
}

fn ball() -> (Grid, Scalars) {
    floats([32; 3], |place| 20.0 - place.length() as f32)
}

/// Pixels nearer to the middle than `radius` voxels, of which a fifth is a pixel.
fn within(picture: &Picture, radius: f32) -> Vec<[f32; 4]> {
    let place = |n: usize| (n as f32 - 74.5) / 5.0;
    let near = |x: usize, y: usize| place(x).hypot(place(y)) < radius;
    let pixels = (0..150).flat_map(|y| (0..150).map(move |x| (x, y)));
    pixels.filter(|(x, y)| near(*x, *y)).map(|(x, y)| picture.pixel(x, y)).collect()
}

/// The observer stands at −y; the cut faces it.
const HALF: [f64; 4] = [0.0, -1.0, 0.0, 0.3];

#[test]
fn a_ball_that_is_cut_shows_a_flat_disc_at_any_step() {
    for filter in FILTERS {
        for step in [0.5, 2.0, 5.0] {
            let (picture, hits) =
                seen(ball(), surface(1.0, Form::Above), (filter, step), vec![HALF]);
            let middle = 75 * 150 + 75;
            assert!((hits.depth[middle] + 0.3).abs() < 1e-3, "{step}: {}", hits.depth[middle]);
            assert_eq!(hits.normal[middle], [0.0, -1.0, 0.0], "{step}");
            let disc = within(&picture, 9.6);
            let flat = |pixel: &[f32; 4]| (pixel[0] - 1.0).abs() < 1e-5 && pixel[3] > 1.0 - 1e-5;
            let other = disc.iter().find(|pixel| !flat(pixel));
            assert_eq!(other, None, "{filter:?} {step}");
            let area: f32 = picture.pixels.iter().map(|pixel| pixel[3]).sum::<f32>() / 25.0;
            let radius = (area / std::f32::consts::PI).sqrt();
            assert!((radius - 10.0).abs() < 0.05, "{filter:?} {step}: {radius}");
        }
    }
}

#[test]
fn a_face_is_a_surface_like_any_other_and_what_is_around_a_value_has_none() {
    for step in [0.5, 2.0] {
        let of = |form| {
            let (picture, _) =
                seen(ball(), surface(0.5, form), (Filter::Interpolating, step), vec![HALF]);
            within(&picture, 9.5).iter().map(|pixel| pixel[3]).collect::<Vec<_>>()
        };
        // The face and the far side of the ball; or that alone.
        assert!(of(Form::Above).iter().all(|alpha| (alpha - 0.75).abs() < 1e-5), "{step}");
        assert!(of(Form::Around).iter().all(|alpha| (alpha - 0.5).abs() < 1e-5), "{step}");
    }
}

#[test]
fn what_is_above_everywhere_is_a_block_that_ends_where_the_grid_does() {
    for filter in FILTERS {
        for step in [0.5, 0.9, 2.0, 5.0] {
            let block = floats([21, 17, 11], |_| 20.0);
            let (picture, hits) =
                seen(block, surface(0.6, Form::Above), (filter, step), Vec::new());
            let middle = 75 * 150 + 75;
            assert!((hits.depth[middle] + 8.0).abs() < 1e-3, "{step}: {}", hits.depth[middle]);
            assert_eq!(hits.normal[middle], [0.0, -1.0, 0.0], "{step}");
            for (x, y) in (0..150).flat_map(|y| (0..150).map(move |x| (x, y))) {
                let [across, up] = [x, y].map(|n| (n as f32 - 74.5).abs() / 5.0);
                let [color, _, _, alpha] = picture.pixel(x, y);
                if across < 9.8 && up < 4.8 {
                    // The near face shows its light, the far one, which faces away, both sides of it.
                    assert!((alpha - 0.84).abs() < 1e-5, "{filter:?} {step} {x} {y}: {alpha}");
                    assert!((color - 0.84).abs() < 1e-5, "{filter:?} {step} {x} {y}: {color}");
                } else if across > 10.2 || up > 5.2 {
                    assert_eq!(alpha, 0.0, "{filter:?} {step} {x} {y}");
                }
            }
        }
    }
}
