//! The command line: parse → run → report, a verb a file.
//!
//! Flags mean the same for every verb and stand in any place. Results go to standard output, everything else to
//! standard error. Exit codes: 0 done, 1 failed, 2 misused, 130 interrupted.

mod accuracy;
mod animate;
mod animate_stats;
mod assemble;
mod bound;
mod bytes;
mod calibration;
mod compare;
mod contact;
mod convert;
mod empty;
mod escaped;
mod excerpt;
mod failure;
mod flags;
mod frame_progress;
mod goal;
mod html;
mod info;
mod info_mesh;
mod info_picture;
mod interrupt;
mod limit;
mod listing;
mod memory;
mod motion;
mod noted;
mod number;
mod one_heap;
mod outputs;
mod plan;
mod plot;
mod profile;
mod profile_numbers;
mod profile_pair;
mod profile_resume;
mod profile_run;
mod profile_saved;
mod profile_table;
mod progress;
mod progressive;
mod raw_header;
mod render;
mod report;
mod report_extremes;
mod report_figures;
mod report_growth;
mod report_page;
mod report_parts;
mod report_scenes;
mod results;
mod same_file;
mod scenes;
mod schema;
mod sentence;
mod stats;
mod steps;
mod table;
mod target;
mod trace;
mod trade;
mod trade_others;
mod trade_page;
mod trade_points;
mod trade_run;
mod trade_scene;
mod trimming;
mod verb_first;
mod view_name;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::error::Error as Unparsed;
use clap::{Command, CommandFactory, FromArgMatches, Parser, Subcommand};

use failure::Failure;
use flags::Flags;

const EXAMPLES: &str = "\
Examples:
  gelray render -o head.png                          the embedded scene `head`
  gelray render scan.nii.gz -o scan.png              a volume without a scene
  gelray render scene.toml -o out.exr --stats out.json
  gelray render -o big.png --size 1520x1520 --set observer.view.azimuth=60
  gelray animate -o turn.gif                         a full turn
  gelray plan scene.toml                             what would run, and how many bytes it takes
  gelray profile figure_06a                          what each stage takes, beside the paper's seconds
  gelray trade scene.toml -o trade --target psnr=45  what each knob costs and buys, and the fastest that keeps 45 dB
  gelray compare fast.png exact.png -o where.png     how far two images are apart, and where

Exit codes: 0 done, 1 failed, 2 misused, 130 interrupted.
Folders for data: --data DIR and the variable GELRAY_DATA (several, as in PATH).";

/// Renders mixtures of volumes and polygons as coloured gel, after Levoy 1988
#[derive(Debug, Parser)]
#[command(name = "gelray", version, propagate_version = true, max_term_width = 110)]
#[command(arg_required_else_help = true, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
    #[command(flatten)]
    flags: Flags,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Renders one image
    #[command(after_help = render::EXAMPLES)]
    Render {
        /// A scene file, the name of an embedded scene, or a volume [default: head]
        scene: Option<OsString>,
        #[command(flatten)]
        progressive: progressive::Progressive,
        #[command(flatten)]
        accuracy: accuracy::Accuracy,
    },
    /// Renders a sequence: frames, or an animation in one file
    #[command(after_help = animate::EXAMPLES)]
    Animate {
        /// A scene file, or the name of an embedded scene [default: head]
        scene: Option<OsString>,
        #[command(flatten)]
        motion: motion::Motion,
    },
    /// Makes one animation of finished frames
    #[command(after_help = assemble::EXAMPLES)]
    Assemble {
        /// The folder of the frames, or their manifest
        frames: std::path::PathBuf,
        /// Frames a second [default: as the frames were rendered for]
        #[arg(long, value_name = "RATE", value_parser = gelray::formats::moving::Rate::parse)]
        fps: Option<gelray::formats::moving::Rate>,
    },
    /// Measures what each stage takes, beside the paper's table; or two scenes or saved profiles, and whether they differ
    #[command(after_help = profile::EXAMPLES)]
    Profile {
        /// A scene file, the name of an embedded scene, a volume, or a saved profile [default: head]
        scene: Option<OsString>,
        #[command(flatten)]
        profiling: profile::Profiling,
    },
    /// Measures what each knob of accuracy costs and buys; picks the settings that keep a target
    #[command(after_help = trade::EXAMPLES)]
    Trade {
        /// A scene file, the name of an embedded scene, or a volume [default: head]
        scene: Option<OsString>,
        #[command(flatten)]
        trading: trade::Trading,
    },
    /// Writes the paper's figures, tables and the trade as one page that needs no network
    #[command(after_help = report::EXAMPLES)]
    Report {
        #[command(flatten)]
        reporting: report::Reporting,
    },
    /// Tells which systems would run, which not and why, and how many bytes they take
    Plan {
        /// A scene file, the name of an embedded scene, or a volume [default: head]
        scene: Option<OsString>,
    },
    /// Tells the error between two images; with -o, an image of where they differ
    Compare {
        /// An image
        a: std::path::PathBuf,
        /// Another one of the same size
        b: std::path::PathBuf,
    },
    /// Tells what a volume or an image holds: header, values, histogram, suggested isovalues
    Info {
        /// A file, or `phantom:NAME`
        file: OsString,
    },
    /// Writes a volume of any format that is read as NRRD
    Convert {
        /// A volume: a file, or the folder of a series
        from: OsString,
        /// The file to write, .nrrd
        to: std::path::PathBuf,
    },
    /// Lists the embedded scenes, or prints one
    Scenes {
        /// The name of an embedded scene
        name: Option<String>,
    },
    /// Prints the JSON schema of the scene format
    Schema,
}

