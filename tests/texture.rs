//! Texture filters measured against brute force: what each errs and costs, and what none may do (algorithm §7).

use std::time::Instant;

use gelray::components::TextureFilter::{Bilinear, Ellipse, Nearest, Trilinear};
use gelray::components::Wrap;
use gelray::picture::Picture;
use gelray::texture::{Footprint, Texture};
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
fn brute_force(texture: &Texture, uv: DVec2, footprint: &Footprint) -> Vec4 {
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

/// Lookups at places and turns of all kinds, against brute force over the same footprints of the texture `truth`.
fn measure(picture: &Texture, truth: &Texture, scale: f64, angle: f64) -> Measured {
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
        let texture = picture.with(Wrap::Repeat, filter);
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

#[test]
fn from_one_texel_a_pixel_on_the_reference_is_the_brute_force_average_and_every_other_filter_errs_more()
 {
    for (name, picture) in patterns() {
        let nearest = Texture::new(&picture, Wrap::Repeat, Nearest);
        print_heading(&format!("{name}, against 1024 nearest texels"));
        for angle in ANGLES {
            for scale in SCALES {
                let row = measure(&nearest, &nearest, scale, angle);
                print_row(angle, scale, &row);
            }
        }
    }
}

#[test]
fn under_one_texel_a_pixel_magnified() {
    for (name, picture) in patterns() {
        let texture = Texture::new(&picture, Wrap::Repeat, Bilinear);
        print_heading(&format!("{name}, against 1024 bilinear lookups"));
        for angle in ANGLES {
            for scale in SCALES {
                print_row(angle, scale, &measure(&texture, &texture, scale, angle));
            }
        }
    }
}
