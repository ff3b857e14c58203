//! Contours without thickness: a sphere by formula is where it is and as it is, at any step.

use gelray::prelude::*;
use gelray::view::samples::POSITIONS;

use super::{FILTERS, carrier, floats, rendered, world};

/// A ball of radius 10 in 32³ voxels, lit from the observer: each pixel shows the cosine to the surface's normal.
fn ball(filter: Filter, step: f64, contour: Contour) -> Rendered {
    let ball = floats([32; 3], |place| 20.0 - place.length() as f32);
    let classify = Classify { iso: vec![contour], ..Classify::default() };
    let view = View { size: [300, 300], height_mm: Some(30.0), ..View::default() };
    let sampling = Sampling {
        coarsest: 4,
        finest: 4,
        stop_at: 0.0,
        filter,
        distance_mm: Some(step),
        ..Sampling::default()
    };
    let mut world = world(ball, classify, (view, sampling));
    let volume = carrier::<Reconstruct>(&world);
    let matt = Material { ambient: 0.0, diffuse: 1.0, ..Material::default() };
    world.insert_one(volume, matt).unwrap();
    let light = carrier::<Light>(&world);
    world.insert_one(light, Light::at_observer()).unwrap();
    rendered(&mut world)
}

fn surface(opacity: f32) -> Contour {
    Contour { thickness_voxels: 0.0, opacity, ..Contour::at(10.0) }
}

/// The radius of a disc of that area, of pixels a tenth of a voxel wide.
fn radius(picture: &Picture) -> f32 {
    let area: f32 = picture.pixels.iter().map(|pixel| pixel[3]).sum::<f32>() / 100.0;
    (area / std::f32::consts::PI).sqrt()
}

/// The greatest angle in degrees between the normals that are seen and those of a sphere as large as what is seen, where it is
/// not seen edge on.
fn worst_normal(picture: &Picture) -> f32 {
    let radius = radius(picture);
    let place = |n: usize| (n as f32 - 149.5) / 10.0 / radius;
    let at = |(x, y): (usize, usize)| {
        let off = place(x).powi(2) + place(y).powi(2);
        let angle = picture.pixel(x, y)[0].clamp(0.0, 1.0).acos() - (1.0 - off).sqrt().acos();
        // Head on, a cosine of 32 bits does not tell a small angle.
        if (0.01..0.9).contains(&off) { angle.abs().to_degrees() } else { 0.0 }
    };
    (0..300)
        .flat_map(|y| (0..300).map(move |x| (x, y)))
        .filter(|(x, y)| place(*x).powi(2) + place(*y).powi(2) < 0.9)
        .map(at)
        .fold(0.0, f32::max)
}

#[test]
fn a_sphere_has_its_silhouette_and_its_normals() {
    // The smooth spline is off by a sixth of the second differences: 2 / r / 6, a thirtieth of a voxel.
    for (filter, silhouette) in FILTERS.into_iter().zip([0.02, 0.04, 0.02, 0.02]) {
        let picture = ball(filter, 1.0, surface(1.0)).picture;
        let off = (radius(&picture) - 10.0).abs();
        let angle = worst_normal(&picture);
        println!("{filter:?}: radius off by {off:.4} voxels, normals by {angle:.3} degrees");
        assert!(off <= silhouette, "{filter:?}: {off}");
        assert!(angle <= 0.5, "{filter:?}: {angle}");
    }
}

#[test]
fn short_steps_and_long_ones_find_the_same_surface() {
    for filter in FILTERS {
        let [short, long] = [0.5, 2.0].map(|step| ball(filter, step, surface(1.0)).picture);
        assert!((radius(&short) - radius(&long)).abs() < 0.01, "{filter:?}");
        let pairs = short.pixels.iter().zip(long.pixels.iter());
        // A hundredth of a voxel along the ray turns the normal by a thousandth where it is met at 45 degrees.
        let facing = pairs.filter(|(a, b)| a[0] > 0.5 && b[0] > 0.5);
        let worst = facing.map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-3, "{filter:?}: {worst}");
    }
}

