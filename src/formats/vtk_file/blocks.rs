//! Values of a VTK file as bytes: after their length, or packed by zlib in blocks after a table of lengths.

use crate::formats::base64::decoded;
use crate::formats::number::Order;
use crate::formats::stream::{Stream, room};

/// How bytes are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    Raw,
    Base64,
}

/// How the values of a file are written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Written {
    pub encoding: Encoding,
    pub order: Order,
    /// Bytes of a length: 4 or 8.
    pub width: usize,
}

impl Written {
    /// The first `count` bytes of what is written.
    fn first(self, bytes: &[u8], count: usize) -> Result<Vec<u8>, String> {
        match self.encoding {
            Encoding::Raw => bytes.get(..count).map(<[u8]>::to_vec).ok_or_else(truncated),
            Encoding::Base64 => decoded(bytes, count).ok_or_else(truncated),
        }
    }

    fn lengths(self, bytes: &[u8]) -> Vec<u64> {
        let fold = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
        let length = |bytes: &[u8]| match self.order {
            Order::Big => bytes.iter().fold(0, fold),
            Order::Little => bytes.iter().rev().fold(0, fold),
        };
        bytes.chunks_exact(self.width).map(length).collect()
    }
}

/// Bytes of a plain array of `needed` bytes: its length goes before it.
pub(super) fn plain(bytes: &[u8], written: Written, needed: usize) -> Result<Vec<u8>, String> {
    let width = written.width;
    let all = written.first(bytes, width.saturating_add(needed))?;
    let [length] = written.lengths(&all[..width])[..] else { return Err(truncated()) };
    if length < needed as u64 {
        return Err(format!(
            "its values are {length} bytes where {needed} are needed; save it again"
        ));
    }
    Ok(all[width..].to_vec())
}

/// Bytes of an array of `needed` bytes that is packed in blocks.
pub(super) fn inflated(bytes: &[u8], written: Written, needed: usize) -> Result<Vec<u8>, String> {
    let width = written.width;
    let start = written.lengths(&written.first(bytes, 3 * width)?);
    let [count, block, last] = start[..] else { return Err(truncated()) };
    // Each block has a length in the table.
    let count = usize::try_from(count).ok().filter(|&count| count <= bytes.len() / width);
    let count = count.ok_or_else(truncated)?;
    let table = (3 + count) * width;
    let lengths = written.lengths(&written.first(bytes, table)?);
    let packed: u64 = lengths[3..].iter().fold(0, |sum, &length| sum.saturating_add(length));
    let rest = match written.encoding {
        Encoding::Raw => bytes.get(table..),
        Encoding::Base64 => {
            let start = bytes.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(0);
            bytes.get(start + table.div_ceil(3) * 4..)
        }
    };
    let packed = usize::try_from(packed).map_err(|_| truncated())?;
    let packed = written.first(rest.ok_or_else(truncated)?, packed)?;
    let mut values: Vec<u8> = Vec::new();
    let mut from = 0;
    for (number, &length) in lengths[3..].iter().enumerate() {
        let size = if number + 1 == count && last > 0 { last } else { block };
        let size = usize::try_from(size).unwrap_or(usize::MAX).min(needed - values.len());
        let own = packed[from..from + length as usize].to_vec();
        from += length as usize;
        let more = Stream::of(own).inflated_zlib().array::<u8>(size)?;
        room(&mut values, more.len())?;
        values.extend(more);
    }
    if values.len() < needed { Err(truncated()) } else { Ok(values) }
}

fn truncated() -> String {
    "is truncated: its values are fewer bytes than it says; fetch the file again".to_owned()
}
