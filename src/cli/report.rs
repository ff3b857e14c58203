//! `gelray report`: the figures of the paper, its tables, the trade, growth and extremes on one page that needs no network.

use std::path::PathBuf;

use clap::Args;
use gelray::scene::{EMBEDDED, Source};

use super::failure::{Failure, tell};
use super::flags::Flags;
use super::interrupt::Interrupt;
use super::report_figures::CLAIMS;
use super::report_page::{self, Report};
use super::report_parts::{Figure, Parts};
use super::scenes::summary;
use super::steps::Steps;
use super::trade_others::Other;
use super::trade_run::{How, folder, traded};
use super::{outputs, profile_numbers, report_extremes, report_growth, trade_others, trade_page};

pub const EXAMPLES: &str = "\
Examples:
  gelray report -o report --data DIR                 report/index.html; minutes
  gelray report -o report --quick                    fewer settings and runs
  gelray report -o report --resume                   goes on where it was stopped";

/// Flags that have a use here.
pub const TAKES: &[&str] = &["--output", "--size", "--max-memory"];

/// What `report` takes beside the flags of all verbs.
#[derive(Debug, Args)]
pub struct Reporting {
    /// Embedded scenes to show; stages and the trade are of the first [default: the paper's figures]
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',', value_parser = embedded)]
    figures: Vec<String>,
    /// Sweeps fewer settings, and measures each less often
    #[arg(long)]
    quick: bool,
    /// What other programs reach of the first scene, to be drawn beside: lines of name, milliseconds, decibels
    #[arg(long, value_name = "FILE.csv")]
    points: Option<PathBuf>,
    /// Leaves what is measured already as it is
    #[arg(long)]
    resume: bool,
}

/// Measures all parts and writes the page.
pub fn run(reporting: &Reporting, flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("report", TAKES)?;
    let to = folder("report", flags)?;
    let others = reporting.points.as_deref().map_or(Ok(Vec::new()), trade_others::read)?;
    let names: Vec<String> = if reporting.figures.is_empty() {
        CLAIMS.iter().map(|claim| claim.scene.to_owned()).collect()
    } else {
        reporting.figures.clone()
    };
    let interrupt = Interrupt::listen();
    interrupt.work_begins();
    outputs::make_folder(&to.join("parts"))?;
    let steps = Steps::new(names.len() + 1, flags);
    let (repeat, pairs) = if reporting.quick { (1, 6) } else { (5, 15) };
    let parts = Parts {
        folder: to.join("parts"),
        resume: reporting.resume,
        repeat,
        pairs,
        flags,
        interrupt: &interrupt,
        steps: &steps,
    };
    let mut report =
        Report { figures: figures(&parts, &names)?, exact: None, measured: String::new() };
    if let Some((name, _, first)) = report.figures.first() {
        report.exact = Some(parts.exact(name, &first.profile)?);
        report.measured = trade(&parts, name, (reporting, &others))?;
        report.measured.push_str(&report_growth::section(&parts)?);
        report.measured.push_str(&report_extremes::section(&parts)?);
    }
    drop(steps);
    outputs::write_text(&to.join("index.html"), &report_page::words(&report))?;
    if !flags.quiet {
        tell(format_args!("{}: {} figures", to.join("index.html").display(), names.len()));
    }
    Ok(())
}

/// All figures; each is asked for those of the paper's numbers that none before it could tell.
fn figures(parts: &Parts, names: &[String]) -> Result<Vec<(String, String, Figure)>, Failure> {
    let mut figures = Vec::new();
    let mut wanted: Vec<&str> = profile_numbers::keys();
    for name in names {
        let figure = parts.figure(name, &wanted)?;
        let told = figure.profile.numbers.iter().filter(|number| number.ours.is_some());
        let told: Vec<String> = told.map(|number| number.key.clone()).collect();
        wanted.retain(|key| told.iter().all(|told| told != key));
        figures.push((name.clone(), summary(&Source::embedded(name)?.text), figure));
    }
    Ok(figures)
}

/// The trade of a scene, as part of the page.
fn trade(
    parts: &Parts,
    name: &str,
    (reporting, others): (&Reporting, &[Other]),
) -> Result<String, Failure> {
    let to = parts.folder.join("trade");
    let how = if reporting.quick {
        How { repeat: 1, combinations: 4, step: 3, resume: parts.resume }
    } else {
        How { repeat: 7, combinations: 16, step: 1, resume: parts.resume }
    };
    let source = Source::embedded(name)?;
    let (trade, pictures) =
        traded((&source, 1), &to, &how, (parts.flags, parts.interrupt, parts.steps))?;
    Ok(format!("<h2>Speed against accuracy</h2>\n{}", trade_page::body(&trade, &pictures, others)))
}

fn embedded(name: &str) -> Result<String, String> {
    if EMBEDDED.iter().any(|(known, _)| *known == name) {
        Ok(name.to_owned())
    } else {
        Err("names of embedded scenes are expected; `gelray scenes` lists them".to_owned())
    }
}
