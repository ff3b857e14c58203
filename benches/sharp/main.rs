//! What interpolating values buys and costs beside interpolating colors: the field of Marschner and Lobb in every filter, a
//! field of which voxels lose nothing and a head of half its resolution against the truth, what a frame costs, and how soon an
//! edit of the classification is seen.
//!
//! Two threads; the head of CT data where `GELRAY_DATA` is set, else the phantom. Ways are interleaved, times are medians.

mod marschner_lobb;
#[allow(dead_code, reason = "other benches tell what threads were busy with")]
#[path = "../timed.rs"]
mod timed;

use std::f64::consts::PI;

use gelray::components::{
    Classify, Filter, OpacityUnit, Polygon, Reconstruct, Sampling, TransferPoint, View,
};
use gelray::measure::error::compare;
use gelray::scene::Source;
use gelray::schedule::Ran;
use gelray::shared::Shared;
use gelray::view::picture::{Frame, Picture};
use gelray::volume::grid::{Grid, Scalars};
use glam::{DAffine3, DMat3, DVec3};
use hecs::Entity;
use timed::{Setting, Spread, is_quick, on_threads};

const FILTERS: [Filter; 4] =
    [Filter::Linear, Filter::Cubic, Filter::CatmullRom, Filter::Interpolating];

fn main() {
    on_threads(2, || {
        marschner_lobb::measure();
        band_limited();
        half_resolution();
        edits();
    });
}

/// The head of figure 6a without its polygons, a ray a pixel.
fn head(size: u32) -> Setting {
    let source = Source::embedded("figure_06a").expect("figure 6a is embedded");
    let mut head = Setting::open(&source).expect("figure 6a is read");
    let planes: Vec<_> = head.world.query::<Entity>().with::<&Polygon>().iter().collect();
    for plane in planes {
        let _ = head.world.despawn(plane);
    }
    head.world.query_mut::<&mut View>().into_iter().for_each(|view| view.size = [size; 2]);
    head.sample(|sampling| {
        (sampling.coarsest, sampling.finest, sampling.distance_mm) = (4, 4, Some(1.0));
    });
    head
}

fn volume(setting: &Setting) -> Entity {
    setting.world.query::<Entity>().with::<&Scalars>().iter().next().expect("it has a volume")
}

/// A way of reconstruction; `None` is that of colors.
type Way = Option<Filter>;

fn reconstruct(setting: &mut Setting, way: Way) {
    let kind = if way.is_some() { Reconstruct::Values } else { Reconstruct::Colors };
    let volume = volume(setting);
    setting.world.insert_one(volume, kind).expect("the volume is there");
    setting.sample(|sampling: &mut Sampling| sampling.filter = way.unwrap_or(Filter::Linear));
}

fn name(way: Way) -> String {
    way.map_or("colors / Linear".to_owned(), |filter| format!("values / {filter:?}"))
}

fn picture(setting: &Setting) -> Picture {
    setting.world.query::<&Frame>().iter().next().expect("a picture was made").0.clone()
}

fn seconds(ran: &[Ran], names: &[&str]) -> f64 {
    ran.iter().filter(|ran| names.contains(&ran.name)).map(|ran| ran.seconds).sum()
}

/// Every two voxels along each axis averaged to one.
fn halve(setting: &mut Setting) {
    let volume = volume(setting);
    let grid = *setting.world.get::<&Grid>(volume).expect("it has a grid");
    let scalars = (*setting.world.get::<&Scalars>(volume).expect("it has scalars")).clone();
    let size = grid.size.map(|n| n / 2);
    let voxel = |at: usize| {
        let first = [at % size[0], at / size[0] % size[1], at / (size[0] * size[1])].map(|n| 2 * n);
        let of = |corner: usize| {
            let voxel = std::array::from_fn(|axis| first[axis] + (corner >> axis & 1));
            scalars.value(grid.offset(voxel))
        };
        (0..8).map(of).sum::<f32>() / 8.0
    };
    let voxels = (0..size.iter().product()).map(voxel).collect();
    let unit = grid.spacing().min_element();
    let coarse = DAffine3 {
        matrix3: grid.index_to_world.matrix3 * DMat3::from_diagonal(DVec3::splat(2.0)),
        translation: grid.index_to_world.transform_point3(DVec3::splat(0.5)),
    };
    let made = Grid::new(size, coarse).expect("a grid of half the size");
    let made = (made, Scalars::F32(Shared::new(voxels)), OpacityUnit(unit));
    setting.world.insert(volume, made).expect("the volume is there");
}

/// Half the resolution against the whole, whose spline at short steps is the truth.
fn half_resolution() {
    for size in [380, 1000] {
        let (whole, mut half) = (head(size), head(size));
        halve(&mut half);
        against_the_truth(&format!("a head of half its resolution, {size} × {size}"), half, whole);
    }
}

/// Waves in eight directions, none shorter than 2.6 world units, of amplitudes that are as their lengths: nothing of them is lost
/// at a voxel a unit.
fn waves(p: DVec3) -> f64 {
    let wave = |n: i32| {
        let turn = f64::from(n) * 2.4;
        let rise = f64::from(n) / 4.0 - 0.9;
        let along = DVec3::new(turn.cos(), turn.sin(), rise).normalize();
        let length = 2.6 * 1.5_f64.powi(n);
        length * (2.0 * PI * along.dot(p) / length + turn).cos()
    };
    (0..8).map(wave).sum()
}

