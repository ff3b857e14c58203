//! What `gelray render --target psnr=45` lands at, and how its settings compare with the cheapest of an exhaustive grid.
//!
//! Five scenes: a volume alone, three planes, shadows, textures, two volumes. Cost is counted, in rays and samples, so that a
//! busy machine changes nothing. With `--ms` it is a time that is asked for, and each of ten views of a turn is timed.
//! CT data where `GELRAY_DATA` is set, else the phantom; `--quick` takes a coarser grid.

#[allow(dead_code, reason = "other benches measure memory and seconds")]
mod timed;

use std::path::Path;
use std::process::Command;

use gelray::components::{Sampling, View};
use gelray::formats::read_picture;
use gelray::measure::cost::FRAME;
use gelray::measure::error::compare;
use gelray::scene::Source;
use gelray::view::picture::{Frame, Picture};
use gelray::view::samples::{Counts, Samples};
use timed::{Setting, Spread, is_quick};

const GOAL: f64 = 45.0;
const SIZE: u32 = 256;
const VIEWS: u32 = 10;

/// A name, the TOML or the name of an embedded scene, and its Δ.
const SCENES: [(&str, &str, f64); 5] = [
    ("volume alone", ALONE, 0.5),
    ("three planes", "figure_06a", 0.5),
    ("shadows", "figure_09", 0.5),
    ("textures", "figure_10", 0.5),
    ("two volumes", TWO, 1.0),
];

const ALONE: &str = r#"
[[entity]]
name = "head"
volume = { file = "cthead.nrrd", stand_in = "phantom:head", spacing_mm = [1, 1, -2], center = [16, -3, 0] }
classify = { iso = [{ value = 1300 }] }
[[entity]]
name = "observer"
view = { azimuth = 30, elevation = 18, height_mm = 284 }
sampling = { distance_mm = 0.5 }
"#;

const TWO: &str = r#"
[[entity]]
name = "outer"
volume = { file = "phantom:ball" }
classify = { iso = [{ value = 0.2, opacity = 0.2 }] }
[[entity]]
name = "inner"
volume = { file = "phantom:ball", center = [9, 5, 4] }
classify = { iso = [{ value = 0.6, opacity = 0.8 }] }
material = { color = "royalblue" }
[[entity]]
name = "observer"
view = { azimuth = 30, elevation = 18 }
sampling = { distance_mm = 1.0 }
"#;

fn main() {
    if std::env::args().any(|argument| argument == "--ms") {
        times();
        return;
    }
    println!(
        "{:14} {:>8} {:>12} {:>12} {:>8}   settings",
        "scene", "dB", "work", "grid's", "ratio"
    );
    for (what, scene, distance) in SCENES {
        let (file, source) = source(scene);
        let (chosen, work_chosen, settings) = target(&file, &[&format!("psnr={GOAL}")]);
        let mut setting = opened(&source);
        setting.sample(|s| {
            *s = Sampling { distance_mm: Some(distance / 4.0), ..s.exact() };
        });
        setting.run();
        let exact = frame(&setting);
        let landed = decibels(&chosen, &exact);
        let (best, of) = cheapest(&mut setting, distance, &exact);
        println!(
            "{what:14} {landed:8.2} {work_chosen:12.0} {best:12.0} {:8.3}   {settings}; the grid: {of}",
            work_chosen / best
        );
    }
}

/// A scene of the benches' size.
fn opened(source: &Source) -> Setting {
    let mut setting = Setting::open(source).expect("the scene is read");
    let sized = |view: &mut View| view.size = [SIZE; 2];
    setting.world.query_mut::<&mut View>().into_iter().for_each(sized);
    setting
}

/// Milliseconds of a frame at ten views, by the settings that keep seven tenths of the slowest view's.
fn times() {
    println!("{:14} {:>8} {:>8}   ten views, ms; settings", "scene", "asked", "within");
    for (what, scene, _) in SCENES {
        let (file, source) = source(scene);
        let mut setting = opened(&source);
        let start = setting.world.query::<&View>().iter().next().map_or(0.0, |view| view.azimuth);
        let asked = 0.7 * turn(&mut setting, start).into_iter().fold(0.0, f64::max);
        let goal = [&format!("ms={asked}"), "--views", &VIEWS.to_string()];
        let (_, _, settings) = target(&file, &goal);
        let stated: toml::Table =
            settings.parse().expect("the settings are told as a scene states them");
        let sampling: Sampling =
            stated["sampling"].clone().try_into().expect("the settings are those of a view");
        setting.sample(|own| *own = sampling.clone());
        let times = turn(&mut setting, start);
        let within = times.iter().filter(|&&time| time <= 1.1 * asked).count();
        println!("{what:14} {asked:8.2} {within:5}/{VIEWS}   {times:.1?}; {settings}");
    }
}

