//! Textures on polygons of the hybrid ray tracer, in pictures (paper §5, the paper's figure 10).

use gelray::components::{Color, TextureFilter, Wrap};
use gelray::polygon::texture::{Laid, MappedTexture, TexturedBy};
use gelray::view::picture::Picture;
use gelray::view::samples::{POSITIONS, SampleArray};
use hecs::World;

use crate::{
    EVERY_PIXEL, at, difference, entity, frame, gel, level, near, pixels, polygon, rendered, run,
    samples, stated, view,
};

const AMBIENT: &str = "surface = { ambient = 1, diffuse = 0 }";

/// Lays a picture on a polygon that has a texture already.
fn lay(world: &mut World, name: &str, picture: &Picture, wrap: Wrap, filter: TextureFilter) {
    let entity = entity(world, name);
    world.get::<&mut TexturedBy>(entity).unwrap().laid =
        Laid::One(MappedTexture::new(picture, wrap, filter));
}

fn picture(side: usize, texel: impl Fn(usize, usize) -> [f32; 4]) -> Picture {
    Picture::new([side; 2], (0..side * side).map(|at| texel(at % side, at / side)).collect())
        .unwrap()
}

#[test]
fn the_rays_below_a_pixel_are_those_of_the_scene_without_its_textures() {
    let ball = gel("ball", [0.0, 0.2], "material = { color = \"#f0e0c0\" }");
    let upright =
        [[-30.0, 3.0, 28.0], [30.0, -8.0, 28.0], [30.0, -8.0, -28.0], [-30.0, 3.0, -28.0]];
    println!("view      rays textured, plain; below a pixel textured, plain, in one of both alone");
    for [azimuth, elevation] in [[0.0, 0.0], [30.0, 20.0], [140.0, -35.0], [265.0, 60.0]] {
        let cast = |textured: [&str; 2]| {
            let surface = "surface = { opacity = 0.8 }";
            let upright = polygon("upright", &upright, &format!("{surface}\n{}", textured[0]));
            let level = level("level", 4.2, 26.0, &format!("{surface}\n{}", textured[1]));
            let mut world =
                stated(&[&ball, &upright, &level, &view(azimuth, elevation, 96, 90.0, "")], &[]);
            run(&mut world);
            samples(&world)
        };
        let grid = "textured = { texture = \"grid\", repeats = [3, 3] }";
        let (textured, plain) =
            (cast(["textured = { texture = \"portrait\" }", grid]), cast([""; 2]));
        // Bit 0 of a block is its ray of the lattice of pixels.
        let below = |cast: &[u16]| cast.iter().map(|bits| (bits & !1).count_ones()).sum::<u32>();
        let apart: u32 =
            textured.cast.iter().zip(&plain.cast).map(|(a, b)| ((a ^ b) & !1).count_ones()).sum();
        println!(
            "{azimuth:>3} {elevation:>3}   {} {}; {} {}, {apart}",
            textured.counts.rays,
            plain.counts.rays,
            below(&textured.cast),
            below(&plain.cast)
        );
        assert!(below(&plain.cast) > 1000 && textured.counts.rays > plain.counts.rays);
        assert_eq!(apart, 0, "{azimuth} {elevation}");
    }
}

#[test]
fn the_alpha_of_a_texture_multiplies_the_polygons_opacity_and_outside_it_vanishes_if_so_stated() {
    // The texture covers the middle of the polygon; its left half is half transparent.
    let textured =
        "textured = { texture = \"grid\", corners = [[-10, 0, 10], [10, 0, 10], [-10, 0, -10]] }";
    let square = [[-20.0, 0.0, 20.0], [20.0, 0.0, 20.0], [20.0, 0.0, -20.0], [-20.0, 0.0, -20.0]];
    let keys = format!(
        "surface = {{ color = \"#ff0000\", ambient = 1, diffuse = 0, opacity = 0.8 }}\n{textured}"
    );
    let half = picture(2, |x, _| if x == 0 { [0.25, 0.25, 0.25, 0.5] } else { [1.0; 4] });
    for (wrap, outside) in [(Wrap::Vanish, [0.0, 0.0]), (Wrap::Clamp, [0.2, 0.4])] {
        let mut world = stated(
            &[&polygon("plane", &square, &keys), &view(0.0, 0.0, 96, 48.0, EVERY_PIXEL)],
            &[],
        );
        lay(&mut world, "plane", &half, wrap, TextureFilter::Nearest);
        run(&mut world);
        // Associated red and alpha: 0.8 times the texel's.
        for (x, [red, alpha]) in
            [(-5.0, [0.2, 0.4]), (5.0, [0.8, 0.8]), (-15.0, outside), (-23.0, [0.0; 2])]
        {
            let found = at(&world, [x, 0.0, 3.0]);
            assert!(difference(found, [red, 0.0, 0.0, alpha]) < 1e-6, "{wrap:?} {x}: {found:?}");
        }
    }
}

