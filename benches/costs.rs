//! The paper's §7 on the paper's sizes: seconds per stage, what a frame costs in each way of casting, and the floors.
//!
//! 256 × 256 × 113 voxels, 380 × 380 pixels, two threads; the head of CT data where `GELRAY_DATA` is set, else the phantom.
//! Lights are fixed and nothing is specular, so that a turn of the view casts rays and does nothing else; samples are 1 mm
//! apart, as voxels are, where nothing else is said. Ways of casting are interleaved view by view, ratios are of one view's
//! frames, and medians are over views. `--quick` takes fewer.

#[allow(dead_code, reason = "other benches tell what threads were busy with")]
mod timed;
mod way;

use gelray::components::{Ellipsoid, Mesh, Sampling, Surface};
use gelray::measure::cost::{COLORS, FRAME, paper_costs};
use gelray::measure::variants;
use gelray::resolve::resolve;
use gelray::scene::{EMBEDDED, Source};
use gelray::schedule::Ran;
use timed::{Spread, is_quick, on_threads};
use way::{Way, compare, open};

const THREADS: usize = 2;
/// Given to a copy of this program that makes one frame and tells its memory.
const PEAK: &str = "--peak-memory";

fn main() {
    on_threads(THREADS, || {
        if std::env::args().any(|argument| argument == PEAK) {
            return tell_peak_memory();
        }
        let mut floors = Vec::new();
        stages(&mut floors);
        frames(&mut floors);
        polygons(&mut floors);
        floors.push(Floor::at_most("most memory of a frame, MB", 250.0, peak_memory()));
        println!("\nfloors");
        floors.iter().for_each(Floor::print);
        scan_conversion();
        shadows();
        textures();
    });
}

/// What must be reached, and what was.
struct Floor {
    what: &'static str,
    limit: f64,
    is_least: bool,
    measured: f64,
}

impl Floor {
    fn at_most(what: &'static str, limit: f64, measured: f64) -> Self {
        Self { what, limit, is_least: false, measured }
    }

    fn at_least(what: &'static str, limit: f64, measured: f64) -> Self {
        Self { what, limit, is_least: true, measured }
    }

    fn print(&self) {
        let Self { what, limit, is_least, measured } = self;
        let met = if *is_least { measured >= limit } else { measured <= limit };
        let (bound, met) = (if *is_least { "≥" } else { "≤" }, if met { "met" } else { "MISSED" });
        println!("  {what:46} {measured:>9.2}   {bound} {limit:<6} {met}");
    }
}

/// A scene of the program; `None`, with a line that says so, where there is none of that name.
fn scene(name: &str) -> Option<Source> {
    let found = EMBEDDED.iter().any(|(known, _)| *known == name);
    if !found {
        println!("\n{name}: no such scene, left out");
    }
    found.then(|| Source::embedded(name).ok()).flatten()
}

/// Figure 6a without its planes, cast in some way.
fn alone(name: &'static str, sampling: impl Fn(&mut Sampling)) -> Way {
    let whole = Source::embedded("figure_06a").expect("figure 6a is embedded");
    let mut way = Way::new(name, &whole, sampling);
    variants::take_polygons(&mut way.setting.world);
    way.setting.run();
    way
}

fn seconds(ran: &[Ran], wanted: impl Fn(&str) -> bool) -> f64 {
    ran.iter().filter(|ran| wanted(ran.name)).map(|ran| ran.seconds).sum()
}

/// Seconds of each stage, of scenes read anew, beside the paper's.
fn stages(floors: &mut Vec<Floor>) {
    let source = Source::embedded("figure_06a").expect("figure 6a is embedded");
    let mut runs = Vec::new();
    for _ in 0..if is_quick() { 2 } else { 5 } {
        let mut setting = open(&source);
        if runs.is_empty() {
            setting.warnings.iter().for_each(|warning| println!("{warning}"));
        }
        runs.push(setting.run().0);
    }
    println!("figure_06a, first frame, {THREADS} threads: seconds, median of {}", runs.len());
    let of = |wanted: &dyn Fn(&str) -> bool| {
        Spread::of(&runs.iter().map(|ran| seconds(ran, wanted)).collect::<Vec<_>>()).median
    };
    for Ran { name, .. } in runs[0].iter().filter(|ran| ran.made > 0) {
        let spent = of(&|stage| stage == *name);
        let told = paper_costs(name).next().map_or_else(String::new, |paper| {
            format!("paper {} s, {:.0} times", paper.seconds, paper.seconds / spent)
        });
        println!("  {name:46} {spent:>9.4}   {told}");
    }
    let preparation = of(&|stage| !FRAME.contains(&stage));
    floors.push(Floor::at_most("preparation, s", 0.5, preparation));
}

