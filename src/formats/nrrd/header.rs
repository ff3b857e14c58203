//! The fields of an NRRD header, checked: they come from outside and are not trusted.

use super::super::number::{NumberType, Order};
use super::super::stream::Stream;

/// Bytes that a header may take.
const LONGEST: u64 = 1 << 20;

/// How the voxels are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Raw,
    Gzip,
    Text,
}

/// What lies before the voxels in their file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Skip {
    /// So many bytes.
    Bytes(u64),
    /// All but the voxels, which end the file (`byte skip: -1`).
    ToLast,
}

/// What a header says of its voxels; `placement` reads where they are from the fields.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) kind: NumberType,
    /// Voxels on each axis of space.
    pub(super) size: [usize; 3],
    /// Whether a first axis of four colour components comes before those of space.
    pub(super) painted: bool,
    pub(super) encoding: Encoding,
    pub(super) order: Option<Order>,
    pub(super) data_file: Option<String>,
    pub(super) line_skip: u64,
    pub(super) byte_skip: Skip,
    pub(super) fields: Fields,
}

/// Field names, in lower case and without blanks, and what they say, in the file's order.
#[derive(Debug)]
pub(super) struct Fields(Vec<(String, String)>);

impl Header {
    /// Reads up to the blank line after the header, or to the end of a detached one.
    pub(super) fn read(stream: &mut Stream) -> Result<Self, String> {
        let fields = Fields::read(stream)?;
        let kind = NumberType::named(fields.needed("type")?)?;
        let (size, painted) = shape(&fields)?;
        let encoding = encoding(fields.needed("encoding")?)?;
        Ok(Self {
            kind,
            size,
            painted,
            encoding,
            order: fields.get("endian")?.map(Order::named).transpose()?,
            data_file: data_file(&fields)?,
            line_skip: match fields.get("lineskip")? {
                None => 0,
                Some(text) => number(text, "line skip", "a whole number from 0")?,
            },
            byte_skip: byte_skip(&fields, encoding)?,
            fields,
        })
    }
}

impl Fields {
    fn read(stream: &mut Stream) -> Result<Self, String> {
        let mut most = LONGEST;
        let magic = stream.line(&mut most)?.unwrap_or_default();
        if !matches!(magic.trim_end().strip_prefix("NRRD000"), Some("1" | "2" | "3" | "4" | "5")) {
            let start: String = magic.chars().take(16).collect();
            return Err(format!(
                "starts with {start:?}, and an NRRD file starts with NRRD0001 to NRRD0005; check that it is what its name says"
            ));
        }
        let mut fields = Vec::new();
        let mut count = 1;
        while let Some(line) = stream.line(&mut most)? {
            count += 1;
            if line.is_empty() {
                break;
            }
            if line.starts_with('#') {
                continue;
            }
            let Some((name, value)) = line.split_once(':') else {
                return Err(format!(
                    "line {count} of its header has no colon; expected `field: value`, or a blank line before the voxels"
                ));
            };
            // `key:=value` is for other programs.
            if !value.starts_with('=') {
                let name = name.split_whitespace().collect::<String>().to_ascii_lowercase();
                let listed = name == "datafile" && value.trim().starts_with("LIST");
                fields.push((name, value.trim().to_owned()));
                if listed {
                    // The rest of the header is names of files.
                    break;
                }
            }
        }
        Ok(Self(fields))
    }

    /// What the field says; an error where two lines say it.
    pub(super) fn get(&self, name: &str) -> Result<Option<&str>, String> {
        let mut found = self.0.iter().filter(|field| field.0 == name);
        let first = found.next();
        match found.next() {
            None => Ok(first.map(|field| field.1.as_str())),
            Some(_) => Err(format!("its header states `{name}` twice; remove one")),
        }
    }

    fn needed(&self, name: &str) -> Result<&str, String> {
        self.get(name)?.ok_or_else(|| format!("its header lacks the field `{name}`; add it"))
    }
}

/// The size of space, and whether colours come first.
fn shape(fields: &Fields) -> Result<([usize; 3], bool), String> {
    let sizes = fields.needed("sizes")?;
    let numbers: Vec<usize> = sizes
        .split_whitespace()
        .map(|word| number(word, "sizes", "a whole number"))
        .collect::<Result<_, _>>()?;
    let dimension = fields.needed("dimension")?;
    if numbers.len().to_string() != dimension {
        return Err(format!(
            "its `dimension` is {dimension} and its `sizes` are {} numbers; correct one of them",
            numbers.len()
        ));
    }
    let kinds = kinds(fields, numbers.len())?;
    let spatial = |kind: &String| ["domain", "space", "none", "???"].contains(&kind.as_str());
    let colors = ["rgba-color", "4-color", "4-vector", "vector"];
    match numbers[..] {
        [x, y, z] if kinds.iter().all(spatial) => Ok(([x, y, z], false)),
        [4, x, y, z] if colors.contains(&kinds[0].as_str()) && kinds[1..].iter().all(spatial) => {
            Ok(([x, y, z], true))
        }
        _ => Err(format!(
            "its `sizes` are {sizes} with `kinds` {}; expected three axes of space, or a first axis of 4 components of kind RGBA-color and three of space; convert or crop it to one of these",
            kinds.join(" ")
        )),
    }
}

/// The kind of each axis, in lower case; `???` where the header says none.
fn kinds(fields: &Fields, axes: usize) -> Result<Vec<String>, String> {
    let Some(text) = fields.get("kinds")? else { return Ok(vec!["???".to_owned(); axes]) };
    let kinds: Vec<String> = text.split_whitespace().map(str::to_ascii_lowercase).collect();
    if kinds.len() == axes {
        Ok(kinds)
    } else {
        Err(format!("its `kinds` are `{text}`; expected {axes} words, one an axis; correct them"))
    }
}

fn encoding(name: &str) -> Result<Encoding, String> {
    match name.to_ascii_lowercase().as_str() {
        "raw" => Ok(Encoding::Raw),
        "gzip" | "gz" => Ok(Encoding::Gzip),
        "ascii" | "text" | "txt" => Ok(Encoding::Text),
        _ => Err(format!(
            "its `encoding` is `{name}`, and raw, gzip and ascii are read; save it again with one of these"
        )),
    }
}

fn data_file(fields: &Fields) -> Result<Option<String>, String> {
    let Some(name) = fields.get("datafile")? else { return Ok(None) };
    if name.is_empty() || name.contains('%') || name.split_whitespace().next() == Some("LIST") {
        return Err(format!(
            "its `data file` is `{name}`, and the name of one file is expected, not a list or pattern of slices; join them in one file"
        ));
    }
    Ok(Some(name.to_owned()))
}

fn byte_skip(fields: &Fields, encoding: Encoding) -> Result<Skip, String> {
    let Some(text) = fields.get("byteskip")? else { return Ok(Skip::Bytes(0)) };
    match number::<i64>(text, "byte skip", "a whole number from -1")? {
        -1 if encoding == Encoding::Raw => Ok(Skip::ToLast),
        bytes => u64::try_from(bytes).map(Skip::Bytes).map_err(|_| {
            format!(
                "its `byte skip` is {bytes}; expected a whole number from 0, or -1 with encoding raw; correct it"
            )
        }),
    }
}

fn number<T: std::str::FromStr>(text: &str, field: &str, expected: &str) -> Result<T, String> {
    text.parse().map_err(|_| {
        format!("its `{field}` has `{text}` where {expected} is expected; correct the header")
    })
}