const EXACT: &str = "coarsest = 1, finest = 1, tolerance = 0, stop_at = 0";

fn checker(side: usize, period: usize) -> Picture {
    let white = |x: usize, y: usize| (x / period + y / period).is_multiple_of(2);
    picture(side, |x, y| if white(x, y) { [1.0; 4] } else { [0.0, 0.0, 0.0, 1.0] })
}

#[test]
fn at_a_texel_a_pixel_a_smooth_texture_is_reproduced() {
    let side = 256;
    let half = side as f64 / 2.0;
    let square = [[-half, 0.0, half], [half, 0.0, half], [half, 0.0, -half], [-half, 0.0, -half]];
    let plane = format!("{AMBIENT}\ntextured = {{ texture = \"grid\" }}");
    let plane = polygon("plane", &square, &plane);
    let wave = |i: usize, period: f64| (std::f64::consts::TAU * i as f64 / period).sin() as f32;
    let wave = |i, period| 0.5 + 0.4 * wave(i, period);
    let waves = picture(side, |x, y| [wave(x, 24.0), wave(y, 32.0), wave(x + y, 40.0), 1.0]);
    let portrait = gelray::phantom::texture("portrait").unwrap();
    println!("texture   sampling       differences from texels in 1/255: mean, greatest");
    for (name, texels) in
        [("waves", &waves), ("portrait", &portrait), ("checks", &checker(side, 3))]
    {
        for (how, sampling) in [("a ray a pixel", EVERY_PIXEL), ("exact", EXACT)] {
            let seen = view(0.0, 0.0, side as u32, side as f64, sampling);
            let mut world = stated(&[&plane, &seen], &[]);
            lay(&mut world, "plane", texels, Wrap::Clamp, TextureFilter::Area);
            run(&mut world);
            let frame = frame(&world);
            let inner: Vec<f32> = pixels(&frame)
                .filter(|at| at.iter().all(|p| (2..side - 2).contains(p)))
                .map(|[x, y]| difference(frame.pixel(x, y), texels.pixel(x, y)) * 255.0)
                .collect();
            let most = inner.iter().copied().fold(0.0, f32::max);
            let mean = inner.iter().sum::<f32>() / inner.len() as f32;
            println!("{name:<9} {how:<14} {mean:.3} {most:.2}");
            // Edges of a texel are softened: a pixel is a box over rays that are interpolated, (1, 6, 1)/8 along each axis.
            match name {
                "waves" => assert!(most <= 2.0),
                "portrait" => assert!(mean <= 1.0),
                _ => assert!((most / 255.0 - (1.0 - 0.875 * 0.875)).abs() < 0.02),
            }
        }
    }
}

const FILTERS: [(&str, TextureFilter); 5] = [
    ("area", TextureFilter::Area),
    ("ellipse", TextureFilter::Ellipse),
    ("trilinear", TextureFilter::Trilinear),
    ("bilinear", TextureFilter::Bilinear),
    ("nearest", TextureFilter::Nearest),
];

/// A floor seen at a grazing angle, with a picture on it, `pixels` pixels wide.
fn floor(texture: &Picture, filter: TextureFilter, elevation: f64, pixels: u32) -> World {
    let keys = format!("{AMBIENT}\ntextured = {{ texture = \"grid\", repeats = [2, 2] }}");
    let floor = level("floor", 0.0, 60.0, &keys);
    let mut world = stated(&[&floor, &view(12.0, elevation, pixels, 70.0, EVERY_PIXEL)], &[]);
    lay(&mut world, "floor", texture, Wrap::Repeat, filter);
    run(&mut world);
    world
}

/// The pixels that see nothing but the floor, with their neighbours.
fn inside(picture: &Picture) -> Vec<[usize; 2]> {
    pixels(picture).filter(|&at| !near(picture, at, 3, |pixel| pixel[3] < 0.999)).collect()
}

/// What the ray through a pixel's middle saw.
fn ray(samples: &SampleArray, [x, y]: [usize; 2]) -> f32 {
    let position = |p: usize| POSITIONS * p + samples.layout.margin;
    samples.color(position(x), position(y))[0]
}