fn a_ray_a_pixel(sampling: &mut Sampling) {
    (sampling.coarsest, sampling.finest) = (4, 4);
}

fn half_a_voxel(sampling: &mut Sampling) {
    sampling.distance_mm = Some(0.5);
}

fn exact(sampling: &mut Sampling) {
    *sampling = sampling.exact();
}

/// What a frame of a rotation takes, with polygons and without, in each way of casting.
fn frames(floors: &mut Vec<Floor>) {
    let mixed = Source::embedded("figure_06a").expect("embedded");
    let mut ways = [
        alone("volume alone, adaptive", |_| ()),
        alone("volume alone, a ray a pixel", a_ray_a_pixel),
        Way::new("three polygons, adaptive", &mixed, |_| ()),
        Way::new("three polygons, a ray a pixel", &mixed, a_ray_a_pixel),
        Way::new("three polygons, adaptive, samples 0.5 mm apart", &mixed, half_a_voxel),
    ];
    let (views, repeat) = if is_quick() { (4, 2) } else { (18, 5) };
    for view in 0..views {
        let azimuth = 360.0 / f64::from(views) * f64::from(view) + 5.0;
        for way in &mut ways {
            way.view(azimuth, repeat);
        }
    }
    let mut brute = alone("volume alone, exact: brute force", exact);
    let mut beside = alone("volume alone, adaptive, beside it", |_| ());
    for view in 0..if is_quick() { 1 } else { 3 } {
        brute.view(f64::from(view) * 120.0 + 5.0, 1);
        beside.view(f64::from(view) * 120.0 + 5.0, repeat);
    }
    println!("\na frame of a rotation, {views} views, best of {repeat} each");
    println!("  {:46} {:>26}  {:>6}  {:>7}", "", "ms, median [min–max]", "rays/px", "ratio");
    for way in &ways {
        way.print(&ways[0]);
    }
    brute.print(&beside);
    let median = |way: &Way| Spread::of(&way.seconds).median * 1e3;
    floors.push(Floor::at_most("a frame at a ray a pixel, ms", 25.0, median(&ways[1])));
    floors.push(Floor::at_most("a frame, adaptive, ms", 15.0, median(&ways[0])));
    floors.push(Floor::at_most(
        "three polygons to none (paper: 1.6)",
        1.6,
        ways[2].ratio(&ways[0]),
    ));
    let brute = brute.ratio(&beside);
    floors.push(Floor::at_least("brute force to adaptive (paper: over 100)", 100.0, brute));
}

/// Figure 6a with a hundred thousand translucent triangles in place of its planes: two ellipsoids, one in the other.
fn triangles(name: &'static str, sampling: impl Fn(&mut Sampling)) -> Way {
    let mut way = alone(name, sampling);
    for (radius, subdivisions) in [(95.0, 6), (60.0, 5)] {
        let (center, radii) = ([0.0; 3], [radius; 3]);
        let shape = Ellipsoid { center, radii, subdivisions, lumpiness: 0.2 };
        let mesh = Mesh { ellipsoid: Some(shape), ..Mesh::default() };
        let surface = Surface { opacity: 0.4, specular: 0.0, ..Surface::default() };
        way.setting.world.spawn((mesh, surface));
    }
    resolve(&mut way.setting.world).expect("what is left out is filled in");
    way.setting.run();
    way
}

