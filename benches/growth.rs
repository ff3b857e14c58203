//! How preparation grows with a volume: seconds from voxels to gel, and the most memory, over the voxels' own bytes and beside
//! what the plan says before anything is made.
//!
//! The growing volumes are made by formula in a copy of this program each, so that the peak of one is not another's. The
//! edits are of the head in one world: CT data where `GELRAY_DATA` is set, else the phantom. Two threads; `--quick` leaves
//! out the largest volume and repeats less.

#[allow(dead_code, reason = "other benches change how a view samples")]
mod timed;

use gelray::Renderer;
use gelray::components::{
    Classify, Color, Contour, Light, Material, OpacityUnit, Order, Sampling, Toward, View,
};
use gelray::measure::cost::FRAME;
use gelray::scene::Source;
use gelray::shared::Shared;
use gelray::view::extent::Extent;
use gelray::volume::bricks::EDGE;
use gelray::volume::classification::Classifier;
use gelray::volume::gradients::Gradients;
use gelray::volume::grid::{Grid, Scalar, Scalars};
use gelray::volume::layer::Opacity;
use gelray::volume::ranges::Ranges;
use hecs::World;
use rayon::prelude::*;
use timed::{Setting, Spread, is_quick, on_threads};

const THREADS: usize = 2;
/// A contour of bone, alone, under lights that stand still.
const HEAD: &str = r#"
[[entity]]
name = "head"
volume = { file = "cthead.nrrd", stand_in = "phantom:head", spacing_mm = [1, 1, -2], center = [16, -3, 0] }
classify = { iso = [{ value = 1300 }] }
material = { diffuse = 0.85, two_sided = false }

[[entity]]
name = "key"
light = { toward = [-0.5, -0.7, 0.6] }

[[entity]]
name = "observer"
view = { azimuth = 30, elevation = 18, height_mm = 284, size = [380, 380] }
"#;
/// Given to a copy of this program, with the name of the volume that it is to prepare.
const GROWN: &str = "--grown";

/// A volume made by formula, its seconds and its most memory over its voxels' bytes: floors.
struct Grown {
    name: &'static str,
    scalars: fn() -> (Scalars, usize),
    seconds: f64,
    peak: f64,
}

const GROWN_VOLUMES: [Grown; 3] = [
    Grown { name: "256³ u16 shell", scalars: || shell(256), seconds: 0.1, peak: 3.0 },
    Grown { name: "512³ u16 shell", scalars: || shell(512), seconds: 0.4, peak: 2.0 },
    Grown { name: "1024³ u8 sparse", scalars: || sparse(1024), seconds: 2.5, peak: 2.0 },
];

fn main() {
    let asked = std::env::args().skip_while(|argument| argument != GROWN).nth(1);
    if let Some(grown) = asked.and_then(|name| GROWN_VOLUMES.iter().find(|v| v.name == name)) {
        return on_threads(THREADS, || tell(grown));
    }
    println!("from voxels to gel, {THREADS} threads");
    for Grown { name, seconds, peak, .. } in &GROWN_VOLUMES {
        if is_quick() && name.starts_with("1024") {
            continue;
        }
        let copy = std::env::current_exe().expect("a bench is a program");
        let copy = std::process::Command::new(copy).args([GROWN, name]).output();
        let told = copy.map_or_else(
            |error| error.to_string(),
            |output| String::from_utf8_lossy(&output.stdout).into_owned(),
        );
        println!("{name:18} (floors {seconds} s, {peak} ×): {told}");
    }
    on_threads(THREADS, edits);
}

/// A soft ball in air: a contour of it is a thin shell.
fn shell(n: usize) -> (Scalars, usize) {
    let radius = n as f32 * 0.4;
    let value = |[x, y, z]: [f32; 3]| {
        let away = radius - (x * x + y * y + z * z).sqrt();
        ((away / 8.0 + 0.5).clamp(0.0, 1.0) * 2000.0) as u16
    };
    (Scalars::U16(Shared::new(field(n, value))), n)
}

/// Small balls in a volume that is empty else, one in each block of 256³ voxels.
fn sparse(n: usize) -> (Scalars, usize) {
    let value = |place: [f32; 3]| {
        let within = place.map(|c| c.rem_euclid(256.0) - 128.0);
        let squared: f32 = within.iter().map(|c| c * c).sum();
        if squared > 576.0 {
            0
        } else {
            ((20.0 - squared.sqrt()) * 25.0 + 100.0).clamp(0.0, 200.0) as u8
        }
    };
    (Scalars::U8(Shared::new(field(n, value))), n)
}

/// A value at each of n³ voxels, from its place about the middle.
fn field<T: Scalar + Default>(n: usize, value: impl Fn([f32; 3]) -> T + Sync) -> Vec<T> {
    let mut made = vec![T::default(); n * n * n];
    let place = |index: usize| index as f32 - (n - 1) as f32 / 2.0;
    made.par_chunks_mut(n * n).enumerate().for_each(|(z, slice)| {
        for (at, voxel) in slice.iter_mut().enumerate() {
            *voxel = value([place(at % n), place(at / n), place(z)]);
        }
    });
    made
}

