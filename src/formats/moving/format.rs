//! What a clip is, and what a format of moving pictures says of itself.

use std::io::Write;

use crate::error::Error;
use crate::formats::whole::Failure;

/// The frames of a clip: 8-bit sRGB with straight alpha, row by row from the top, four bytes a pixel; an error breaks off.
pub type Frames<'a> = &'a mut dyn Iterator<Item = Result<Vec<u8>, Error>>;

/// Writes a clip to a stream.
pub type Writer = fn(&mut dyn Write, &Movie, Frames) -> Result<(), Failure>;

/// What a clip is, before its first frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Movie {
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
