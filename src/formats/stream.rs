//! A file as a stream that knows how many bytes it may still give: nothing is allocated that it cannot back.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, ErrorKind, Read};
use std::path::Path;

use bytemuck::Pod;
use flate2::bufread::{MultiGzDecoder, ZlibDecoder};

/// No deflate stream inflates to more than this many times its length.
const MOST_INFLATION: u64 = 1032;
/// Bytes that are allocated at first for an inflated array; more only as its bytes arrive.
const FIRST_CHUNK: usize = 1 << 20;

/// Bytes that a stream still has.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Left {
    /// Those of a plain file.
    Exactly(u64),
    /// Those that a compressed file could inflate to.
    AtMost(u64),
}

impl Left {
    /// What this many bytes could inflate to.
    fn inflated(self) -> Self {
        let (Self::Exactly(packed) | Self::AtMost(packed)) = self;
        Self::AtMost(packed.saturating_mul(MOST_INFLATION))
    }
}

/// A file, plain or inflating, read from start to end.
pub(super) struct Stream {
    reader: Box<dyn BufRead>,
    left: Left,
}

impl Stream {
    /// Opens an ordinary file; the error is a sentence without a subject.
    pub(super) fn open(path: &Path) -> Result<Self, String> {
        let found = std::fs::metadata(path).map_err(|error| match error.kind() {
            ErrorKind::NotFound => "no such file; correct the path".to_owned(),
            _ => format!("cannot be read ({error}); check its permissions"),
        })?;
        if !found.is_file() {
            return Err("is not a file; name the file that holds the volume".to_owned());
        }
        let file = File::open(path)
            .map_err(|error| format!("cannot be read ({error}); check its permissions"))?;
        Ok(Self { reader: Box::new(BufReader::new(file)), left: Left::Exactly(found.len()) })
    }

    /// A stream that has ended.
    pub(super) fn empty() -> Self {
        Self { reader: Box::new(io::empty()), left: Left::Exactly(0) }
    }

    /// A stream of bytes in memory.
    pub(super) fn of(bytes: Vec<u8>) -> Self {
        let left = Left::Exactly(bytes.len() as u64);
        Self { reader: Box::new(Cursor::new(bytes)), left }
    }

    /// The rest of this stream, inflated.
    pub(super) fn inflated(self) -> Self {
        let left = self.left.inflated();
        let inflater = BufReader::with_capacity(1 << 16, MultiGzDecoder::new(self.reader));
        Self { reader: Box::new(inflater), left }
    }

    /// The rest of this stream, inflated from what zlib packed, without the header of gzip.
    pub(super) fn inflated_zlib(self) -> Self {
        let left = self.left.inflated();
        let inflater = BufReader::with_capacity(1 << 16, ZlibDecoder::new(self.reader));
        Self { reader: Box::new(inflater), left }
    }

    /// The stream inflated where it starts as gzip, else as it is.
    pub(super) fn inflated_if_gzip(mut self) -> Result<Self, String> {
        let gzip = self.peek(3)? == [0x1f, 0x8b, 8];
        Ok(if gzip { self.inflated() } else { self })
    }

    /// The next bytes, up to `most`, which stay in the stream.
    pub(super) fn peek(&mut self, most: usize) -> Result<Vec<u8>, String> {
        let mut head = Vec::new();
        let mut reader = std::mem::replace(&mut self.reader, Box::new(io::empty()));
        reader.by_ref().take(most as u64).read_to_end(&mut head).map_err(|e| unreadable(&e))?;
        self.reader = Box::new(Cursor::new(head.clone()).chain(reader));
        Ok(head)
    }

    /// The next `N` bytes: a header of fixed length called `what`.
    pub(super) fn block<const N: usize>(&mut self, what: &str) -> Result<[u8; N], String> {
        let mut block = [0; N];
        let got = self.fill(&mut block)?;
        if got < N {
            return Err(format!(
                "is truncated: {what} needs {N} bytes and {got} were found; fetch the file again"
            ));
        }
        Ok(block)
    }

    /// The next line without its end, or `None` at the end of the file; `most` bytes are left to the header it is of.
    pub(super) fn line(&mut self, most: &mut u64) -> Result<Option<String>, String> {
        let mut line = Vec::new();
        let got = self
            .reader
            .by_ref()
            .take(*most)
            .read_until(b'\n', &mut line)
            .map_err(|e| unreadable(&e))? as u64;
        self.spend(got);
        *most -= got;
        if *most == 0 {
            return Err("its header does not end; expected a blank line within 1 MiB; check that it is what its name says".to_owned());
        }
        if got == 0 {
            return Ok(None);
        }
        let text = String::from_utf8_lossy(&line);
        Ok(Some(text.strip_suffix('\n').unwrap_or(&text).trim_end_matches('\r').to_owned()))
    }

    /// Leaves out whole lines, as a header's `line skip` asks.
    pub(super) fn skip_lines(&mut self, lines: u64) -> Result<(), String> {
        for line in 0..lines {
            let got = self.reader.skip_until(b'\n').map_err(|e| unreadable(&e))?;
            self.spend(got as u64);
            if got == 0 {
                return Err(format!(
                    "ends after {line} lines of the {lines} that its header says to skip; correct `line skip`"
                ));
            }
        }
        Ok(())
    }

    /// Leaves out bytes, as a header's `byte skip` or the offset of its voxels asks.
    pub(super) fn skip_bytes(&mut self, bytes: u64) -> Result<(), String> {
        self.skip(bytes, "the bytes before its voxels")
    }

