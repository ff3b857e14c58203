//! What interpolating values buys and costs beside interpolating colors: the field of Marschner and Lobb in every filter, a
//! head of half its resolution against the whole one, what a frame costs, and how soon an edit of the classification is seen.
//!
//! Two threads; the head of CT data where `GELRAY_DATA` is set, else the phantom. Ways are interleaved, times are medians.

#[allow(dead_code, reason = "other benches tell what threads were busy with")]
mod timed;

use std::f64::consts::PI;

use fearless_simd::Level;
use gelray::components::{
    Classify, Filter, OpacityUnit, Polygon, Reconstruct, Sampling, TransferPoint, View,
};
use gelray::measure::error::compare;
use gelray::scene::Source;
use gelray::schedule::Ran;
use gelray::shared::Shared;
use gelray::view::picture::{Frame, Picture};
use gelray::volume::coefficients::Coefficients;
use gelray::volume::field::{Field, Sampled, Spot};
use gelray::volume::grid::{Grid, Scalars};
use glam::{DAffine3, DMat3, DVec3, Vec3};
use hecs::Entity;
use timed::{Setting, Spread, is_quick, on_threads};

const FILTERS: [Filter; 4] =
    [Filter::Linear, Filter::Cubic, Filter::CatmullRom, Filter::Interpolating];
/// Voxels along each axis of the field of Marschner and Lobb.
const VOXELS: usize = 40;

fn main() {
    on_threads(2, || {
        marschner_lobb();
        half_resolution();
        edits();
    });
}

/// ρ of Marschner and Lobb 1994, over −1..1 on each axis: f_M = 6, α = 1/4.
fn field(p: DVec3) -> f64 {
    let ring = (2.0 * PI * 6.0 * (PI * p.truncate().length() / 2.0).cos()).cos();
    (1.0 - (PI * p.z / 2.0).sin() + 0.25 * (1.0 + ring)) / 2.5
}

fn slope(p: DVec3) -> DVec3 {
    let h = 1e-5;
    let along = |axis: DVec3| (field(p + axis * h) - field(p - axis * h)) / (2.0 * h);
    DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
}

/// How far off the surface ρ = 1/2 is found in each filter, and by how much its normals are turned.
fn marschner_lobb() {
    let h = 2.0 / (VOXELS - 1) as f64;
    let grid = Grid::axis_aligned([VOXELS; 3], [h; 3], [-1.0; 3]).expect("a grid of 40³ voxels");
    let index = |at: usize| [at % VOXELS, at / VOXELS % VOXELS, at / (VOXELS * VOXELS)];
    let place = |at: usize| DVec3::from(index(at).map(|n| n as f64)) * h - DVec3::ONE;
    let voxels = (0..grid.voxels()).map(|at| field(place(at)) as f32).collect();
    let scalars = Scalars::F32(Shared::new(voxels));
    let splines = Coefficients::of(&scalars, &grid, &gelray::schedule::Watch::default()).values;
    // On the surface z is a function of x and y.
    let on = (0..200 * 200).map(|n| {
        let (x, y) = (f64::from(n % 200) / 110.0 - 0.9, f64::from(n / 200) / 110.0 - 0.9);
        let ring = (2.0 * PI * 6.0 * (PI * x.hypot(y) / 2.0).cos()).cos();
        DVec3::new(x, y, (0.25 * (1.0 + ring) - 0.25).asin() * 2.0 / PI)
    });
    let on: Vec<_> = on.collect();
    println!("Marschner and Lobb, 40³: the surface ρ = 1/2 at {} places", on.len());
    println!(
        "  {:14} {:>31} {:>31}",
        "", "position, voxels, rms / worst", "normal, degrees, rms / worst"
    );
    for filter in FILTERS {
        let scalars = if filter == Filter::Interpolating { &splines } else { &scalars };
        let made = Field::new(scalars, &grid, filter);
        let errors: Vec<[f64; 2]> = on.iter().map(|&p| error(&made, p, h)).collect();
        let rms = |i: usize| {
            (errors.iter().map(|e| e[i] * e[i]).sum::<f64>() / errors.len() as f64).sqrt()
        };
        let worst = |i: usize| errors.iter().map(|e| e[i]).fold(0.0, f64::max);
        println!(
            "  {:14} {:>20.3} {:>10.3} {:>20.2} {:>10.2}",
            format!("{filter:?}"),
            rms(0),
            worst(0),
            rms(1),
            worst(1)
        );
    }
}

/// The distance in voxels to where the field takes the value that it has at `p`, to first order, and the turn of its normal.
fn error(made: &Field, p: DVec3, h: f64) -> [f64; 2] {
    let place = (p + DVec3::ONE) / h;
    let cell = place.floor();
    let spot = Spot {
        cell: cell.to_array().map(|n| n as usize),
        part: (place - cell).to_array().map(|n| n as f32),
    };
    let mut found = [Sampled::default()];
    made.sample(Level::new(), &[spot], &mut found);
    let truth = slope(p);
    let gradient = Vec3::from(found[0].gradient).as_dvec3();
    let off = (f64::from(found[0].value) - field(p)).abs() / truth.length() / h;
    [off, gradient.angle_between(truth).to_degrees()]
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

/// Half the resolution against the whole, whose spline at short steps is the truth; and what frames of it and of the whole take.
fn half_resolution() {
    let ways: [Way; 5] =
        [None, Some(FILTERS[0]), Some(FILTERS[1]), Some(FILTERS[2]), Some(FILTERS[3])];
    for size in [380, 1000] {
        let mut whole = head(size);
        reconstruct(&mut whole, Some(Filter::Interpolating));
        whole.sample(|sampling| sampling.distance_mm = Some(0.25));
        whole.run();
        let truth = picture(&whole);
        whole.sample(|sampling| sampling.distance_mm = Some(1.0));
        let mut half = head(size);
        halve(&mut half);
        println!(
            "\na head of half its resolution against the whole, {size} × {size}, a ray a pixel"
        );
        println!(
            "  {:22} {:>9} {:>8} {:>16} {:>16} {:>7}",
            "", "PSNR, dB", "SSIM", "half, cast ms", "whole, cast ms", "ratio"
        );
        let mut told = vec![(0.0, 0.0); ways.len()];
        let mut times = vec![[Vec::new(), Vec::new()]; ways.len()];
        for again in 0..if is_quick() { 2 } else { 5 } {
            for (way, (told, times)) in ways.iter().zip(told.iter_mut().zip(&mut times)) {
                for (setting, times) in [&mut half, &mut whole].into_iter().zip(times) {
                    reconstruct(setting, *way);
                    // A step a hair off is another step: rays are cast again.
                    setting.sample(|s| s.distance_mm = Some(1.0 + 1e-9 * f64::from(again)));
                    times.push(seconds(&setting.run().0, &["cast"]));
                }
                if again == 0 {
                    let off =
                        compare(&picture(&half), &truth).expect("pictures of one size").linear;
                    *told = (off.psnr_db, off.ssim);
                }
            }
        }
        let median = |times: &[f64]| Spread::of(times).median * 1e3;
        let colors = median(&times[0][1]);
        for (way, ((psnr, ssim), [of_half, of_whole])) in ways.iter().zip(told.iter().zip(&times)) {
            println!(
                "  {:22} {psnr:>9.2} {ssim:>8.4} {:>16.1} {:>16.1} {:>7.2}",
                name(*way),
                median(of_half),
                median(of_whole),
                median(of_whole) / colors
            );
        }
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
