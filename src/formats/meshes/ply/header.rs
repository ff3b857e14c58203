//! The header of a PLY: which elements it holds, and of which numbers.

/// Lines that a header may have.
const LONGEST: usize = 4096;

/// How the numbers are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Writing {
    Text,
    Little,
    Big,
}

/// The number types of PLY, under both names of each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Number {
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
pub(super) struct Property {
    pub name: String,
    pub kind: Number,
    /// The type of the number of its values, for a list.
    pub list: Option<Number>,
}

/// A kind of elements, and how many there are.
pub(super) struct Element {
    pub name: String,
    pub count: usize,
    pub properties: Vec<Property>,
}

impl Element {
    /// Where among its properties that of a name is.
    pub fn at(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|own| own.name == name)
    }
}

/// The header's lines to `end_header`, and the bytes after it.
pub(super) fn header(bytes: &[u8]) -> Result<(Writing, Vec<Element>, &[u8]), String> {
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
    pub fn white(self) -> f64 {
        match self {
            Self::F32 | Self::F64 => 1.0,
            Self::I16 | Self::U16 | Self::I32 | Self::U32 => 65535.0,
            Self::I8 | Self::U8 => 255.0,
        }
    }

    /// Bytes of a number.
    pub fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number of as many bytes as it has.
    pub fn value(self, bytes: &[u8], big: bool) -> f64 {
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
