//! What reading a picture takes, by its header alone, before anything is decoded.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use super::{checked_length, format_of, unknown, unreadable};
use crate::error::Error;

/// Bytes of a pixel in memory: four floats.
const PIXEL: u64 = 16;

/// Bytes that a picture takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Weight {
    /// As long as it is kept.
    pub kept: u64,
    /// The most beside, while it is read.
    pub passing: u64,
}

impl Weight {
    /// Of a picture of so many pixels across and down, in a file of `length` bytes, that is decoded by way of `a_pixel` bytes for each.
    pub(super) fn of([width, height]: [usize; 2], a_pixel: u64, length: u64) -> Self {
        let pixels = width as u64 * height as u64;
        Self { kept: pixels * PIXEL, passing: length.saturating_add(pixels * a_pixel) }
    }

    /// The most that it takes at once.
    #[must_use]
    pub fn most(self) -> u64 {
        self.kept.saturating_add(self.passing)
    }
}

/// What the picture of a file would take, of any known format; its pixels are not looked at.
///
/// A file that is not there, of no known format, or whose header makes no sense is an error as that of
/// [`read_picture`](super::read_picture).
pub fn weighed(path: &Path) -> Result<Weight, Error> {
    let size = format_of(path).and_then(|format| format.size);
    let size = size.ok_or_else(|| unknown(path, |format| format.read.is_some()))?;
    let length = checked_length(path)?;
    let file = File::open(path).map_err(|error| unreadable(path, &error))?;
    let (size, a_pixel) =
        size(&mut BufReader::new(file)).map_err(|problem| Error::format(path, problem))?;
    Ok(Weight::of(size, a_pixel, length))
}

#[cfg(test)]
mod tests {
    use super::super::{PICTURE_FORMATS, read_picture, write_picture};
    use super::*;
    use crate::view::picture::Picture;

    #[test]
    fn every_format_states_its_size_before_its_pixels() {
        let folder = tempfile::tempdir().unwrap();
        let picture = Picture::new([37, 11], vec![[0.25, 0.5, 0.125, 1.0]; 37 * 11]).unwrap();
        for format in PICTURE_FORMATS.iter().filter(|format| format.write.is_some()) {
            let path = folder.path().join("a").with_extension(format.extensions[0]);
            write_picture(&path, &picture, &[]).unwrap();
            let weight = weighed(&path).unwrap();
            assert_eq!(weight.kept, read_picture(&path).unwrap().pixels.bytes(), "{}", format.name);
            assert!(weight.passing >= std::fs::metadata(&path).unwrap().len(), "{}", format.name);
            std::fs::write(&path, b"other bytes").unwrap();
            assert!(weighed(&path).is_err(), "{}", format.name);
        }
        assert!(weighed(&folder.path().join("a.txt")).is_err());
    }
}
