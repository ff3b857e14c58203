//! DICOM: a series of slices, a file each, in a folder; named by the folder or by any of its files.

mod elements;
mod pixels;
mod series;
mod slice;
mod stack;
#[cfg(test)]
mod tests;

use std::path::Path;

use rayon::prelude::*;

use super::stream::{Stream, room};
use super::survey::{Promise, of_size};
use super::{Loaded, Stated, Voxels};
use crate::shared::Shared;
use crate::volume::grid::Scalars;
pub(super) use elements::recognizes;
use slice::Slice;
use stack::Stack;

/// Reads the series that a file is of, from the files of its folder.
pub(super) fn read(stream: Stream, path: &Path, stated: &Stated) -> Result<Loaded, String> {
    volume(series::of_file(stream, path)?, stated)
}

/// What the headers of the series that a file is of promise, and the files themselves.
pub(super) fn promised(stream: &mut Stream, path: &Path, _: &Stated) -> Result<Promise, String> {
    promise(series::of_file(std::mem::replace(stream, Stream::empty()), path)?)
}

/// Reads the one series in a folder.
pub(super) fn read_folder(folder: &Path, stated: &Stated) -> Result<Loaded, String> {
    let mut loaded = volume(series::of_folder(folder)?, stated)?;
    loaded.warnings.extend(stated.unused_choices(&[]));
    Ok(loaded)
}

/// What the headers of the one series in a folder promise, and its files.
pub(super) fn promised_of_folder(folder: &Path, _: &Stated) -> Result<Promise, String> {
    promise(series::of_folder(folder)?)
}

fn promise((slices, _): (Vec<Slice>, Vec<String>)) -> Result<Promise, String> {
    let stack = Stack::of(slices)?;
    let each = Numbers::of(&stack.slices).bytes();
    let files = stack.slices.iter().map(|slice| slice.path.clone()).collect();
    Ok((of_size(stack.size, each), files))
}

/// The type that values of a series are kept in.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Numbers {
    U8,
    U16,
    I16,
    I32,
    F32,
}

impl Numbers {
    /// The narrowest that holds all that the bits of the slices could say, after slope and intercept.
    fn of(slices: &[Slice]) -> Self {
        let (mut low, mut high) = (0.0_f64, 0.0_f64);
        for slice in slices {
            if slice.slope.fract() != 0.0 || slice.intercept.fract() != 0.0 {
                return Self::F32;
            }
            let bits = i32::from(slice.bits_stored);
            let ends = if slice.signed {
                [-(2.0_f64.powi(bits - 1)), 2.0_f64.powi(bits - 1) - 1.0]
            } else {
                [0.0, 2.0_f64.powi(bits) - 1.0]
            };
            for end in ends.map(|end| end * slice.slope + slice.intercept) {
                (low, high) = (low.min(end), high.max(end));
            }
        }
        let fits = |least: f64, most: f64| low >= least && high <= most;
        if fits(0.0, 255.0) {
            Self::U8
        } else if fits(-32_768.0, 32_767.0) {
            Self::I16
        } else if fits(0.0, 65_535.0) {
            Self::U16
        } else if fits(f64::from(i32::MIN), f64::from(i32::MAX)) {
            Self::I32
        } else {
            Self::F32
        }
    }

    fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::I32 | Self::F32 => 4,
        }
    }
}

fn volume(
    (slices, mut warnings): (Vec<Slice>, Vec<String>),
    stated: &Stated,
) -> Result<Loaded, String> {
    let stack = Stack::of(slices)?;
    let grid = stated.grid(stack.size, stack.placed)?;
    let scalars = match Numbers::of(&stack.slices) {
        Numbers::U8 => Scalars::U8(filled(&stack, |value| value.round() as u8)?),
        Numbers::U16 => Scalars::U16(filled(&stack, |value| value.round() as u16)?),
        Numbers::I16 => Scalars::I16(filled(&stack, |value| value.round() as i16)?),
        Numbers::I32 => Scalars::I32(filled(&stack, |value| value.round() as i32)?),
        Numbers::F32 => Scalars::F32(filled(&stack, |value| value as f32)?),
    };
    warnings.extend(stack.warnings);
    Ok(Loaded { grid, voxels: Voxels::Scalars(scalars), warnings })
}

/// The voxels of all slices of the grid; `number` makes the type of a value.
fn filled<T: Copy + Default + Send + Sync + 'static>(
    stack: &Stack,
    number: impl Fn(f64) -> T + Sync,
) -> Result<Shared<T>, String> {
    let [columns, rows, count] = stack.size;
    let mut values: Vec<T> = Vec::new();
    room(&mut values, columns * rows * count)?;
    values.resize(columns * rows * count, T::default());
    let own = values.par_chunks_mut(columns * rows).enumerate();
    match &stack.between {
        None => own.try_for_each(|(at, into)| {
            let slice = of_slice(&stack.slices[at])?;
            into.iter_mut().zip(slice).for_each(|(into, value)| *into = number(value));
            Ok::<(), String>(())
        })?,
        Some(between) => own.try_for_each(|(at, into)| {
            let (below, part) = between[at];
            let (low, high) =
                (of_slice(&stack.slices[below])?, of_slice(&stack.slices[below + 1])?);
            let part = f64::from(part);
            for (into, (low, high)) in into.iter_mut().zip(low.into_iter().zip(high)) {
                *into = number(low + (high - low) * part);
            }
            Ok::<(), String>(())
        })?,
    }
    Ok(Shared::new(values))
}

/// The values of a slice, with its slope and intercept.
fn of_slice(known: &Slice) -> Result<Vec<f64>, String> {
    let stored = Stream::open(&known.path).and_then(|stream| {
        let (slice, mut elements, pixels) = Slice::read(stream, &known.path)?;
        if slice.size != known.size {
            return Err("was changed while it was read; render it again".to_owned());
        }
        pixels::stored(&slice, &mut elements, pixels)
    });
    let stored =
        stored.map_err(|problem| format!("its slice `{}` {problem}", known.path.display()))?;
    let value = |stored: i32| {
        let stored = if known.signed { f64::from(stored) } else { f64::from(stored as u32) };
        stored * known.slope + known.intercept
    };
    Ok(stored.into_iter().map(value).collect())
}
