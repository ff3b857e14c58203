//! The number types of volume files, by NRRD's names, and arrays of them read from a file in either byte order.

use bytemuck::Pod;

use super::Voxels;
use super::stream::Stream;
use crate::shared::Shared;
use crate::volume::grid::{Painted, Scalars};

/// The type of a file's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "the variants are the types")]
pub(super) enum NumberType {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F32,
    F64,
}

/// Every name that NRRD has for each type, and the obvious `float32` and `float64`.
const NAMES: &[(NumberType, &[&str])] = &[
    (NumberType::I8, &["signed char", "int8", "int8_t"]),
    (NumberType::U8, &["uchar", "unsigned char", "uint8", "uint8_t"]),
    (
        NumberType::I16,
        &["short", "short int", "signed short", "signed short int", "int16", "int16_t"],
    ),
    (NumberType::U16, &["ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"]),
    (NumberType::I32, &["int", "signed int", "int32", "int32_t"]),
    (NumberType::U32, &["uint", "unsigned int", "uint32", "uint32_t"]),
    (
        NumberType::I64,
        &[
            "longlong",
            "long long",
            "long long int",
            "signed long long",
            "signed long long int",
            "int64",
            "int64_t",
        ],
    ),
    (
        NumberType::U64,
        &["ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"],
    ),
    (NumberType::F32, &["float", "float32"]),
    (NumberType::F64, &["double", "float64"]),
];

impl NumberType {
    /// The type of that name, in any case and with any blanks between its words.
    pub(super) fn named(name: &str) -> Result<Self, String> {
        let words: Vec<String> = name.split_whitespace().map(str::to_ascii_lowercase).collect();
        let plain = words.join(" ");
        NAMES.iter().find(|(_, names)| names.contains(&plain.as_str())).map(|row| row.0).ok_or_else(
            || {
                format!(
                    "the number type `{name}` is not one of int8, uint8, int16, uint16, int32, uint32, int64, uint64, float, double; convert the file to one of these"
                )
            },
        )
    }

    /// Bytes of a number.
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::U64 | Self::I64 | Self::F64 => 8,
        }
    }
}

/// Which byte of a number comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    /// The least significant.
    Little,
    /// The most significant.
    Big,
}

impl Order {
    /// `little` or `big`.
    pub(super) fn named(name: &str) -> Result<Self, String> {
        match name.trim().to_ascii_lowercase().as_str() {
            "little" => Ok(Self::Little),
            "big" => Ok(Self::Big),
            _ => Err(format!("the byte order `{name}` is neither `little` nor `big`; correct it")),
        }
    }

    fn native(self) -> bool {
        (self == Self::Little) == cfg!(target_endian = "little")
    }
}

/// A number as a file stores it.
pub(super) trait Stored: Pod {
    /// The same bytes in the other order.
    fn swapped(self) -> Self;
    /// The number that a word of text says, if it is one of this type.
    fn parsed(word: &str) -> Option<Self>;
    /// The number, rounded once where it has more than 53 bits.
    fn wide(self) -> f64;
    /// An array of this type.
    fn scalars(values: Vec<Self>) -> Scalars;
}

macro_rules! stored {
    ($($kind:ty => $variant:ident, $swapped:expr;)*) => {$(
        impl Stored for $kind {
            fn swapped(self) -> Self { $swapped(self) }
            fn parsed(word: &str) -> Option<Self> { word.parse().ok() }
            #[allow(clippy::cast_lossless, reason = "one body for all types")]
            fn wide(self) -> f64 { self as f64 }
            fn scalars(values: Vec<Self>) -> Scalars { Scalars::$variant(Shared::new(values)) }
        }
    )*};
}
stored! {
    u8 => U8, u8::swap_bytes;
    i8 => I8, i8::swap_bytes;
    u16 => U16, u16::swap_bytes;
    i16 => I16, i16::swap_bytes;
    u32 => U32, u32::swap_bytes;
    i32 => I32, i32::swap_bytes;
    u64 => U64, u64::swap_bytes;
    i64 => I64, i64::swap_bytes;
    f32 => F32, |v: f32| f32::from_bits(v.to_bits().swap_bytes());
    f64 => F64, |v: f64| f64::from_bits(v.to_bits().swap_bytes());
}

/// Puts numbers that were read in `order` into that of the processor, in place.
pub(super) fn to_native<T: Stored>(values: &mut [T], order: Order) {
    if size_of::<T>() > 1 && !order.native() {
        for value in values {
            *value = value.swapped();
        }
    }
}

