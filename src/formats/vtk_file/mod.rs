//! VTK's files of XML: how their numbers are written, and their arrays as text, base64 or raw bytes, plain or packed by zlib.

mod blocks;
mod tags;

use bytemuck::Pod;

use super::nrrd::words::Words;
use super::number::{Binary, NumberSource, Order, Stored};
use super::stream::Stream;
use blocks::{Encoding, Written};
pub(super) use tags::{Tag, before, tag};

/// A file, and how its numbers are written.
#[derive(Debug, Clone, Copy)]
pub(super) struct VtkFile<'b> {
    bytes: &'b [u8],
    order: Order,
    /// Bytes of the lengths before packed or binary values.
    width: usize,
    packed: bool,
}

/// The numbers of an array: words, or bytes in an order.
pub(super) enum Source {
    Text(Stream),
    Bytes(Stream, Order),
}

impl NumberSource for Source {
    fn array<E: Pod, T: Stored>(&mut self, count: usize) -> Result<Vec<E>, String> {
        match self {
            Self::Text(stream) => Words::new(stream).array::<E, T>(count),
            Self::Bytes(stream, order) => Binary { stream, order: *order }.array::<E, T>(count),
        }
    }
}

impl<'b> VtkFile<'b> {
    /// What the head of a file says.
    pub fn of(bytes: &'b [u8]) -> Result<Self, String> {
        let head = tag(bytes, "VTKFile").ok_or("has no `VTKFile`; check that it is one")?;
        let packed = match head.attribute("compressor").as_deref() {
            None | Some("") => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                return Err(format!("is packed by {other}, and zlib is read; save it with zlib"));
            }
        };
        let big = head.attribute("byte_order").as_deref() == Some("BigEndian");
        let wide = head.attribute("header_type").as_deref() == Some("UInt64");
        Ok(Self {
            bytes,
            order: if big { Order::Big } else { Order::Little },
            width: if wide { 8 } else { 4 },
            packed,
        })
    }

    /// The numbers of a `DataArray`, which take `needed` bytes where they are not text.
    pub fn source(&self, array: &Tag<'b>, needed: usize) -> Result<Source, String> {
        let (bytes, encoding) = match self.payload(array)? {
            Payload::Text(text) => return Ok(Source::Text(Stream::of(text.to_vec()))),
            Payload::Bytes(bytes, encoding) => (bytes, encoding),
        };
        let written = Written { encoding, order: self.order, width: self.width };
        let raw = if self.packed {
            blocks::inflated(bytes, written, needed)?
        } else {
            blocks::plain(bytes, written, needed)?
        };
        Ok(Source::Bytes(Stream::of(raw), self.order))
    }

    fn payload(&self, array: &Tag<'b>) -> Result<Payload<'b>, String> {
        let damaged = "its values do not end; fetch the file again";
        let own = || before(array.rest, b"<").ok_or(damaged);
        match array.attribute("format").as_deref() {
            Some("ascii") => Ok(Payload::Text(own()?)),
            Some("binary") => Ok(Payload::Bytes(own()?, Encoding::Base64)),
            Some("appended") => {
                let appended = tag(self.bytes, "AppendedData").ok_or(damaged)?;
                let encoding = match appended.attribute("encoding").as_deref() {
                    Some("base64") => Encoding::Base64,
                    _ => Encoding::Raw,
                };
                let start = appended.rest.iter().position(|&byte| byte == b'_').ok_or(damaged)?;
                let offset = array.attribute("offset").and_then(|text| text.trim().parse().ok());
                let offset: usize = offset.ok_or("its values have no `offset`; save it again")?;
                let bytes = appended.rest[start + 1..].get(offset..).ok_or(damaged)?;
                Ok(Payload::Bytes(bytes, encoding))
            }
            _ => Err("its values state no `format` that is read; save it again".to_owned()),
        }
    }
}

/// Where the values of an array stand.
enum Payload<'b> {
    Text(&'b [u8]),
    Bytes(&'b [u8], Encoding),
}