#[test]
fn a_clear_surface_has_its_opacity_at_any_step_and_both_its_sides_are_seen() {
    for step in [0.5, 2.0, 5.0] {
        let picture = ball(Filter::Interpolating, step, surface(0.5)).picture;
        for x in [150, 180, 220] {
            let alpha = picture.pixel(x, 150)[3];
            assert!((alpha - 0.75).abs() < 1e-5, "{step} {x}: {alpha}");
        }
    }
}

#[test]
fn a_surface_is_refused_where_colors_are_interpolated() {
    let ball = floats([8; 3], |place| 20.0 - place.length() as f32);
    let classify = Classify { iso: vec![surface(1.0)], ..Classify::default() };
    let mut world = world(ball, classify, (View::default(), Sampling::default()));
    let volume = carrier::<Reconstruct>(&world);
    world.insert_one(volume, Reconstruct::Colors).unwrap();
    let refused = Renderer::new().unwrap().render(&mut world).unwrap_err().to_string();
    assert!(refused.contains("thickness 0"), "{refused}");
}

#[test]
fn a_polygon_in_a_surface_is_before_it_or_behind_it_at_every_pixel() {
    // The surface falls to the right, the polygon upwards: they cross in a line.
    let [of_surface, of_polygon] = [|x: f64, _: f64| 0.31 * x, |_: f64, z: f64| 0.1 - 0.23 * z];
    let (white, half) = (glam::Vec3::ONE, 0.5);
    for (step, filter) in [(0.5, Filter::Linear), (2.0, Filter::Linear), (3.0, Filter::Cubic)] {
        let field = |at: glam::DVec3| (20.0 + at.y - of_surface(at.x, at.z)) as f32;
        let form = Form::Around;
        let contour = Contour { thickness_voxels: 0.0, opacity: half, form, ..Contour::at(20.0) };
        let classify = Classify { iso: vec![contour], ..Classify::default() };
        let view = View { size: [90, 90], height_mm: Some(20.0), ..View::default() };
        let (coarsest, finest, distance_mm) = (4, 4, Some(step));
        let sampling =
            Sampling { coarsest, finest, filter, distance_mm, stop_at: 0.0, ..Sampling::default() };
        let mut world = world(floats([32; 3], field), classify, (view, sampling));
        let volume = carrier::<Reconstruct>(&world);
        let ambient = Material { ambient: 1.0, diffuse: 0.0, ..Material::default() };
        world.insert_one(volume, Material { color: Color(white), ..ambient }).unwrap();
        let corners = [[-15.0, -15.0], [15.0, -15.0], [15.0, 15.0], [-15.0, 15.0]];
        let vertices = corners.map(|[x, z]| [x, of_polygon(x, z), z]).to_vec();
        let black = Surface { opacity: half, ambient: 0.0, diffuse: 0.0, ..Surface::default() };
        world.spawn((Polygon { vertices, holes: Vec::new() }, black));
        // What the ray in the middle of a pixel sees, before pixels are made of several.
        let samples = rendered(&mut world).samples;
        let at = |n: usize| samples.layout.margin + n * POSITIONS;
        for (x, y) in (0..90).flat_map(|y| (0..90).map(move |x| (x, y))) {
            let [right, up] = [x as f64 - 44.5, 44.5 - y as f64].map(|n| n * 20.0 / 90.0);
            let (surface, polygon) = (of_surface(right, up), of_polygon(right, up));
            // White before black, or behind it.
            let expected = if surface < polygon { 0.5 } else { 0.25 };
            let [found, .., alpha] = samples.color(at(x), at(y));
            let known = (surface - polygon).abs() > 2e-3;
            assert!(
                !known || (found - expected).abs() < 1e-5,
                "{filter:?} {step} {x} {y}: {found}"
            );
            assert!((alpha - 0.75).abs() < 1e-5, "{filter:?} {step} {x} {y}: {alpha}");
        }
    }
}
