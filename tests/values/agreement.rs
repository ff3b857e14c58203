//! What values look like against what is known: constants, spheres by formula, colors of voxels.

use gelray::prelude::*;
use glam::Vec3;

use super::{FILTERS, carrier, floats, rendered, world};

/// A ray a pixel, through the middles of pixels, no stopping.
fn every_pixel(filter: Filter, step: f64) -> Sampling {
    let (distance_mm, texel) = (Some(step), TexelKind::F32);
    let all = Sampling { coarsest: 4, finest: 4, stop_at: 0.0, ..Sampling::default() };
    Sampling { filter, distance_mm, texel, ..all }
}

fn point(value: f32, opacity: f32) -> TransferPoint {
    TransferPoint { value, opacity, color: None }
}

#[test]
fn where_nothing_changes_values_and_colors_look_alike() {
    let view = || View { azimuth: 20.0, elevation: 10.0, size: [16, 16], ..View::default() };
    let classify =
        Classify { transfer: vec![point(0.0, 0.0), point(9.0, 0.9)], ..Classify::default() };
    let block = || floats([9, 8, 7], |_| 1.0);
    let mut colors = world(block(), classify.clone(), (view(), every_pixel(Filter::Linear, 0.7)));
    let volume = carrier::<Reconstruct>(&colors);
    colors.remove_one::<Reconstruct>(volume).unwrap();
    let colors = rendered(&mut colors).picture;
    for filter in FILTERS {
        let mut values = world(block(), classify.clone(), (view(), every_pixel(filter, 0.7)));
        let values = rendered(&mut values).picture;
        let pairs = colors.pixels.iter().flatten().zip(values.pixels.iter().flatten());
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 2e-5, "{filter:?}: {worst}");
        assert!(values.pixels.iter().any(|pixel| pixel[3] > 0.1));
    }
}

#[test]
fn a_ball_of_a_steep_function_has_its_radius_and_its_shading_in_every_filter() {
    // f falls by 1 a voxel: opaque from a distance of 10 voxels inwards.
    let ball = || floats([32; 3], |place| 20.0 - place.length() as f32);
    let classify =
        Classify { transfer: vec![point(9.95, 0.0), point(10.05, 1.0)], ..Classify::default() };
    let view = || View { size: [300, 300], height_mm: Some(30.0), ..View::default() };
    for (filter, most) in FILTERS.into_iter().zip([0.03, 0.04, 0.03, 0.03]) {
        let mut world = world(ball(), classify.clone(), (view(), every_pixel(filter, 0.25)));
        let matt = Material { ambient: 0.0, diffuse: 1.0, ..Material::default() };
        let volume = carrier::<Reconstruct>(&world);
        world.insert_one(volume, matt).unwrap();
        let light = carrier::<Light>(&world);
        let toward = Toward::Direction([0.0, -1.0, 0.0]);
        world.insert_one(light, Light { toward, strength: 1.0, color: Color::WHITE }).unwrap();
        let picture = rendered(&mut world).picture;
        let area: f32 = picture.pixels.iter().map(|pixel| pixel[3]).sum::<f32>() / 100.0;
        let radius = (area / std::f32::consts::PI).sqrt();
        assert!((radius - 10.0).abs() < most, "{filter:?}: {radius}");
        // Lit from the observer, a point of the ball reflects the cosine.
        for (x, y) in (0..300).step_by(15).flat_map(|y| (0..300).step_by(15).map(move |x| (x, y))) {
            let off = Vec3::new((x as f32 - 149.5) / 10.0, 0.0, (y as f32 - 149.5) / 10.0);
            if off.length() < 8.0 {
                let cosine = (1.0 - off.length_squared() / 100.0).sqrt();
                let seen = picture.pixel(x, y)[0];
                assert!((seen - cosine).abs() < 0.02, "{filter:?} {x} {y}: {seen} {cosine}");
            }
        }
    }
}
