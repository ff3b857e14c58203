//! Moving pictures out, one format a file; the table here is where a format is added.
//!
//! Frames come one by one as they are rendered, and go out one by one: no format holds more than one of them. All are made
//! of the 8-bit codes that a PNG of the frame holds, so a clip of finished frames is that of rendering, byte for byte.

pub mod apng;
mod colors;
mod dither;
pub mod ffmpeg;
mod format;
pub mod gif;
pub(crate) mod opaque;
mod palette;
pub mod y4m;

use std::path::Path;

use crate::error::Error;
use crate::formats::whole::{check_writable, write_whole};
pub use format::{By, Frames, Movie, MovingFormat, Rate, Writer};

/// Every known format of moving pictures.
pub static MOVING_FORMATS: &[MovingFormat] =
    &[apng::FORMAT, gif::FORMAT, y4m::FORMAT, ffmpeg::MP4, ffmpeg::WEBM];

/// The format that a file's name says.
#[must_use]
pub fn moving_format_of(path: &Path) -> Option<&'static MovingFormat> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    MOVING_FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str()))
}

/// The format of a clip's name; the error lists the names that there are.
pub(crate) fn moving_format(path: &Path) -> Result<&'static MovingFormat, Error> {
    moving_format_of(path).ok_or_else(|| {
        let known = MOVING_FORMATS.iter().flat_map(|format| format.extensions);
        let known: Vec<_> = known.map(|extension| format!(".{extension}")).collect();
        let known = known.join(", ");
        Error::file(path, format!("is no name of a clip; end it in one of {known}"))
    })
}

/// Finds out, before a frame is rendered, whether [`write_clip`] would be able to write at `path`.
pub fn check_clip(path: &Path) -> Result<(), Error> {
    if let By::Ffmpeg(arguments) = moving_format(path)?.made {
        ffmpeg::check(path, arguments)?;
    }
    check_writable(path)
}

/// Writes a clip in the format that the name's extension says, whole or not at all.
pub fn write_clip(path: &Path, clip: &Movie, frames: Frames) -> Result<(), Error> {
    match moving_format(path)?.made {
        By::Writer(write) => write_whole(path, |sink| {
            let mut sink: &mut dyn crate::formats::whole::Sink = sink;
            write(&mut sink, clip, frames)
        }),
        By::Ffmpeg(arguments) => ffmpeg::write(path, arguments, clip, frames),
    }
}

#[cfg(test)]
mod tests;
