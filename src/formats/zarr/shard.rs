//! The chunks within a file: the file itself, or what the tables of its shards lead to.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use super::array::{Array, Content, Shard};
use super::crc32c::checked;
use super::keys::Found;
use crate::formats::number::Order;
use crate::formats::stream::zeros;

/// An innermost chunk.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Piece {
    /// Where its bytes are in its file.
    pub bytes: Range<u64>,
    /// The index of its first number, on each axis of the array.
    pub at: Vec<usize>,
}

/// The innermost chunks of a file that hold numbers of the array, of index `fixed` on each axis that states one.
pub(super) fn pieces(
    array: &Array,
    fixed: &[Option<usize>],
    found: &Found,
) -> Result<Vec<Piece>, String> {
    let at = found.at.iter().zip(&array.chunk).map(|(at, chunk)| at * chunk).collect();
    let mut pieces = vec![Piece { bytes: 0..found.length, at }];
    let (mut chunk, mut chain) = (&array.chunk, &array.chain);
    while let Content::Shard(shard) = &chain.content {
        let mut inner = Vec::new();
        for piece in pieces {
            let table = table(&found.path, &piece.bytes, chunk, shard)?;
            let own = inner_pieces(&piece, &table, chunk, shard)?;
            let is_wanted = |piece: &Piece| is_wanted(piece, &shard.chunk, array, fixed);
            inner.extend(own.into_iter().filter(is_wanted));
        }
        (pieces, chunk, chain) = (inner, &shard.chunk, &shard.chain);
    }
    Ok(pieces)
}

fn is_wanted(piece: &Piece, chunk: &[usize], array: &Array, fixed: &[Option<usize>]) -> bool {
    let axes = piece.at.iter().zip(chunk).zip(array.shape.iter().zip(fixed));
    axes.into_iter().all(|((&at, &chunk), (&shape, fixed))| {
        at < shape && fixed.is_none_or(|fixed| (at..at.saturating_add(chunk)).contains(&fixed))
    })
}

/// The table of a shard: for each of its chunks where it begins and how long it is, in bytes.
fn table(
    path: &Path,
    within: &Range<u64>,
    outer: &[usize],
    shard: &Shard,
) -> Result<Vec<[u64; 2]>, String> {
    let rows = outer.iter().zip(&shard.chunk).map(|(outer, inner)| outer / inner);
    let rows = rows.fold(1_u64, |all, rows| all.saturating_mul(rows as u64));
    let length = rows.saturating_mul(16).saturating_add(if shard.table.summed { 4 } else { 0 });
    if length > within.end - within.start {
        return Err(format!(
            "is truncated: the table of its {rows} chunks needs {length} bytes and it has {}; fetch the file again",
            within.end - within.start
        ));
    }
    let start = if shard.table.first { within.start } else { within.end - length };
    let bytes = read(path, &(start..start + length))?;
    let bytes = if shard.table.summed { checked(&bytes)? } else { &bytes };
    let number = |eight: &[u8]| {
        let eight: [u8; 8] = eight.try_into().unwrap_or_default();
        match shard.table.order {
            Order::Little => u64::from_le_bytes(eight),
            Order::Big => u64::from_be_bytes(eight),
        }
    };
    Ok(bytes.chunks_exact(16).map(|row| [number(&row[..8]), number(&row[8..])]).collect())
}

/// The chunks that a table leads to: those that there are.
fn inner_pieces(
    outer: &Piece,
    table: &[[u64; 2]],
    outer_chunk: &[usize],
    shard: &Shard,
) -> Result<Vec<Piece>, String> {
    let mut pieces = Vec::new();
    for (row, &[start, length]) in table.iter().enumerate() {
        if [start, length] == [u64::MAX; 2] {
            continue;
        }
        let end = outer.bytes.start.checked_add(start).and_then(|start| start.checked_add(length));
        let end = end.filter(|&end| end <= outer.bytes.end);
        let end = end.ok_or("is damaged: its table leads out of it; fetch the file again")?;
        let mut at = outer.at.clone();
        let mut rest = row;
        for axis in (0..at.len()).rev() {
            let count = outer_chunk[axis] / shard.chunk[axis];
            at[axis] += rest % count * shard.chunk[axis];
            rest /= count;
        }
        pieces.push(Piece { bytes: end - length..end, at });
    }
    Ok(pieces)
}

/// Bytes of a file.
pub(super) fn read(path: &Path, bytes: &Range<u64>) -> Result<Vec<u8>, String> {
    let mut all = zeros((bytes.end - bytes.start) as usize)?;
    let read = File::open(path).and_then(|mut file| {
        file.seek(SeekFrom::Start(bytes.start))?;
        file.read_exact(&mut all)
    });
    read.map_err(|error| format!("cannot be read ({error}); check its permissions"))?;
    Ok(all)
}
