//! A zlib stream made in bands by all threads: each band is filtered and deflated alone, and the stream is whole.

use flate2::{Compress, Compression, FlushCompress, Status};
use rayon::prelude::*;

/// Bytes of a row of pixels in a band before it is deflated, about: long enough to find repetitions.
const BAND: usize = 1 << 18;

/// How hard a band is deflated: little, for a picture must not wait for its file. Level 1 takes three quarters of the time and
/// leaves files two fifths longer.
pub(super) const LEVEL: Compression = Compression::new(2);

/// The parts of one zlib stream over the filtered rows of a picture, in order; the same for any number of threads.
///
/// `bytes` holds rows of `row` bytes in pixels of `pixel` bytes. Each row is preceded by its filter type (PNG 1.2, §6):
/// `Sub` or `Up`, whichever leaves the smaller numbers.
pub(super) fn zlib(bytes: &[u8], row: usize, pixel: usize) -> Result<Vec<Vec<u8>>, String> {
    let rows = (BAND / row).max(1);
    let count = bytes.len().div_ceil(rows * row);
    let deflated = |band: usize| {
        let first = band * rows * row;
        let own = &bytes[first..bytes.len().min(first + rows * row)];
        let above = first.checked_sub(row).map(|above| &bytes[above..first]);
        let filtered = filtered(own, above, row, pixel);
        let check = adler32(&filtered);
        deflate(&filtered, band + 1 == count).map(|packed| (packed, check, filtered.len()))
    };
    let bands: Vec<_> = (0..count).into_par_iter().map(deflated).collect::<Result<_, _>>()?;
    let check = bands.iter().fold(1, |sum, (_, check, length)| joined(sum, *check, *length));
    // 32 KiB of window, no dictionary, the fastest algorithm.
    let mut parts = vec![vec![0x78, 0x01]];
    parts.extend(bands.into_iter().map(|(packed, ..)| packed));
    parts.push(check.to_be_bytes().to_vec());
    Ok(parts)
}

/// The rows of a band with their filter types before them.
fn filtered(band: &[u8], above: Option<&[u8]>, row: usize, pixel: usize) -> Vec<u8> {
    let nothing = vec![0; row];
    let mut above = above.unwrap_or(&nothing);
    let mut filtered = Vec::with_capacity(band.len() + band.len() / row);
    let (mut sub, mut up) = (vec![0; row], vec![0; row]);
    for own in band.chunks_exact(row) {
        sub[..pixel].copy_from_slice(&own[..pixel]);
        subtract(&mut sub[pixel..], &own[pixel..], own);
        subtract(&mut up, own, above);
        let (kind, smaller) = if weight(&up) <= weight(&sub) { (2, &up) } else { (1, &sub) };
        filtered.push(kind);
        filtered.extend_from_slice(smaller);
        above = own;
    }
    filtered
}

fn subtract(out: &mut [u8], from: &[u8], what: &[u8]) {
    for ((out, from), what) in out.iter_mut().zip(from).zip(what) {
        *out = from.wrapping_sub(*what);
    }
}

/// The sum of differences, each as a signed number: what is small is deflated well.
fn weight(differences: &[u8]) -> u64 {
    let short =
        |part: &[u8]| part.iter().map(|&d| u32::from(d.cast_signed().unsigned_abs())).sum::<u32>();
    differences.chunks(1 << 20).map(|part| u64::from(short(part))).sum()
}

/// One band as deflate blocks that end at a whole byte; the last ends the stream.
fn deflate(bytes: &[u8], last: bool) -> Result<Vec<u8>, String> {
    deflate_with(Compress::new(LEVEL, false), bytes, last)
}

