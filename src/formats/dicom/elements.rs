//! The data elements of a DICOM file (PS3.5 §7): tags with their values, sequences left out, up to the pixels.

use super::super::number::Order;
use super::super::stream::Stream;

/// Whether a file starts as DICOM.
pub(crate) fn recognizes(head: &[u8]) -> bool {
    head.get(128..132) == Some(b"DICM")
}

/// Bytes of a value that is kept; what is wanted of a header is short.
const LONGEST: u64 = 1 << 14;

/// Sequences within sequences that are followed.
const DEEPEST: usize = 64;

/// The length that stands for one that a delimiter ends.
const UNDEFINED: u32 = u32::MAX;

const ITEM: u32 = 0xfffe_e000;
const ITEM_END: u32 = 0xfffe_e00d;
const SEQUENCE_END: u32 = 0xfffe_e0dd;

/// Where the pixels begin.
pub(super) const PIXELS: u32 = 0x7fe0_0010;

/// How elements are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Writing {
    pub order: Order,
    /// Whether each says its type.
    pub explicit: bool,
}

/// How the pixels stand in the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Pixels {
    /// So many bytes of numbers.
    Native(u32),
    /// Fragments of a packed picture.
    Packed,
}

/// A file that is read element by element.
pub(super) struct Elements {
    pub stream: Stream,
    writing: Writing,
    /// Whether the elements of the file's own group have not ended: they are written one way in every file.
    own: bool,
}

/// The start of an element: what it is and how long.
struct Start {
    tag: u32,
    length: u32,
    /// Whether what is inside is written without types, whatever the file is.
    unknown: bool,
}

impl Elements {
    /// A file, which begins with 128 bytes of anything and a word.
    pub fn of(mut stream: Stream) -> Result<Self, String> {
        let start = stream.block::<132>("its header")?;
        if !recognizes(&start) {
            return Err("lacks the word DICM of a DICOM file; check that it is one".to_owned());
        }
        let writing = Writing { order: Order::Little, explicit: true };
        Ok(Self { stream, writing, own: true })
    }

    /// Reads to the pixels, or to the end of the file where there are none.
    ///
    /// Each value that is short and in no sequence is handed to `take`; of what it returns, the last says how the elements
    /// after the file's own group are written.
    pub fn walk(
        &mut self,
        mut take: impl FnMut(u32, &[u8], Order) -> Result<Option<Writing>, String>,
    ) -> Result<Option<Pixels>, String> {
        let mut after = self.writing;
        while !self.stream.buffered()?.is_empty() {
            let start = self.start(&mut after)?;
            if start.tag == PIXELS {
                let packed = start.length == UNDEFINED;
                return Ok(Some(if packed {
                    Pixels::Packed
                } else {
                    Pixels::Native(start.length)
                }));
            }
            if start.length == UNDEFINED {
                self.skip_items(start.unknown, 0)?;
            } else if u64::from(start.length) > LONGEST {
                self.stream.skip_bytes(start.length.into())?;
            } else {
                let value = self.stream.array::<u8>(start.length as usize)?;
                if let Some(found) = take(start.tag, &value, self.writing.order)? {
                    after = found;
                }
            }
        }
        Ok(None)
    }

    /// The fragments of packed pixels one after the other, without the table of offsets before them.
    pub(crate) fn fragments(&mut self) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        let mut first = true;
        loop {
            let start = self.start(&mut self.writing.clone())?;
            match start.tag {
                ITEM if start.length != UNDEFINED => {
                    let more = self.stream.array::<u8>(start.length as usize)?;
                    if !first {
                        bytes.extend(more);
                    }
                    first = false;
                }
                SEQUENCE_END => return Ok(bytes),
                _ => return Err(damaged("its pixels are no fragments")),
            }
        }
    }

    /// The start of the next element; `after` is how elements are written once the file's own group has ended.
    fn start(&mut self, after: &mut Writing) -> Result<Start, String> {
        let bytes = self.stream.block::<4>("its elements")?;
        if self.own && bytes[..2] != [2, 0] {
            self.own = false;
            self.writing = *after;
        }
        let order = self.writing.order;
        let group = u32::from(short(&bytes[..2], order));
        let tag = group << 16 | u32::from(short(&bytes[2..], order));
        if group == 0xfffe || !self.writing.explicit {
            let length = long(&self.stream.block::<4>("its elements")?, order);
            return Ok(Start { tag, length, unknown: false });
        }
        let kind = self.stream.block::<4>("its elements")?;
        let known = [
            b"OB", b"OD", b"OF", b"OL", b"OV", b"OW", b"SQ", b"SV", b"UC", b"UN", b"UR", b"UT",
            b"UV",
        ];
        let length = if known.iter().any(|long| kind[..2] == **long) {
            long(&self.stream.block::<4>("its elements")?, order)
        } else {
            u32::from(short(&kind[2..], order))
        };
        Ok(Start { tag, length, unknown: &kind[..2] == b"UN" })
    }

    /// Leaves out the items of a sequence, to its delimiter.
    fn skip_items(&mut self, unknown: bool, depth: usize) -> Result<(), String> {
        if depth > DEEPEST {
            return Err(damaged("its sequences do not end"));
        }
        let outside = self.writing;
        if unknown {
            self.writing = Writing { order: Order::Little, explicit: false };
        }
        loop {
            let start = self.start(&mut self.writing.clone())?;
            match start.tag {
                SEQUENCE_END => break,
                ITEM if start.length == UNDEFINED => self.skip_item(depth)?,
                ITEM => self.stream.skip_bytes(start.length.into())?,
                _ => return Err(damaged("a sequence holds something that is no item")),
            }
        }
        self.writing = outside;
        Ok(())
    }

    /// Leaves out the elements of an item, to its delimiter.
    fn skip_item(&mut self, depth: usize) -> Result<(), String> {
        loop {
            let start = self.start(&mut self.writing.clone())?;
            match start {
                Start { tag: ITEM_END, .. } => return Ok(()),
                Start { length: UNDEFINED, unknown, .. } => self.skip_items(unknown, depth + 1)?,
                Start { length, .. } => self.stream.skip_bytes(length.into())?,
            }
        }
    }
}

fn damaged(what: &str) -> String {
    format!("is damaged: {what}; fetch the file again")
}

/// The first two bytes as a number; 0 where there are fewer.
pub(super) fn short(bytes: &[u8], order: Order) -> u16 {
    let two = bytes.first_chunk().copied().unwrap_or_default();
    if order == Order::Big { u16::from_be_bytes(two) } else { u16::from_le_bytes(two) }
}

/// The first four bytes as a number; 0 where there are fewer.
pub(super) fn long(bytes: &[u8], order: Order) -> u32 {
    let four = bytes.first_chunk().copied().unwrap_or_default();
    if order == Order::Big { u32::from_be_bytes(four) } else { u32::from_le_bytes(four) }
}
