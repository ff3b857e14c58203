//! NumPy arrays (`.npy`): three axes of numbers, the last fastest, or the first where the array is in Fortran's order.

use std::path::Path;

use glam::DAffine3;
use half::f16;

use super::number::{self, Binary, NumberType, Order};
use super::stream::Stream;
use super::survey::{Promise, of_size};
use super::{Loaded, Stated, Voxels};
use crate::shared::Shared;
use crate::volume::grid::Scalars;

/// What a file starts with.
const MAGIC: &[u8] = b"\x93NUMPY";

/// What the numbers of an array are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Element {
    Number(NumberType),
    /// Floats of 16 bits.
    Half,
}

struct Header {
    element: Element,
    order: Order,
    size: [usize; 3],
    painted: bool,
}

/// Whether a file starts as an array that is no picture: of pictures the last axis is the four of RGBA.
pub(super) fn recognizes(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(head);
    head.starts_with(MAGIC) && !shape(&text).is_some_and(|shape| shape.len() == 3 && shape[2] == 4)
}

/// Reads an array of three axes, z, y, x, at a spacing of 1; of a fourth axis of 4 bytes as RGBA.
pub(super) fn read(mut stream: Stream, _: &Path, stated: &Stated) -> Result<Loaded, String> {
    let header = Header::read(&mut stream)?;
    let grid = stated.grid(header.size, DAffine3::IDENTITY)?;
    let mut source = Binary { stream: &mut stream, order: header.order };
    let voxels = match header.element {
        Element::Number(kind) if header.painted => {
            number::painted(&mut source, kind, grid.voxels())?
        }
        Element::Number(kind) => {
            Voxels::Scalars(number::scalars(&mut source, kind, grid.voxels())?)
        }
        Element::Half => {
            let bits = number::NumberSource::array::<u16, u16>(&mut source, grid.voxels())?;
            let values = bits.into_iter().map(|bits| f16::from_bits(bits).to_f32()).collect();
            Voxels::Scalars(Scalars::F32(Shared::new(values)))
        }
    };
    let mut warnings: Vec<String> = stream.finish()?.into_iter().collect();
    if stated.spacing_mm.is_none() {
        warnings.push(
            "an array has no spacing, and 1 is taken on each axis; state `spacing_mm` (x, y, z)"
                .to_owned(),
        );
    }
    Ok(Loaded { grid, voxels, warnings })
}

/// Whether an array's header says that it is a volume.
pub(super) fn holds_volume(stream: &mut Stream) -> bool {
    Header::read(stream).is_ok()
}

/// Bytes of the numbers that a header promises.
pub(super) fn promised(stream: &mut Stream, _: &Path, _: &Stated) -> Result<Promise, String> {
    let header = Header::read(stream)?;
    let each = match header.element {
        Element::Number(kind) => kind.bytes() * if header.painted { 4 } else { 1 },
        Element::Half => size_of::<u16>() + size_of::<f32>(),
    };
    Ok((of_size(header.size, each), Vec::new()))
}

impl Header {
    fn read(stream: &mut Stream) -> Result<Self, String> {
        let start = stream.block::<8>("its header")?;
        let length = match start[6] {
            1 => u64::from(u16::from_le_bytes(stream.block::<2>("its header")?)),
            2 | 3 => u64::from(u32::from_le_bytes(stream.block::<4>("its header")?)),
            version => return Err(format!("is of NumPy's format {version}, and 1 to 3 are read")),
        };
        if length > 1 << 16 {
            return Err(format!("its header is {length} bytes long, and 65536 is the most"));
        }
        let text = stream.array::<u8>(length as usize)?;
        Self::of(&String::from_utf8_lossy(&text))
    }

    fn of(text: &str) -> Result<Self, String> {
        let descr = after(text, "'descr':").and_then(|rest| rest.strip_prefix('\''));
        let descr = descr.and_then(|rest| rest.split('\'').next()).ok_or(
            "its header states no plain `descr`; save one array of numbers, without fields",
        )?;
        let (element, order) = element(descr)?;
        let fortran = after(text, "'fortran_order':").is_some_and(|rest| rest.starts_with("True"));
        let mut axes = shape(text).ok_or("its header states no `shape`; save it again")?;
        if !fortran {
            axes.reverse();
        }
        let (size, painted) = match axes[..] {
            [x, y, z] => ([x, y, z], false),
            [4, x, y, z] if !fortran => ([x, y, z], true),
            _ => {
                return Err(format!(
                    "its `shape` has {} axes, and three are expected (z, y, x); take a part of it",
                    axes.len()
                ));
            }
        };
        Ok(Self { element, order, size, painted })
    }
}

