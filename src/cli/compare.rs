//! `gelray compare`: the error between two images, in linear light and in sRGB, and where they differ.

use std::borrow::Cow;
use std::path::Path;

use gelray::formats::pictures::weighed;
use gelray::formats::read_picture;
use gelray::measure::error::{Difference, Errors, compare};
use serde::Serialize;

use super::failure::{Failure, print};
use super::flags::Flags;
use super::interrupt::Interrupt;
use super::limit::Limit;
use super::memory;
use super::outputs;
use super::results::Results;
use super::table::table;

/// All that `--stats` writes of a comparison.
#[derive(Debug, Serialize)]
struct Stats<'a> {
    version: &'static str,
    a: Cow<'a, str>,
    b: Cow<'a, str>,
    size: [usize; 2],
    linear: Errors,
    srgb: Errors,
    /// Column and row of the largest difference.
    worst_at: [usize; 2],
    /// Pixels that are not finite, in each.
    non_finite: [usize; 2],
}

/// As many bytes as the first picture takes are taken at the most, while the two are compared and their difference is written.
const COMPARED: u64 = 12;

/// Flags that have a use here.
pub const TAKES: &[&str] = &["--output", "--stats", "--fail-below"];

/// Prints the error between two images, and writes what was asked for; fails where they are less alike than allowed.
pub fn run(a: &Path, b: &Path, flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("compare", TAKES)?;
    if let Some(map) = &flags.output {
        outputs::check_picture(map)?;
    }
    outputs::check(flags, &[a, b])?;
    affordable(a, b, flags)?;
    let (first, second) = (read_picture(a)?, read_picture(b)?);
    let found = compare(&first, &second).map_err(|problem| {
        Failure::Said(format!("{} and {}: {problem}", a.display(), b.display()))
    })?;
    let mut results = Results::default();
    if let Some(map) = &flags.output {
        results.pictures(&[map], &found.worst, &[])?;
    }
    if let Some(path) = &flags.stats {
        let Difference { linear, srgb, worst_at, non_finite, .. } = found;
        let (version, size) = (env!("CARGO_PKG_VERSION"), first.size);
        let [a, b] = [a, b].map(Path::to_string_lossy);
        results.json(path, &Stats { version, a, b, size, linear, srgb, worst_at, non_finite })?;
    }
    results.appear(&Interrupt::default())?;
    if !flags.quiet && flags.output.as_deref().is_none_or(|map| !outputs::is_standard(map)) {
        print(&words(&found))?;
    }
    flags.fail_below.iter().try_for_each(|limit: &Limit| limit.check(&found.linear))
}

/// A failure if two pictures, and what is made of them pixel by pixel, are more than memory may hold.
fn affordable(a: &Path, b: &Path, flags: &Flags) -> Result<(), Failure> {
    let [a, b] = [weighed(a)?, weighed(b)?];
    let compared = a.kept.saturating_mul(COMPARED).max(a.passing.max(b.passing));
    memory::check(a.kept + b.kept + compared, flags.max_memory)
}

fn words(found: &Difference) -> String {
    let heading = ["", "max", "rmse", "psnr", "ssim"].map(str::to_owned);
    let rows = [heading, row("linear", &found.linear), row("sRGB", &found.srgb)];
    let [column, row] = found.worst_at;
    let place = match found.linear.max {
        0.0 => "The pictures are equal.\n".to_owned(),
        _ => format!("They differ most in column {column} of row {row}, from 0 at the top left.\n"),
    };
    let left_out = match found.non_finite {
        [0, 0] => String::new(),
        [a, b] => format!(
            "Left out, as infinite or not numbers: {a} pixels of the first and {b} of the second.\n"
        ),
    };
    table(&rows, &[1, 2, 3, 4]) + &place + &left_out
}

fn row(name: &str, errors: &Errors) -> [String; 5] {
    let Errors { max, rmse, psnr_db, ssim } = errors;
    let psnr = if psnr_db.is_finite() { format!("{psnr_db:.2} dB") } else { "∞ dB".to_owned() };
    [name.to_owned(), format!("{max:.6}"), format!("{rmse:.6}"), psnr, format!("{ssim:.6}")]
}
