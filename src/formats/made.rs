//! What the tests of several formats make.

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
