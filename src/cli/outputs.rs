//! Files out: checked before any work is done, so that no hour of rendering ends at a folder that is not there.

use std::path::Path;

use gelray::Error;
use gelray::formats::pictures::{PICTURE_FORMATS, check_output, format_of};
use gelray::formats::whole::{check_writable, write_whole};
use serde::Serialize;

use super::failure::{Failure, print};
use super::flags::Flags;
use super::same_file::same_file;

/// Whether a path is `-`: standard output.
pub fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Finds out whether a picture could be written; an extension that no picture has is a misuse.
pub fn check_picture(path: &Path) -> Result<(), Failure> {
    if is_standard(path) {
        return Ok(());
    }
    check_output(path).map_err(|error| {
        if format_of(path).is_some_and(|format| format.write.is_some()) {
            error.into()
        } else {
            Failure::Misused(error.to_string())
        }
    })
}

/// Finds out whether the files that flags name could be written, and that none of them is another one or an input.
pub fn check(flags: &Flags, inputs: &[&Path]) -> Result<(), Failure> {
    let named = flags.outputs();
    for (at, (flag, path)) in named.iter().enumerate() {
        if is_standard(path) && *flag != "--output" {
            return Err(Failure::Misused(format!(
                "{flag} cannot be standard output; give it a file"
            )));
        } else if is_standard(path) {
            continue;
        }
        check_writable(path)?;
        if let Some((other, _)) = named[..at].iter().find(|(_, other)| same_file(other, path)) {
            return Err(Failure::Misused(format!(
                "{other} and {flag} both name {}; give each a file of its own",
                path.display()
            )));
        }
    }
    spare(flags, inputs)
}

/// Finds out that no file that is to be written is one that is read, whatever names and links lead to it.
pub fn spare<P: AsRef<Path>>(flags: &Flags, inputs: &[P]) -> Result<(), Failure> {
    for (flag, path) in flags.outputs() {
        if inputs.iter().any(|input| same_file(input.as_ref(), path)) {
            return Err(Failure::Misused(format!(
                "{flag} names {}, which is read; choose another file",
                path.display()
            )));
        }
    }
    Ok(())
}

/// Text to the file that `-o` names, or else to standard output.
pub fn print_or_write(text: &str, flags: &Flags) -> Result<(), Failure> {
    match &flags.output {
        Some(path) if is_standard(path) => print(text),
        Some(path) => write_text(path, text).map_err(Failure::from),
        None => print(text),
    }
}

/// Makes a folder, and finds out that files can be written into it.
pub fn make_folder(folder: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(folder).map_err(|error| {
        let problem =
            format!("cannot be made ({error}); name a folder whose parent can be written");
        Error::file(folder, problem)
    })?;
    check_writable(&folder.join("index.html"))
}

/// A file of text, whole or not at all.
pub fn write_text(path: &Path, text: &str) -> Result<(), Error> {
    write_whole(path, |out| Ok(out.write_all(text.as_bytes())?))
}

/// A file of JSON, whole or not at all.
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value).map_err(|error| {
        Failure::Said(format!("{} cannot be written ({error})", path.display()))
    })?;
    Ok(write_text(path, &(text + "\n"))?)
}

/// The extensions of the pictures that are written, for sentences.
pub fn extensions() -> String {
    let written = PICTURE_FORMATS.iter().filter(|format| format.write.is_some());
    written.map(|format| format!(".{}", format.extensions[0])).collect::<Vec<_>>().join(", ")
}