#[test]
fn the_better_filters_come_nearer_to_the_supersampled_pixels_of_a_floor() {
    const FINER: usize = 8;
    let names = FILTERS.map(|(name, _)| format!("{name:>10}")).concat();
    println!("root mean square error; checks of so many texels, elevation\n            {names}");
    let (mut squares, mut count) = ([0.0; 5], 0.0);
    for (texels, elevation) in [(1, 9.0), (4, 9.0), (8, 9.0), (4, 25.0), (8, 25.0), (8, 60.0)] {
        let texture = checker(128, texels);
        let fine = samples(&floor(&texture, TextureFilter::Nearest, elevation, 96 * FINER as u32));
        let mean = |[x, y]: [usize; 2]| {
            let within = (0..FINER * FINER).map(|n| [n % FINER, n / FINER]);
            let rays = within.map(|[i, j]| ray(&fine, [x * FINER + i, y * FINER + j]));
            rays.sum::<f32>() / (FINER * FINER) as f32
        };
        let seen = FILTERS.map(|(_, filter)| floor(&texture, filter, elevation, 96));
        let inner = inside(&frame(&seen[0]));
        assert!(inner.len() > 500);
        let exact: Vec<f32> = inner.iter().map(|&at| mean(at)).collect();
        let errors = seen.each_ref().map(|world| {
            let samples = samples(world);
            let square = |(at, exact): (&[usize; 2], &f32)| (ray(&samples, *at) - exact).powi(2);
            inner.iter().zip(&exact).map(square).sum::<f32>() / inner.len() as f32
        });
        println!(
            "{texels:>6} {elevation:>4} {}",
            errors.map(|e| format!("{:10.4}", e.sqrt())).concat()
        );
        squares = std::array::from_fn(|filter| squares[filter] + errors[filter]);
        count += 1.0;
    }
    let pooled = squares.map(|sum: f32| (sum / count).sqrt());
    println!("all         {}", pooled.map(|e| format!("{e:10.4}")).concat());
    assert!(pooled[0] < 0.04 && pooled.windows(2).all(|pair| pair[0] < pair[1]), "{pooled:?}");
}

#[test]
fn a_checker_of_one_texel_at_a_grazing_angle_is_an_even_grey_picture() {
    let texture = checker(256, 1);
    println!("elevation  standard deviation over the floor: area, ellipse, nearest");
    for elevation in [15.0, 9.0, 4.0] {
        let spread = |filter| {
            let seen = frame(&floor(&texture, filter, elevation, 96));
            let values: Vec<f32> =
                inside(&seen).iter().map(|&[x, y]| seen.pixel(x, y)[0]).collect();
            let count = values.len() as f32;
            let mean = values.iter().sum::<f32>() / count;
            assert!(count > 100.0 && (mean - 0.5).abs() < 0.02, "{mean}");
            (values.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / count).sqrt()
        };
        let [area, ellipse, _, _, nearest] = FILTERS.map(|(_, filter)| spread(filter));
        println!("{elevation:<10} {area:.4} {ellipse:.4} {nearest:.4}");
        assert!(area < 0.02 && ellipse < 0.02 && nearest > 0.1);
    }
}

#[test]
fn a_texture_of_one_color_is_the_polygon_in_that_color_in_gel_and_at_any_footprint() {
    let (gel, seen) = (gel("ball", [0.01, 0.2], ""), view(25.0, 30.0, 64, 90.0, EVERY_PIXEL));
    let light = crate::KEY.replace("casts_shadow = {}", "");
    let srgb = [0.5, 0.25, 0.75];
    let surface = format!("surface = {{ color = {srgb:?}, opacity = 0.5 }}");
    let plain = rendered(&[&gel, &level("plane", 3.0, 30.0, &surface), &light, &seen]);
    let texel = (Color::from_srgb(srgb).0 * 0.5).extend(0.5).to_array();
    for (name, filter) in FILTERS {
        let textured = level("plane", 3.0, 30.0, "textured = { texture = \"grid\" }");
        let mut world = stated(&[&gel, &textured, &light, &seen], &[]);
        lay(&mut world, "plane", &picture(4, |_, _| texel), Wrap::Repeat, filter);
        run(&mut world);
        let textured = frame(&world);
        let apart =
            pixels(&plain).map(|[x, y]| difference(plain.pixel(x, y), textured.pixel(x, y)));
        let most = apart.fold(0.0, f32::max);
        assert!(most < 1e-5, "{name}: {most}");
    }
}
