//! MappedTexture filters measured against brute force: what each errs and costs, and what none may do (algorithm §7).

use std::time::Instant;

use gelray::components::TextureFilter::{self, Bilinear, Ellipse, Nearest, Trilinear};
use gelray::components::Wrap;
use gelray::polygon::texture::{Footprint, MappedTexture};
use gelray::view::picture::Picture;
use glam::{DMat2, DVec2, DVec4, Vec4};

const SIZE: usize = 256;
const ANGLES: [f64; 6] = [0.0, 30.0, 60.0, 75.0, 80.0, 85.0];
const SCALES: [f64; 8] = [0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0];
const LOOKUPS: u64 = 48;
const NAMES: [&str; 5] = ["average", "ellipse", "trilinear", "bilinear", "nearest"];

/// A number in 0..1 that depends on `n` alone.
fn hash(n: u64) -> f64 {
    let mut z = n.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(0x1234_5678_9abc_def1);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z >> 11) as f64 / (1_u64 << 53) as f64
}

fn picture(size: [usize; 2], texel: impl Fn(usize, usize) -> [f32; 4]) -> Picture {
    let texels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    Picture::new(size, texels.map(|(x, y)| texel(x, y)).collect()).unwrap()
}

fn grey(value: f64) -> [f32; 4] {
    [value as f32, value as f32, value as f32, 1.0]
}

fn checker(period: usize) -> Picture {
    picture([SIZE; 2], |x, y| grey(((x / period + y / period) % 2) as f64))
}

fn noise() -> Picture {
    picture([SIZE; 2], |x, y| grey(hash((y * SIZE + x) as u64)))
}

fn smooth() -> Picture {
    let wave = |i: usize, n: f64| (i as f64 * n * std::f64::consts::TAU / SIZE as f64).sin();
    picture([SIZE; 2], |x, y| {
        grey(0.5 + 0.2 * wave(x, 5.0) * wave(y, 3.0) + 0.25 * wave(x + y, 9.0))
    })
}

/// A pixel `scale` texels wide on a polygon tilted by `angle` about an axis that is turned in the texture.
fn tilted(scale: f64, angle: f64, turn: f64, size: f64) -> Footprint {
    let tilt = DMat2::from_diagonal(DVec2::new(1.0, 1.0 / angle.to_radians().cos()));
    let sides = DMat2::from_angle(turn.to_radians()) * tilt * (scale / size);
    Footprint::new(sides.x_axis, sides.y_axis)
}

/// The mean of 32 × 32 lookups, jittered each in its own part of the footprint.
fn brute_force(texture: &MappedTexture, uv: DVec2, footprint: &Footprint) -> Vec4 {
    let sides = footprint.sides();
    let sample = |i: u64| {
        let place = DVec2::new((i % 32) as f64 + hash(2 * i), (i / 32) as f64 + hash(2 * i + 1));
        texture.filtered(uv + sides * (place / 32.0 - 0.5), &Footprint::default()).as_dvec4()
    };
    ((0..1024).map(sample).sum::<DVec4>() / 1024.0).as_vec4()
}

/// A row of the table: root mean square errors, and nanoseconds a lookup, of the five filters.
struct Measured {
    errors: [f64; 5],
    costs: [f64; 5],
}

/// Lookups at places and turns of all kinds, against brute force over the same footprints by the texture's own filter.
fn measure(truth: &MappedTexture, scale: f64, angle: f64) -> Measured {
    let places: Vec<_> = (0..LOOKUPS)
        .map(|i| {
            let uv = DVec2::new(hash(7 * i + 1), hash(7 * i + 2));
            (uv, tilted(scale, angle, [0.0, 20.0, 45.0][(i % 3) as usize], SIZE as f64))
        })
        .collect();
    let truths: Vec<_> = places.iter().map(|(uv, f)| brute_force(truth, *uv, f).x).collect();
    let mut measured = Measured { errors: [0.0; 5], costs: [0.0; 5] };
    let filters = [Ellipse, Ellipse, Trilinear, Bilinear, Nearest];
    for (which, filter) in filters.into_iter().enumerate() {
        let texture = truth.with(Wrap::Repeat, filter);
        let start = Instant::now();
        let found: Vec<_> = (places.iter())
            .map(
                |(uv, f)| {
                    if which == 0 { texture.average(*uv, f) } else { texture.filtered(*uv, f) }
                },
            )
            .collect();
        measured.costs[which] = start.elapsed().as_nanos() as f64 / LOOKUPS as f64;
        let squares = found.iter().zip(&truths).map(|(f, t)| f64::from(f.x - t).powi(2));
        measured.errors[which] = (squares.sum::<f64>() / LOOKUPS as f64).sqrt();
    }
    measured
}

fn print_heading(title: &str) {
    let names = NAMES.map(|n| format!("{n:>10}")).concat();
    println!("\n{title}: rms error, then ns a lookup\nangle  texels{names} |{names}");
}

fn print_row(angle: f64, scale: f64, row: &Measured) {
    let errors = row.errors.map(|e| format!("{e:10.4}")).concat();
    let costs = row.costs.map(|c| format!("{c:10.0}")).concat();
    println!("{angle:5}  {scale:6}{errors} |{costs}");
}

