//! `gelray scenes`: the scenes that are part of the program.

use gelray::scene::{EMBEDDED, Source};

use super::failure::Failure;
use super::flags::Flags;
use super::outputs;
use super::table::table;

/// Lists the scenes with the first line of their comments, or prints the text of one.
pub fn run(name: Option<&str>, flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("scenes", &["--output"])?;
    let text = match name {
        Some(name) => Source::embedded(name)?.text,
        None => table(&EMBEDDED.map(|(name, text)| [name.to_owned(), summary(text)]), &[]),
    };
    outputs::print_or_write(&text, flags)
}

/// The first line of a scene's comment.
fn summary(text: &str) -> String {
    text.lines().next().and_then(|line| line.strip_prefix("# ")).unwrap_or_default().to_owned()
}
