//! The voxels of an array from its chunks: unpacked several at once, and put where they belong.

use bytemuck::Pod;
use rayon::prelude::*;

use super::array::{Array, Content};
use super::axes::View;
use super::keys::{Found, chunks};
use super::packing::unpacked;
use super::shard::{Piece, pieces, read};
use crate::formats::number::{NumberSource, Order, Stored, to_native};
use crate::formats::numpy::Element;
use crate::formats::stream::room;
use crate::formats::survey::of_size;

/// The most that chunks unpack to for each byte of their files: more than a block of zstd, of 128 KiB in 4 bytes, does.
const MOST_PACKED: u64 = 1 << 15;

/// Bytes that an array may be long whatever there is of its chunks: the rest is its fill value.
const UNBACKED: u64 = 1 << 30;

/// Bytes of chunks that are unpacked at once, if that is not fewer than one a thread, and the most chunks at once.
const AT_ONCE: u64 = 16 << 20;
const MOST_AT_ONCE: u64 = 256;

/// Bytes that a chunk may be longer packed than twice its numbers.
const SLACK: u64 = 64 << 10;

/// The chunks of an array that hold voxels, to be read as numbers.
pub(super) struct Source<'a> {
    array: &'a Array,
    view: &'a View,
    pub found: Vec<Found>,
    /// Chunks that were read; those that there were not are the fill value.
    pub read: u64,
}

impl<'a> Source<'a> {
    /// Finds the chunks; fails where they cannot be those of an array so large.
    pub fn of(array: &'a Array, view: &'a View) -> Result<Self, String> {
        let found = chunks(array, &view.fixed)?;
        let files = found.iter().fold(0_u64, |all, chunk| all.saturating_add(chunk.length));
        let source = Self { array, view, found, read: 0 };
        let needed = source.voxel_bytes().saturating_add(array.chunk_bytes());
        if needed > UNBACKED.saturating_add(files.saturating_mul(MOST_PACKED)) {
            return Err(format!(
                "is truncated: its {:?} numbers need {needed} bytes, which {} chunks of {files} bytes cannot hold; fetch the rest of it or correct its shape",
                array.shape,
                source.found.len()
            ));
        }
        Ok(source)
    }

    /// Numbers of a voxel.
    fn each(&self) -> usize {
        if self.view.axes.len() == 4 { 4 } else { 1 }
    }

    /// Bytes of the voxels as they are kept.
    fn voxel_bytes(&self) -> u64 {
        let each = match self.array.element {
            Element::Number(kind) => kind.bytes() * self.each(),
            Element::Half => size_of::<u16>() + size_of::<f32>(),
        };
        of_size(self.view.size, each)
    }

    /// The most bytes that reading takes: the voxels, and for the chunks that are unpacked at once what they are packed and
    /// unpacked, and what unpacking itself takes.
    pub fn bytes(&self) -> u64 {
        let chunk = self.array.chunk_bytes().saturating_mul(5).saturating_add(SLACK);
        let at_once = self.at_once().min(self.expected()) * u64::from(!self.found.is_empty());
        self.voxel_bytes().saturating_add(chunk.saturating_mul(at_once))
    }

    /// Chunks that are unpacked at once.
    fn at_once(&self) -> u64 {
        let threads = rayon::current_num_threads() as u64;
        (AT_ONCE / self.array.chunk_bytes().max(1)).min(MOST_AT_ONCE).max(threads)
    }

    /// The innermost chunks that there would be if none were left out.
    pub fn expected(&self) -> u64 {
        let (chunk, _) = self.array.innermost();
        self.view.axes.iter().fold(1, |all: u64, &axis| {
            all.saturating_mul(self.array.shape[axis].div_ceil(chunk[axis]) as u64)
        })
    }

    /// Reads chunks into their places among the voxels.
    fn fill<T: Stored>(&mut self, into: &mut [T]) -> Result<(), String> {
        let most = usize::try_from(self.at_once()).unwrap_or(usize::MAX);
        let mut waiting = Vec::new();
        for found in &self.found {
            let own = pieces(self.array, &self.view.fixed, found).map_err(|p| blame(found, &p))?;
            self.read += own.len() as u64;
            for piece in own {
                waiting.push((found, piece));
                if waiting.len() == most {
                    self.place(&waiting, into)?;
                    waiting.clear();
                }
            }
        }
        self.place(&waiting, into)
    }

