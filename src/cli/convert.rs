//! `gelray convert`: a volume of any format that is read, written as NRRD.

use std::ffi::OsStr;
use std::path::Path;

use gelray::formats::whole::check_writable;
use gelray::formats::write_volume;

use super::failure::{Failure, tell};
use super::flags::Flags;
use super::info::{find, within};
use super::same_file::same_file;

/// Flags that have a use here.
pub const TAKES: &[&str] = &["--channel", "--time"];

/// Reads the volume `from` and writes it to `to`, whole or not at all.
pub fn run(from: &OsStr, to: &Path, flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("convert", TAKES)?;
    if to.extension().is_none_or(|end| !end.eq_ignore_ascii_case("nrrd")) {
        return Err(Failure::Misused(format!(
            "`gelray convert` writes NRRD, and {} is not named so; give it a name that ends in .nrrd",
            to.display()
        )));
    }
    let from = find(from, flags);
    if same_file(&from, to) {
        return Err(Failure::Misused(format!(
            "{} is read and cannot be written too; choose another file",
            to.display()
        )));
    }
    check_writable(to)?;
    let loaded = within(&from, &flags.stated(), flags)?;
    for warning in loaded.warnings.iter().filter(|_| !flags.quiet) {
        tell(format_args!("warning: {warning}"));
    }
    write_volume(to, &loaded)?;
    if !flags.quiet {
        let [x, y, z] = loaded.grid.size;
        tell(format_args!("{}: {x} × {y} × {z} voxels", to.display()));
    }
    Ok(())
}
