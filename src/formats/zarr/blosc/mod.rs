//! Blosc's container, version 1: blocks of bytes that are shuffled and packed, each alone, by one of several ways.

mod blosclz;
#[cfg(test)]
mod tests;

use ruzstd::decoding::FrameDecoder;

use super::shuffle::{bits_unshuffled, unshuffled};
use super::unpack::{lz4_into, zlib_into, zstd_into};
use crate::formats::stream::zeros;

/// Bytes of the header.
const HEADER: usize = 16;

/// Numbers of more bytes than this are not packed byte by byte.
const MOST_SPLITS: usize = 16;

/// Nor are blocks of fewer numbers.
const LEAST_OF_SPLIT: usize = 128;

/// How each block is packed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Packed {
    BloscLz,
    Lz4,
    Zlib,
    Zstd,
}

/// How the bytes of a block are ordered.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shuffled {
    No,
    Bytes,
    Bits,
}

/// What a container says of itself.
struct Header {
    packed: Packed,
    shuffled: Shuffled,
    /// Whether its bytes are as they are, after the header.
    plain: bool,
    /// Whether a block may be packed byte by byte of its numbers.
    splits: bool,
    /// Bytes of a number.
    width: usize,
    bytes: usize,
    block: usize,
}

/// Unpacks a container of at most `most` bytes.
pub(super) fn unpacked(bytes: &[u8], most: usize) -> Result<Vec<u8>, String> {
    let header = Header::of(bytes)?;
    if header.bytes > most {
        return Err(format!(
            "unpacks to {} bytes where {most} are the most; fetch the file again",
            header.bytes
        ));
    }
    if header.plain {
        let end = HEADER + header.bytes;
        return Ok(bytes.get(HEADER..end).ok_or_else(damaged)?.to_vec());
    }
    let count = header.bytes.div_ceil(header.block);
    let starts = bytes.get(HEADER..).and_then(|rest| rest.get(..count.checked_mul(4)?));
    let starts = starts.ok_or_else(damaged)?;
    let mut all = zeros(header.bytes)?;
    let mut room = zeros(header.block.min(header.bytes))?;
    let mut zstd = FrameDecoder::new();
    for (into, start) in all.chunks_mut(header.block).zip(starts.chunks_exact(4)) {
        let block = bytes.get(number(start)..).ok_or_else(damaged)?;
        header.block(block, into, &mut room, &mut zstd)?;
    }
    Ok(all)
}

impl Header {
    fn of(bytes: &[u8]) -> Result<Self, String> {
        let head = bytes.first_chunk::<HEADER>().ok_or_else(damaged)?;
        let [version, _, flags, width] = [head[0], head[1], head[2], head[3]];
        if !(1..=2).contains(&version) {
            return Err(format!(
                "is of Blosc's format {version}, and 1 and 2 are read; write it with c-blosc 1, as zarr-python does"
            ));
        }
        let plain = flags & 2 != 0;
        let packed = match flags >> 5 {
            0 => Packed::BloscLz,
            1 => Packed::Lz4,
            3 => Packed::Zlib,
            4 => Packed::Zstd,
            // What is not packed was not packed by it.
            _ if plain => Packed::Lz4,
            other => {
                let name = if other == 2 { "Snappy" } else { "a way unknown" };
                return Err(format!(
                    "is packed by {name} within Blosc, and blosclz, lz4, lz4hc, zlib and zstd are read; write the array with `cname` \"zstd\""
                ));
            }
        };
        let shuffled = match flags & 5 {
            1 => Shuffled::Bytes,
            4 => Shuffled::Bits,
            _ => Shuffled::No,
        };
        let (size, block) = (number(&head[4..8]), number(&head[8..12]));
        if !plain && size > 0 && block == 0 {
            return Err(damaged());
        }
        let (width, splits) = (usize::from(width).max(1), flags & 16 == 0);
        Ok(Self { packed, shuffled, plain, splits, width, bytes: size, block: block.max(1) })
    }

    /// Unpacks a block that begins at `bytes` into its place.
    fn block(
        &self,
        bytes: &[u8],
        into: &mut [u8],
        room: &mut [u8],
        zstd: &mut FrameDecoder,
    ) -> Result<(), String> {
        let whole = into.len() == self.block;
        let splits = self.splits
            && whole
            && self.width <= MOST_SPLITS
            && self.block / self.width >= LEAST_OF_SPLIT
            && self.block.is_multiple_of(self.width);
        let part = if splits { into.len() / self.width } else { into.len() };
        if self.shuffled == Shuffled::No {
            return self.parts(bytes, into.chunks_mut(part), zstd);
        }
        let room = &mut room[..into.len()];
        self.parts(bytes, room.chunks_mut(part), zstd)?;
        match self.shuffled {
            Shuffled::Bits => bits_unshuffled(room, into, self.width),
            _ => unshuffled(room, into, self.width),
        }
        Ok(())
    }

    /// Unpacks the parts of a block, each after its length.
    fn parts<'b>(
        &self,
        mut bytes: &[u8],
        parts: impl Iterator<Item = &'b mut [u8]>,
        zstd: &mut FrameDecoder,
    ) -> Result<(), String> {
        for into in parts {
            let (length, rest) = bytes.split_at_checked(4).ok_or_else(damaged)?;
            let (own, rest) = rest.split_at_checked(number(length)).ok_or_else(damaged)?;
            bytes = rest;
            if own.len() == into.len() {
                into.copy_from_slice(own);
                continue;
            }
            match self.packed {
                Packed::BloscLz => blosclz::unpacked(own, into).ok_or_else(damaged)?,
                Packed::Lz4 => lz4_into(own, into)?,
                Packed::Zlib => zlib_into(own, into)?,
                Packed::Zstd => zstd_into(zstd, own, into)?,
            }
        }
        Ok(())
    }
}

/// A number of four bytes, the lowest first.
fn number(bytes: &[u8]) -> usize {
    bytes.iter().rev().fold(0, |sum, &byte| sum << 8 | usize::from(byte))
}

fn damaged() -> String {
    "is damaged: its blocks are not what its header says; fetch the file again".to_owned()
}