/// The waves on a grid of `n`³ voxels that fills a cube of 63 world units.
fn sampled(size: u32, n: usize) -> Setting {
    let scene = format!(
        r#"
[[entity]]
volume = {{ file = "phantom:ball" }}
classify = {{ iso = [{{ value = 20 }}] }}

[[entity]]
light = {{ toward = [-0.4, -0.8, 0.5] }}

[[entity]]
view = {{ azimuth = 30, elevation = 25, size = [{size}, {size}], height_mm = 60 }}
sampling = {{ coarsest = 4, finest = 4, distance_mm = 1.0 }}
"#
    );
    let mut setting = Setting::open(&Source::inline("waves", scene)).expect("the scene is read");
    let h = 63.0 / (n - 1) as f64;
    let grid = Grid::axis_aligned([n; 3], [h; 3], [-31.5; 3]).expect("a grid of that size");
    let place = |at: usize| DVec3::from([at % n, at / n % n, at / (n * n)].map(|i| i as f64));
    let voxels = (0..grid.voxels()).map(|at| waves(place(at) * h - 31.5) as f32).collect();
    let volume = volume(&setting);
    let made = (grid, Scalars::F32(Shared::new(voxels)), OpacityUnit(1.0));
    setting.world.insert(volume, made).expect("the volume is there");
    setting
}

/// A field without anything that 64³ voxels lose, against itself in 253³.
fn band_limited() {
    for size in [380, 1000] {
        let title = format!("waves down to 2.6 voxels in 64³, {size} × {size}");
        against_the_truth(&title, sampled(size, 64), sampled(size, 253));
    }
}

/// How far every way of a coarse volume is off the spline of the `whole` one at short steps, and what frames of both take.
fn against_the_truth(title: &str, mut coarse: Setting, mut whole: Setting) {
    let ways: [Way; 5] =
        [None, Some(FILTERS[0]), Some(FILTERS[1]), Some(FILTERS[2]), Some(FILTERS[3])];
    reconstruct(&mut whole, Some(Filter::Interpolating));
    whole.sample(|sampling| sampling.distance_mm = Some(0.25));
    whole.run();
    let truth = picture(&whole);
    whole.sample(|sampling| sampling.distance_mm = Some(1.0));
    println!("\n{title}, a ray a pixel, against the whole");
    println!(
        "  {:22} {:>9} {:>8} {:>16} {:>16} {:>7}",
        "", "PSNR, dB", "SSIM", "coarse, cast ms", "whole, cast ms", "ratio"
    );
    let mut told = vec![(0.0, 0.0); ways.len()];
    let mut times = vec![[Vec::new(), Vec::new()]; ways.len()];
    for again in 0..if is_quick() { 2 } else { 5 } {
        for (way, (told, times)) in ways.iter().zip(told.iter_mut().zip(&mut times)) {
            for (setting, times) in [&mut coarse, &mut whole].into_iter().zip(times) {
                reconstruct(setting, *way);
                // A step a hair off is another step: rays are cast again.
                setting.sample(|s| s.distance_mm = Some(1.0 + 1e-9 * f64::from(again)));
                times.push(seconds(&setting.run().0, &["cast"]));
            }
            if again == 0 {
                let off = compare(&picture(&coarse), &truth).expect("pictures of one size").linear;
                *told = (off.psnr_db, off.ssim);
            }
        }
    }
    let median = |times: &[f64]| Spread::of(times).median * 1e3;
    let colors = median(&times[0][1]);
    for (way, ((psnr, ssim), [of_coarse, of_whole])) in ways.iter().zip(told.iter().zip(&times)) {
        println!(
            "  {:22} {psnr:>9.2} {ssim:>8.4} {:>16.1} {:>16.1} {:>7.2}",
            name(*way),
            median(of_coarse),
            median(of_whole),
            median(of_whole) / colors
        );
    }
}

/// From an edit of the isovalue to the picture of 380 × 380 pixels, adaptive.
fn edits() {
    println!("\nan edit of what is seen → picture, 380 × 380, adaptive, ms: median [least–most]");
    let mut settings = [None, Some(Filter::Linear), Some(Filter::Cubic)].map(|way| {
        let mut setting = head(380);
        setting.sample(|s| (s.coarsest, s.finest) = (8, 1));
        reconstruct(&mut setting, way);
        setting.run();
        (way, setting, Vec::new(), Vec::new())
    });
    for again in 0..if is_quick() { 3 } else { 9 } {
        for (_, setting, all, bits) in &mut settings {
            let volume = volume(setting);
            let point = |value, opacity| TransferPoint { value, opacity, color: None };
            let low = 1180.0 + again as f32;
            let transfer = vec![point(low, 0.0), point(low + 200.0, 1.0)];
            let classify = Classify::<f32> { transfer, ..Classify::default() };
            setting.world.insert_one(volume, classify).expect("the volume is there");
            let (ran, seconds_in_all) = setting.run();
            all.push(seconds_in_all);
            bits.push(seconds_of_preparation(&ran));
        }
    }
    for (way, _, all, bits) in &settings {
        let [all, bits] = [all, bits].map(|times| Spread::of(times).milliseconds());
        println!("  {:22} {all:>26}, of which preparation {bits}", name(*way));
    }
}

fn seconds_of_preparation(ran: &[Ran]) -> f64 {
    ran.iter().map(|ran| ran.seconds).sum::<f64>() - seconds(ran, &["cast", "resample"])
}
