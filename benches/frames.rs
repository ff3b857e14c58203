//! What a scene takes, stage by stage, in lines for a script: its first frame, a turn of the view, an edit of its isovalues.
//!
//! `frames SCENE THREADS REPEAT`: an embedded scene or a file; prints `kind stage milliseconds`, the least of some runs.
//! `compare.sh` runs it for two commits by turns.

#[allow(dead_code, reason = "other benches print spreads of seconds")]
mod timed;

use std::collections::BTreeMap;

use gelray::components::Classify;
use gelray::scene::Source;
use gelray::view::samples::Samples;
use timed::{Setting, on_threads};

/// The least seconds of each stage of each kind of run.
type Least = BTreeMap<(&'static str, &'static str), f64>;

fn note(least: &mut Least, kind: &'static str, setting: &mut Setting) {
    let (ran, whole) = setting.run();
    let stages = ran.iter().filter(|ran| ran.made > 0).map(|ran| (ran.name, ran.seconds));
    for (stage, seconds) in stages.chain([("whole", whole)]) {
        let known = least.entry((kind, stage)).or_insert(f64::INFINITY);
        *known = known.min(seconds);
    }
}

/// Moves every stated value by a little, so that all is classified again.
fn edit(setting: &mut Setting, by: f32) {
    for classify in setting.world.query_mut::<&mut Classify>() {
        classify.iso.iter_mut().for_each(|contour| contour.value += by);
        classify.regions.iter_mut().for_each(|tissue| tissue.value += by);
        classify.transfer.iter_mut().for_each(|point| point.value += by);
        let points = classify.materials.iter_mut().flat_map(|m| &mut m.probability);
        points.for_each(|point| point[0] += by);
    }
}

fn main() {
    let mut told = std::env::args().skip(1).filter(|argument| !argument.starts_with("--"));
    let scene = told.next().unwrap_or_else(|| "figure_06a".to_owned());
    let mut number = |or: usize| told.next().and_then(|n| n.parse().ok()).unwrap_or(or);
    let (threads, repeat) = (number(2), number(5));
    let source = Source::open(&scene).expect("the scene is read");
    let mut least = Least::new();
    on_threads(threads, || {
        for _ in 0..repeat.min(3) {
            let mut setting = Setting::open(&source).expect("the scene is loaded");
            note(&mut least, "first", &mut setting);
        }
        let mut setting = Setting::open(&source).expect("the scene is loaded");
        setting.run();
        let made = setting.world.query_mut::<&Samples>().into_iter().next();
        made.inspect(|Samples(samples)| eprintln!("{:?}", samples.counts));
        for turn in 0..repeat {
            setting.turn(20.0 + 1e-3 * turn as f64);
            note(&mut least, "turn", &mut setting);
        }
        for again in 0..repeat {
            edit(&mut setting, if again % 2 == 0 { 0.5 } else { -0.5 });
            note(&mut least, "edit", &mut setting);
        }
    });
    for ((kind, stage), seconds) in least {
        println!("{kind} {stage} {:.4}", seconds * 1e3);
    }
}
