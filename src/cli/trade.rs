//! `gelray trade`: what each knob of accuracy costs and buys, and the cheapest settings that keep a goal.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use clap::Args;
use gelray::Error;
use gelray::formats::pictures::write_picture;
use gelray::formats::whole::check_writable;

use super::failure::{Failure, print, tell};
use super::flags::Flags;
use super::goal::Goal;
use super::interrupt::Interrupt;
use super::noted::VERSION;
use super::trade_page::{csv, page};
use super::trade_points::{
    Choice, Point, Trade, best, combinations, on_front, psnr_db, singles, stated,
};
use super::trade_scene::TradeScene;
use super::{bound, contact, outputs, render};

pub const EXAMPLES: &str = "\
Examples:
  gelray trade -o trade                              the embedded scene `head`: tables, pictures and a page
  gelray trade scene.toml -o trade --target psnr=45  and the fastest settings that keep 45 dB, to paste
  gelray trade scene.toml -o trade --target ms=20 --views 8
  gelray trade scene.toml -o trade --resume          goes on where it was stopped";

/// Flags that have a use here.
pub const TAKES: &[&str] = &["--output", "--size", "--set", "--iso", "--preset", "--max-memory"];

/// What `trade` takes beside the flags of all verbs.
#[derive(Debug, Args)]
pub struct Trading {
    /// Prints the settings that keep it: the fastest for psnr=45, max=0.01 or ssim=0.99, the most exact for ms=20
    #[arg(long, value_name = "MEASURE=NUMBER", value_parser = Goal::parse)]
    target: Option<Goal>,
    /// Views of a turn; errors are those of the worst
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u32).range(1..=360))]
    views: u32,
    /// How often each choice is timed
    #[arg(long, value_name = "N", default_value = "7", value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeat: u32,
    /// How many combinations of knobs are tried
    #[arg(long, value_name = "N", default_value = "16", value_parser = clap::value_parser!(u32).range(0..=1000))]
    combinations: u32,
    /// Leaves what is measured already as it is
    #[arg(long)]
    resume: bool,
}

/// Measures, writes what was measured, and prints the settings that were asked for.
pub fn run(scene: Option<&OsStr>, trading: &Trading, flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("trade", TAKES)?;
    let folder =
        flags.output.as_deref().filter(|path| !outputs::is_standard(path)).ok_or_else(|| {
            Failure::Misused("`gelray trade` needs a folder to write; add -o DIR".to_owned())
        })?;
    let source = contact::open(scene, flags)?;
    let interrupt = Interrupt::listen();
    let scene = render::load(&source, flags)?;
    make(folder)?;
    let mut traded = TradeScene::new(scene, trading.views, &interrupt.watch)?;
    bound::check_memory(traded.renderer.schedule(), &traded.scene.world, flags)?;
    interrupt.work_begins();
    let known = if trading.resume { known(folder, &traded)? } else { None };
    let trade = measure(&mut traded, folder, known, (trading, flags))?;
    write_text(folder, "trade.csv", &csv(&trade))?;
    show(&mut traded, &trade, folder)?;
    write_text(folder, "index.html", &page(&trade))?;
    if !flags.quiet {
        let front = on_front(&trade.points).len();
        tell(format_args!(
            "{}: {} choices, {front} on the front; the reference is known to {:.1} dB",
            folder.join("index.html").display(),
            trade.points.len(),
            psnr_db(trade.reference_rmse)
        ));
    }
    trading.target.map_or(Ok(()), |goal| keep(&trade, goal))
}

/// Prints the settings that keep a goal.
fn keep(trade: &Trade, goal: Goal) -> Result<(), Failure> {
    let Some(point) = best(&trade.points, goal) else {
        let most = trade.points.iter().map(Point::psnr_db).fold(0.0, f64::max);
        let least = trade.points.iter().map(|p| p.milliseconds).fold(f64::INFINITY, f64::min);
        return Err(Failure::Said(format!(
            "no settings that were tried keep the target: the most exact reach {most:.1} dB and the fastest {least:.1} ms; ask for less, or try more --combinations"
        )));
    };
    print(&format!(
        "# {}: {:.2} dB, at most {:.4} off, SSIM {:.4}, {:.1} ms a frame.\n{}\n",
        point.name,
        point.psnr_db(),
        point.max,
        point.ssim,
        point.milliseconds,
        stated(&point.sampling)
    ))
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
    (trading, flags): (&Trading, &Flags),
) -> Result<Trade, Failure> {
    say(flags, format_args!("the reference: every position, a quarter of the sample distance"));
    let reference_rmse = traded.find_references(known.as_ref().map(|k| k.reference_rmse))?;
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
    let singles = singles(&traded.base, traded.distance);
    all(traded, (singles, &known), (&mut trade, folder), (trading, flags))?;
    let combined = combinations(&trade.points, trading.combinations as usize);
    all(traded, (combined, &known), (&mut trade, folder), (trading, flags))?;
    Ok(trade)
}

/// Measures some choices, but for those that are known.
fn all(
    traded: &mut TradeScene,
    (choices, known): (Vec<Choice>, &[Point]),
    (trade, folder): (&mut Trade, &Path),
    (trading, flags): (&Trading, &Flags),
) -> Result<(), Failure> {
    let count = choices.len();
    for (at, choice) in choices.into_iter().enumerate() {
        say(flags, format_args!("{} of {count}: {}", at + 1, choice.0));
        let found = known.iter().find(|point| point.name == choice.0);
        trade.points.push(match found {
            Some(point) => {
                if point.knobs.is_empty() {
                    traded.milliseconds = point.milliseconds;
                }
                point.clone()
            }
            None => traded.measure(choice, trading.repeat)?,
        });
        let text = serde_json::to_string_pretty(&trade)
            .map_err(|error| Failure::Said(format!("trade.json cannot be written ({error})")))?;
        write_text(folder, "trade.json", &(text + "\n"))?;
    }
    Ok(())
}

/// Pictures of the choices on the front, and where they are off.
fn show(traded: &mut TradeScene, trade: &Trade, folder: &Path) -> Result<(), Failure> {
    make(&folder.join("pictures"))?;
    for at in on_front(&trade.points) {
        let [picture, difference] = traded.pictures(&trade.points[at].sampling)?;
        for (end, picture) in [("", &picture), ("_off", &difference)] {
            write_picture(&folder.join(format!("pictures/{at}{end}.png")), picture, &[])?;
        }
    }
    Ok(())
}

/// A line of progress, where it is wanted.
fn say(flags: &Flags, line: std::fmt::Arguments) {
    if flags.verbose || (!flags.quiet && std::io::IsTerminal::is_terminal(&std::io::stderr())) {
        tell(line);
    }
}

fn make(folder: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(folder).map_err(|error| {
        Error::file(
            folder,
            format!("cannot be made ({error}); name a folder whose parent can be written"),
        )
    })?;
    check_writable(&folder.join("trade.json"))
}

fn write_text(folder: &Path, name: &str, text: &str) -> Result<(), Error> {
    let path: PathBuf = folder.join(name);
    outputs::write_text(&path, text)
}
