//! Accessors of a glTF: numbers of any of its types, at any stride, as floats or as indices.

use super::super::triangles::reserve;
use super::buffers::Buffers;
use super::document::{Accessor, BufferView, Document};

/// The numbers of an accessor, one element after the other.
pub(super) struct Numbers {
    pub values: Vec<f64>,
    /// Numbers of an element.
    pub width: usize,
}

/// The numbers of an accessor; integers that are normalized are −1..=1 or 0..=1.
pub(super) fn floats(document: &Document, buffers: &Buffers, at: usize) -> Result<Numbers, String> {
    let accessor = document.accessors.get(at).ok_or_else(|| missing("accessor", at))?;
    let mut values = Vec::new();
    let width = each(document, buffers, accessor, &mut values)?;
    Ok(Numbers { values, width })
}

/// The numbers of an accessor of whole numbers, such as those of vertices.
pub(super) fn indices(
    document: &Document,
    buffers: &Buffers,
    at: usize,
) -> Result<Vec<u32>, String> {
    let accessor = document.accessors.get(at).ok_or_else(|| missing("accessor", at))?;
    if !matches!(accessor.component_type, 5121 | 5123 | 5125) {
        return Err(
            "has indices that are not whole numbers of 0 and above; export it again".to_owned()
        );
    }
    let mut values = Vec::new();
    each(document, buffers, accessor, &mut values)?;
    Ok(values.into_iter().map(|value| value as u32).collect())
}

/// Puts all numbers of an accessor into `values`; their number an element.
fn each(
    document: &Document,
    buffers: &Buffers,
    accessor: &Accessor,
    values: &mut Vec<f64>,
) -> Result<usize, String> {
    if accessor.sparse.is_some() {
        return Err("has sparse accessors, which are not read; export it without".to_owned());
    }
    let width = match accessor.shape.as_str() {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        other => return Err(format!("has vertices of {other}; export it again")),
    };
    let size = size(accessor.component_type)?;
    let at = accessor.buffer_view.ok_or("has an accessor without bytes; export it again")?;
    let (view, own) = viewed(document, buffers, at)?;
    let own = part(
        own,
        accessor.byte_offset,
        own.len() as u64 - accessor.byte_offset.min(own.len() as u64),
    )?;
    let stride = view.byte_stride.unwrap_or((width * size) as u64);
    let stride = usize::try_from(stride).ok().filter(|&stride| stride >= width * size);
    let stride = stride.ok_or("has elements that overlap; export it again")?;
    let count = usize::try_from(accessor.count).map_err(|_| beyond())?;
    // The last element need not be followed by the rest of its stride.
    let needed =
        count.checked_sub(1).map_or(Some(0), |n| n.checked_mul(stride)?.checked_add(width * size));
    if needed.is_none_or(|needed| needed > own.len()) {
        return Err(beyond());
    }
    reserve(values, count * width)?;
    for element in 0..count {
        let element = &own[element * stride..][..width * size];
        values.extend(element.chunks_exact(size).map(|number| value(number, accessor)));
    }
    Ok(width)
}

/// A view of a buffer, and its bytes.
pub(super) fn viewed<'b>(
    document: &'b Document,
    buffers: &'b Buffers,
    at: usize,
) -> Result<(&'b BufferView, &'b [u8]), String> {
    let view = document.buffer_views.get(at).ok_or_else(|| missing("buffer view", at))?;
    let buffer = buffers.bytes.get(view.buffer).ok_or_else(|| missing("buffer", view.buffer))?;
    Ok((view, part(buffer, view.byte_offset, view.byte_length)?))
}

fn part(bytes: &[u8], from: u64, length: u64) -> Result<&[u8], String> {
    let end = from.checked_add(length).and_then(|end| usize::try_from(end).ok());
    end.and_then(|end| bytes.get(from as usize..end)).ok_or_else(beyond)
}

/// Bytes of a number of a type.
fn size(kind: u32) -> Result<usize, String> {
    match kind {
        5120 | 5121 => Ok(1),
        5122 | 5123 => Ok(2),
        5125 | 5126 => Ok(4),
        _ => Err(format!("has numbers of the unknown type {kind}; export it again")),
    }
}

/// A number of an accessor's type.
fn value(bytes: &[u8], accessor: &Accessor) -> f64 {
    let mut four = [0; 4];
    four[..bytes.len()].copy_from_slice(bytes);
    let [a, b, ..] = four;
    let (value, greatest) = match accessor.component_type {
        5120 => (f64::from(a as i8), 127.0),
        5121 => (f64::from(a), 255.0),
        5122 => (f64::from(i16::from_le_bytes([a, b])), 32767.0),
        5123 => (f64::from(u16::from_le_bytes([a, b])), 65535.0),
        5125 => (f64::from(u32::from_le_bytes(four)), f64::from(u32::MAX)),
        _ => return f64::from(f32::from_le_bytes(four)),
    };
    if accessor.normalized { (value / greatest).max(-1.0) } else { value }
}

fn missing(what: &str, at: usize) -> String {
    format!("names {what} {at}, which it does not have; export it again")
}

fn beyond() -> String {
    "is truncated: an accessor reaches past its buffer; fetch the file again".to_owned()
}
