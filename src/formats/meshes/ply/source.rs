//! The elements of a PLY, one after the other.

use super::header::{Number, Property, Writing};

/// Numbers one after the other.
pub(super) struct Source<'b> {
    pub writing: Writing,
    pub bytes: &'b [u8],
}

impl Source<'_> {
    /// The values of a property of the next element: one, or those of its list.
    pub fn values(&mut self, property: &Property, into: &mut Vec<f64>) -> Result<(), String> {
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

/// What a file is that ends too early.
pub(super) fn truncated() -> String {
    "is truncated: its header states more than follows; fetch the file again".to_owned()
}
