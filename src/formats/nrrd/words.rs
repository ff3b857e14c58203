//! Voxels written as text: numbers between blanks or commas.

use bytemuck::Pod;

use super::super::number::{NumberSource, Stored};
use super::super::stream::{Stream, room};

/// Letters that a number may have: the smallest double, written out, has 327.
const LONGEST: usize = 400;
/// Elements that are allocated at first; more only as their words arrive.
const FIRST_CHUNK: usize = 1 << 16;

/// The words of a stream, one after another.
pub(crate) struct Words<'a> {
    stream: &'a mut Stream,
    word: Vec<u8>,
}

impl<'a> Words<'a> {
    /// The words from where the stream stands.
    pub fn new(stream: &'a mut Stream) -> Self {
        Self { stream, word: Vec::new() }
    }

    /// A warning where a word is left.
    pub(super) fn finish(mut self) -> Result<Option<String>, String> {
        Ok(self
            .next()?
            .map(|word| format!("text follows the last voxel, from `{word}`, and is not used")))
    }

    /// The next word; `None` at the end.
    fn next(&mut self) -> Result<Option<&str>, String> {
        self.word.clear();
        loop {
            let bytes = self.stream.buffered()?;
            if bytes.is_empty() {
                break;
            }
            let separates = |byte: &u8| byte.is_ascii_whitespace() || *byte == b',';
            if self.word.is_empty() {
                let blank = bytes.iter().take_while(|byte| separates(byte)).count();
                if blank > 0 {
                    self.stream.consume(blank);
                    continue;
                }
            }
            let end = bytes.iter().position(separates);
            let taken = end.unwrap_or(bytes.len());
            if self.word.len() + taken > LONGEST {
                return Err(format!(
                    "has more than {LONGEST} letters without a blank where a number is expected; correct its `encoding`"
                ));
            }
            self.word.extend(&bytes[..taken]);
            self.stream.consume(taken);
            if end.is_some() {
                break;
            }
        }
        match std::str::from_utf8(&self.word) {
            Ok("") => Ok(None),
            Ok(word) => Ok(Some(word)),
            Err(_) => Err("its voxels are not text; correct its `encoding`".to_owned()),
        }
    }
}

impl NumberSource for Words<'_> {
    fn array<E: Pod, T: Stored>(&mut self, count: usize) -> Result<Vec<E>, String> {
        let each = size_of::<E>() / size_of::<T>();
        // A number and a separator are two bytes; the last needs no separator.
        let fewest = (count * each) as u64 * 2 - 1;
        self.stream.must_hold(fewest, "its voxels, as text,")?;
        let mut elements: Vec<E> = Vec::new();
        while elements.len() < count {
            let start = elements.len();
            let end = count.min((2 * start).max(FIRST_CHUNK));
            room(&mut elements, end - start)?;
            elements.resize(end, E::zeroed());
            let numbers: &mut [T] = bytemuck::cast_slice_mut(&mut elements[start..]);
            for (at, number) in numbers.iter_mut().enumerate() {
                let place = start * each + at;
                let word = self.next()?.ok_or_else(|| {
                    format!(
                        "is truncated: its sizes promise {} numbers and {place} were found; correct `sizes` or fetch the file again",
                        count * each
                    )
                })?;
                *number = T::parsed(word).ok_or_else(|| {
                    format!(
                        "its number {place} is `{word}`, which is not of its `type`; correct the number or the `type`"
                    )
                })?;
            }
        }
        Ok(elements)
    }
}
