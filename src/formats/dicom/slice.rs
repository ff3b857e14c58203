//! One slice of a series: what its header says of its pixels, their place, and the series that it is of.

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::super::number::Order;
use super::super::stream::Stream;
use super::elements::{Elements, Pixels, Writing, short};

/// The longest side of a slice.
const LONGEST_SIDE: u16 = 16384;

/// How pixels are packed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Packing {
    /// Not at all.
    Native,
    /// Run lengths, byte plane by byte plane (PS3.5 annex G).
    Runs,
    /// A JPEG of a kind that is read: baseline, extended, or lossless.
    Jpeg,
}

/// What the header of a slice says.
#[derive(Debug, Clone)]
pub(super) struct Slice {
    pub path: PathBuf,
    pub series: String,
    pub described: String,
    pub instance: i64,
    /// Whether it is a scout for planning, which lies across the others.
    pub localizer: bool,
    /// Columns and rows.
    pub size: [u16; 2],
    pub bits_allocated: u16,
    pub bits_stored: u16,
    pub high_bit: u16,
    pub signed: bool,
    pub slope: f64,
    pub intercept: f64,
    /// Distance between neighbors along a row and along a column, mm.
    pub spacing: [f64; 2],
    /// Distance that it states between slices, mm.
    pub between: Option<f64>,
    /// Center of its first pixel, LPS, mm.
    pub position: Option<DVec3>,
    /// Directions of its rows and of its columns.
    pub directions: Option<[DVec3; 2]>,
    pub packing: Packing,
    pub order: Order,
}

/// Values as they stand in the file, before they are checked.
#[derive(Default)]
struct Found {
    syntax: String,
    photometric: String,
    samples: u16,
    frames: f64,
    kinds: String,
}

impl Slice {
    /// Reads the header of a file, to its pixels; the file is handed back where they begin.
    pub fn read(stream: Stream, path: &Path) -> Result<(Self, Elements, Pixels), String> {
        let mut elements = Elements::of(stream)?;
        let mut slice = Self::blank(path);
        let mut found = Found { samples: 1, frames: 1.0, ..Found::default() };
        let pixels = elements.walk(|tag, value, order| {
            slice.take(tag, value, order);
            found.take(tag, value, order);
            if tag == 0x0002_0010 { writing(&found.syntax).map(Some) } else { Ok(None) }
        })?;
        let pixels = pixels.ok_or("holds no pixels; name a file of the series of slices")?;
        slice.order = writing(&found.syntax)?.order;
        slice.packing = packing(&found.syntax)?;
        slice.localizer = found.kinds.contains("LOCALIZER");
        slice.check(&found)?;
        Ok((slice, elements, pixels))
    }

    fn blank(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            series: String::new(),
            described: String::new(),
            instance: 0,
            localizer: false,
            size: [0; 2],
            bits_allocated: 16,
            bits_stored: 16,
            high_bit: 15,
            signed: false,
            slope: 1.0,
            intercept: 0.0,
            spacing: [1.0; 2],
            between: None,
            position: None,
            directions: None,
            packing: Packing::Native,
            order: Order::Little,
        }
    }

    fn take(&mut self, tag: u32, value: &[u8], order: Order) {
        let numbers = || numbers(value);
        match tag {
            0x0008_103e => self.described = text(value),
            0x0020_000e => self.series = text(value),
            0x0020_0013 => self.instance = numbers().first().map_or(0, |&n| n as i64),
            0x0020_0032 => self.position = three(&numbers()),
            0x0020_0037 => {
                let all = numbers();
                let columns = all.get(3..).and_then(three);
                self.directions = three(&all).zip(columns).map(|(rows, columns)| [rows, columns]);
            }
            0x0018_0088 => self.between = numbers().first().copied(),
            // The thickness stands in where no distance is stated.
            0x0018_0050 if self.between.is_none() => self.between = numbers().first().copied(),
            0x0028_0010 => self.size[1] = short(value, order),
            0x0028_0011 => self.size[0] = short(value, order),
            0x0028_0030 => {
                if let [down, across, ..] = numbers()[..] {
                    self.spacing = [across, down];
                }
            }
            0x0028_0100 => self.bits_allocated = short(value, order),
            0x0028_0101 => self.bits_stored = short(value, order),
            0x0028_0102 => self.high_bit = short(value, order),
            0x0028_0103 => self.signed = short(value, order) == 1,
            0x0028_1052 => self.intercept = numbers().first().copied().unwrap_or(0.0),
            0x0028_1053 => self.slope = numbers().first().copied().unwrap_or(1.0),
            _ => {}
        }
    }

    fn check(&self, found: &Found) -> Result<(), String> {
        let Self { size: [columns, rows], bits_allocated, bits_stored, high_bit, .. } = *self;
        if found.samples != 1 || !found.photometric.starts_with("MONOCHROME") {
            return Err(format!(
                "its pixels are {} of {} samples, and one number a pixel is expected; name a series of slices, not of pictures",
                found.photometric, found.samples
            ));
        }
        if found.frames != 1.0 {
            return Err(format!(
                "holds {} frames, and one slice a file is read; split it, or convert it to NIfTI or NRRD",
                found.frames
            ));
        }
        if ![columns, rows].iter().all(|side| (1..=LONGEST_SIDE).contains(side)) {
            return Err(format!(
                "its size is {columns} × {rows} pixels, and sides of 1 to {LONGEST_SIDE} are read; fetch the file again"
            ));
        }
        let whole = [8, 16, 32].contains(&bits_allocated);
        let within = (1..=bits_allocated).contains(&bits_stored)
            && high_bit < bits_allocated
            && bits_stored <= high_bit + 1;
        if !whole || !within {
            return Err(format!(
                "its pixels are {bits_stored} of {bits_allocated} bits up to bit {high_bit}, and 8, 16 or 32 are read; convert the series to NIfTI or NRRD"
            ));
        }
        let scale = [self.slope, self.intercept, self.spacing[0], self.spacing[1]];
        if !scale.iter().all(|n| n.is_finite()) || self.slope == 0.0 {
            return Err(format!(
                "its slope, intercept or spacing is no number ({scale:?}); fetch the file again"
            ));
        }
        Ok(())
    }
}

