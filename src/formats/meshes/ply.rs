//! PLY, text and binary of either byte order: the vertices, their colors and the faces of a file, whatever else it holds.

use std::path::Path;

use glam::DVec3;

use super::triangles::{Triangles, add_fan, fans};
use crate::components::Color;

/// Lines that a header may have.
const LONGEST: usize = 4096;

/// How the numbers are written.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Writing {
    Text,
    Little,
    Big,
}

/// The number types of PLY, under both names of each.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// What each element of a kind has one of.
struct Property {
    name: String,
    kind: Number,
    /// The type of the number of its values, for a list.
    list: Option<Number>,
}

/// A kind of elements, and how many there are.
struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

/// Reads the vertices' x, y and z, their red, green and blue (sRGB), and the faces' lists of vertices.
pub(super) fn read(bytes: &[u8], _: &Path) -> Result<Triangles, String> {
    let (writing, elements, body) = header(bytes)?;
    let mut source = Source { writing, bytes: body };
    let mut triangles = Triangles::default();
    let mut polygons = 0;
    let mut values = Vec::new();
    for element in &elements {
        let at = |name: &str| element.properties.iter().position(|own| own.name == name);
        let place = at("x").zip(at("y")).zip(at("z")).map(|((x, y), z)| [x, y, z]);
        let channels = at("red").zip(at("green")).zip(at("blue")).map(|((r, g), b)| [r, g, b]);
        let channels = channels.filter(|_| element.name == "vertex" && place.is_some());
        let list = at("vertex_indices").or(at("vertex_index"));
        // An element has a byte at least, unless it has no property at all.
        if element.count > source.bytes.len() {
            return Err(truncated());
        }
        for _ in 0..element.count {
            let mut point = DVec3::ZERO;
            let mut srgb = [0.0; 3];
            for (number, property) in element.properties.iter().enumerate() {
                source.values(property, &mut values)?;
                if element.name == "vertex"
                    && let Some(axis) = place.and_then(|p| p.iter().position(|&at| at == number))
                {
                    point[axis] = values.first().copied().unwrap_or(f64::NAN);
                }
                if let Some(channel) = channels.and_then(|c| c.iter().position(|&at| at == number))
                {
                    let value = values.first().copied().unwrap_or(0.0) / property.kind.white();
                    srgb[channel] = (value as f32).clamp(0.0, 1.0);
                }
                if element.name == "face" && list == Some(number) {
                    let polygon: Option<Vec<u32>> =
                        values.iter().map(|&value| index(value)).collect();
                    let polygon = polygon
                        .ok_or("a face names a vertex by no whole number; fetch the file again")?;
                    polygons += usize::from(polygon.len() > 3);
                    add_fan(&mut triangles.faces, &polygon);
                }
            }
            if element.name == "vertex" && place.is_some() {
                triangles.vertices.push(point);
                triangles.colors.extend(channels.map(|_| Color::from_srgb(srgb)));
            }
        }
    }
    triangles.warnings.extend(fans(polygons));
    Ok(triangles)
}

fn index(value: f64) -> Option<u32> {
    ((0.0..=f64::from(u32::MAX)).contains(&value) && value.fract() == 0.0).then_some(value as u32)
}

