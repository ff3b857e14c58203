//! Slabs that are integrated from one end to the other: sharp transfer functions at the step of smooth ones.

use gelray::prelude::*;

use super::{FILTERS, floats, rendered, world};

fn point(value: f32, opacity: f32, color: [f32; 3]) -> TransferPoint {
    TransferPoint { value, opacity, color: Some(Color::from_srgb(color)) }
}

/// A field of some waves, seen at a ray a pixel with so many voxels from sample to sample.
fn waves(
    transfer: &[TransferPoint],
    gradient: &[[f32; 2]],
    filter: Filter,
    (step, integrate): (f64, bool),
) -> Picture {
    let field = |p: glam::DVec3| {
        let wave = (0.5 * p.x).sin() + (0.4 * p.y + 0.3 * p.z).cos() + 0.12 * p.z;
        // 0 towards the borders, where slabs are cut off.
        let inside = (p.abs() / 9.5).to_array().map(|part| 1.0 - part.powi(4));
        (10.0 * wave * inside.iter().product::<f64>()) as f32
    };
    let (transfer, gradient) = (transfer.to_vec(), gradient.to_vec());
    let classify = Classify { transfer, gradient, ..Classify::default() };
    let view = View { size: [40, 40], azimuth: 25.0, elevation: 15.0, ..View::default() };
    let all = Sampling { coarsest: 4, finest: 4, stop_at: 0.0, ..Sampling::default() };
    let sampling = Sampling { filter, integrate, distance_mm: Some(step), ..all };
    rendered(&mut world(floats([20; 3], field), classify, (view, sampling))).picture
}

/// The root mean square over all channels.
fn apart(a: &Picture, b: &Picture) -> f64 {
    let pairs = a.pixels.as_flattened().iter().zip(b.pixels.as_flattened());
    let sum: f64 = pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    (sum / (4 * a.pixels.len()) as f64).sqrt()
}

/// The opacity in place of every channel.
fn opacity(picture: &Picture) -> Picture {
    let pixels = picture.pixels.iter().map(|pixel| [pixel[3]; 4]).collect();
    Picture::new(picture.size, pixels).unwrap()
}

#[test]
fn a_sharp_function_does_not_ask_for_short_steps() {
    let (red, blue) = ([0.9, 0.2, 0.1], [0.1, 0.3, 0.9]);
    let thin = [point(3.0, 0.0, red), point(3.2, 0.95, red), point(3.4, 0.0, red)];
    let step = [
        point(4.0, 0.0, red),
        point(4.01, 0.5, red),
        point(9.0, 0.5, blue),
        point(9.01, 0.0, blue),
    ];
    let hidden =
        [point(2.0, 0.0, red), point(2.1, 1.0, red), point(3.0, 1.0, red), point(3.1, 0.02, blue)];
    // What is left of the error of the middles of slabs: of opacity, and of all channels, for shading stays that of the middle.
    for (name, transfer, left) in [
        ("thin", &thin[..], [0.1; 2]),
        ("step", &step[..], [0.25; 2]),
        ("hidden", &hidden[..], [0.25; 2]),
    ] {
        let of = |how| waves(transfer, &[], Filter::Interpolating, how);
        let truth = of((1.0 / 32.0, true));
        let made = [(1.0, false), (1.0, true), (0.25, false)].map(of);
        let [plain, integrated, fine] = made
            .each_ref()
            .map(|made| [apart(&opacity(made), &opacity(&truth)), apart(made, &truth)]);
        println!(
            "{name}: off by {plain:.5?} in the middles of slabs, {fine:.5?} of a fourth; {integrated:.5?} integrated"
        );
        for n in 0..2 {
            assert!(integrated[n] < left[n] * plain[n], "{name}: {integrated:?} {plain:?}");
        }
    }
}

#[test]
fn at_short_steps_both_ways_are_the_same_picture_with_a_factor_of_the_gradient_too() {
    let gray = [0.8; 3];
    let transfer = [point(0.0, 0.0, gray), point(5.0, 0.7, [0.9, 0.3, 0.1]), point(9.0, 0.1, gray)];
    for (filter, gradient) in
        FILTERS.into_iter().zip([&[][..], &[[0.5, 0.0], [5.0, 1.0]][..]].repeat(2))
    {
        let of = |how| waves(&transfer, gradient, filter, how);
        let [plain, integrated] = [false, true].map(|integrate| of((1.0 / 16.0, integrate)));
        assert!(plain.pixels.iter().any(|pixel| pixel[3] > 0.2));
        let off = apart(&plain, &integrated);
        assert!(off < 2e-4, "{filter:?} {gradient:?}: {off}");
    }
}

#[test]
fn a_constant_is_to_the_eye_what_it_is_in_the_middle() {
    let flat = || floats([9, 8, 7], |_| 5.0);
    let classify = Classify {
        transfer: vec![point(0.0, 0.0, [1.0; 3]), point(9.0, 0.9, [0.5; 3])],
        ..Classify::default()
    };
    let [plain, integrated] = [false, true].map(|integrate| {
        let view = View { size: [16, 16], azimuth: 20.0, ..View::default() };
        let sampling = Sampling { integrate, distance_mm: Some(0.7), ..Sampling::default() };
        rendered(&mut world(flat(), classify.clone(), (view, sampling))).picture
    });
    assert!(apart(&plain, &integrated) < 1e-6);
}
