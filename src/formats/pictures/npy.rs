//! NumPy arrays (`.npy`): float32, height × width × 4, C order, little-endian; linear and associated. No notes.

use std::io::Read;

use super::{Notes, Opened, PictureFormat, checked_size, whole, wrong};
use crate::formats::whole::{Failure, Sink};
use crate::view::picture::Picture;

/// Read and written.
pub(crate) const FORMAT: PictureFormat = PictureFormat {
    name: "NPY",
    extensions: &["npy"],
    read: Some(read),
    size: Some(size),
    write: Some(write),
};

const MAGIC: &[u8] = b"\x93NUMPY";

/// Writes the array; its header fills a multiple of 64 bytes, as NumPy's own do.
pub fn write(sink: &mut dyn Sink, picture: &Picture, _: &Notes) -> Result<(), Failure> {
    let [width, height] = picture.size;
    sink.write_all(&header(&format!("({height}, {width}, 4)")))?;
    for pixel in picture.pixels.iter() {
        sink.write_all(pixel.map(f32::to_le_bytes).as_flattened())?;
    }
    Ok(())
}

/// The beginning of an array of floats of a shape as Python writes it, in C order.
pub(super) fn header(shape: &str) -> Vec<u8> {
    let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}");
    let length = (MAGIC.len() + 4 + header.len() + 1).next_multiple_of(64) - MAGIC.len() - 4;
    let mut bytes = [MAGIC, &[1, 0], &(length as u16).to_le_bytes()].concat();
    bytes.extend(format!("{header:<0$}\n", length - 1).into_bytes());
    bytes
}

/// The longest header that is read where the size alone is asked for, bytes.
const LONGEST_HEADER: u64 = 1 << 17;

/// The floats are those of the file.
fn size(file: &mut dyn Opened) -> Result<([usize; 2], u64), String> {
    let mut bytes = Vec::new();
    file.take(LONGEST_HEADER).read_to_end(&mut bytes).map_err(|error| wrong("NPY", error))?;
    Ok((stated(&bytes)?.0, 0))
}

/// Reads the array, of versions 1 to 3 of the format.
pub fn read(bytes: &[u8]) -> Result<Picture, String> {
    let (size, body) = stated(bytes)?;
    let (values, extra) = body.as_chunks::<4>();
    let (pixels, rest) = values.as_chunks::<4>();
    if !extra.is_empty() || !rest.is_empty() || pixels.len() != size[0] * size[1] {
        return Err(format!(
            "holds {} bytes of values and its shape needs {}; the file is damaged",
            body.len(),
            size[0] * size[1] * 16
        ));
    }
    whole(size, pixels.iter().map(|pixel| pixel.map(f32::from_le_bytes)).collect())
}

/// The size that a header states, and the bytes behind it.
fn stated(bytes: &[u8]) -> Result<([usize; 2], &[u8]), String> {
    let short = || wrong("NPY", "it is cut short or begins with other bytes");
    let rest = bytes.strip_prefix(MAGIC).ok_or_else(short)?;
    let (length, rest) = match rest {
        [1, _, a, b, rest @ ..] => (u32::from(u16::from_le_bytes([*a, *b])), rest),
        [2 | 3, _, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]), rest),
        _ => return Err(short()),
    };
    let (header, body) = rest.split_at_checked(length as usize).ok_or_else(short)?;
    let header: String =
        header.iter().map(|&b| char::from(b)).filter(|c| !c.is_whitespace()).collect();
    let [width, height] = shape(&header)?;
    Ok((checked_size(width, height)?, body))
}

/// Width and height of an array whose header, without spaces, states the one layout that is read.
fn shape(header: &str) -> Result<[u64; 2], String> {
    let stated = |text: &str| header.contains(text);
    let shape = header.split_once("'shape':(").and_then(|(_, rest)| rest.split_once(')'));
    let sides: Option<Vec<u64>> = shape.and_then(|(sides, _)| {
        sides.trim_end_matches(',').split(',').map(|side| side.parse().ok()).collect()
    });
    match sides.as_deref() {
        Some(&[height, width, 4]) if stated("'descr':'<f4'") && stated("'fortran_order':False") => {
            Ok([width, height])
        }
        _ => Err(format!(
            "holds an array of {header:?}; a picture is little-endian float32 ('<f4') in C order of shape (height, width, 4)"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_of_another_type_order_or_shape_is_told_what_a_picture_is() {
        let array = |header: &str| {
            [b"\x93NUMPY\x01\x00\x80\x00".as_slice(), format!("{header:<128}").as_bytes(), &[0; 32]]
                .concat()
        };
        let good = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 1, 4), }";
        assert_eq!(read(&array(good)).unwrap().size, [1, 2]);
        for (from, to) in [
            ("<f4", "<f8"),
            ("False", "True"),
            ("(2, 1, 4)", "(8,)"),
            ("(2, 1, 4)", "(99999, 99999, 4)"),
            ("2, 1", "-2, 1"),
        ] {
            assert!(read(&array(&good.replace(from, to))).is_err(), "{to}");
        }
    }
}
