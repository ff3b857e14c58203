//! Where surfaces of values end, or hide others of their own, there is more than a ray a pixel; elsewhere there is not.

use gelray::prelude::*;
use glam::DVec3;

use super::{carrier, floats, rendered, world};

/// Two balls, one half before the other, on a picture of pixels as large as a third of a voxel.
fn balls(thickness_voxels: f32, [coarsest, finest]: [u32; 2]) -> Rendered {
    let off = |place: DVec3, middle: [f64; 3]| (place - DVec3::from(middle)).length() as f32;
    let field = |place| 20.0 - off(place, [-4.0, -4.0, 0.0]).min(off(place, [4.0, 7.0, 2.0]));
    let contour = Contour { thickness_voxels, ..Contour::at(13.0) };
    let classify = Classify { iso: vec![contour], ..Classify::default() };
    let view = View { size: [90, 90], height_mm: Some(30.0), ..View::default() };
    let sampling =
        Sampling { coarsest, finest, filter: Filter::Interpolating, ..Sampling::default() };
    let mut world = world(floats([32; 3], field), classify, (view, sampling));
    let volume = carrier::<Reconstruct>(&world);
    let material = Material { diffuse: 1.0, ambient: 0.0, ..Material::default() };
    world.insert_one(volume, material).unwrap();
    rendered(&mut world)
}

/// The root mean square of what pixels are off by in any channel, of those that a ray a pixel gets wrong.
fn off(picture: &Picture, truth: &Picture, plain: &Picture) -> f64 {
    let worst = |a: &[f32; 4], b: &[f32; 4]| {
        a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max)
    };
    let pixels = picture.pixels.iter().zip(truth.pixels.iter()).zip(plain.pixels.iter());
    let wrong = pixels.filter(|((_, truth), plain)| worst(truth, plain) > 0.05);
    let squares: Vec<f64> = wrong.map(|((own, truth), _)| worst(own, truth).powi(2)).collect();
    assert!(squares.len() > 100, "{}", squares.len());
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn silhouettes_of_surfaces_are_smooth_and_their_insides_cost_no_ray_more() {
    let truth = balls(0.0, [1, 1]);
    let plain = balls(0.0, [8, 4]);
    let fine = balls(0.0, [8, 1]);
    let [before, after] =
        [&plain, &fine].map(|made| off(&made.picture, &truth.picture, &plain.picture));
    let rays = [&truth, &plain, &fine].map(|made| made.samples.counts.rays);
    println!("off by {before:.4} with a ray a pixel, by {after:.4} with more; rays {rays:?}");
    assert!(after < 0.1 * before, "{after} {before}");
    assert!(rays[2] > rays[1] && rays[2] < rays[0] / 4, "{rays:?}");
}

#[test]
fn a_contour_of_some_thickness_has_no_edge_that_asks_for_rays() {
    let [plain, fine] = [[8, 4], [8, 1]].map(|of| balls(1.0, of).samples.counts.rays);
    assert_eq!(plain, fine);
}
