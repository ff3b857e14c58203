//! What a format of pictures is, and what its readers share: how large a picture may be, and what is said of a broken one.

use std::io::{BufRead, Seek};

use crate::formats::whole::{Failure, Sink};
use crate::view::picture::Picture;

/// Named sentences that go with a picture (scene, settings, version, counts), in the order they are written.
pub type Notes = [(String, String)];

/// Makes a picture of a file's bytes; the failure is a sentence without a subject.
pub type Reader = fn(&[u8]) -> Result<Picture, String>;

/// A file of which the header alone is read.
pub trait Opened: BufRead + Seek {}

impl<T: BufRead + Seek> Opened for T {}

/// What a header states: pixels across and down, and the most bytes that a pixel takes while it is decoded, beside its floats.
pub type Sizer = fn(&mut dyn Opened) -> Result<([usize; 2], u64), String>;

/// Writes a picture and its notes.
pub type Writer = fn(&mut dyn Sink, &Picture, &Notes) -> Result<(), Failure>;

/// A format that pictures are read from, written to, or both.
#[derive(Debug)]
pub struct PictureFormat {
    /// Its name, as sentences print it.
    pub name: &'static str,
    /// The ends of its files' names, in lower case; the first is the usual one.
    pub extensions: &'static [&'static str],
    /// How it is read, if it is.
    pub read: Option<Reader>,
    /// How its size is read, of its header alone.
    pub size: Option<Sizer>,
    /// How it is written, if it is.
    pub write: Option<Writer>,
}

/// The longest side of a picture that is read, in pixels.
pub(crate) const LONGEST_SIDE: u64 = 65_536;

/// The most pixels of a picture that is read: 16384², 4 GiB in memory.
pub(crate) const MOST_PIXELS: u64 = 1 << 28;

/// The size of a picture that a file's header states, if it is one that may be read.
pub(crate) fn checked_size(width: u64, height: u64) -> Result<[usize; 2], String> {
    let side = 1..=LONGEST_SIDE;
    if side.contains(&width) && side.contains(&height) && width * height <= MOST_PIXELS {
        return Ok([width as usize, height as usize]);
    }
    Err(format!(
        "states a size of {width} × {height} pixels; sides of 1 to {LONGEST_SIDE} and at most {MOST_PIXELS} pixels are read: scale it down"
    ))
}

/// A picture of as many pixels as its size needs.
pub fn whole(size: [usize; 2], pixels: Vec<[f32; 4]>) -> Result<Picture, String> {
    let found = pixels.len();
    Picture::new(size, pixels).ok_or_else(|| {
        let [width, height] = size;
        format!("holds {found} pixels and its size of {width} × {height} needs another number; the file is damaged")
    })
}

/// The sentence of a file that a decoder could not make sense of.
pub fn wrong(name: &str, error: impl std::fmt::Display) -> String {
    format!("is not a whole {name} file ({error}); make or fetch it again")
}