/// The number type and byte order of a `descr` such as `<i2`.
pub(super) fn element(descr: &str) -> Result<(Element, Order), String> {
    let order = if descr.starts_with('>') { Order::Big } else { Order::Little };
    let kind = match descr.trim_start_matches(['<', '>', '|', '=']) {
        "u1" | "b1" => NumberType::U8,
        "i1" => NumberType::I8,
        "u2" => NumberType::U16,
        "i2" => NumberType::I16,
        "u4" => NumberType::U32,
        "i4" => NumberType::I32,
        "u8" => NumberType::U64,
        "i8" => NumberType::I64,
        "f4" => NumberType::F32,
        "f8" => NumberType::F64,
        "f2" => return Ok((Element::Half, order)),
        _ => {
            return Err(format!(
                "its numbers are `{descr}`, and integers and floats are read; convert it with astype"
            ));
        }
    };
    Ok((Element::Number(kind), order))
}

/// What follows a key, without blanks before it.
fn after<'t>(text: &'t str, key: &str) -> Option<&'t str> {
    text.split_once(key).map(|(_, rest)| rest.trim_start())
}

/// The numbers of the tuple after `'shape':`.
fn shape(text: &str) -> Option<Vec<usize>> {
    let inner = after(text, "'shape':")?.strip_prefix('(')?.split_once(')')?.0;
    let words = inner.split(',').map(str::trim).filter(|word| !word.is_empty());
    words.map(|word| word.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn array(descr: &str, order: &str, shape: &str, bytes: &[u8]) -> Vec<u8> {
        let text =
            format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': ({shape}), }}\n");
        let length = (text.len() as u16).to_le_bytes();
        [MAGIC, &[1, 0], &length, text.as_bytes(), bytes].concat()
    }

    fn of(bytes: Vec<u8>) -> Result<Loaded, String> {
        read(Stream::of(bytes), Path::new(""), &Stated::default())
    }

    #[test]
    fn the_last_axis_is_x_but_in_fortran_order_the_first() {
        let bytes: Vec<u8> = (0..24).collect();
        let loaded = of(array("|u1", "False", "4, 3, 2", &bytes)).unwrap();
        assert_eq!(loaded.grid.size, [2, 3, 4]);
        let loaded = of(array("|u1", "True", "2, 3, 4", &bytes)).unwrap();
        assert_eq!(loaded.grid.size, [2, 3, 4]);
        assert!(loaded.warnings[0].contains("spacing_mm"));
    }

    #[test]
    fn halves_and_big_ends_are_read() {
        let halves = [0x3c00_u16, 0xc000].map(u16::to_le_bytes).concat().repeat(4);
        let loaded = of(array("<f2", "False", "2, 2, 2", &halves)).unwrap();
        assert!(matches!(loaded.voxels, Voxels::Scalars(Scalars::F32(v)) if v[..2] == [1.0, -2.0]));
        let loaded = of(array(">i2", "False", "2, 2, 2", &[1, 0].repeat(8))).unwrap();
        assert!(matches!(loaded.voxels, Voxels::Scalars(Scalars::I16(v)) if v[0] == 256));
    }

    #[test]
    fn a_picture_is_no_volume_and_the_rest_is_said() {
        assert!(!recognizes(&array("<f4", "False", "40, 48, 4", &[])));
        assert!(recognizes(&array("<f4", "False", "40, 48, 5", &[])));
        for (bytes, said) in [
            (array("<c8", "False", "2, 2, 2", &[]), "astype"),
            (array("<i2", "False", "2, 2", &[]), "2 axes"),
            (array("<i2", "False", "2, 2, 2", &[0; 15]), "truncated"),
            (array("<i2", "False", "99999999999, 9999999999, 9", &[]), "multiply"),
        ] {
            let problem = of(bytes).unwrap_err();
            assert!(problem.contains(said), "{problem}");
        }
    }
}
