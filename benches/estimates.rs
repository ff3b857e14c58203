//! Whether a picture's estimate of its own error holds the truth, how wide it is and what it costs: over scenes, settings, views.
//!
//! The truth is the picture with a ray at every position, samples at a quarter of the distance, no stopping and 32-bit texels.
//! CT data where `GELRAY_DATA` is set, else the phantom; `--quick` takes fewer views and seeds.

#[allow(dead_code, reason = "other benches measure memory")]
mod timed;

use gelray::components::{Estimate, Sampling, View};
use gelray::measure::cost::FRAME;
use gelray::measure::error::compare;
use gelray::measure::judged::Judged;
use gelray::scene::Source;
use gelray::view::picture::{Frame, Picture};
use timed::{Setting, Spread, is_quick};

const SCENES: [(&str, f64); 6] = [
    ("figure_06a", 0.5),
    ("figure_09", 0.5),
    ("figure_10", 0.5),
    ("figure_11", 0.5),
    ("figure_12", 0.2),
    ("minimal_4", 1.0),
];

/// A name, and what it changes of what a scene states; the number is Δ.
type Change = (&'static str, fn(&mut Sampling, f64));

const CHANGES: [Change; 6] = [
    ("as stated", |_, _| {}),
    ("2 Δ", |s, distance| s.distance_mm = Some(2.0 * distance)),
    ("Δ/2, tolerance 0.005", |s, distance| {
        s.distance_mm = Some(0.5 * distance);
        s.tolerance = 0.005;
    }),
    ("tolerance 0.1", |s, _| s.tolerance = 0.1),
    ("coarse", |s, _| {
        s.tolerance = 0.1;
        s.coarsest = 32;
        s.finest = 4;
        s.outlines = false;
    }),
    ("stop at 0.2", |s, _| s.stop_at = 0.2),
];

fn main() {
    let (views, seeds) = if is_quick() { (1, 10) } else { (3, 40) };
    println!(
        "{:12} {:22} {:>8} {:>10} {:>10} {:>8} {:>8}",
        "scene", "settings", "dB", "wide, dB", "holds", "pixels", "cost"
    );
    let mut all = [0, 0];
    for (name, distance) in SCENES {
        for (change, turn) in &CHANGES {
            let mut rows = Vec::new();
            for view in 0..views {
                let azimuth = 20.0 + 113.0 * f64::from(view);
                rows.extend(case(name, (distance, *turn), azimuth, seeds));
            }
            let of = |number: fn(&Row) -> f64| {
                Spread::of(&rows.iter().map(number).collect::<Vec<_>>()).median
            };
            let held = rows.iter().filter(|row| row.held).count();
            println!(
                "{name:12} {change:22} {:8.1} {:10.1} {:>10} {:8.0} {:8.3}",
                of(|row| row.truth),
                of(|row| row.told.high - row.told.low),
                format!("{held}/{}", rows.len()),
                of(|row| row.told.pixels as f64),
                of(|row| row.cost)
            );
            all = [all[0] + held, all[1] + rows.len()];
        }
    }
    println!(
        "{} of {} intervals hold the truth: {:.3}",
        all[0],
        all[1],
        all[0] as f64 / all[1] as f64
    );
}

struct Row {
    truth: f64,
    told: Judged,
    held: bool,
    /// Seconds of the estimate over those of casting and resampling.
    cost: f64,
}

fn case(
    name: &str,
    (distance, turn): (f64, fn(&mut Sampling, f64)),
    azimuth: f64,
    seeds: u32,
) -> Vec<Row> {
    let source = Source::embedded(name).expect("it is embedded");
    let open = || {
        let mut setting = Setting::open(&source).expect("an embedded scene is read");
        setting.turn(azimuth);
        setting.world.query_mut::<&mut View>().into_iter().for_each(|view| view.size = [380; 2]);
        setting
    };
    let mut exact = open();
    exact.sample(|sampling| {
        let mut turned = sampling.clone();
        turn(&mut turned, distance);
        let finer = turned.distance_mm.unwrap_or(distance) / 4.0;
        *sampling = Sampling { distance_mm: Some(finer), ..sampling.exact() };
    });
    exact.run();
    let exact = frame(&exact);
    let mut setting = open();
    setting.sample(|sampling| turn(sampling, distance));
    let (ran, _) = setting.run();
    let of = |ran: &[gelray::schedule::Ran], names: &[&str]| -> f64 {
        ran.iter().filter(|ran| names.contains(&ran.name)).map(|ran| ran.seconds).sum()
    };
    let seconds = of(&ran, &FRAME);
    let truth = compare(&frame(&setting), &exact).expect("they are of one size").linear.psnr_db;
    let judge = |seed: u32| {
        let world = &mut setting.world;
        let views = world.query_mut::<hecs::Entity>().with::<&View>();
        let view = views.into_iter().next().expect("a scene has a view");
        let stated = Estimate { seed, ..Estimate::default() };
        world.insert_one(view, stated).expect("the view is there");
        let (ran, _) = setting.run();
        let mut told = setting.world.query::<&Judged>();
        let told = told.iter().next().expect("the view asks for it").clone();
        let held = told.low <= truth && truth <= told.high;
        Row { truth, told, held, cost: of(&ran, &["judge"]) / seconds }
    };
    (0..seeds).map(judge).collect()
}

fn frame(setting: &Setting) -> Picture {
    setting.world.query::<&Frame>().iter().next().expect("a picture is made").0.clone()
}