/// What polygons add to a frame, at the same rays: without those between pixels, which their edges ask for.
fn polygons(floors: &mut Vec<Floor>) {
    let mixed = Source::embedded("figure_06a").expect("embedded");
    let no_finer = |sampling: &mut Sampling| sampling.finest = 4;
    let mut ways = [
        alone("no polygon, a ray a pixel", a_ray_a_pixel),
        Way::new("three planes, a ray a pixel", &mixed, a_ray_a_pixel),
        triangles("102,400 triangles, a ray a pixel", a_ray_a_pixel),
        alone("no polygon, at most a ray a pixel", no_finer),
        Way::new("three planes, at most a ray a pixel", &mixed, no_finer),
        triangles("102,400 triangles, at most a ray a pixel", no_finer),
    ];
    let views = if is_quick() { 3 } else { 9 };
    for view in 0..views {
        for way in &mut ways {
            way.view(f64::from(view) * 40.0 + 5.0, 3);
        }
    }
    println!("\npolygons, {views} views, best of 3 each");
    for alike in ways.chunks(3) {
        for way in alike {
            way.print(&alike[0]);
        }
    }
    floors.push(Floor::at_most("three planes to none", 1.3, ways[1].ratio(&ways[0])));
    floors.push(Floor::at_most("102,400 triangles to none", 2.0, ways[2].ratio(&ways[0])));
}

/// The most memory in MB that a copy of this program took for one frame of figure 6a; NaN where the system tells none.
fn peak_memory() -> f64 {
    let copy = std::env::current_exe()
        .map(|program| std::process::Command::new(program).arg(PEAK).output());
    let told = copy.ok().and_then(Result::ok).map(|output| output.stdout);
    let told = told.and_then(|text| String::from_utf8_lossy(&text).trim().parse().ok());
    told.unwrap_or(f64::NAN)
}

fn tell_peak_memory() {
    let source = Source::embedded("figure_06a").expect("figure 6a is embedded");
    open(&source).run();
    println!("{}", timed::peak_megabytes());
}

/// Figure 6b: what scan-conversion takes, and what a frame takes beside figure 6a.
fn scan_conversion() {
    let (Some(scanned), Some(traced)) = (scene("figure_06b"), scene("figure_06a")) else { return };
    let ran = open(&scanned).run().0;
    println!("\nscan-conversion, figure_06b");
    for stage in ["scan_convert", "matte"] {
        let Some(ran) = ran.iter().find(|ran| ran.name == stage) else { continue };
        let each = ran.seconds / f64::from(ran.made.max(1));
        let told = paper_costs(stage).next().map_or_else(String::new, |paper| {
            format!(" (paper: {} s {})", paper.seconds, paper.what)
        });
        println!("  {stage:46} {each:>9.4} s each of {}{told}", ran.made);
    }
    let mut ways = [
        Way::new("polygons scan-converted", &scanned, |_| ()),
        Way::new("polygons traced", &traced, |_| ()),
    ];
    compare(&mut ways, "to traced (paper: 70 / 80)");
}

/// Figure 9: what shadows add to the total voxel colours c_T, and that they add nothing to a frame.
fn shadows() {
    let Some(source) = scene("figure_09") else { return };
    let total = |shadows: bool| {
        let mut setting = open(&source);
        if !shadows {
            variants::take_shadows(&mut setting.world);
        }
        seconds(&setting.run().0, |stage| COLORS.contains(&stage))
    };
    let repeat = if is_quick() { 2 } else { 5 };
    let pairs: Vec<_> = (0..repeat).map(|_| [total(true), total(false)]).collect();
    let column = |i: usize| Spread::of(&pairs.iter().map(|pair| pair[i]).collect::<Vec<_>>());
    let ratio = Spread::of(&pairs.iter().map(|[with, without]| with / without).collect::<Vec<_>>());
    println!("\nshadows, figure_09: total voxel colours, ms");
    println!("  {:46} {:>26}", "with shadows", column(0).milliseconds());
    println!("  {:46} {:>26}", "without", column(1).milliseconds());
    println!("  {:46} {:>9.2}", "ratio (paper: about 2)", ratio.median);
    let mut ways = [
        Way::new("a frame, with shadows", &source, |_| ()),
        Way::new("a frame, without", &source, |_| ()),
    ];
    variants::take_shadows(&mut ways[1].setting.world);
    ways[1].setting.run();
    compare(&mut ways, "to without (paper: 1)");
}

/// Figure 10: what textures add to a frame.
fn textures() {
    let Some(source) = scene("figure_10") else { return };
    println!("\ntextures, figure_10");
    let mut ways = [
        Way::new("a frame, with textures", &source, |_| ()),
        Way::new("a frame, without", &source, |_| ()),
    ];
    variants::take_textures(&mut ways[1].setting.world);
    ways[1].setting.run();
    compare(&mut ways, "to without (paper: about 1.5)");
}
