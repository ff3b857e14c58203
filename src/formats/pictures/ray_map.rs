//! Where rays were cast (paper, figure 8): a white pixel for each.

use std::path::Path;

use png::{BitDepth, ColorType, Encoder, chunk};

use super::bands;
use crate::error::Error;
use crate::formats::whole::{Whole, written_beside};

/// Writes a map of rays as a grey PNG of one bit a pixel, white where a ray was `cast`, whole or not at all.
///
/// `size` is positions across and down, `cast` one truth a position, row 0 at the top and x fastest; another number of
/// them is an error.
pub fn write_ray_map(path: &Path, size: [usize; 2], cast: &[bool]) -> Result<(), Error> {
    ray_map_beside(path, size, cast)?.appear()
}

/// The first half of [`write_ray_map`]: all but the moment in which the file is seen under its name.
pub fn ray_map_beside(path: &Path, size: [usize; 2], cast: &[bool]) -> Result<Whole, Error> {
    let [width, height] = size;
    if width == 0 || width.checked_mul(height) != Some(cast.len()) {
        return Err(Error::file(
            path,
            format!(
                "cannot hold a map of {width} × {height} positions made of {}; state one truth a position",
                cast.len()
            ),
        ));
    }
    let eight = |bits: &[bool]| {
        bits.iter().zip(0..).fold(0_u8, |byte, (&bit, place)| byte | u8::from(bit) << (7 - place))
    };
    // Each row begins with a byte of its own.
    let packed: Vec<u8> =
        cast.chunks_exact(width).flat_map(|row| row.chunks(8).map(eight)).collect();
    written_beside(path, |sink| {
        let mut encoder = Encoder::new(sink, u32::try_from(width)?, u32::try_from(height)?);
        encoder.set_color(ColorType::Grayscale);
        encoder.set_depth(BitDepth::One);
        let mut writer = encoder.write_header()?;
        for part in bands::zlib(&packed, width.div_ceil(8), 1)? {
            writer.write_chunk(chunk::IDAT, &part)?;
        }
        Ok(writer.finish()?)
    })
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "these values are exact")]
mod tests {
    use super::*;
    use crate::formats::pictures::read_picture;

    #[test]
    fn a_ray_is_white_and_rows_need_not_fill_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rays.png");
        let cast: Vec<bool> = (0..11 * 3).map(|i| i % 4 == 1).collect();
        write_ray_map(&path, [11, 3], &cast).unwrap();
        let picture = read_picture(&path).unwrap();
        assert_eq!(picture.size, [11, 3]);
        assert!(
            picture
                .pixels
                .iter()
                .zip(&cast)
                .all(|(p, &c)| p[0] == f32::from(u8::from(c)) && p[3] == 1.0)
        );
        assert!(write_ray_map(&path, [10, 3], &cast).is_err());
        assert!(write_ray_map(&path, [0, 3], &[]).is_err());
    }
}
