//! The 348 bytes of a NIfTI-1 header, checked.

use super::super::number::{NumberType, Order};
use super::super::stream::Stream;

/// Bytes of the header.
pub(super) const LENGTH: usize = 348;
/// The first byte that may hold a voxel: four bytes after the header tell of extensions.
const FIRST_VOXEL: f32 = 352.0;

/// What a header says.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) order: Order,
    pub(super) size: [usize; 3],
    /// How many volumes of that size follow each other, at least 1.
    pub(super) times: usize,
    /// The type of its numbers; `None` for RGBA of 8 bits each.
    pub(super) kind: Option<NumberType>,
    /// Bytes from the start of the file to the first voxel.
    pub(super) voxel_offset: u64,
    pub(super) slope: f64,
    pub(super) intercept: f64,
    /// `pixdim`: the handedness of the quaternion, then the spacings.
    pub(super) spacing: [f64; 4],
    pub(super) quaternion_code: i16,
    /// b, c, d, then the offset x, y, z.
    pub(super) quaternion: [f64; 6],
    pub(super) affine_code: i16,
    /// Three rows of four.
    pub(super) affine: [f64; 12],
}

/// The header's bytes, with numbers in its byte order.
struct Words<'a>(&'a [u8; LENGTH], Order);

impl Words<'_> {
    fn bytes<const N: usize>(&self, at: usize) -> [u8; N] {
        std::array::from_fn(|i| self.0[at + if self.1 == Order::Little { i } else { N - 1 - i }])
    }

    fn short(&self, at: usize) -> i16 {
        i16::from_le_bytes(self.bytes(at))
    }

    fn float(&self, at: usize) -> f32 {
        f32::from_le_bytes(self.bytes(at))
    }

    fn floats<const N: usize>(&self, at: usize) -> [f64; N] {
        std::array::from_fn(|i| f64::from(self.float(at + 4 * i)))
    }
}

impl Header {
    /// Reads a header; fails where it is of another format, of another type or of no volumes of three axes.
    pub(super) fn read(stream: &mut Stream) -> Result<Self, String> {
        let block = stream.block::<LENGTH>("its header")?;
        let words = Words(&block, order(&block)?);
        match &block[344..348] {
            b"n+1\0" => {}
            b"ni1\0" => {
                return Err(
                    "is the header of a pair .hdr and .img; join them in one .nii file".to_owned()
                );
            }
            found => {
                return Err(format!(
                    "has `{}` where NIfTI-1 has `n+1`; check that it is what its name says",
                    found.escape_ascii()
                ));
            }
        }
        let (size, times) = size(&words)?;
        Ok(Self {
            order: words.1,
            size,
            times,
            kind: kind(words.short(70))?,
            voxel_offset: voxel_offset(words.float(108))?,
            slope: f64::from(Some(words.float(112)).filter(|s| s.is_normal()).unwrap_or(1.0)),
            intercept: scale_intercept(&words),
            spacing: words.floats(76),
            quaternion_code: words.short(252),
            quaternion: words.floats(256),
            affine_code: words.short(254),
            affine: words.floats(280),
        })
    }
}

/// The byte order in which the header's first word is its length.
fn order(block: &[u8; LENGTH]) -> Result<Order, String> {
    let first = [block[0], block[1], block[2], block[3]];
    let (little, big) = (i32::from_le_bytes(first), i32::from_be_bytes(first));
    match (little, big) {
        (348, _) => Ok(Order::Little),
        (_, 348) => Ok(Order::Big),
        (540, _) | (_, 540) => {
            Err("is NIfTI-2, and NIfTI-1 is read; save it again as NIfTI-1 or NRRD".to_owned())
        }
        _ => Err(format!(
            "has {little} (or {big}) as its header's length in either byte order, and NIfTI-1 has 348; check that it is what its name says"
        )),
    }
}

/// Voxels on each axis of space, and how many volumes of them there are in time.
fn size(words: &Words) -> Result<([usize; 3], usize), String> {
    let sizes: [i16; 8] = std::array::from_fn(|i| words.short(40 + 2 * i));
    let axes = usize::try_from(sizes[0]).unwrap_or(0);
    let flat = sizes.get(5..=axes).is_none_or(|more| more.iter().all(|&n| n == 1));
    let times = if axes < 4 { 1 } else { sizes[4] };
    if !(3..=7).contains(&axes) || !flat || times < 1 || sizes[1..4].iter().any(|&n| n < 1) {
        return Err(format!(
            "its `dim` is {sizes:?}, and a volume of three axes or a series of such in time is expected; take one volume out and save it alone"
        ));
    }
    Ok(([sizes[1] as usize, sizes[2] as usize, sizes[3] as usize], times as usize))
}

fn kind(code: i16) -> Result<Option<NumberType>, String> {
    Ok(Some(match code {
        2 => NumberType::U8,
        4 => NumberType::I16,
        8 => NumberType::I32,
        16 => NumberType::F32,
        64 => NumberType::F64,
        256 => NumberType::I8,
        512 => NumberType::U16,
        768 => NumberType::U32,
        1024 => NumberType::I64,
        1280 => NumberType::U64,
        2304 => return Ok(None),
        _ => {
            return Err(format!(
                "its `datatype` is {code}, and 2, 4, 8, 16, 64, 256, 512, 768, 1024, 1280 (integers and floats) and 2304 (RGBA) are read; convert it to one of these"
            ));
        }
    }))
}

/// A file in one piece has its voxels at 352 or later; many writers leave a 0.
fn voxel_offset(stated: f32) -> Result<u64, String> {
    if stated.fract() != 0.0 || stated < 0.0 || !stated.is_finite() {
        return Err(format!(
            "its `vox_offset` is {stated}, and a whole number of bytes is expected; correct the header"
        ));
    }
    Ok(stated.max(FIRST_VOXEL) as u64)
}

/// A slope of 0 means that nothing is scaled.
fn scale_intercept(words: &Words) -> f64 {
    let (slope, intercept) = (words.float(112), words.float(116));
    if slope.is_normal() && intercept.is_finite() { f64::from(intercept) } else { 0.0 }
}
