//! Pictures that another file holds or names: their first bytes say of which format they are, and else their name.

use std::path::Path;

use super::format::{Opened, PictureFormat};
use super::{LONGEST_FILE, Weight, format_of, jpeg, png, webp};
use crate::view::picture::Picture;

/// The format of a picture that begins with these bytes; the error is a sentence without a subject.
fn format_held(start: &[u8], name: &Path) -> Result<&'static PictureFormat, String> {
    let by_start = match start {
        [0x89, b'P', b'N', b'G', ..] => Some(&png::FORMAT),
        [0xff, 0xd8, 0xff, ..] => Some(&jpeg::FORMAT),
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Some(&webp::FORMAT),
        _ => format_of(name).filter(|format| format.read.is_some()),
    };
    by_start.ok_or_else(|| "is of no format that is read; save it as PNG or JPEG".to_owned())
}

/// Pixels across and down, and what the picture takes, of its header alone; it is `length` bytes long.
///
/// The error is a sentence without a subject, as that of [`read_held`].
pub(crate) fn weighed_held(
    stored: &mut dyn Opened,
    name: &Path,
    length: u64,
) -> Result<([usize; 2], Weight), String> {
    if length > LONGEST_FILE {
        return Err(format!("is longer than {LONGEST_FILE} bytes; scale it down"));
    }
    let start = stored
        .fill_buf()
        .map_err(|error| format!("cannot be read ({error}); check its permissions"))?;
    let size = format_held(start, name)?.size.ok_or("states no size; save it as PNG or JPEG")?;
    let (size, a_pixel) = size(stored)?;
    Ok((size, Weight::of(size, a_pixel, length)))
}

/// Reads a picture as linear associated RGBA; where it is to be `opaque`, its alpha is no opacity and hides no color.
pub(crate) fn read_held(bytes: &[u8], name: &Path, opaque: bool) -> Result<Picture, String> {
    let format = format_held(bytes, name)?;
    if opaque && format.name == png::FORMAT.name {
        return png::read_opaque(bytes);
    }
    let read = format.read.ok_or("is of no format that is read; save it as PNG or JPEG")?;
    read(bytes)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::super::png_bytes;
    use super::*;

    #[test]
    fn what_a_picture_is_its_bytes_say_whatever_it_is_called() {
        let picture = Picture::new([2, 1], vec![[0.25, 0.25, 0.25, 0.5], [0.0; 4]]).unwrap();
        let bytes = png_bytes(&picture, &[]).unwrap();
        let name = Path::new("a.jpg");
        let read = read_held(&bytes, name, false).unwrap();
        assert!((read.pixels[0][0] - 0.25).abs() < 4e-3 && read.pixels[1] == [0.0; 4]);
        let opaque = read_held(&bytes, name, true).unwrap();
        assert!((opaque.pixels[0][0] - 0.5).abs() < 4e-3 && opaque.pixels[1][3] == 1.0);
        let (size, weight) =
            weighed_held(&mut Cursor::new(&bytes), name, bytes.len() as u64).unwrap();
        assert_eq!((size, weight.kept), ([2, 1], 32));
    }

    #[test]
    fn what_is_no_picture_is_said_to_be_none() {
        for (bytes, name) in [(&b"hello"[..], "a"), (b"", "a.bin"), (b"\x89PNG", "a.png")] {
            let problem = read_held(bytes, Path::new(name), true).unwrap_err();
            assert!(problem.contains(';'), "{problem}");
            assert!(weighed_held(&mut Cursor::new(bytes), Path::new(name), 1).is_err());
        }
    }
}