/// Milliseconds of casting and resampling at each view of a turn, the median of some frames.
fn turn(setting: &mut Setting, start: f64) -> Vec<f64> {
    let mut times = Vec::new();
    for view in 0..VIEWS {
        setting.turn(start + 360.0 * f64::from(view) / f64::from(VIEWS));
        let mut seconds = Vec::new();
        for _ in 0..7 {
            // Frames of equal settings in a row would be kept, and take no time.
            setting.sample(|own| own.tolerance += 1e-6);
            let frame = setting.run().0.into_iter().filter(|ran| FRAME.contains(&ran.name));
            seconds.push(frame.map(|ran| ran.seconds * 1e3).sum());
        }
        times.push(Spread::of(&seconds).median);
    }
    times
}

/// A file of the scene for the program, or its name, and the scene itself.
fn source(scene: &str) -> (String, Source) {
    if !scene.contains('[') {
        return (scene.to_owned(), Source::embedded(scene).expect("it is embedded"));
    }
    let file = std::env::temp_dir().join(format!("gelray-target-{}.toml", std::process::id()));
    std::fs::write(&file, scene).expect("a temporary file is written");
    (file.display().to_string(), Source::inline("scene", scene))
}

/// The picture that the program makes, what it took, and the line of settings.
fn target(scene: &str, goal: &[&str]) -> (Picture, f64, String) {
    let [picture, stats] = ["npy", "json"].map(|end| {
        std::env::temp_dir().join(format!("gelray-target-{}.{end}", std::process::id()))
    });
    let size = format!("{SIZE}x{SIZE}");
    let ran = Command::new(env!("CARGO_BIN_EXE_gelray"))
        .args(["render", scene, "--size", &size, "--target"])
        .args(goal)
        .arg("-o")
        .arg(&picture)
        .arg("--stats")
        .arg(&stats)
        .output()
        .expect("the program runs");
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    assert!(ran.status.success(), "{said}");
    let chosen = said.lines().find(|line| line.starts_with("sampling")).unwrap_or_default();
    let made = read_picture(&picture).expect("the picture is read");
    (made, counted(&stats), chosen.to_owned())
}

fn counted(stats: &Path) -> f64 {
    let text = std::fs::read_to_string(stats).expect("the stats are read");
    let told: serde_json::Value = serde_json::from_str(&text).expect("the stats are JSON");
    let number = |key: &str| told["counts"][key].as_f64().unwrap_or(f64::NAN);
    number("samples") + 8.0 * number("packet_steps") + 32.0 * number("rays")
}

fn work(counts: &Counts) -> f64 {
    counts.samples as f64 + 8.0 * counts.packet_steps as f64 + 32.0 * counts.rays as f64
}

/// The least work of a grid of settings that keep the goal, and which they are.
fn cheapest(setting: &mut Setting, distance: f64, exact: &Picture) -> (f64, String) {
    let step = if is_quick() { 2 } else { 1 };
    let mut best = (f64::INFINITY, String::from("none"));
    let some = |numbers: &'static [f32]| numbers.iter().copied().step_by(step);
    for times in some(&[1.0, 1.41, 2.0, 2.83, 4.0]) {
        for tolerance in some(&[0.01, 0.02, 0.04, 0.08, 0.16]) {
            for stop_at in some(&[0.01, 0.02, 0.05, 0.1, 0.2]) {
                for edge_tolerance in some(&[0.02, 0.2, 0.5]) {
                    for coarsest in [4, 8, 16, 32] {
                        for finest in [1, 2, 4] {
                            let distance_mm = Some(distance * f64::from(times));
                            setting.sample(|s| {
                                *s = Sampling {
                                    distance_mm,
                                    tolerance,
                                    stop_at,
                                    edge_tolerance,
                                    coarsest,
                                    finest,
                                    ..Sampling::default()
                                };
                            });
                            setting.run();
                            let work = work(&counts(setting));
                            if work < best.0 && decibels(&frame(setting), exact) >= GOAL {
                                best = (
                                    work,
                                    format!(
                                        "{times} Δ, {tolerance}, stop {stop_at}, edges {edge_tolerance}, {coarsest} to {finest}"
                                    ),
                                );
                            }
                        }
                    }
                }
            }
        }
    }
    best
}

fn decibels(a: &Picture, b: &Picture) -> f64 {
    compare(a, b).expect("they are of one size").linear.psnr_db
}

fn frame(setting: &Setting) -> Picture {
    setting.world.query::<&Frame>().iter().next().expect("a picture is made").0.clone()
}

fn counts(setting: &Setting) -> Counts {
    setting.world.query::<&Samples>().iter().next().expect("rays are cast").0.counts
}
