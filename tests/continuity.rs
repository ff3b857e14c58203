//! Frames that do not flicker: adaptive sampling decides anew in each, and a turning edge shows nothing of it.

use gelray::measure::error::compare;
use gelray::prelude::*;
use gelray::view::picture::Picture;
use glam::Vec4;

const FRAMES: usize = 120;
const SIDE: u32 = 64;

/// A full turn of a translucent polygon in a translucent ball of gel, sampled as stated.
fn turn(sampling: &Sampling) -> Vec<Picture> {
    let squares = |i: usize| [i / 576, i / 24 % 24, i % 24].map(|n| (n as f32 - 11.5).powi(2));
    let density = |i: usize| 11.0 - squares(i).iter().sum::<f32>().sqrt();
    let voxels: Vec<f32> = (0..24 * 24 * 24).map(density).collect();
    let mut world = World::new();
    let (grid, scalars) = volume(voxels, [24; 3], [1.0; 3]).unwrap();
    let mut classify = Classify::iso(2.0);
    classify.iso[0].opacity = 0.25;
    world.spawn((grid, scalars, classify));
    let corners = [[-9.0, -9.0, 1.0], [9.0, -9.0, 1.0], [9.0, 9.0, -1.0], [-9.0, 9.0, -1.0]];
    let red = Color::from_srgb([0.9, 0.2, 0.1]);
    let surface = Surface { color: red, opacity: 0.5, ..Surface::default() };
    world.spawn((polygon(&corners).unwrap(), surface));
    world.spawn((Light::from_direction([-0.4, -0.8, 0.5]),));
    let view = View { size: [SIDE; 2], elevation: 20.0, height_mm: Some(30.0), ..View::default() };
    let eye = world.spawn((view, sampling.clone()));
    let renderer = Renderer::new().unwrap();
    let frame = |frame: usize| {
        world.get::<&mut View>(eye).unwrap().azimuth = 360.0 * frame as f64 / FRAMES as f64;
        renderer.render(&mut world).unwrap().picture
    };
    (0..FRAMES).map(frame).collect()
}

/// The mean of two pictures.
fn mean(a: &Picture, b: &Picture) -> Picture {
    let pixels = a.pixels.iter().zip(b.pixels.iter());
    let half = |(a, b): (&[f32; 4], &[f32; 4])| {
        ((Vec4::from_array(*a) + Vec4::from_array(*b)) * 0.5).to_array()
    };
    Picture::new(a.size, pixels.map(half).collect()).unwrap()
}

/// Of all frames: how far one is from its neighbors' mean against how far these are from each other, at the most, and how
/// far that is in any pixel.
fn unsteadiness(frames: &[Picture]) -> [f64; 2] {
    let mut most = [0.0_f64; 2];
    for at in 0..FRAMES {
        let near = |by: usize| &frames[(at + by) % FRAMES];
        let [before, own, after] = [near(FRAMES - 1), near(0), near(1)];
        let between = compare(own, &mean(before, after)).unwrap().linear;
        let apart = compare(before, after).unwrap().linear;
        most[0] = most[0].max(between.rmse / apart.rmse);
        most[1] = most[1].max(between.max);
    }
    most
}

#[test]
fn over_a_full_turn_no_frame_differs_from_its_neighbors_mean_by_more_than_these_differ() {
    let adaptive = Sampling::default();
    let every = Sampling { coarsest: 1, finest: 1, ..adaptive.clone() };
    let [[ratio, worst], [least, unavoidable]] =
        [adaptive, every].map(|sampling| unsteadiness(&turn(&sampling)));
    println!(
        "a frame from its neighbors' mean, against these apart: {ratio:.3} adaptive, {least:.3} with a ray at every position; in a pixel at the most {worst:.4} and {unavoidable:.4}"
    );
    assert!(ratio < 1.0, "{ratio}");
    // What sampling decides anew shows by no more than its tolerance.
    assert!(
        worst < unavoidable + f64::from(Sampling::default().tolerance),
        "{worst} {unavoidable}"
    );
}
