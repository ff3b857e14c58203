//! `gelray trade`: what each knob of accuracy costs and buys, and the cheapest settings that keep a goal.

use std::ffi::OsStr;
use std::path::PathBuf;

use clap::Args;

use super::failure::{Failure, print, tell};
use super::flags::Flags;
use super::goal::Goal;
use super::html::page;
use super::interrupt::Interrupt;
use super::steps::Steps;
use super::trade_page::{body, csv};
use super::trade_points::{Point, Trade, best, on_front, psnr_db, stated};
use super::trade_run::{How, folder, traded, write_text};
use super::{contact, trade_others};

pub const EXAMPLES: &str = "\
Examples:
  gelray trade -o trade                              the embedded scene `head`: tables, pictures and a page
  gelray trade scene.toml -o trade --target psnr=45  and the fastest settings that keep 45 dB, to paste
  gelray trade scene.toml -o trade --target ms=20 --views 8
  gelray trade scene.toml -o trade --resume          goes on where it was stopped";

/// Flags that have a use here.
pub const TAKES: &[&str] =
    &["--output", "--size", "--set", "--iso", "--preset", "--channel", "--time", "--max-memory"];

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
    /// What other programs reach, to be drawn beside: lines of name, milliseconds, decibels
    #[arg(long, value_name = "FILE.csv")]
    points: Option<PathBuf>,
    /// Leaves what is measured already as it is
    #[arg(long)]
    resume: bool,
}

/// Measures, writes what was measured, and prints the settings that were asked for.
pub fn run(scene: Option<&OsStr>, trading: &Trading, flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("trade", TAKES)?;
    let folder = folder("trade", flags)?;
    let others = trading.points.as_deref().map_or(Ok(Vec::new()), trade_others::read)?;
    let source = contact::open(scene, flags)?;
    let interrupt = Interrupt::listen();
    let steps = Steps::new(0, flags);
    let how = How {
        repeat: trading.repeat,
        combinations: trading.combinations as usize,
        step: 1,
        resume: trading.resume,
    };
    let (trade, pictures) =
        traded((&source, trading.views), folder, &how, (flags, &interrupt, &steps))?;
    drop(steps);
    write_text(folder, "trade.csv", &csv(&trade))?;
    let title = format!("{}: speed against accuracy", trade.scene);
    write_text(folder, "index.html", &page(&title, &body(&trade, &pictures, &others)))?;
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
