//! VTK's older files (`.vtk`) of PolyData, text or binary, to version 5.1: their points, polygons and strips.

use std::path::Path;

use glam::DVec3;

use super::triangles::{Triangles, add_fan, add_strip, fans, reserve};
use crate::formats::nrrd::words::Words;
use crate::formats::number::{self, Binary, NumberType, Order};
use crate::formats::stream::Stream;

/// Reads the points and what joins them; what is said of points and cells after that is left out.
pub(super) fn read(bytes: &[u8], _: &Path) -> Result<Triangles, String> {
    let mut lines = bytes.splitn(4, |&byte| byte == b'\n');
    if !lines.next().is_some_and(|line| line.starts_with(b"# vtk DataFile")) {
        return Err(
            "does not begin with `# vtk DataFile`; check that it is what its name says".to_owned()
        );
    }
    let text = match lines.nth(1).map(<[u8]>::trim_ascii) {
        Some(b"ASCII") => true,
        Some(b"BINARY") => false,
        _ => return Err("its third line is neither ASCII nor BINARY; save it again".to_owned()),
    };
    let mut file = Legacy { bytes: lines.next().unwrap_or_default(), text };
    if file.word() != "DATASET" || file.word() != "POLYDATA" {
        return Err("is no PolyData; save its surface as one".to_owned());
    }
    let mut triangles = Triangles::default();
    let mut split = 0;
    loop {
        match file.word().as_str() {
            "POINTS" => add_points(&mut triangles, &mut file)?,
            "POLYGONS" => {
                for corners in file.cells()? {
                    split += usize::from(corners.len() > 3);
                    add_fan(&mut triangles.faces, &corners);
                }
            }
            "TRIANGLE_STRIPS" => {
                file.cells()?.iter().for_each(|corners| add_strip(&mut triangles.faces, corners));
            }
            "VERTICES" | "LINES" => drop(file.cells()?),
            "METADATA" => file.skip_paragraph(),
            "" | "POINT_DATA" | "CELL_DATA" => break,
            other => {
                return Err(format!(
                    "has `{other}` where points or polygons are expected; save it again"
                ));
            }
        }
    }
    triangles.warnings.extend(fans(split));
    Ok(triangles)
}

fn add_points(triangles: &mut Triangles, file: &mut Legacy) -> Result<(), String> {
    let count = file.count()?;
    let kind = NumberType::named(&file.word())?;
    let points = file.numbers(kind, count.checked_mul(3).ok_or_else(truncated)?)?;
    reserve(&mut triangles.vertices, count)?;
    triangles.vertices.extend(points.chunks_exact(3).map(|p| DVec3::new(p[0], p[1], p[2])));
    Ok(())
}

/// A file from where it is read on.
struct Legacy<'b> {
    bytes: &'b [u8],
    text: bool,
}

impl Legacy<'_> {
    /// The next word of a line of text; none at the end.
    fn word(&mut self) -> String {
        let rest = self.bytes.trim_ascii_start();
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        // A number of bytes that are no text is cut short in any case.
        let word = String::from_utf8_lossy(&rest[..end.min(80)]).into_owned();
        self.bytes = &rest[end..];
        word
    }

    fn count(&mut self) -> Result<usize, String> {
        let word = self.word();
        word.parse().map_err(|_| format!("has `{word}` where a number is expected; save it again"))
    }

    /// So many numbers: words, or bytes from the next line on, the highest first.
    fn numbers(&mut self, kind: NumberType, count: usize) -> Result<Vec<f64>, String> {
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
    fn cells(&mut self) -> Result<Vec<Vec<u32>>, String> {
        let (first, second) = (self.count()?, self.count()?);
        let before = self.bytes;
        if self.word() != "OFFSETS" {
            self.bytes = before;
            return counted(&self.numbers(NumberType::I32, second)?);
        }
        let kind = self.index_type()?;
        let ends = self.numbers(kind, first)?;
        if self.word() != "CONNECTIVITY" {
            return Err("has offsets without `CONNECTIVITY`; save it again".to_owned());
        }
        let kind = self.index_type()?;
        let corners = self.numbers(kind, second)?;
        let cell = |pair: &[f64]| {
            let own = corners.get(pair[0].max(0.0) as usize..pair[1].max(0.0) as usize);
            own.ok_or_else(truncated).and_then(indices)
        };
        ends.windows(2).map(cell).collect()
    }

    fn index_type(&mut self) -> Result<NumberType, String> {
        match self.word().as_str() {
            "vtktypeint64" => Ok(NumberType::I64),
            other => NumberType::named(other),
        }
    }

    /// Goes on after the next blank line.
    fn skip_paragraph(&mut self) {
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

fn truncated() -> String {
    "is truncated or damaged: it holds fewer numbers than it says; fetch the file again".to_owned()
}