/// Where numbers come from: the bytes of a file, or its words.
pub(super) trait NumberSource {
    /// `count` elements `E`, each of one or more numbers `T`.
    fn array<E: Pod, T: Stored>(&mut self, count: usize) -> Result<Vec<E>, String>;
}

/// The bytes of a file, in its byte order.
pub(super) struct Binary<'a> {
    /// The file, at its first voxel.
    pub(super) stream: &'a mut Stream,
    /// Which byte of a number comes first.
    pub(super) order: Order,
}

impl NumberSource for Binary<'_> {
    fn array<E: Pod, T: Stored>(&mut self, count: usize) -> Result<Vec<E>, String> {
        let mut elements = self.stream.array::<E>(count)?;
        to_native(bytemuck::cast_slice_mut::<E, T>(&mut elements), self.order);
        Ok(elements)
    }
}

/// Calls a function that is generic over the type that a [`NumberType`] names.
macro_rules! of_type {
    ($kind:expr, $of:ident, $arguments:tt) => {
        match $kind {
            NumberType::U8 => $of::<u8>$arguments,
            NumberType::I8 => $of::<i8>$arguments,
            NumberType::U16 => $of::<u16>$arguments,
            NumberType::I16 => $of::<i16>$arguments,
            NumberType::U32 => $of::<u32>$arguments,
            NumberType::I32 => $of::<i32>$arguments,
            NumberType::U64 => $of::<u64>$arguments,
            NumberType::I64 => $of::<i64>$arguments,
            NumberType::F32 => $of::<f32>$arguments,
            NumberType::F64 => $of::<f64>$arguments,
        }
    };
}

/// One number a voxel, kept in its own type.
pub(super) fn scalars(
    source: &mut impl NumberSource,
    kind: NumberType,
    count: usize,
) -> Result<Scalars, String> {
    fn of<T: Stored>(source: &mut impl NumberSource, count: usize) -> Result<Scalars, String> {
        source.array::<T, T>(count).map(T::scalars)
    }
    of_type!(kind, of, (source, count))
}

/// Numbers of any type as floats of 64 bits.
pub(super) fn numbers(
    source: &mut impl NumberSource,
    kind: NumberType,
    count: usize,
) -> Result<Vec<f64>, String> {
    fn of<T: Stored>(source: &mut impl NumberSource, count: usize) -> Result<Vec<f64>, String> {
        Ok(source.array::<T, T>(count)?.into_iter().map(T::wide).collect())
    }
    of_type!(kind, of, (source, count))
}

/// Four numbers a voxel, RGBA with straight alpha.
pub(super) fn painted(
    source: &mut impl NumberSource,
    kind: NumberType,
    count: usize,
) -> Result<Voxels, String> {
    Ok(Voxels::Painted(match kind {
        NumberType::U8 => Painted::U8(Shared::new(source.array::<_, u8>(count)?)),
        NumberType::U16 => Painted::U16(Shared::new(source.array::<_, u16>(count)?)),
        NumberType::F32 => Painted::F32(Shared::new(source.array::<_, f32>(count)?)),
        _ => {
            return Err(format!(
                "its RGBA voxels are of type {kind:?}, and uint8, uint16 or float are expected; convert the file to one of these"
            ));
        }
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_of_a_type_is_known_in_any_case() {
        for (kind, names) in NAMES {
            for name in *names {
                assert_eq!(NumberType::named(name), Ok(*kind));
                assert_eq!(NumberType::named(&format!(" {} ", name.to_uppercase())), Ok(*kind));
            }
        }
        assert!(NumberType::named("block").unwrap_err().contains("convert"));
    }

    #[test]
    fn numbers_survive_either_byte_order() {
        let values = [1.5_f32, -0.0, 3.0e38, f32::NEG_INFINITY];
        for (order, bytes) in [
            (Order::Little, values.map(f32::to_le_bytes).concat()),
            (Order::Big, values.map(f32::to_be_bytes).concat()),
        ] {
            let mut stream = Stream::of(bytes);
            let read = Binary { stream: &mut stream, order }.array::<f32, f32>(4).unwrap();
            assert_eq!(read.map_bits(), values.to_vec().map_bits());
        }
    }

    trait Bits {
        fn map_bits(self) -> Vec<u32>;
    }
    impl Bits for Vec<f32> {
        fn map_bits(self) -> Vec<u32> {
            self.into_iter().map(f32::to_bits).collect()
        }
    }

    #[test]
    fn an_unknown_byte_order_is_refused() {
        assert_eq!(Order::named(" Big "), Ok(Order::Big));
        assert!(Order::named("middle").unwrap_err().contains("`middle`"));
    }
}
