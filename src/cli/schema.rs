//! `gelray schema`: the JSON schema of the scene format.

use super::failure::Failure;
use super::flags::Flags;
use super::outputs;

/// Flags that have a use here.
pub const TAKES: &[&str] = &["--output"];

/// Prints the schema.
pub fn run(flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("schema", TAKES)?;
    let text = format!("{:#}\n", gelray::scene::schema());
    outputs::print_or_write(&text, flags)
}