fn patterns() -> [(&'static str, Picture); 4] {
    [
        ("checker of 1 texel", checker(1)),
        ("checker of 8 texels", checker(8)),
        ("noise", noise()),
        ("smooth", smooth()),
    ]
}

/// Errors of the five filters over several rows together.
fn pooled<'a>(rows: impl Iterator<Item = &'a Measured>) -> [f64; 5] {
    let (mut squares, mut count) = ([0.0; 5], 0.0);
    for row in rows {
        squares = std::array::from_fn(|i| squares[i] + row.errors[i].powi(2));
        count += 1.0;
    }
    squares.map(|s: f64| (s / count).sqrt())
}

/// The table of all patterns at all angles and the scales given, against brute force over lookups by `truth`.
fn table(truth: TextureFilter, scales: &[f64]) -> Vec<(&'static str, Vec<Measured>)> {
    let mut all = vec![];
    for (name, picture) in patterns() {
        let texture = MappedTexture::new(&picture, Wrap::Repeat, truth);
        print_heading(&format!("{name}, against 1024 {truth:?} lookups"));
        let mut rows = vec![];
        for angle in ANGLES {
            for &scale in scales {
                rows.push(measure(&texture, scale, angle));
                print_row(angle, scale, rows.last().unwrap());
            }
        }
        println!("pooled       {}", pooled(rows.iter()).map(|e| format!("{e:10.4}")).concat());
        all.push((name, rows));
    }
    let total = pooled(all.iter().flat_map(|(_, rows)| rows));
    println!("\nall pooled   {}", total.map(|e| format!("{e:10.4}")).concat());
    all
}

#[test]
fn from_a_texel_a_pixel_up_the_average_is_the_brute_force_one_and_the_ellipse_comes_next() {
    let all = table(Nearest, &SCALES[3..]);
    for (name, rows) in &all {
        // What is left are the errors of 1024 samples.
        assert!(rows.iter().all(|row| row.errors[0] < 0.02), "{name}");
        let [average, others @ ..] = pooled(rows.iter());
        assert!(others.iter().all(|other| average < 0.5 * other), "{name}: {average} {others:?}");
        assert!(others[0] < others[2].min(others[3]) / 3.0, "{name}: {others:?}");
    }
    let [_, ellipse, trilinear, ..] = pooled(all.iter().flat_map(|(_, rows)| rows));
    assert!(ellipse < 0.04 && ellipse < 0.5 * trilinear, "{ellipse} {trilinear}");
}

#[test]
fn magnified_the_average_is_smooth_and_nearest_to_the_bilinear_texture() {
    let all = table(Bilinear, &SCALES[..3]);
    let [average, ellipse, trilinear, bilinear, nearest] =
        pooled(all.iter().flat_map(|(_, rows)| rows));
    assert!(average < 0.03 && average < ellipse && ellipse < 0.06);
    assert!(average < 0.5 * bilinear && average < 0.5 * trilinear && average < 0.2 * nearest);
}

/// Mean and standard deviation over 64 × 64 pixels of the 1-texel checker.
fn spread(lookup: impl Fn(DVec2, &Footprint) -> Vec4, footprint: &Footprint) -> (f64, f64) {
    let pixel = |i: u32| footprint.sides() * DVec2::new(f64::from(i % 64), f64::from(i / 64));
    let values: Vec<_> = (0..4096).map(|i| f64::from(lookup(pixel(i), footprint).x)).collect();
    let mean = values.iter().sum::<f64>() / 4096.0;
    (mean, (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 4096.0).sqrt())
}

#[test]
fn a_checker_of_one_texel_at_a_grazing_angle_is_an_even_grey_without_moire() {
    let [ellipse, nearest] =
        [Ellipse, Nearest].map(|f| MappedTexture::new(&checker(1), Wrap::Repeat, f));
    println!("\nangle  texels  turn   average   ellipse   nearest: standard deviation over pixels");
    for angle in [75.0, 85.0, 88.0] {
        for (scale, turn) in [(1.9, 0.0), (2.3, 33.0), (4.1, 10.0), (7.7, 45.0)] {
            let footprint = tilted(scale, angle, turn, SIZE as f64);
            let (mean, average) = spread(|uv, f| ellipse.average(uv, f), &footprint);
            let (gaussian_mean, gaussian) = spread(|uv, f| ellipse.filtered(uv, f), &footprint);
            let (_, sampled) = spread(|uv, f| nearest.filtered(uv, f), &footprint);
            println!("{angle:5}  {scale:6} {turn:5}{average:10.5}{gaussian:10.5}{sampled:10.5}");
            assert!((mean - 0.5).abs() < 2e-3 && (gaussian_mean - 0.5).abs() < 2e-3);
            // A square pixel lets a little through along the diagonals of the checker; a Gaussian does not.
            assert!(average < 0.02 && gaussian < 2e-3, "{angle} {scale} {turn}");
            assert!(sampled > 0.4, "the same pixels sampled show the checker: {sampled}");
        }
    }
}
