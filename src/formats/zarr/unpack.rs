//! What other crates unpack, held to the bytes that are expected.

use std::io::Read;

use flate2::bufread::ZlibDecoder;
use ruzstd::decoding::FrameDecoder;

use crate::formats::stream::{room, zeros};

/// The largest window that a stream of zstd may ask for, where its chunk is smaller: that of its highest usual level, bytes.
const WINDOW: usize = 8 << 20;

/// Unpacks a block of LZ4 into exactly `into`.
pub(super) fn lz4_into(bytes: &[u8], into: &mut [u8]) -> Result<(), String> {
    let unpacked = lz4_flex::block::decompress_into(bytes, into).map_err(damaged)?;
    filled(unpacked, into)
}

/// Unpacks one stream of zlib into exactly `into`.
pub(super) fn zlib_into(bytes: &[u8], into: &mut [u8]) -> Result<(), String> {
    let mut packed = ZlibDecoder::new(bytes);
    packed.read_exact(into).map_err(damaged)?;
    let more = packed.read(&mut [0]).map_err(damaged)?;
    filled(into.len() + more, into)
}

/// Unpacks frames of zstd into exactly `into`.
pub(super) fn zstd_into(
    decoder: &mut FrameDecoder,
    bytes: &[u8],
    into: &mut [u8],
) -> Result<(), String> {
    let unpacked = of_zstd(decoder, bytes, into)?;
    filled(unpacked, into)
}

/// Unpacks frames of zstd to at most `most` bytes.
pub(super) fn zstd(bytes: &[u8], most: usize) -> Result<Vec<u8>, String> {
    let mut all = zeros(most)?;
    let unpacked = of_zstd(&mut FrameDecoder::new(), bytes, &mut all)?;
    all.truncate(unpacked);
    Ok(all)
}

/// Unpacks a block of LZ4, after its length as numcodecs writes it, to at most `most` bytes.
pub(super) fn lz4(bytes: &[u8], most: usize) -> Result<Vec<u8>, String> {
    let (length, packed) =
        bytes.split_first_chunk::<4>().ok_or_else(|| damaged("it ends early"))?;
    let length = u32::from_le_bytes(*length) as usize;
    if length > most {
        return Err(too_long(most));
    }
    let mut all = zeros(length)?;
    lz4_into(packed, &mut all)?;
    Ok(all)
}

/// All that a reader gives, at most `most` bytes.
pub(super) fn to_end(reader: impl Read, most: usize) -> Result<Vec<u8>, String> {
    let mut all = Vec::new();
    room(&mut all, most)?;
    reader.take(most as u64 + 1).read_to_end(&mut all).map_err(damaged)?;
    if all.len() > most { Err(too_long(most)) } else { Ok(all) }
}

fn of_zstd(decoder: &mut FrameDecoder, bytes: &[u8], into: &mut [u8]) -> Result<usize, String> {
    decoder.set_max_window_size(into.len().max(WINDOW) as u64);
    decoder.decode_all(bytes, into).map_err(damaged)
}

fn filled(unpacked: usize, into: &[u8]) -> Result<(), String> {
    if unpacked == into.len() { Ok(()) } else { Err(damaged("it is of another length")) }
}

fn damaged(error: impl std::fmt::Display) -> String {
    format!("is damaged ({error}); fetch the file again")
}

fn too_long(most: usize) -> String {
    format!("unpacks to more than the {most} bytes that its array says; fetch the file again")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::made::{gzip, zlib};

    /// A frame of zstd that holds the bytes as they are (RFC 8878: magic, a header with the size in a byte, one raw block).
    fn frame(bytes: &[u8]) -> Vec<u8> {
        let block = (bytes.len() << 3 | 1) as u32;
        let head = [0x28, 0xb5, 0x2f, 0xfd, 0x20, bytes.len() as u8];
        [&head, &block.to_le_bytes()[..3], bytes].concat()
    }

    #[test]
    fn zstd_is_held_to_its_length() {
        let bytes = frame(b"hello");
        assert_eq!(zstd(&bytes, 5).unwrap(), b"hello");
        assert_eq!(zstd(&bytes, 9).unwrap(), b"hello");
        assert_eq!(zstd(&[bytes.clone(), bytes.clone()].concat(), 10).unwrap(), b"hellohello");
        assert!(zstd(&bytes, 4).unwrap_err().contains("damaged"));
        assert!((0..bytes.len()).skip(1).all(|end| zstd(&bytes[..end], 5).is_err()));
        let mut exact = [0; 6];
        assert!(zstd_into(&mut FrameDecoder::new(), &bytes, &mut exact).is_err());
    }

    #[test]
    fn a_frame_that_asks_for_a_large_window_is_refused() {
        // A window of 2 GiB, and a block of no bytes.
        let bytes = [0x28, 0xb5, 0x2f, 0xfd, 0, 21 << 3, 1, 0, 0];
        assert!(zstd(&bytes, 100).unwrap_err().contains("window"));
    }

    #[test]
    fn lz4_is_held_to_its_length() {
        // Five bytes as they are.
        let block = [&[0x50][..], b"hello"].concat();
        let bytes = [&[5, 0, 0, 0][..], &block].concat();
        assert_eq!(lz4(&bytes, 5).unwrap(), b"hello");
        assert!(lz4(&bytes, 4).unwrap_err().contains("4 bytes"));
        assert!(lz4(&bytes[..7], 5).unwrap_err().contains("damaged"));
        assert!(lz4(&[[6, 0, 0, 0].to_vec(), block].concat(), 9).unwrap_err().contains("damaged"));
    }

    #[test]
    fn zlib_and_gzip_are_held_to_their_lengths() {
        let mut exact = [0; 5];
        zlib_into(&zlib(b"hello"), &mut exact).unwrap();
        assert_eq!(&exact, b"hello");
        assert!(zlib_into(&zlib(b"hello!"), &mut exact).unwrap_err().contains("length"));
        let packed = gzip(b"hello");
        let read = |most| to_end(flate2::bufread::MultiGzDecoder::new(&packed[..]), most);
        assert_eq!(read(5).unwrap(), b"hello");
        assert!(read(4).unwrap_err().contains("more than the 4"));
    }
}