fn world((scalars, n): (Scalars, usize)) -> World {
    let middle = -((n - 1) as f64) / 2.0;
    let grid = Grid::axis_aligned([n; 3], [1.0; 3], [middle; 3]).expect("a cube is a grid");
    let value = if matches!(scalars, Scalars::U8(_)) { 100.0 } else { 1000.0 };
    let classify = Classify { iso: vec![Contour::at(value)], ..Classify::default() };
    let mut world = World::new();
    world.spawn((Order(0), grid, scalars, classify, Material::default(), OpacityUnit(1.0)));
    let toward = Toward::Direction([0.3, -0.8, 0.5]);
    world.spawn((Order(1), Light { toward, strength: 1.0, color: Color::WHITE }));
    let view = View { size: [380, 380], azimuth: 30.0, elevation: 15.0, ..View::default() };
    let extent = Extent::of(grid.corners()).expect("a grid has corners");
    world.spawn((Order(2), view, Sampling::default(), extent));
    world
}

/// Tells seconds and memory of one picture.
fn tell(grown: &Grown) {
    let voxels = (grown.scalars)();
    let bytes = voxels.0.bytes() as f64;
    let mut world = world(voxels);
    let before = timed::peak_megabytes() * 1e6;
    let busy = timed::busy_seconds();
    let renderer = Renderer::new().expect("the schedule is sound");
    let planned = planned(&renderer, &world).map(|made| before + made);
    let rendered = renderer.render(&mut world);
    let ran = rendered.expect("a volume made by formula renders").ran;
    let prepared = ran.iter().filter(|ran| !FRAME.contains(&ran.name));
    let stages: Vec<_> = prepared
        .clone()
        .filter(|ran| ran.made > 0)
        .map(|ran| format!("{} {:.0}", ran.name, ran.seconds * 1e3))
        .collect();
    let frame: f64 = ran.iter().map(|ran| ran.seconds).sum();
    let seconds: f64 = prepared.map(|ran| ran.seconds).sum();
    let most = timed::peak_megabytes() * 1e6;
    let (peak, [bound, expected]) = (most / bytes, planned.map(|bytes| bytes / most));
    println!(
        "prepared in {seconds:.3} s ({} ms), with the frame {frame:.3} s, {:.2} s of all threads; most memory {peak:.2} × its voxels (before: {:.2} ×), of which the plan bounds {bound:.2} × and expects {expected:.2} ×; {}",
        stages.join(", "),
        timed::busy_seconds() - busy,
        before / bytes,
        looked_at(&mut world)
    );
}

/// The most bytes that is to be made of a world, and what is expected, as `gelray plan` has them.
fn planned(renderer: &Renderer, world: &World) -> [f64; 2] {
    let plans = renderer.schedule().waves().iter().flatten().map(|job| (job.plan)(world));
    plans.fold([0.0; 2], |[most, expected], plan| {
        [most + plan.bytes() as f64, expected + plan.expected() as f64]
    })
}

/// How many bricks there are, how many of them may show something by their ranges, and how many are kept.
fn looked_at(world: &mut World) -> String {
    let mut volumes = world.query_mut::<(&Grid, &Ranges, &Classify, &Opacity)>().into_iter();
    let (grid, ranges, classify, opacity) = volumes.next().expect("a volume was prepared");
    let classifier = Classifier::new(classify, &Material::default(), 1.0);
    let gradients = Gradients::new(grid);
    let counts = opacity.voxels.counts();
    let may_show = |at: &usize| {
        let brick = [at % counts[0], at / counts[0] % counts[1], at / (counts[0] * counts[1])];
        let range = ranges.around(brick);
        classifier
            .may_show(range, gradients.at_most(range.spread, brick.map(|b| b * EDGE), [EDGE; 3]))
    };
    let bricks: usize = counts.iter().product();
    let showing = (0..bricks).filter(may_show).count();
    format!("{bricks} bricks, {showing} may show, {} stored", opacity.voxels.stored().count())
}

/// From an edit to the picture of it, in one world.
fn edits() {
    let mut setting = Setting::open(&Source::inline("head", HEAD)).expect("the head is a scene");
    setting.warnings.iter().for_each(|warning| println!("{warning}"));
    setting.run();
    let repeat = if is_quick() { 6 } else { 30 };
    println!("\nfrom an edit to a picture of the head, ms, median [min–max] of {repeat}");
    let classify = |step: u32, setting: &mut Setting| {
        for classify in setting.world.query_mut::<&mut Classify>() {
            for contour in &mut classify.iso {
                contour.value += if step.is_multiple_of(2) { 40.0 } else { -40.0 };
            }
        }
    };
    let light = |step: u32, setting: &mut Setting| {
        for light in setting.world.query_mut::<&mut Light>() {
            light.strength *= if step.is_multiple_of(2) { 0.8 } else { 1.25 };
        }
    };
    edit("an isovalue", repeat, &mut setting, classify);
    edit("a light", repeat, &mut setting, light);
    edit("the view", repeat, &mut setting, |step, setting| setting.turn(f64::from(step) * 11.0));
}

fn edit(what: &str, repeat: u32, setting: &mut Setting, change: impl Fn(u32, &mut Setting)) {
    let mut runs = Vec::new();
    for step in 0..repeat {
        change(step, setting);
        runs.push(setting.run());
    }
    let whole: Vec<_> = runs.iter().map(|(_, seconds)| *seconds).collect();
    let stages = runs[0].0.iter().filter(|ran| ran.made > 0).map(|ran| ran.name);
    let stages: Vec<_> = stages
        .map(|stage| {
            let spent = runs.iter().flat_map(|(ran, _)| ran).filter(|ran| ran.name == stage);
            let spent = Spread::of(&spent.map(|ran| ran.seconds).collect::<Vec<_>>());
            format!("{stage} {:.1}", spent.median * 1e3)
        })
        .collect();
    println!("{what:14} {:>24}   {}", Spread::of(&whole).milliseconds(), stages.join(", "));
}
