//! A legacy VTK file from where it is read on: words, and numbers as text or bytes.

use crate::formats::nrrd::words::Words;
use crate::formats::number::{self, Binary, NumberType, Order};
use crate::formats::stream::Stream;

/// A file from where it is read on.
pub(super) struct Legacy<'b> {
    pub bytes: &'b [u8],
    /// Whether its numbers are words, and not bytes.
    pub text: bool,
}

impl Legacy<'_> {
    /// The next word of a line of text; none at the end.
    pub fn word(&mut self) -> String {
        let rest = self.bytes.trim_ascii_start();
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        // A number of bytes that are no text is cut short in any case.
        let word = String::from_utf8_lossy(&rest[..end.min(80)]).into_owned();
        self.bytes = &rest[end..];
        word
    }

    /// The next word as a whole number.
    pub fn count(&mut self) -> Result<usize, String> {
        let word = self.word();
        word.parse().map_err(|_| format!("has `{word}` where a number is expected; save it again"))
    }

    /// So many numbers: words, or bytes from the next line on, the highest first.
    pub fn numbers(&mut self, kind: NumberType, count: usize) -> Result<Vec<f64>, String> {
        if self.text {
            return self.words(kind, count);
        }
        let line = self.bytes.iter().position(|&byte| byte == b'\n').ok_or_else(truncated)?;
        let from = &self.bytes[line + 1..];
        let bytes = count.checked_mul(kind.bytes()).ok_or_else(truncated)?;
        let (own, rest) = from.split_at_checked(bytes).ok_or_else(truncated)?;
        self.bytes = rest;
        let mut stream = Stream::of(own.to_vec());
        number::numbers(&mut Binary { stream: &mut stream, order: Order::Big }, kind, count)
    }

    fn words(&mut self, kind: NumberType, count: usize) -> Result<Vec<f64>, String> {
        // Each number has a letter and a blank.
        if count > self.bytes.len() {
            return Err(truncated());
        }
        let mut end = 0;
        for _ in 0..count {
            let rest = &self.bytes[end..];
            let blank = rest.len() - rest.trim_ascii_start().len();
            let word = &rest[blank..];
            let length = word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len());
            end += blank + length;
        }
        let (own, rest) = self.bytes.split_at(end);
        self.bytes = rest;
        let mut stream = Stream::of(own.to_vec());
        number::numbers(&mut Words::new(&mut stream), kind, count)
    }

    /// The points of each cell: each after its length, or from version 5 on all in a row after where each ends.
    pub fn cells(&mut self) -> Result<Vec<Vec<u32>>, String> {
        let (first, second) = (self.count()?, self.count()?);
        let before = self.bytes;
        if self.word() != "OFFSETS" {
            self.bytes = before;
            return counted(&self.numbers(NumberType::I32, second)?);
        }
        let kind = self.number_type()?;
        let ends = self.numbers(kind, first)?;
        if self.word() != "CONNECTIVITY" {
            return Err("has offsets without `CONNECTIVITY`; save it again".to_owned());
        }
        let kind = self.number_type()?;
        let corners = self.numbers(kind, second)?;
        let cell = |pair: &[f64]| {
            let own = corners.get(pair[0].max(0.0) as usize..pair[1].max(0.0) as usize);
            own.ok_or_else(truncated).and_then(indices)
        };
        ends.windows(2).map(cell).collect()
    }

    /// The next word as a type of numbers, under VTK's names too.
    pub fn number_type(&mut self) -> Result<NumberType, String> {
        match self.word().as_str() {
            "vtktypeint64" | "long" => Ok(NumberType::I64),
            // So it is written however wide it is in memory.
            "vtkIdType" => Ok(NumberType::I32),
            "unsigned_long" => Ok(NumberType::U64),
            other => NumberType::named(&other.replace("unsigned_", "unsigned ")),
        }
    }

    /// The next word, if it is a whole number; else it stays.
    pub fn count_if_any(&mut self) -> Option<usize> {
        let before = self.bytes;
        let count = self.word().parse().ok();
        if count.is_none() {
            self.bytes = before;
        }
        count
    }

    /// Goes on after the next blank line.
    pub fn skip_paragraph(&mut self) {
        let end = self.bytes.windows(2).position(|two| two == b"\n\n");
        self.bytes = &self.bytes[end.map_or(self.bytes.len(), |end| end + 2)..];
    }
}

/// Cells that each come after their length.
fn counted(numbers: &[f64]) -> Result<Vec<Vec<u32>>, String> {
    let mut rest = numbers;
    let mut cells = Vec::new();
    while let Some((&length, after)) = rest.split_first() {
        let (own, next) = after.split_at_checked(length.max(0.0) as usize).ok_or_else(truncated)?;
        cells.push(indices(own)?);
        rest = next;
    }
    Ok(cells)
}

fn indices(numbers: &[f64]) -> Result<Vec<u32>, String> {
    let index = |&at: &f64| (0.0..=f64::from(u32::MAX)).contains(&at).then_some(at as u32);
    numbers.iter().map(index).collect::<Option<_>>().ok_or_else(truncated)
}

/// What a file is that ends too early.
pub(super) fn truncated() -> String {
    "is truncated or damaged: it holds fewer numbers than it says; fetch the file again".to_owned()
}