    /// Leaves out bytes, which are `what` for a sentence.
    pub(super) fn skip(&mut self, bytes: u64, what: &str) -> Result<(), String> {
        self.must_hold(bytes, what)?;
        let got = io::copy(&mut self.reader.by_ref().take(bytes), &mut io::sink())
            .map_err(|e| unreadable(&e))?;
        self.spend(got);
        if got < bytes {
            return Err(truncated(bytes, got, what));
        }
        Ok(())
    }

    /// Leaves out all but the last `bytes`, as `byte skip: -1` asks.
    pub(super) fn skip_to_last(&mut self, bytes: u64) -> Result<(), String> {
        self.must_hold(bytes, "its voxels")?;
        match self.left {
            Left::Exactly(left) => self.skip_bytes(left - bytes),
            Left::AtMost(_) => {
                Err("a `byte skip` of -1 needs a file that is not compressed; inflate it first"
                    .to_owned())
            }
        }
    }

    /// `count` values, laid out as in the file; allocated at once from a plain file, else as the bytes arrive.
    pub(super) fn array<T: Pod>(&mut self, count: usize) -> Result<Vec<T>, String> {
        let promised = (count as u64).saturating_mul(size_of::<T>() as u64);
        self.must_hold(promised, "its voxels")?;
        let mut values: Vec<T> = Vec::new();
        while values.len() < count {
            let start = values.len();
            let end = match self.left {
                Left::Exactly(_) => count,
                Left::AtMost(_) => count.min((2 * start).max(FIRST_CHUNK / size_of::<T>())),
            };
            room(&mut values, end - start)?;
            values.resize(end, T::zeroed());
            let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut values[start..]);
            let wanted = bytes.len();
            let got = self.fill(bytes)?;
            if got < wanted {
                let before = (start * size_of::<T>()) as u64;
                return Err(truncated(promised, before + got as u64, "its voxels"));
            }
        }
        Ok(values)
    }

    /// All bytes that are left, for a format that goes back and forth in its file; of a plain file only.
    pub(super) fn rest(&mut self) -> Result<Vec<u8>, String> {
        match self.left {
            Left::Exactly(left) => self.array(left as usize),
            Left::AtMost(_) => {
                Err("is packed as a whole, and its format packs its parts; inflate it first"
                    .to_owned())
            }
        }
    }

    /// The next bytes of text, as they happen to be buffered; none at the end. [`Self::consume`] takes them.
    pub(super) fn buffered(&mut self) -> Result<&[u8], String> {
        self.reader.fill_buf().map_err(|e| unreadable(&e))
    }

    /// Takes `bytes` of those that [`Self::buffered`] gave.
    pub(super) fn consume(&mut self, bytes: usize) {
        self.reader.consume(bytes);
        self.spend(bytes as u64);
    }

    /// Ends the reading: bytes too many are a warning in a plain file and an error in an inflated one.
    pub(super) fn finish(mut self) -> Result<Option<String>, String> {
        match self.left {
            Left::Exactly(0) => Ok(None),
            Left::Exactly(left) => {
                Ok(Some(format!("{left} bytes follow the last voxel and are not used")))
            }
            Left::AtMost(_) => match self.fill(&mut [0])? {
                0 => Ok(None),
                _ => Err("inflates past its header: more bytes follow than its sizes and type promise; check the header's sizes and type".to_owned()),
            },
        }
    }

    /// Fails where the file cannot hold `bytes` more, before anything is allocated for them.
    pub(super) fn must_hold(&self, bytes: u64, what: &str) -> Result<(), String> {
        match self.left {
            Left::Exactly(left) if left < bytes => Err(truncated(bytes, left, what)),
            Left::AtMost(left) if left < bytes => Err(format!(
                "is truncated: {what} need {bytes} bytes and the file could inflate to {left} at the most; fetch the file again or correct its header"
            )),
            _ => Ok(()),
        }
    }

    fn fill(&mut self, bytes: &mut [u8]) -> Result<usize, String> {
        let mut got = 0;
        while got < bytes.len() {
            match self.reader.read(&mut bytes[got..]) {
                Ok(0) => break,
                Ok(more) => got += more,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(unreadable(&error)),
            }
        }
        self.spend(got as u64);
        Ok(got)
    }

    fn spend(&mut self, bytes: u64) {
        let (Left::Exactly(left) | Left::AtMost(left)) = &mut self.left;
        *left = left.saturating_sub(bytes);
    }
}

/// So many bytes of 0.
pub(super) fn zeros(count: usize) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    room(&mut bytes, count)?;
    bytes.resize(count, 0);
    Ok(bytes)
}

/// Makes room in an array for `more` values; the error is that the machine has no memory for them.
pub(super) fn room<T>(values: &mut Vec<T>, more: usize) -> Result<(), String> {
    values.try_reserve_exact(more).map_err(|_| {
        let bytes = (values.len() + more) as u64 * size_of::<T>() as u64;
        format!("needs {bytes} bytes of memory, which there are not; choose a smaller volume or free some memory")
    })
}

fn truncated(needed: u64, found: u64, what: &str) -> String {
    format!(
        "is truncated: {what} need {needed} bytes and {found} were found; fetch the file again or correct its header"
    )
}

fn unreadable(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::UnexpectedEof => {
            "is truncated: its packed data end early; fetch the file again".to_owned()
        }
        ErrorKind::InvalidData | ErrorKind::InvalidInput => {
            format!("its packed data are damaged ({error}); fetch the file again")
        }
        _ => format!("cannot be read ({error}); check the disk and its permissions"),
    }
}

#[cfg(test)]
mod tests;
