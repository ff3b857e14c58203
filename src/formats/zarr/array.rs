//! An array of Zarr, as either version of the format states it.

use std::path::PathBuf;

use serde_json::Value;

use super::json::short;
use super::packing::Packing;
use crate::formats::number::Order;
use crate::formats::numpy::Element;

/// The most axes of an array that is read.
const MOST_AXES: usize = 16;

/// An array: what its metadata state.
#[derive(Debug, Clone)]
pub(super) struct Array {
    /// Its folder, and the files of metadata in it that were read.
    pub folder: PathBuf,
    pub files: Vec<PathBuf>,
    /// Numbers on each axis, the slowest first.
    pub shape: Vec<usize>,
    /// Numbers of a chunk on each axis; those of the last ones reach over the end.
    pub chunk: Vec<usize>,
    pub element: Element,
    /// The number where there is no chunk, as text.
    pub fill: String,
    pub chain: Chain,
    pub keys: Keys,
    /// Names of its axes; none, or one for each.
    pub names: Vec<String>,
    pub attributes: Value,
}

/// How the numbers of a chunk are written.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chain {
    /// The axes in the order in which they are written, the slowest first.
    pub axes: Vec<usize>,
    pub content: Content,
}

/// What a chunk holds.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Content {
    /// Numbers, packed in each of these ways, one after another.
    Numbers(Order, Vec<Packing>),
    /// Chunks of its own.
    Shard(Box<Shard>),
}

/// A chunk of chunks: a file of them, and a table of where each begins and how long it is.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shard {
    /// Numbers of an inner chunk on each axis.
    pub chunk: Vec<usize>,
    pub chain: Chain,
    pub table: Table,
}

/// How the table of a shard is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Table {
    pub order: Order,
    /// Whether a checksum follows it.
    pub summed: bool,
    /// Whether it lies at the start of the file, and not at its end.
    pub first: bool,
}

/// How files of chunks are named by the place of the chunk on each axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Keys {
    /// Whether `c` comes first.
    pub prefixed: bool,
    /// `/`, a folder an axis, or `.`.
    pub separator: char,
}

impl Array {
    /// Bytes of a number.
    pub fn bytes(&self) -> usize {
        match self.element {
            Element::Number(kind) => kind.bytes(),
            Element::Half => 2,
        }
    }

    /// Numbers on each axis of the innermost chunks, and how they are written.
    pub fn innermost(&self) -> (&[usize], &Chain) {
        let (mut chunk, mut chain) = (&self.chunk, &self.chain);
        while let Content::Shard(shard) = &chain.content {
            (chunk, chain) = (&shard.chunk, &shard.chain);
        }
        (chunk, chain)
    }

    /// Bytes of an innermost chunk unpacked, at most 2⁶⁴ − 1.
    pub fn chunk_bytes(&self) -> u64 {
        let (chunk, _) = self.innermost();
        chunk.iter().fold(self.bytes() as u64, |bytes, &n| bytes.saturating_mul(n as u64))
    }

    /// Fails where chunks and axes do not fit together.
    pub fn check(&self) -> Result<(), String> {
        let axes = self.shape.len();
        if axes > MOST_AXES {
            return Err(format!(
                "has {axes} axes, and {MOST_AXES} are the most; take a part of it"
            ));
        }
        if !self.names.is_empty() && self.names.len() != axes {
            let names = self.names.len();
            return Err(format!("has {axes} axes and names {names}; correct its metadata"));
        }
        let (mut outer, mut chunk, mut chain) = (None, &self.chunk, &self.chain);
        loop {
            if chunk.len() != axes || chunk.contains(&0) {
                return Err(format!(
                    "its chunks are of {chunk:?} numbers and it of {:?}, and as many axes, none of 0, are expected; write it again",
                    self.shape
                ));
            }
            let divides = |outer: &Vec<usize>| outer.iter().zip(chunk).all(|(o, i)| o % i == 0);
            if outer.is_some_and(|outer| !divides(outer)) {
                return Err(format!(
                    "its shards are not a multiple of their chunks of {chunk:?} numbers; write it again"
                ));
            }
            let Content::Shard(shard) = &chain.content else { return Ok(()) };
            (outer, chunk, chain) = (Some(chunk), &shard.chunk, &shard.chain);
        }
    }
}

/// The number of a fill value, as text that its type reads; `null` is 0.
pub(super) fn fill(value: Option<&Value>, element: Element) -> Result<String, String> {
    let Some(value) = value else { return Ok("0".to_owned()) };
    let wrong = || {
        format!(
            "its `fill_value` is {}, and a number of its type is expected; correct it",
            short(value)
        )
    };
    let word = match value {
        Value::Null => "0".to_owned(),
        Value::Bool(set) => u8::from(*set).to_string(),
        // Whole numbers keep all their digits; of floats, 0.0 is also a whole number.
        Value::Number(number) if number.is_f64() => number.as_f64().unwrap_or(0.0).to_string(),
        Value::Number(number) => number.to_string(),
        Value::String(text) => match text.strip_prefix("0x") {
            Some(bits) => of_bits(u64::from_str_radix(bits, 16).map_err(|_| wrong())?, element),
            None => text.clone(),
        },
        _ => return Err(wrong()),
    };
    match element {
        Element::Number(_) => Ok(word),
        // Halves are read as their bits.
        Element::Half => {
            let value: f32 = word.parse().map_err(|_| wrong())?;
            Ok(half::f16::from_f32(value).to_bits().to_string())
        }
    }
}

/// A float by its bits.
fn of_bits(bits: u64, element: Element) -> String {
    match element {
        Element::Half => half::f16::from_bits(bits as u16).to_f32().to_string(),
        Element::Number(kind) if kind.bytes() == 4 => f32::from_bits(bits as u32).to_string(),
        Element::Number(_) => f64::from_bits(bits).to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::number::NumberType;
    use serde_json::json;

    #[test]
    fn fill_values_are_text_that_their_types_read() {
        let double = Element::Number(NumberType::F64);
        let of = |value, element| fill(Some(&value), element).unwrap();
        assert_eq!(of(json!(18_446_744_073_709_551_615_u64), double), "18446744073709551615");
        assert_eq!(of(json!(0.0), double), "0");
        assert_eq!(of(json!(-1), double), "-1");
        assert_eq!(of(json!(true), double), "1");
        assert_eq!(of(json!(null), double), "0");
        assert!(of(json!("NaN"), double).parse::<f64>().unwrap().is_nan());
        assert_eq!(of(json!("-Infinity"), double).parse::<f64>().unwrap(), f64::NEG_INFINITY);
        assert_eq!(of(json!("0x3fc00000"), Element::Number(NumberType::F32)), "1.5");
        assert_eq!(of(json!(1.5), Element::Half), 0x3e00.to_string());
        assert_eq!(of(json!("0x3e00"), Element::Half), 0x3e00.to_string());
        assert!(fill(Some(&json!([1])), double).unwrap_err().contains("fill_value"));
    }
}
