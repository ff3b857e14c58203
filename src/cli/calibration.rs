//! `render --target`: the cheapest settings that keep a goal, from a short calibration in passing.
//!
//! The choices of `trade` are swept over a picture of a fraction of the size; those on its front are tried at the full size,
//! and the best of them is trimmed by what can be turned continuously. There an accuracy is measured at some thousand pixels
//! that are cast exactly once, and cost is counted in rays and samples: no clock is looked at, and equal commands choose equal
//! settings. Only a goal of milliseconds is timed.

use gelray::components::{Sampling, View};
use gelray::scene::{Scene, Source, overridden};

use super::failure::{Failure, tell};
use super::flags::Flags;
use super::goal::Goal;
use super::interrupt::Interrupt;
use super::trade_points::{Choice, Point, best, combinations, on_front, singles, stated};
use super::trade_scene::TradeScene;
use super::trimming::{Bench, Tried};
use super::{bound, view_name};

/// Pixels of the picture that choices are swept over, at the most.
const SWEPT: f64 = 40_000.0;
/// How many combinations are swept.
const COMBINATIONS: usize = 24;
/// What is not turned for a target: it changes other things than accuracy, or what it misses or costs is not known from few
/// pixels.
const LEFT: [&str; 4] = ["skip", "texel", "outlines", "per_voxel"];

/// The scene with settings that keep `goal` at so many views of a turn; says which, and what is expected of them.
pub fn calibrated(
    scene: Scene,
    (goal, views): (Goal, u32),
    interrupt: &Interrupt,
    flags: &Flags,
) -> Result<Scene, Failure> {
    let size = scene.world.query::<&View>().iter().next().map_or([1, 1], |view| view.size);
    let mut traded = TradeScene::new(scene, views, &interrupt.watch)?;
    bound::check_memory(traded.renderer.schedule(), &traded.scene.world, flags)?;
    interrupt.work_begins();
    traded.resize(fraction(size));
    let swept = sweep(&mut traded, matches!(goal, Goal::Milliseconds(_)))?;
    traded.resize(size);
    let (sampling, expected) = match goal {
        Goal::Max(_) | Goal::Ssim(_) => at_a_fraction(&swept, goal)?,
        Goal::Psnr(_) | Goal::Milliseconds(_) => {
            let front: Vec<&Sampling> =
                on_front(&swept).into_iter().map(|at| &swept[at].sampling).collect();
            let Tried { sampling, told, .. } = Bench::new(&mut traded, goal)?.choose(&front)?;
            (sampling, told)
        }
    };
    if !flags.quiet {
        tell(format_args!("{expected}\n{}", stated(&sampling)));
    }
    state(traded.into_scene(), &sampling)
}

/// A size of so few pixels that a sweep is short, of the same shape.
fn fraction(size: [u32; 2]) -> [u32; 2] {
    let pixels: f64 = size.iter().map(|&n| f64::from(n)).product();
    let part = (SWEPT / pixels).sqrt().min(1.0);
    size.map(|n| ((f64::from(n) * part).round() as u32).max(1))
}

/// What each knob, and some combinations, cost and are off by.
fn sweep(traded: &mut TradeScene, timed: bool) -> Result<Vec<Point>, Failure> {
    traded.find_references(Some(0.0))?;
    let mut choices = singles(&traded.base, traded.distance);
    choices.retain(|(_, knobs, _)| knobs.iter().all(|knob| !LEFT.contains(&knob.as_str())));
    let mut points = Vec::new();
    measure(traded, choices, timed, &mut points)?;
    let combined = combinations(&points, COMBINATIONS);
    measure(traded, combined, timed, &mut points)?;
    Ok(points)
}

fn measure(
    traded: &mut TradeScene,
    choices: Vec<Choice>,
    timed: bool,
    points: &mut Vec<Point>,
) -> Result<(), Failure> {
    for choice in choices {
        let mut point = traded.measure(choice, if timed { 3 } else { 1 })?;
        if !timed {
            let work = point.work();
            point.times = work / points.first().map_or(work, Point::work);
            point.milliseconds = work;
        }
        points.push(point);
    }
    Ok(())
}

/// The best of what was swept, for measures that no few pixels tell.
fn at_a_fraction(swept: &[Point], goal: Goal) -> Result<(Sampling, String), Failure> {
    let Some(point) = best(swept, goal) else {
        return Err(Failure::Said(
            "no settings that were tried keep the target; ask for less, or look at what `gelray trade` finds"
                .to_owned(),
        ));
    };
    let expected = format!(
        "{}: at a fraction of the size at most {:.4} off, SSIM {:.4}, {:.1} dB, and {:.2} times the work of what the scene states",
        point.name,
        point.max,
        point.ssim,
        point.psnr_db(),
        point.times
    );
    Ok((point.sampling.clone(), expected))
}

/// The scene with such settings, in its world and in its text.
fn state(mut scene: Scene, sampling: &Sampling) -> Result<Scene, Failure> {
    let wrong = |error: toml::ser::Error| {
        Failure::Said(format!("the settings that were chosen cannot be written ({error})"))
    };
    let table = toml::Table::try_from(sampling).map_err(wrong)?;
    let view = view_name::view_name(&scene.resolved);
    let change = |(key, value)| format!("{view}.sampling.{key}={value}");
    let changes: Vec<String> = table.iter().map(change).collect();
    scene.resolved = overridden(&Source::inline(&scene.name, &scene.resolved), &changes)?;
    for own in scene.world.query_mut::<&mut Sampling>() {
        *own = sampling.clone();
    }
    Ok(scene)
}
