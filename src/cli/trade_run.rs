//! The measurement of a trade: choice after choice, each kept as soon as it is known, and the pictures of the front.

use std::path::{Path, PathBuf};

use gelray::Error;
use gelray::formats::pictures::png_bytes;
use gelray::scene::Source;
use gelray::view::picture::Picture;

use super::failure::Failure;
use super::flags::Flags;
use super::interrupt::Interrupt;
use super::noted::VERSION;
use super::steps::Steps;
use super::trade_points::{Choice, Point, Trade, combinations, on_front, singles};
use super::trade_scene::TradeScene;
use super::{bound, outputs, render};

/// How much is measured.
pub struct How {
    /// How often each choice is timed.
    pub repeat: u32,
    /// How many combinations of knobs are tried.
    pub combinations: usize,
    /// Of the settings of knobs, one in so many.
    pub step: usize,
    /// What is measured already is left as it is.
    pub resume: bool,
}

/// PNGs of a choice on the front: its place among the points, the picture, and where it is off.
pub type Shown = (usize, [Vec<u8>; 2]);

/// The folder that `-o` names.
pub fn folder<'a>(verb: &str, flags: &'a Flags) -> Result<&'a Path, Failure> {
    flags.output.as_deref().filter(|path| !outputs::is_standard(path)).ok_or_else(|| {
        Failure::Misused(format!("`gelray {verb}` needs a folder to write; add -o DIR"))
    })
}

/// Measures a scene from so many views, keeps `trade.json` in a folder, and renders what is on the front.
pub fn traded(
    (source, views): (&Source, u32),
    folder: &Path,
    how: &How,
    (flags, interrupt, steps): (&Flags, &Interrupt, &Steps),
) -> Result<(Trade, Vec<Shown>), Failure> {
    let scene = render::load(source, flags)?;
    outputs::make_folder(folder)?;
    let mut traded = TradeScene::new(scene, views, &interrupt.watch)?;
    bound::check_memory(traded.renderer.schedule(), &traded.scene.world, flags)?;
    interrupt.work_begins();
    let known = if how.resume { known(folder, &traded)? } else { None };
    let trade = measure(&mut traded, folder, known, (how, steps))?;
    let pictures = pictures(&mut traded, &trade)?;
    Ok((trade, pictures))
}

/// What the folder holds of an earlier run of the same scene by the same version.
fn known(folder: &Path, traded: &TradeScene) -> Result<Option<Trade>, Failure> {
    let path = folder.join("trade.json");
    let Ok(text) = std::fs::read_to_string(&path) else { return Ok(None) };
    let trade: Trade = serde_json::from_str(&text).map_err(|error| {
        Failure::Said(format!(
            "{}: is no list of what `gelray trade` measured ({error}); leave --resume away to measure anew",
            path.display()
        ))
    })?;
    let same = trade.settings == traded.scene.resolved
        && trade.version == VERSION
        && trade.threads == rayon::current_num_threads()
        && trade.views == traded.views;
    if same {
        return Ok(Some(trade));
    }
    Err(Failure::Said(format!(
        "{}: was measured of other settings, views, threads or by another version; leave --resume away to measure anew",
        path.display()
    )))
}

/// Measures all choices; each is written as soon as it is known.
fn measure(
    traded: &mut TradeScene,
    folder: &Path,
    known: Option<Trade>,
    (how, steps): (&How, &Steps),
) -> Result<Trade, Failure> {
    let mut singles = singles(&traded.base, traded.distance);
    let mut at = 0..;
    singles.retain(|_| at.next().is_some_and(|at: usize| at.is_multiple_of(how.step)));
    steps.expect(singles.len() + 1);
    steps.begin("the reference: every position, a quarter of the sample distance");
    let reference_rmse = traded.find_references(known.as_ref().map(|k| k.reference_rmse))?;
    steps.done();
    let mut trade = Trade {
        version: VERSION.to_owned(),
        scene: traded.scene.name.clone(),
        settings: traded.scene.resolved.clone(),
        size: traded.size(),
        threads: rayon::current_num_threads(),
        views: traded.views,
        reference_rmse,
        points: Vec::new(),
    };
    let known = known.map(|known| known.points).unwrap_or_default();
    all(traded, (singles, &known), (&mut trade, folder), (how.repeat, steps))?;
    let combined = combinations(&trade.points, how.combinations);
    steps.expect(combined.len());
    all(traded, (combined, &known), (&mut trade, folder), (how.repeat, steps))?;
    Ok(trade)
}

/// Measures some choices, but for those that are known.
fn all(
    traded: &mut TradeScene,
    (choices, known): (Vec<Choice>, &[Point]),
    (trade, folder): (&mut Trade, &Path),
    (repeat, steps): (u32, &Steps),
) -> Result<(), Failure> {
    for choice in choices {
        steps.begin(&choice.0);
        let found = known.iter().find(|point| point.name == choice.0);
        trade.points.push(match found {
            Some(point) => {
                if point.knobs.is_empty() {
                    traded.milliseconds = point.milliseconds;
                }
                point.clone()
            }
            None => traded.measure(choice, repeat)?,
        });
        outputs::write_json(&folder.join("trade.json"), trade)?;
        steps.done();
    }
    Ok(())
}

/// Pictures of the choices on the front, and where they are off.
fn pictures(traded: &mut TradeScene, trade: &Trade) -> Result<Vec<Shown>, Failure> {
    let png = |picture: &Picture| {
        png_bytes(picture, &[]).map_err(|problem| Failure::Said(format!("a picture {problem}")))
    };
    let mut shown = Vec::new();
    for at in on_front(&trade.points) {
        let [picture, difference] = traded.pictures(&trade.points[at].sampling)?;
        shown.push((at, [png(&picture)?, png(&difference)?]));
    }
    Ok(shown)
}

/// A file of text in the folder, whole or not at all.
pub fn write_text(folder: &Path, name: &str, text: &str) -> Result<(), Error> {
    let path: PathBuf = folder.join(name);
    outputs::write_text(&path, text)
}