/// The flags that each verb has a use for, beside those of all: what its help lists.
const TAKES: [(&str, &[&str]); 12] = [
    ("render", render::TAKES),
    ("animate", animate::TAKES),
    ("assemble", assemble::TAKES),
    ("profile", profile::TAKES),
    ("trade", trade::TAKES),
    ("report", report::TAKES),
    ("plan", plan::TAKES),
    ("compare", compare::TAKES),
    ("info", info::TAKES),
    ("convert", convert::TAKES),
    ("scenes", scenes::TAKES),
    ("schema", schema::TAKES),
];

/// The command line, with the flags that a verb has no use for hidden in its help.
fn command() -> Command {
    let mut command = Cli::command();
    // Flags reach the verbs only now.
    command.build();
    for (verb, takes) in TAKES {
        command = command.mut_subcommand(verb, |verb| {
            verb.mut_args(|arg| {
                let given = |flag: &&str| arg.get_long() == flag.strip_prefix("--");
                let known = flags::FOR_SOME.iter().any(&given);
                let hidden = known && !takes.iter().any(given);
                arg.hide(hidden)
            })
        });
    }
    command
}

fn parse(arguments: Vec<OsString>) -> Result<Cli, Unparsed> {
    let matches = command().try_get_matches_from(verb_first::verb_first(arguments))?;
    Cli::from_arg_matches(&matches)
}

/// Parses the arguments, runs the verb and says what went wrong.
pub fn main(arguments: Vec<OsString>) -> ExitCode {
    one_heap::share(&arguments);
    match parse(arguments) {
        Ok(Cli { verb, flags }) => match run(verb, &flags) {
            Ok(()) => ExitCode::SUCCESS,
            Err(failure) => failure.report(),
        },
        Err(words) => {
            // Help that nobody reads on is no failure.
            let _ = words.print();
            ExitCode::from(if words.use_stderr() { failure::MISUSED } else { 0 })
        }
    }
}

fn run(verb: Verb, flags: &Flags) -> Result<(), Failure> {
    flags.set_threads()?;
    match verb {
        Verb::Render { scene, progressive, accuracy } => {
            render::run(scene.as_deref(), &progressive, &accuracy, flags)
        }
        Verb::Animate { scene, motion } => animate::run(scene.as_deref(), &motion, flags),
        Verb::Assemble { frames, fps } => assemble::run(&frames, fps, flags),
        Verb::Profile { scene, profiling } => profile::run(scene.as_deref(), &profiling, flags),
        Verb::Trade { scene, trading } => trade::run(scene.as_deref(), &trading, flags),
        Verb::Report { reporting } => report::run(&reporting, flags),
        Verb::Plan { scene } => plan::run(scene.as_deref(), flags),
        Verb::Compare { a, b } => compare::run(&a, &b, flags),
        Verb::Info { file } => info::run(&file, flags),
        Verb::Convert { from, to } => convert::run(&from, &to, flags),
        Verb::Scenes { name } => scenes::run(name.as_deref(), flags),
        Verb::Schema => schema::run(flags),
    }
}