impl Found {
    fn take(&mut self, tag: u32, value: &[u8], order: Order) {
        match tag {
            0x0002_0010 => self.syntax = text(value),
            0x0008_0008 => self.kinds = text(value).to_uppercase(),
            0x0028_0002 => self.samples = short(value, order),
            0x0028_0004 => self.photometric = text(value),
            0x0028_0008 => self.frames = numbers(value).first().copied().unwrap_or(1.0),
            _ => {}
        }
    }
}

/// How the elements of a transfer syntax are written; a file without one is as in the standard's default.
fn writing(syntax: &str) -> Result<Writing, String> {
    let writing = |order, explicit| Ok(Writing { order, explicit });
    match syntax {
        "" | "1.2.840.10008.1.2" => writing(Order::Little, false),
        "1.2.840.10008.1.2.2" => writing(Order::Big, true),
        "1.2.840.10008.1.2.1.99" => Err(
            "is deflated as a whole (transfer syntax 1.2.840.10008.1.2.1.99); convert it with dcmconv or gdcmconv --raw"
                .to_owned(),
        ),
        _ => writing(Order::Little, true),
    }
}

fn packing(syntax: &str) -> Result<Packing, String> {
    let packed = match syntax {
        "" | "1.2.840.10008.1.2" | "1.2.840.10008.1.2.1" | "1.2.840.10008.1.2.2" => {
            return Ok(Packing::Native);
        }
        "1.2.840.10008.1.2.5" => return Ok(Packing::Runs),
        "1.2.840.10008.1.2.4.50"
        | "1.2.840.10008.1.2.4.51"
        | "1.2.840.10008.1.2.4.57"
        | "1.2.840.10008.1.2.4.70" => return Ok(Packing::Jpeg),
        "1.2.840.10008.1.2.4.80" | "1.2.840.10008.1.2.4.81" => "JPEG-LS",
        "1.2.840.10008.1.2.4.90" | "1.2.840.10008.1.2.4.91" => "JPEG 2000",
        "1.2.840.10008.1.2.4.201" | "1.2.840.10008.1.2.4.202" | "1.2.840.10008.1.2.4.203" => {
            "High-Throughput JPEG 2000"
        }
        _ => "a way that is not known",
    };
    Err(format!(
        "its pixels are packed by {packed} (transfer syntax {syntax}), and plain pixels, run lengths and JPEG are read; unpack the series with gdcmconv --raw or dcmdjpeg"
    ))
}

/// Text without the blanks and zeros that fill it up.
fn text(value: &[u8]) -> String {
    String::from_utf8_lossy(value).trim_matches(['\0', ' ']).to_owned()
}

/// Decimal numbers with backslashes between them; a word that is none is NaN.
fn numbers(value: &[u8]) -> Vec<f64> {
    let text = text(value);
    let words = text.split('\\').filter(|word| !word.trim().is_empty());
    words.map(|word| word.trim().parse().unwrap_or(f64::NAN)).collect()
}

/// The first three as a vector, if they are finite.
fn three(numbers: &(impl AsRef<[f64]> + ?Sized)) -> Option<DVec3> {
    let three: [f64; 3] = *numbers.as_ref().first_chunk()?;
    Some(DVec3::from(three)).filter(|vector| vector.is_finite())
}