    /// Unpacks some chunks, and copies their numbers to the voxels.
    fn place<T: Stored>(&self, waiting: &[(&Found, Piece)], into: &mut [T]) -> Result<(), String> {
        let unpacked = waiting.par_iter().map(|(found, piece)| {
            self.unpacked(found, piece).map_err(|problem| blame(found, &problem))
        });
        let unpacked = unpacked.collect::<Result<Vec<_>, String>>()?;
        for ((_, piece), (bytes, order)) in waiting.iter().zip(unpacked) {
            let (dimensions, from, to) = self.dimensions(piece);
            copy(&dimensions, (&bytes, from), (into, to), order);
        }
        Ok(())
    }

    fn unpacked(&self, found: &Found, piece: &Piece) -> Result<(Vec<u8>, Order), String> {
        let (_, chain) = self.array.innermost();
        let Content::Numbers(order, packings) = &chain.content else {
            return Err("holds no numbers; write it again".to_owned());
        };
        let (needed, length) = (self.array.chunk_bytes(), piece.bytes.end - piece.bytes.start);
        if length > needed.saturating_mul(2).saturating_add(SLACK) {
            return Err(format!(
                "is {length} bytes long and its numbers are {needed}; write it again"
            ));
        }
        if needed > length.saturating_mul(MOST_PACKED) {
            return Err(format!(
                "is truncated: it needs {needed} bytes, which {length} cannot hold; fetch the file again"
            ));
        }
        let bytes = read(&found.path, &piece.bytes)?;
        Ok((unpacked(bytes, packings, needed as usize)?, *order))
    }

    /// For each axis of voxels, the fastest first, how many numbers of a chunk lie there, and how far apart they are in the
    /// chunk and among the voxels; and where the first of them is in both.
    fn dimensions(&self, piece: &Piece) -> (Vec<Dimension>, usize, usize) {
        let (chunk, chain) = self.array.innermost();
        let mut strides = vec![0; chunk.len()];
        let mut stride = 1;
        for &axis in chain.axes.iter().rev() {
            strides[axis] = stride;
            stride *= chunk[axis];
        }
        let fixed = self.view.fixed.iter().enumerate();
        let from = fixed
            .filter_map(|(axis, fixed)| Some((fixed.as_ref()? - piece.at[axis]) * strides[axis]));
        let from = from.sum();
        let (mut to, mut among) = (0, 1);
        let mut dimensions = Vec::new();
        for &axis in &self.view.axes {
            let (shape, at) = (self.array.shape[axis], piece.at[axis]);
            dimensions.push(Dimension {
                count: chunk[axis].min(shape - at),
                from: strides[axis],
                to: among,
            });
            to += at * among;
            among *= shape;
        }
        (dimensions, from, to)
    }
}

impl NumberSource for Source<'_> {
    fn array<E: Pod, T: Stored>(&mut self, count: usize) -> Result<Vec<E>, String> {
        let fill = T::parsed(&self.array.fill).ok_or_else(|| {
            format!(
                "its `fill_value` is {}, which is no number of its type; correct it",
                self.array.fill
            )
        })?;
        let mut elements: Vec<E> = Vec::new();
        room(&mut elements, count)?;
        elements.resize(count, E::zeroed());
        let numbers: &mut [T] = bytemuck::cast_slice_mut(&mut elements);
        if !bytemuck::bytes_of(&fill).iter().all(|&byte| byte == 0) {
            numbers.fill(fill);
        }
        self.fill(numbers)?;
        Ok(elements)
    }
}

/// An axis of a chunk that is copied: how many numbers, and how far apart they are there and where they go.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Dimension {
    count: usize,
    from: usize,
    to: usize,
}

/// Copies numbers over the axes, the slowest of which is the last; `at` in both are indices of numbers.
fn copy<T: Stored>(
    dimensions: &[Dimension],
    (bytes, from): (&[u8], usize),
    (into, to): (&mut [T], usize),
    order: Order,
) {
    let Some((last, inner)) = dimensions.split_last() else { return };
    let width = size_of::<T>();
    if !inner.is_empty() {
        for step in 0..last.count {
            copy(inner, (bytes, from + step * last.from), (into, to + step * last.to), order);
        }
    } else if last.from == 1 && last.to == 1 {
        let own = &mut into[to..to + last.count];
        let read = &bytes[from * width..(from + last.count) * width];
        bytemuck::cast_slice_mut(own).copy_from_slice(read);
        to_native(own, order);
    } else {
        for step in 0..last.count {
            let at = (from + step * last.from) * width;
            let own = &mut into[to + step * last.to..][..1];
            own[0] = bytemuck::pod_read_unaligned(&bytes[at..at + width]);
            to_native(own, order);
        }
    }
}

fn blame(found: &Found, problem: &str) -> String {
    format!("its chunk `{}` {problem}", found.path.display())
}
