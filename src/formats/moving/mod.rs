//! Moving pictures out, one format a file; the table here is where a format is added.
//!
//! Frames come one by one as they are rendered, and go out one by one: no format holds more than one of them. All are made
//! of the 8-bit codes that a PNG of the frame holds, so a clip of finished frames is that of rendering, byte for byte.

pub mod apng;
mod colors;
mod dither;
pub mod ffmpeg;
pub mod gif;
mod opaque;
mod palette;
pub mod y4m;

use std::io::Write;
use std::path::Path;

use crate::error::Error;
use crate::formats::whole::{Failure, check_writable, write_whole};

/// The frames of a clip: 8-bit sRGB with straight alpha, row by row from the top, four bytes a pixel; an error breaks off.
pub type Frames<'a> = &'a mut dyn Iterator<Item = Result<Vec<u8>, Error>>;

/// Writes a clip to a stream.
pub type Writer = fn(&mut dyn Write, &Clip, Frames) -> Result<(), Failure>;

/// What a clip is, before its first frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Clip {
    /// Pixels across and down.
    pub size: [usize; 2],
    /// How many frames there will be.
    pub count: usize,
    /// Frames a second.
    pub rate: Rate,
}

/// Frames a second, as a fraction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rate {
    /// So many frames …
    pub frames: u32,
    /// … in so many seconds.
    pub seconds: u32,
}

impl Rate {
    /// `24`, `29.97` (two decimals) or `30000/1001`: above 0 and at most 1000; the error is a sentence without a subject.
    pub fn parse(text: &str) -> Result<Self, String> {
        let rate = match text.split_once('/') {
            Some((frames, seconds)) => frames.parse().ok().zip(seconds.parse().ok()),
            None => hundredths(text),
        };
        rate.filter(|(frames, seconds)| {
            (1..=60_000).contains(frames)
                && (1..=60_000).contains(seconds)
                && *frames <= 1000 * seconds
        })
        .map(|(frames, seconds)| Self { frames, seconds })
        .ok_or_else(|| {
            "is no number of frames a second; 24, 29.97 and 30000/1001 are, up to 1000".to_owned()
        })
    }
}

/// A number with at most two decimals as a fraction.
fn hundredths(text: &str) -> Option<(u32, u32)> {
    if let Ok(whole) = text.parse() {
        return Some((whole, 1));
    }
    let number: f64 = text.parse().ok().filter(|number| (0.01..=600.0).contains(number))?;
    let hundredths = (number * 100.0).round();
    ((hundredths / 100.0 - number).abs() < 1e-9).then_some((hundredths as u32, 100))
}

impl std::fmt::Display for Rate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.seconds {
            1 => write!(f, "{}", self.frames),
            seconds => write!(f, "{}/{seconds}", self.frames),
        }
    }
}

/// A format of moving pictures.
#[derive(Debug)]
pub struct MovingFormat {
    /// Its name, as sentences print it.
    pub name: &'static str,
    /// The ends of its files' names, in lower case; the first is the usual one.
    pub extensions: &'static [&'static str],
    /// How it is made.
    pub made: By,
}

/// Who makes a format.
#[derive(Debug, Clone, Copy)]
pub enum By {
    /// gelray does.
    Writer(Writer),
    /// `ffmpeg` does, with these arguments after those for its input.
    Ffmpeg(&'static [&'static str]),
}

/// Every known format of moving pictures.
pub static MOVING_FORMATS: [MovingFormat; 5] =
    [apng::FORMAT, gif::FORMAT, y4m::FORMAT, ffmpeg::MP4, ffmpeg::WEBM];

/// The format that a file's name says.
#[must_use]
pub fn moving_format_of(path: &Path) -> Option<&'static MovingFormat> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    MOVING_FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str()))
}

/// The format of a clip's name; the error lists the names that there are.
pub fn moving_format(path: &Path) -> Result<&'static MovingFormat, Error> {
    moving_format_of(path).ok_or_else(|| {
        let known = MOVING_FORMATS.iter().flat_map(|format| format.extensions);
        let known: Vec<_> = known.map(|extension| format!(".{extension}")).collect();
        let known = known.join(", ");
        Error::file(path, format!("is no name of a clip; end it in one of {known}"))
    })
}

/// Finds out, before a frame is rendered, whether [`write_clip`] would be able to write at `path`.
pub fn check_clip(path: &Path) -> Result<(), Error> {
    if let By::Ffmpeg(_) = moving_format(path)?.made {
        ffmpeg::check(path)?;
    }
    check_writable(path)
}

/// Writes a clip in the format that the name's extension says, whole or not at all.
pub fn write_clip(path: &Path, clip: &Clip, frames: Frames) -> Result<(), Error> {
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
