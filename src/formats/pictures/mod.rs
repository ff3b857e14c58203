//! Pictures in and out, one format a file; the table here is where a format is added.
//!
//! In memory a [`Picture`] is linear, associated RGBA. Files of 8 and 16 bits are sRGB with straight alpha; files of
//! floats are linear and associated. Nothing but the picture and its notes is written, no clock time: equal pictures and
//! notes give equal bytes.

mod bands;
pub mod encoded;
pub mod exr;
mod exr_blocks;
mod format;
mod held;
pub mod jpeg;
mod layers;
pub mod npy;
pub mod png;
mod ray_map;
pub mod tiff;
pub mod webp;
mod weight;

#[cfg(test)]
mod tests;

use std::fs;
use std::io::Cursor;
use std::path::Path;

use crate::error::Error;
use crate::formats::whole::{Whole, check_writable, written_beside};
use crate::view::picture::Picture;

pub(crate) use format::{MOST_PIXELS, checked_size, whole, wrong};
pub use format::{Notes, Opened, PictureFormat, Reader, Sizer, Writer};
pub(crate) use held::{read_held, weighed_held};
pub use layers::{PixelLayer, layers_beside};
pub use ray_map::{ray_map_beside, write_ray_map};
pub use weight::{Weight, weighed};

/// Every known format of pictures.
pub static PICTURE_FORMATS: &[PictureFormat] =
    &[png::FORMAT, exr::FORMAT, tiff::FORMAT, npy::FORMAT, jpeg::FORMAT, webp::FORMAT];

/// The longest file that is read: floats of the most pixels, and as much again.
const LONGEST_FILE: u64 = MOST_PIXELS * 32;

/// The format that a file's name says, without looking whether there is such a file.
#[must_use]
pub fn format_of(path: &Path) -> Option<&'static PictureFormat> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    PICTURE_FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str()))
}

/// Reads a picture of any known format, as linear associated RGBA.
///
/// The name's extension says the format. Sizes are limited to 65536 pixels a side and 2²⁸ in all; a file that is cut
/// short, damaged or of another kind is an error of that file.
pub fn read_picture(path: &Path) -> Result<Picture, Error> {
    let read = format_of(path).and_then(|format| format.read);
    let read = read.ok_or_else(|| unknown(path, |format| format.read.is_some()))?;
    checked_length(path)?;
    let bytes = fs::read(path).map_err(|error| unreadable(path, &error))?;
    read(&bytes).map_err(|problem| Error::format(path, problem))
}

/// The bytes of a file, if it is one that may be read.
fn checked_length(path: &Path) -> Result<u64, Error> {
    let found = fs::metadata(path).map_err(|error| unreadable(path, &error))?;
    if found.is_file() && found.len() <= LONGEST_FILE {
        return Ok(found.len());
    }
    let problem =
        format!("is no file of at most {LONGEST_FILE} bytes; state the path of a picture");
    Err(Error::file(path, problem))
}

fn unreadable(path: &Path, error: &std::io::Error) -> Error {
    Error::file(path, format!("cannot be read ({error}); check the path"))
}

/// Writes a picture in the format that the name's extension says, whole or not at all.
///
/// PNG: 8-bit sRGB, straight alpha, rounded to nearest and clamped, notes as international text. EXR and TIFF: 32-bit
/// floats, linear and associated, notes as text attributes and as the image description. `.npy`: the same floats,
/// height × width × 4, without notes. The name of a note is 1 to 64 printable ASCII characters without spaces, and no two
/// are alike; its text is any text (NUL becomes U+FFFD).
pub fn write_picture(path: &Path, picture: &Picture, notes: &Notes) -> Result<(), Error> {
    picture_beside(path, picture, notes)?.appear()
}

/// The first half of [`write_picture`]: all but the moment in which the file is seen under its name.
pub fn picture_beside(path: &Path, picture: &Picture, notes: &Notes) -> Result<Whole, Error> {
    let write = writer(path)?;
    let notes = writable(picture, notes).map_err(|problem| Error::file(path, problem))?;
    written_beside(path, |sink| write(sink, picture, &notes))
}

/// The bytes of a PNG of a picture, as [`write_picture`] writes it; the failure is a sentence without a subject.
pub fn png_bytes(picture: &Picture, notes: &Notes) -> Result<Vec<u8>, String> {
    let notes = writable(picture, notes)?;
    let mut bytes = Cursor::new(Vec::new());
    png::write(&mut bytes, picture, &notes)
        .map_err(|failure| format!("cannot be made ({failure})"))?;
    Ok(bytes.into_inner())
}

/// The notes as they are written, if picture and notes can be.
fn writable(picture: &Picture, notes: &Notes) -> Result<Vec<(String, String)>, String> {
    if picture.pixels.is_empty() {
        let [width, height] = picture.size;
        return Err(format!(
            "cannot hold a picture of {width} × {height} pixels; state a size of at least 1 × 1"
        ));
    }
    checked(notes)
}

/// Finds out, before a picture is rendered, whether [`write_picture`] would be able to write it at `path`.
pub fn check_output(path: &Path) -> Result<(), Error> {
    writer(path)?;
    check_writable(path)
}

fn writer(path: &Path) -> Result<Writer, Error> {
    let write = format_of(path).and_then(|format| format.write);
    write.ok_or_else(|| unknown(path, |format| format.write.is_some()))
}

/// The error of a name whose extension is not among those of the formats that are `able`.
fn unknown(path: &Path, able: impl Fn(&PictureFormat) -> bool) -> Error {
    let found = match path.extension() {
        Some(extension) => format!("has the extension `.{}`", extension.to_string_lossy()),
        None => "has no extension".to_owned(),
    };
    let known: Vec<String> = PICTURE_FORMATS
        .iter()
        .filter(|format| able(format))
        .flat_map(|format| format.extensions.iter().map(|extension| format!(".{extension}")))
        .collect();
    Error::format(path, format!("{found}; name a picture with one of {}", known.join(", ")))
}

fn checked(notes: &Notes) -> Result<Vec<(String, String)>, String> {
    for (place, (name, _)) in notes.iter().enumerate() {
        if !(1..=64).contains(&name.len()) || !name.bytes().all(|byte| byte.is_ascii_graphic()) {
            return Err(format!(
                "cannot hold a note called {name:?}; a name is 1 to 64 printable ASCII characters without spaces"
            ));
        }
        if notes[..place].iter().any(|(earlier, _)| earlier == name) {
            return Err(format!("cannot hold two notes called {name:?}; join them or rename one"));
        }
    }
    Ok(notes.iter().map(|(name, text)| (name.clone(), text.replace('\0', "\u{fffd}"))).collect())
}