/// Bytes as a fresh compressor packs them, up to the end of the stream or, where it goes on, to a whole byte.
pub(super) fn deflate_with(
    mut compress: Compress,
    bytes: &[u8],
    last: bool,
) -> Result<Vec<u8>, String> {
    let flush = if last { FlushCompress::Finish } else { FlushCompress::Sync };
    // In one call: where room runs out, a flush that goes on may leave off before all is written, and does not tell.
    // What cannot be packed is stored, with some bytes before each 32 KiB.
    let mut room = bytes.len() + bytes.len() / 8 + 1024;
    loop {
        let mut packed = Vec::with_capacity(room);
        let status = compress
            .compress_vec(bytes, &mut packed, flush)
            .map_err(|error| format!("it cannot be deflated: {error}"))?;
        let done =
            if last { status == Status::StreamEnd } else { packed.len() < packed.capacity() };
        if done && compress.total_in() as usize == bytes.len() {
            packed.shrink_to_fit();
            return Ok(packed);
        }
        room *= 2;
        compress.reset();
    }
}

/// The largest prime below 2¹⁶.
const PRIME: u32 = 65521;

/// Adler's checksum (RFC 1950).
pub(super) fn adler32(bytes: &[u8]) -> u32 {
    let (mut a, mut b) = (1_u32, 0_u32);
    // So many sums of bytes fit 32 bits.
    for part in bytes.chunks(5552) {
        for &byte in part {
            a += u32::from(byte);
            b += a;
        }
        (a, b) = (a % PRIME, b % PRIME);
    }
    b << 16 | a
}

/// The checksum of two parts, of which the second has `length` bytes.
fn joined(first: u32, second: u32, length: usize) -> u32 {
    let [(a, b), (c, d)] =
        [first, second].map(|sum| (u64::from(sum & 0xffff), u64::from(sum >> 16)));
    let (prime, length) = (u64::from(PRIME), length as u64 % u64::from(PRIME));
    let low = (a + c + prime - 1) % prime;
    let high = (b + d + length * (a + prime - 1)) % prime;
    (high << 16 | low) as u32
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use flate2::read::{DeflateDecoder, ZlibDecoder};

    use super::*;

    #[test]
    fn bands_make_one_stream_that_inflates_to_the_filtered_rows() {
        let (row, pixel) = (4 * 777, 4);
        let bytes: Vec<u8> = (0..row * 400).map(|i| (i * i / 7 % 251) as u8).collect();
        let parts = zlib(&bytes, row, pixel).unwrap();
        assert!(parts.len() > 4, "more than one band");
        let mut inflated = Vec::new();
        ZlibDecoder::new(parts.concat().as_slice()).read_to_end(&mut inflated).unwrap();
        assert_eq!(inflated, filtered(&bytes, None, row, pixel));
    }

    #[test]
    fn a_band_that_hardly_packs_loses_nothing_at_its_end() {
        // Room for a quarter, taken in steps, once lost the last bytes of some bands: of these, with so much noise behind zeros.
        for (bits, from) in [(2, 254_000), (3, 180_000), (4, 176_000), (5, 115_000), (6, 115_000)] {
            let mut state = 1_u32;
            let noise: Vec<u8> = (0..BAND)
                .map(|_| {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    (state >> (32 - bits)) as u8
                })
                .collect();
            for length in (from..from + 4608).step_by(512) {
                let mut bytes = vec![0; BAND];
                bytes[BAND - length..].copy_from_slice(&noise[..length]);
                let packed =
                    [deflate(&bytes, false).unwrap(), deflate(&[], true).unwrap()].concat();
                let mut inflated = Vec::new();
                DeflateDecoder::new(packed.as_slice()).read_to_end(&mut inflated).unwrap();
                assert!(inflated == bytes, "{length} bytes of noise of {bits} bits");
            }
        }
    }

    #[test]
    fn checksums_of_parts_join_to_that_of_the_whole() {
        let bytes: Vec<u8> = (0..200_000_u32).map(|i| (i % 255) as u8 ^ 0xff).collect();
        for cut in [0, 1, 5552, 65_521, 131_072, 200_000] {
            let (first, second) = bytes.split_at(cut);
            assert_eq!(joined(adler32(first), adler32(second), second.len()), adler32(&bytes));
        }
        assert_eq!(adler32(b"Wikipedia"), 0x11e6_0398);
    }
}
