//! The bytes that a glTF's accessors look into: a part of a `.glb`, base64 in its JSON, or files beside it.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use super::document::Document;
use crate::formats::base64::decoded;
use crate::formats::stream::Stream;

/// The buffers of a file.
pub(super) struct Buffers<'b> {
    /// Their bytes, in order.
    pub bytes: Vec<Cow<'b, [u8]>>,
    /// Those that are files of their own.
    pub files: Vec<PathBuf>,
}

/// The JSON of a file, and the bytes that a `.glb` carries after it.
pub(super) fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    if number(bytes, 4)? != 2 {
        return Err(format!(
            "is version {} of GLB, and 2 is read; export it again",
            number(bytes, 4)?
        ));
    }
    let (text, rest) = chunk(bytes.get(12..).unwrap_or_default(), *b"JSON")?;
    let own = if rest.is_empty() { None } else { Some(chunk(rest, *b"BIN\0")?.0) };
    Ok((text, own))
}

/// The first chunk, which must be of that kind, and what follows it.
fn chunk(bytes: &[u8], kind: [u8; 4]) -> Result<(&[u8], &[u8]), String> {
    let length = number(bytes, 0)? as usize;
    if bytes.get(4..8) != Some(&kind[..]) {
        return Err("its chunks are not JSON and then BIN; export it again".to_owned());
    }
    bytes[8..].split_at_checked(length).ok_or_else(truncated)
}

fn number(bytes: &[u8], at: usize) -> Result<u32, String> {
    let four = bytes.get(at..at + 4).and_then(|four| four.first_chunk::<4>());
    four.map(|four| u32::from_le_bytes(*four)).ok_or_else(truncated)
}

impl<'b> Buffers<'b> {
    /// The buffers of a document; `own` is what its `.glb` carries, and `path` is the file, for others beside it.
    pub fn new(document: &Document, own: Option<&'b [u8]>, path: &Path) -> Result<Self, String> {
        let mut buffers = Self { bytes: Vec::new(), files: Vec::new() };
        for (at, buffer) in document.buffers.iter().enumerate() {
            let bytes = match buffer.uri.as_deref() {
                None => Cow::Borrowed(own.filter(|_| at == 0).unwrap_or_default()),
                Some(uri) if uri.starts_with("data:") => {
                    let text = uri.split_once(";base64,").map(|(_, text)| text.as_bytes());
                    let text = text
                        .ok_or("has a buffer as `data:` that is not base64; export it as .glb")?;
                    let length = usize::try_from(buffer.byte_length).map_err(|_| truncated())?;
                    Cow::Owned(decoded(text, length).ok_or_else(truncated)?)
                }
                Some(uri) => Cow::Owned(buffers.beside(uri, path)?),
            };
            if (bytes.len() as u64) < buffer.byte_length {
                return Err(truncated());
            }
            buffers.bytes.push(bytes);
        }
        Ok(buffers)
    }

    /// The bytes of a file that is named from the folder of `path`.
    fn beside(&mut self, uri: &str, path: &Path) -> Result<Vec<u8>, String> {
        let file = file_of(uri, path).ok_or_else(|| {
            format!("has its buffer at {uri}; export it as .glb, for nothing is fetched")
        })?;
        let read = Stream::open(&file).and_then(|mut stream| stream.rest());
        let bytes = read.map_err(|problem| format!("its buffer {}: {problem}", file.display()))?;
        self.files.push(file);
        Ok(bytes)
    }
}

/// The file that a name in the file `path` means; `None` for a place that things would have to be fetched from.
pub(super) fn file_of(uri: &str, path: &Path) -> Option<PathBuf> {
    let folder = path.parent().unwrap_or(Path::new(""));
    (!uri.contains("://")).then(|| folder.join(unescaped(uri)))
}

/// A name with `%20` and the like as they are meant.
fn unescaped(uri: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let hexadecimal = after.get(..2).and_then(|two| std::str::from_utf8(two).ok());
        let code =
            hexadecimal.filter(|_| first == b'%').and_then(|two| u8::from_str_radix(two, 16).ok());
        bytes.push(code.unwrap_or(first));
        rest = if code.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn truncated() -> String {
    "is truncated: its buffers are fewer bytes than it says; fetch the file again".to_owned()
}
