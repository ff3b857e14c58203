//! `gelray scenes`: the scenes that are part of the program.

use gelray::scene::{EMBEDDED, Source};

use super::failure::Failure;
use super::flags::Flags;
use super::outputs;
use super::table::table;

/// Flags that have a use here.
pub const TAKES: &[&str] = &["--output"];

/// Lists the scenes with the first line of their comments, or prints the text of one.
pub fn run(name: Option<&str>, flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("scenes", TAKES)?;
    let text = match name {
        Some(name) => Source::embedded(name)?.text,
        None => table(&EMBEDDED.map(|(name, text)| [name.to_owned(), summary(text)]), &[]),
    };
    outputs::print_or_write(&text, flags)
}

/// The first lines of a scene's comment, up to one that ends a sentence.
pub fn summary(text: &str) -> String {
    let mut comment = text.lines().map_while(|line| line.strip_prefix("# "));
    let mut summary = comment.next().unwrap_or_default().to_owned();
    while !summary.ends_with('.') {
        let Some(line) = comment.next() else { break };
        summary = summary + " " + line;
    }
    summary
}
