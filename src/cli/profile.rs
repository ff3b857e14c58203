//! `gelray profile`: the paper's cost table (§7) of a scene, from its spans; or two of them, and whether they differ.

use std::ffi::{OsStr, OsString};
use std::path::Path;

use clap::Args;
use gelray::Error;

use super::failure::{Failure, tell};
use super::flags::Flags;
use super::interrupt::Interrupt;
use super::profile_pair::{self, Compared};
use super::profile_resume::{Begun, begun};
use super::profile_run::Subject;
use super::profile_saved::Profile;
use super::steps::Steps;
use super::{contact, outputs, profile_numbers, profile_table};

pub const EXAMPLES: &str = "\
Examples:
  gelray profile figure_06a                          seconds, counts and bytes of each stage beside the paper's
  gelray profile scene.toml --repeat 20 --csv -o stages.csv
  gelray profile scene.toml --repeat 100 --json -o s.json --resume    goes on where it was stopped
  gelray profile figure_06a figure_06b               two scenes by turns, and whether they differ
  gelray profile scene.toml --a sampling.stop_at=0.02 --b sampling.stop_at=0.1
  gelray profile scene.toml --json -o before.json    and with another binary after.json; then
  gelray profile before.json after.json

A run is whole: from the scene's file to the bytes of the picture's, with nothing kept of the run before. Of two, intervals
hold for all rows together in 19 of 20 cases.";

/// Flags that have a use here: those of a scene that is told about and not rendered.
pub const TAKES: &[&str] = super::plan::TAKES;

/// Runs of each where nothing is stated: of one scene, and of two that are compared.
const REPEAT: [u32; 2] = [5, 20];

/// What `profile` takes beside the flags of all verbs.
#[derive(Debug, Args)]
pub struct Profiling {
    /// Another scene, or a saved profile where the first is one too: is there a difference?
    other: Option<OsString>,
    /// Whole runs, of each [default: 5; 20 where two are compared]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeat: Option<u32>,
    /// Changes the first of two alone, as --set changes both (repeatable)
    #[arg(long, value_name = "ENTITY.COMPONENT.KEY=VALUE")]
    a: Vec<String>,
    /// Changes the second of two alone (repeatable)
    #[arg(long, value_name = "ENTITY.COMPONENT.KEY=VALUE")]
    b: Vec<String>,
    /// Compares seconds of processors, all threads together: what else the machine does matters less
    #[arg(long)]
    busy: bool,
    #[command(flatten)]
    form: Form,
    /// Goes on with what -o holds of the same measurement, until there are as many runs as --repeat says
    #[arg(long, requires = "json")]
    resume: bool,
    /// The stages alone, without the paper's ratios, which take as long again
    #[arg(long)]
    no_ratios: bool,
}

/// How what was measured is written.
#[derive(Debug, Args)]
struct Form {
    /// As JSON: what another `profile` can be compared with
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// As comma-separated numbers
    #[arg(long)]
    csv: bool,
}

/// Measures and prints.
pub fn run(scene: Option<&OsStr>, profiling: &Profiling, flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("profile", TAKES)?;
    let saved: Vec<&Path> =
        scene.into_iter().chain(profiling.other.as_deref()).map(Path::new).collect();
    outputs::check(flags, &saved)?;
    match saved.iter().filter(|path| is_saved(path)).count() {
        0 => {}
        2 => {
            profiling.refuse_measuring()?;
            let [a, b] = [Profile::read(saved[0])?, Profile::read(saved[1])?];
            return profiling.print_pair(&Compared::new(a, b, false, profiling.busy), flags);
        }
        _ => {
            return Err(Failure::Misused(
                "a saved profile is compared with another one; name two of them".to_owned(),
            ));
        }
    }
    let interrupt = Interrupt::listen();
    let two = profiling.other.is_some() || !(profiling.a.is_empty() && profiling.b.is_empty());
    if two {
        pair(scene, profiling, flags, &interrupt)
    } else {
        one(scene, profiling, flags, &interrupt)
    }
}

fn is_saved(path: &Path) -> bool {
    path.extension().is_some_and(|end| end.eq_ignore_ascii_case("json"))
}

