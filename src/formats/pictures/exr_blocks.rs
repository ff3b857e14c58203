//! The blocks of an OpenEXR file of RGBA floats: sixteen lines, channel by channel, deflated as its ZIP compression says.

use flate2::Compress;
use rayon::prelude::*;

use super::bands::{LEVEL, deflate_with};
use crate::view::picture::Picture;

/// Scan lines of a block.
pub(super) const LINES: usize = 16;

/// Channels are kept in the order of their names: alpha, blue, green, red.
const CHANNELS: [usize; 4] = [3, 2, 1, 0];

/// Every block of a picture, from the top; the same for any number of threads.
pub(super) fn deflated(picture: &Picture) -> Result<Vec<Vec<u8>>, String> {
    let lines = picture.size[0] * LINES;
    picture.pixels.par_chunks(lines).map(|pixels| block(pixels, picture.size[0])).collect()
}

/// A block: its bytes split in halves, each byte the difference from the one before, deflated; plain where that is longer.
fn block(pixels: &[[f32; 4]], width: usize) -> Result<Vec<u8>, String> {
    let length = pixels.len() * 16;
    // Every second byte goes to the first half, the others to the second: bytes 0 and 2 of a float, bytes 1 and 3.
    let mut split = vec![0; length];
    let (first, second) = split.split_at_mut(length / 2);
    let pairs = first.as_chunks_mut::<2>().0.iter_mut().zip(second.as_chunks_mut::<2>().0);
    for ((first, second), value) in pairs.zip(values(pixels, width)) {
        let [a, b, c, d] = value.to_le_bytes();
        (*first, *second) = ([a, c], [b, d]);
    }
    let mut differences = split.clone();
    for (difference, last) in differences[1..].iter_mut().zip(&split) {
        *difference = difference.wrapping_sub(*last).wrapping_add(128);
    }
    let packed = deflate_with(Compress::new(LEVEL, true), &differences, true)?;
    if packed.len() < length {
        return Ok(packed);
    }
    Ok(values(pixels, width).flat_map(f32::to_le_bytes).collect())
}

/// The values of a block in the order of the file: of each line, channel by channel.
fn values(pixels: &[[f32; 4]], width: usize) -> impl Iterator<Item = f32> {
    pixels.chunks(width).flat_map(|line| {
        CHANNELS.into_iter().flat_map(move |channel| line.iter().map(move |pixel| pixel[channel]))
    })
}
