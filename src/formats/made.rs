//! What the tests of several formats make, and those who damage files.

use std::io::Write;

/// The bytes as a gzip file.
pub(super) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(bytes).unwrap();
    packer.finish().unwrap()
}

/// The bytes as zlib packs them.
pub(super) fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(bytes).unwrap();
    packer.finish().unwrap()
}

/// A TIFF of so many pages of 3 × 2 pixels, each of the hundredfold of its number, without a description.
pub(super) fn pages(count: u16) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut bytes).unwrap();
    for page in 0..count {
        let pixels = [page * 100; 6];
        encoder.write_image::<tiff::encoder::colortype::Gray16>(3, 2, &pixels).unwrap();
    }
    bytes.into_inner()
}

/// A NIfTI of 2 × 3 × 2 zeros of 16 bits.
pub(super) fn nifti() -> Vec<u8> {
    let mut nifti = vec![0; 352 + 24];
    nifti[..4].copy_from_slice(&348_i32.to_le_bytes());
    nifti[40..50].copy_from_slice(&[3, 0, 2, 0, 3, 0, 2, 0, 1, 0]);
    nifti[70] = 4;
    for at in [76, 80, 84, 88, 112] {
        nifti[at..at + 4].copy_from_slice(&1.0_f32.to_le_bytes());
    }
    nifti[344..348].copy_from_slice(b"n+1\0");
    nifti
}

/// An MRC map of 2 × 3 × 2 zeros of 16 bits.
pub(super) fn map() -> Vec<u8> {
    let mut map = vec![0; 1024 + 24];
    for (word, value) in [2, 3, 2, 1, 0, 0, 0, 2, 3, 2].into_iter().enumerate() {
        map[word * 4] = value;
    }
    for (word, value) in [2.0_f32, 3.0, 2.0, 90.0, 80.0, 100.0].iter().enumerate() {
        map[40 + word * 4..44 + word * 4].copy_from_slice(&value.to_le_bytes());
    }
    (map[64], map[68], map[72]) = (1, 2, 3);
    map[208..212].copy_from_slice(b"MAP ");
    map[212] = 0x44;
    map
}

/// The bytes as base64.
pub(super) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let bits =
            (0..3).fold(0_u32, |bits, at| bits << 8 | u32::from(*three.get(at).unwrap_or(&0)));
        for at in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * at) & 63) as usize] as char;
            text.push(if at <= three.len() { letter } else { '=' });
        }
    }
    text
}