/// One scene's stages and the paper's numbers; after an interruption what was measured until then.
fn one(
    scene: Option<&OsStr>,
    profiling: &Profiling,
    flags: &Flags,
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    let subject = Subject::new(contact::open(scene, flags)?, flags, &[], &interrupt.watch)?;
    let begun = begun(profiling.resume, [&subject], flags)?;
    interrupt.work_begins();
    let repeat = profiling.repeat.unwrap_or(REPEAT[0]);
    let numbers = if profiling.no_ratios { 0 } else { profile_numbers::keys().len() };
    let left = begun.left(repeat);
    let steps = Steps::new(left as usize + 1 + numbers, flags);
    let (runs, mut ended) = until_stopped(left, &steps, || subject.run().map(|run| [run]))?;
    let [mut profile] = begun.then(runs)?;
    if ended.is_ok() && !profiling.no_ratios {
        let (keys, pairs) = (profile_numbers::keys(), (repeat as usize).max(7));
        ended = profile_numbers::add_numbers(&subject, &mut profile, (&keys, pairs), &steps);
    }
    drop(steps);
    profiling.print_one(&profile, flags)?;
    ended
}

/// Two subjects by turns.
fn pair(
    scene: Option<&OsStr>,
    profiling: &Profiling,
    flags: &Flags,
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    let other = profiling.other.as_deref().or(scene);
    let subject = |scene, more: &[String]| {
        Subject::new(contact::open(scene, flags)?, flags, more, &interrupt.watch)
    };
    let [a, b] = [subject(scene, &profiling.a)?, subject(other, &profiling.b)?];
    let begun: Begun<2> = begun(profiling.resume, [&a, &b], flags)?;
    interrupt.work_begins();
    let left = begun.left(profiling.repeat.unwrap_or(REPEAT[1]));
    let steps = Steps::new(left as usize + 1, flags);
    let mut turn = false;
    let (pairs, ended) = until_stopped(left, &steps, || {
        // Whoever is first finds the machine as the one before left it: that is shared.
        turn = !turn;
        if turn {
            let first = a.run()?;
            Ok([first, b.run()?])
        } else {
            let first = b.run()?;
            Ok([a.run()?, first])
        }
    })?;
    drop(steps);
    let [of_a, of_b] = begun.then(pairs)?;
    profiling.print_pair(&Compared::new(of_a, of_b, true, profiling.busy), flags)?;
    ended
}

/// What a piece of work done again and again left until it was stopped, and the interruption if it was.
///
/// One more, before the others, is not counted: it starts threads and fills the disc's cache.
fn until_stopped<R>(
    repeat: u32,
    steps: &Steps,
    mut work: impl FnMut() -> Result<R, Failure>,
) -> Result<(Vec<R>, Result<(), Failure>), Failure> {
    let mut done = Vec::new();
    if repeat > 0 {
        steps.begin("a run that is not counted");
        work()?;
    }
    steps.done();
    for _ in 0..repeat {
        steps.begin("whole runs");
        match work() {
            Ok(one) => done.push(one),
            Err(Failure::Failed(Error::Interrupted)) => {
                tell(format_args!("stopped; what follows is of {} of {repeat} runs", done.len()));
                return Ok((done, Err(Error::Interrupted.into())));
            }
            Err(failure) => return Err(failure),
        }
        steps.done();
    }
    Ok((done, Ok(())))
}

impl Profiling {
    /// Refuses what has no use where nothing is measured.
    fn refuse_measuring(&self) -> Result<(), Failure> {
        if self.repeat.is_none() && self.a.is_empty() && self.b.is_empty() {
            return Ok(());
        }
        Err(Failure::Misused(
            "saved profiles are measured already; leave --repeat, --a and --b away".to_owned(),
        ))
    }

    /// Prints what was measured in the form that was asked for.
    fn print<T: serde::Serialize>(
        &self,
        measured: &T,
        [words, csv]: [fn(&T) -> String; 2],
        flags: &Flags,
    ) -> Result<(), Failure> {
        let text = match (self.form.json, self.form.csv) {
            (true, _) => json(measured)?,
            (_, true) => csv(measured),
            _ => words(measured),
        };
        outputs::print_or_write(&text, flags)
    }

    fn print_one(&self, profile: &Profile, flags: &Flags) -> Result<(), Failure> {
        self.print(profile, [profile_table::words, profile_table::csv], flags)
    }

    fn print_pair(&self, compared: &Compared, flags: &Flags) -> Result<(), Failure> {
        self.print(compared, [profile_pair::words, profile_pair::csv], flags)
    }
}

fn json(value: &impl serde::Serialize) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(value);
    text.map(|text| text + "\n")
        .map_err(|error| Failure::Said(format!("what was measured cannot be written ({error})")))
}