/// The header's lines to `end_header`, and the bytes after it.
fn header(bytes: &[u8]) -> Result<(Writing, Vec<Element>, &[u8]), String> {
    let mut rest = bytes;
    let mut writing = None;
    let mut elements: Vec<Element> = Vec::new();
    for number in 1..=LONGEST {
        let Some(end) = rest.iter().position(|&byte| byte == b'\n') else { break };
        let line = String::from_utf8_lossy(&rest[..end]).into_owned();
        rest = &rest[end + 1..];
        let words: Vec<&str> = line.split_whitespace().collect();
        let wrong =
            || format!("line {number} of its header is `{line}`, which is not read; save it again");
        match words[..] {
            ["ply"] if number == 1 => {}
            _ if number == 1 => {
                return Err(
                    "does not begin with `ply`; check that it is what its name says".to_owned()
                );
            }
            ["format", "ascii", _] => writing = Some(Writing::Text),
            ["format", "binary_little_endian", _] => writing = Some(Writing::Little),
            ["format", "binary_big_endian", _] => writing = Some(Writing::Big),
            ["element", name, count] => elements.push(Element {
                name: name.to_owned(),
                count: count.parse().map_err(|_| wrong())?,
                properties: Vec::new(),
            }),
            ["property", "list", count, kind, name] => {
                let list = Some(Number::named(count).ok_or_else(wrong)?);
                let kind = Number::named(kind).ok_or_else(wrong)?;
                let element = elements.last_mut().ok_or_else(wrong)?;
                element.properties.push(Property { name: name.to_owned(), kind, list });
            }
            ["property", kind, name] => {
                let kind = Number::named(kind).ok_or_else(wrong)?;
                let element = elements.last_mut().ok_or_else(wrong)?;
                element.properties.push(Property { name: name.to_owned(), kind, list: None });
            }
            ["end_header"] => {
                let writing = writing.ok_or("its header states no `format`; save it again")?;
                return Ok((writing, elements, rest));
            }
            ["comment" | "obj_info", ..] | [] => {}
            _ => return Err(wrong()),
        }
    }
    Err("its header does not end; check that it is what its name says".to_owned())
}

/// Numbers one after the other.
struct Source<'b> {
    writing: Writing,
    bytes: &'b [u8],
}

impl Source<'_> {
    /// The values of a property of the next element: one, or those of its list.
    fn values(&mut self, property: &Property, into: &mut Vec<f64>) -> Result<(), String> {
        into.clear();
        let count = match property.list {
            None => 1,
            Some(kind) => self.number(kind)?.max(0.0) as usize,
        };
        // A value has a byte at least, also as text.
        if count > self.bytes.len() {
            return Err(truncated());
        }
        for _ in 0..count {
            into.push(self.number(property.kind)?);
        }
        Ok(())
    }

    fn number(&mut self, kind: Number) -> Result<f64, String> {
        if self.writing == Writing::Text {
            let word = self.word().ok_or_else(truncated)?;
            return word.parse().map_err(|_| {
                format!("has `{word}` where a number is expected; fetch the file again")
            });
        }
        let (number, rest) = self.bytes.split_at_checked(kind.bytes()).ok_or_else(truncated)?;
        self.bytes = rest;
        Ok(kind.value(number, self.writing == Writing::Big))
    }

    fn word(&mut self) -> Option<String> {
        let start = self.bytes.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let rest = &self.bytes[start..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.bytes = &rest[end..];
        Some(String::from_utf8_lossy(&rest[..end]).into_owned())
    }
}

impl Number {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// What a channel of full intensity is written as.
    fn white(self) -> f64 {
        match self {
            Self::F32 | Self::F64 => 1.0,
            Self::I16 | Self::U16 | Self::I32 | Self::U32 => 65535.0,
            Self::I8 | Self::U8 => 255.0,
        }
    }

    fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number of as many bytes as it has.
    fn value(self, bytes: &[u8], big: bool) -> f64 {
        let mut eight = [0; 8];
        for (at, byte) in bytes.iter().enumerate() {
            eight[if big { bytes.len() - 1 - at } else { at }] = *byte;
        }
        let [a, b, c, d, ..] = eight;
        match self {
            Self::I8 => f64::from(a as i8),
            Self::U8 => f64::from(a),
            Self::I16 => f64::from(i16::from_le_bytes([a, b])),
            Self::U16 => f64::from(u16::from_le_bytes([a, b])),
            Self::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Self::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Self::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Self::F64 => f64::from_le_bytes(eight),
        }
    }
}

fn truncated() -> String {
    "is truncated: its header states more than follows; fetch the file again".to_owned()
}
