//! How the bytes of a chunk are packed: Zarr's compressors, filters and codecs of bytes, by their names.

use flate2::bufread::{MultiGzDecoder, ZlibDecoder};
use serde_json::Value;

use super::shuffle::unshuffled;
use super::{blosc, crc32c, unpack};
use crate::formats::stream::zeros;

/// A way of packing bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Packing {
    /// gzip, of any number of members.
    Gzip,
    /// zlib.
    Zlib,
    /// Zstandard.
    Zstd,
    /// A block of LZ4 after its length.
    Lz4,
    /// Blosc's container.
    Blosc,
    /// A checksum at the end.
    Crc32c,
    /// The bytes of numbers of so many bytes in the order of their places.
    Shuffle(usize),
}

impl Packing {
    /// The packing of a name, and of what is stated with it.
    pub(super) fn named(name: &str, stated: &Value) -> Result<Self, String> {
        Ok(match name.strip_prefix("numcodecs.").unwrap_or(name) {
            "gzip" => Self::Gzip,
            "zlib" => Self::Zlib,
            "zstd" => Self::Zstd,
            "lz4" => Self::Lz4,
            "blosc" => Self::Blosc,
            "crc32c" => Self::Crc32c,
            "shuffle" => {
                let width = stated.get("elementsize").map_or(Some(4), Value::as_u64);
                let width = width.filter(|width| (1..=256).contains(width));
                Self::Shuffle(width.ok_or("its `elementsize` is not 1 to 256; correct it")? as usize)
            }
            other => {
                return Err(format!(
                    "its chunks are packed by `{other}`, and gzip, zlib, zstd, lz4, blosc, shuffle and crc32c are read; write it with one of these, such as zstd"
                ));
            }
        })
    }

    /// Unpacks bytes to at most `most`.
    fn unpacked(self, bytes: &[u8], most: usize) -> Result<Vec<u8>, String> {
        match self {
            Self::Gzip => unpack::to_end(MultiGzDecoder::new(bytes), most),
            Self::Zlib => unpack::to_end(ZlibDecoder::new(bytes), most),
            Self::Zstd => unpack::zstd(bytes, most),
            Self::Lz4 => unpack::lz4(bytes, most),
            Self::Blosc => blosc::unpacked(bytes, most),
            Self::Crc32c => crc32c::checked(bytes).map(<[u8]>::to_vec),
            Self::Shuffle(width) => {
                let mut into = zeros(bytes.len())?;
                unshuffled(bytes, &mut into, width);
                Ok(into)
            }
        }
    }
}

/// Unpacks a chunk of exactly `needed` bytes, that was packed in each of these ways, one after another.
pub(super) fn unpacked(
    mut bytes: Vec<u8>,
    packings: &[Packing],
    needed: usize,
) -> Result<Vec<u8>, String> {
    for (at, packing) in packings.iter().enumerate().rev() {
        bytes = packing.unpacked(&bytes, most(&packings[..at], needed))?;
    }
    if bytes.len() == needed {
        return Ok(bytes);
    }
    Err(format!(
        "holds {} bytes of numbers where {needed} are expected; fetch the file again",
        bytes.len()
    ))
}

/// The most bytes that `needed` are once they are packed in each of these ways: none makes them much longer.
fn most(packings: &[Packing], needed: usize) -> usize {
    packings.iter().fold(needed, |most, packing| match packing {
        Packing::Crc32c => most.saturating_add(4),
        Packing::Shuffle(_) => most,
        _ => most.saturating_add(most / 8).saturating_add(1 << 10),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::made::{gzip, zlib};

    fn summed(bytes: &[u8]) -> Vec<u8> {
        [bytes, &crc32c::crc32c(bytes).to_le_bytes()].concat()
    }

    #[test]
    fn what_was_packed_last_is_unpacked_first() {
        let packed = gzip(&summed(&zlib(&[1, 3, 2, 4])));
        let ways = [Packing::Shuffle(2), Packing::Zlib, Packing::Crc32c, Packing::Gzip];
        assert_eq!(unpacked(packed.clone(), &ways, 4).unwrap(), [1, 2, 3, 4]);
        for (needed, said) in [(5, "where 5"), (3, "more than the 3")] {
            let problem = unpacked(packed.clone(), &ways, needed).unwrap_err();
            assert!(problem.contains(said), "{problem}");
        }
    }

    #[test]
    fn a_bomb_is_held_to_its_chunk() {
        let bomb = gzip(&vec![0; 8 << 20]);
        assert!(unpacked(bomb, &[Packing::Gzip], 1000).unwrap_err().contains("1000 bytes"));
    }

    #[test]
    fn what_is_not_read_is_named_with_a_remedy() {
        let problem = Packing::named("bz2", &Value::Null).unwrap_err();
        assert!(problem.contains("`bz2`") && problem.contains("such as zstd"), "{problem}");
        assert_eq!(Packing::named("numcodecs.zlib", &Value::Null), Ok(Packing::Zlib));
    }
}
