//! What went wrong, by whose fault, and the exit code that says so. Each failure is handled here and nowhere else.

use std::io::{ErrorKind, IsTerminal, Write};
use std::process::ExitCode;

use gelray::Error;

use super::escaped::escaped;
use super::excerpt::Excerpt;
use super::sentence::sentence;

/// The work failed: the scene, the data, the disc.
const FAILED: u8 = 1;
/// The command line is wrong.
pub const MISUSED: u8 = 2;
/// The work was stopped on request.
pub const INTERRUPTED: u8 = 130;

/// Why a verb gave up.
#[derive(Debug)]
pub enum Failure {
    /// The command line is wrong: a sentence.
    Misused(String),
    /// The library's error.
    Failed(Error),
    /// A failure that is nobody's file: a sentence.
    Said(String),
    /// Whoever read standard output reads no more; nothing to say, nobody to say it to.
    Unread,
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

impl Failure {
    /// Says the sentence on standard error, and the exit code.
    pub fn report(self) -> ExitCode {
        let code = match &self {
            Self::Misused(sentence) => {
                tell(format_args!("error: {sentence}"));
                MISUSED
            }
            Self::Said(sentence) => {
                tell(format_args!("error: {sentence}"));
                FAILED
            }
            Self::Failed(Error::Interrupted) => {
                tell(format_args!("{}", Error::Interrupted));
                INTERRUPTED
            }
            Self::Failed(error) => {
                explain(error);
                FAILED
            }
            Self::Unread => 0,
        };
        ExitCode::from(code)
    }
}

/// One sentence; on a terminal, a fault of a scene with the excerpt that it is in.
fn explain(error: &Error) {
    match error {
        Error::Scene(fault) if std::io::stderr().is_terminal() => match Excerpt::of(fault) {
            // Colors of the excerpt are our own commands to the terminal.
            Some(excerpt) => {
                let _ = writeln!(std::io::stderr(), "{:?}", miette::Report::new(excerpt));
            }
            None => tell(format_args!("error: {}", sentence(error))),
        },
        error => tell(format_args!("error: {}", sentence(error))),
    }
}

/// A line on standard error; a closed one is no reason to stop.
pub fn tell(line: std::fmt::Arguments) {
    let _ = writeln!(std::io::stderr(), "{}", escaped(&line.to_string()));
}

/// Text on standard output.
pub fn print(text: &str) -> Result<(), Failure> {
    print_bytes(text.as_bytes())
}

/// Bytes on standard output.
pub fn print_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(bytes).and_then(|()| out.flush()).map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::Unread,
        _ => Failure::Said(format!(
            "standard output cannot be written ({error}); redirect it to a file that has space"
        )),
    })
}
