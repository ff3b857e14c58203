//! The 256 words of an MRC or CCP4 header, checked.

use super::super::number::{NumberType, Order};
use super::super::stream::Stream;

/// Bytes of the header.
const LENGTH: usize = 1024;

/// How a voxel is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Mode {
    /// As a number of this type.
    Number(NumberType),
    /// As a float of 16 bits.
    Half,
}

/// What a header says; axes of the file are columns (fastest), rows and sections, those of the cell X, Y and Z.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) order: Order,
    /// Columns, rows, sections.
    pub(super) size: [usize; 3],
    pub(super) mode: Mode,
    /// The first column, row and section, in voxels from the cell's origin.
    pub(super) start: [i32; 3],
    /// Voxels along X, Y and Z of the whole cell.
    pub(super) sampling: [i32; 3],
    /// Lengths of the cell's edges, Å.
    pub(super) lengths: [f64; 3],
    /// Angles of the cell, degrees.
    pub(super) angles: [f64; 3],
    /// The cell's axis (0 to 2) that columns, rows and sections run along: a permutation.
    pub(super) axes: [usize; 3],
    /// Position of the first voxel, Å; 0 where the start says it.
    pub(super) origin: [f64; 3],
    /// Bytes between the header and the voxels.
    pub(super) symmetry_bytes: u64,
}

/// The header's words of four bytes, in its byte order; counted from 1 as the format's description does.
struct Words<'a>(&'a [u8; LENGTH], Order);

impl Words<'_> {
    fn bytes(&self, word: usize) -> [u8; 4] {
        let at = (word - 1) * 4;
        std::array::from_fn(|i| self.0[at + if self.1 == Order::Little { i } else { 3 - i }])
    }

    fn int(&self, word: usize) -> i32 {
        i32::from_le_bytes(self.bytes(word))
    }

    fn ints(&self, word: usize) -> [i32; 3] {
        std::array::from_fn(|i| self.int(word + i))
    }

    fn floats(&self, word: usize) -> [f64; 3] {
        std::array::from_fn(|i| f64::from(f32::from_le_bytes(self.bytes(word + i))))
    }

    /// Whether sizes, mode and axes make sense, as they do in one byte order only.
    fn plausible(&self) -> bool {
        self.ints(1).iter().all(|n| (1..1 << 24).contains(n))
            && (0..=127).contains(&self.int(4))
            && self.ints(17).iter().all(|axis| (0..=3).contains(axis))
    }
}

impl Header {
    /// Reads a header; fails where no byte order makes sense of it, or its voxels are not real numbers.
    pub(super) fn read(stream: &mut Stream) -> Result<Self, String> {
        let block = stream.block::<LENGTH>("its header")?;
        let words = words(&block)?;
        let symmetry = words.int(24);
        Ok(Self {
            order: words.1,
            size: words.ints(1).map(|n| n as usize),
            mode: mode(words.int(4))?,
            start: words.ints(5),
            sampling: words.ints(8),
            lengths: words.floats(11),
            angles: words.floats(14),
            axes: axes(words.ints(17))?,
            origin: words.floats(50),
            symmetry_bytes: u64::try_from(symmetry).map_err(|_| {
                format!(
                    "its header has {symmetry} bytes of symmetry records (NSYMBT), and 0 or more are expected; correct the header"
                )
            })?,
        })
    }
}

/// The machine stamp's byte order if the header makes sense in it, else the other.
fn words(block: &[u8; LENGTH]) -> Result<Words<'_>, String> {
    let stamped = if block[212] == 0x11 { Order::Big } else { Order::Little };
    let other = if stamped == Order::Big { Order::Little } else { Order::Big };
    [stamped, other].map(|order| Words(block, order)).into_iter().find(Words::plausible).ok_or_else(
        || {
            let [columns, rows, sections] = Words(block, stamped).ints(1);
            format!(
                "has {columns} x {rows} x {sections} voxels of mode {} in its header, which makes sense in neither byte order; check that it is an MRC or CCP4 map",
                Words(block, stamped).int(4)
            )
        },
    )
}

fn mode(code: i32) -> Result<Mode, String> {
    match code {
        0 => Ok(Mode::Number(NumberType::I8)),
        1 => Ok(Mode::Number(NumberType::I16)),
        2 => Ok(Mode::Number(NumberType::F32)),
        6 => Ok(Mode::Number(NumberType::U16)),
        12 => Ok(Mode::Half),
        _ => Err(format!(
            "its mode is {code}, and 0, 1, 2, 6 and 12 (real numbers) are read; convert it to mode 2"
        )),
    }
}

/// Words 17 to 19, counted from 0; three zeros, as old programs left, are the usual order.
fn axes(stated: [i32; 3]) -> Result<[usize; 3], String> {
    let mut sorted = stated;
    sorted.sort_unstable();
    match sorted {
        [0, 0, 0] => Ok([0, 1, 2]),
        [1, 2, 3] => Ok(stated.map(|axis| axis as usize - 1)),
        _ => Err(format!(
            "its columns, rows and sections run along the axes {stated:?} (MAPC, MAPR, MAPS), and 1, 2 and 3 in some order are expected; correct the header"
        )),
    }
}
