//! Facts about slides: where a texture stands before a light, and what a look-up averages.

use super::*;
use crate::components::Projects;
use crate::view::picture::Picture;

fn stated(
    size: [usize; 2],
    size_mm: [f64; 2],
    wrap: Wrap,
    light: impl Fn(usize, usize) -> f32,
) -> ProjectedBy {
    let grey = |at: usize| {
        let grey = light(at % size[0], at / size[0]);
        [grey, grey, grey, 1.0]
    };
    let picture = Picture::new(size, (0..size[0] * size[1]).map(grey).collect()).unwrap();
    let projects = Projects { texture: "t".to_owned(), size_mm, center: None, up: None, wrap };
    ProjectedBy { projects, picture, center: DVec3::ZERO, up: DVec3::Z }
}

fn slide(stated: &ProjectedBy, toward: DVec3) -> Slide {
    Slide::new(stated, toward).unwrap()
}

#[test]
fn a_texture_stands_upright_as_seen_from_the_light() {
    // Seen from −y, +x is to the right and +z is up.
    let corner =
        |x, y| stated([2, 2], [2.0, 2.0], Wrap::Vanish, move |i, j| f32::from((i, j) == (x, y)));
    let at = |x, y, p: DVec3| slide(&corner(x, y), DVec3::NEG_Y).at(p, [0.0; 2]);
    assert_eq!(at(0, 0, DVec3::new(-0.5, 9.0, 0.5)), 1.0);
    assert_eq!(at(1, 0, DVec3::new(0.5, -9.0, 0.5)), 1.0);
    assert_eq!(at(1, 1, DVec3::new(0.5, 0.0, -0.5)), 1.0);
    assert_eq!(at(1, 1, DVec3::new(0.5, 0.0, 0.5)), 0.0);
}

#[test]
fn a_point_is_bilinear_between_texel_centres() {
    let slide = slide(&stated([4, 1], [4.0, 1.0], Wrap::Clamp, |x, _| x as f32), DVec3::NEG_Y);
    for (x, expected) in
        [(-1.5, 0.0), (-0.5, 1.0), (-0.25, 1.25), (1.2, 2.7), (9.0, 3.0), (-9.0, 0.0)]
    {
        assert!((slide.at(DVec3::X * x, [0.0; 2]) - expected).abs() < 1e-6, "{x}");
    }
}

#[test]
fn outside_a_texture_it_repeats_clamps_or_vanishes() {
    let at = |wrap, x: f64| {
        let stated = stated([4, 4], [4.0, 4.0], wrap, |x, _| x as f32);
        slide(&stated, DVec3::NEG_Y).at(DVec3::X * x, [0.0; 2])
    };
    assert_eq!(at(Wrap::Repeat, 2.5), 0.0);
    assert_eq!(at(Wrap::Repeat, -2.5), 3.0);
    assert_eq!(at(Wrap::Repeat, 4001.5), at(Wrap::Repeat, 1.5));
    assert_eq!([2.5, 5.5, 6.5, -2.5].map(|x| at(Wrap::Mirror, x)), [3.0, 0.0, 0.0, 0.0]);
    assert_eq!(at(Wrap::Mirror, 8001.5), at(Wrap::Mirror, 1.5));
    assert_eq!(at(Wrap::Clamp, 2.5), 3.0);
    assert_eq!(at(Wrap::Vanish, 2.5), 0.0);
    assert_eq!(at(Wrap::Vanish, 1.5), 3.0);
    assert!(at(Wrap::Clamp, 1e300) == 3.0 && at(Wrap::Vanish, -1e300) == 0.0);
    assert!(at(Wrap::Repeat, 1e300).is_finite() && at(Wrap::Repeat, f64::INFINITY) == 0.0);
}

#[test]
fn a_footprint_wider_than_texels_sees_their_average_and_no_moire() {
    let checks = stated([101, 77], [101.0, 77.0], Wrap::Repeat, |x, y| ((x + y) % 2) as f32);
    let fine = slide(&checks, DVec3::NEG_Y);
    let mean = (101 * 77 / 2) as f32 / (101.0 * 77.0);
    for (width, within) in [(10.0, 0.03), (40.0, 0.01), (500.0, 1e-6)] {
        for x in -20..20 {
            let seen = fine.at(DVec3::new(f64::from(x) * 3.7, 0.0, 1.3), [width, width]);
            assert!((seen - mean).abs() < within, "{seen} over {width}");
        }
    }
}

#[test]
fn levels_agree_with_the_texels_that_they_stand_for() {
    let noise = |x: usize, y: usize| ((x * 7919 + y * 104_729) % 977) as f32 / 977.0;
    let slide = slide(&stated([60, 45], [60.0, 45.0], Wrap::Clamp, noise), DVec3::NEG_Y);
    for width in [8.0, 17.0, 30.0] {
        let coarse = slide.at(DVec3::ZERO, [width, width]);
        let low = [30.0 - width / 2.0, 22.5 - width / 2.0];
        let exact = slide.levels[0].average(low, [width, width], Wrap::Clamp) as f32;
        assert!((coarse - exact).abs() < 0.02, "{coarse} {exact} over {width}");
    }
}

#[test]
fn luminance_is_of_associated_colour_and_never_wild() {
    assert!((luminance(&[1.0, 1.0, 1.0, 1.0]) - 1.0).abs() < 1e-6);
    assert!((luminance(&[0.0, 0.25, 0.0, 0.25]) - 0.1788).abs() < 1e-6);
    assert_eq!(luminance(&[f32::NAN, 0.0, 0.0, 1.0]), 0.0);
    assert_eq!(luminance(&[f32::INFINITY, 0.0, 0.0, 1.0]), BRIGHTEST);
}

#[test]
fn a_slide_without_a_size_is_refused() {
    let problem = Slide::new(&stated([1, 1], [0.0, 1.0], Wrap::Clamp, |_, _| 1.0), DVec3::Z);
    assert!(problem.unwrap_err().contains("above 0"));
}
