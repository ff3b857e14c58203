//! The brick that rays meet after the one that they are in: its texels are asked of memory before they are needed, for half of
//! what rays take was waiting for them.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use prefetch_index::prefetch_index;

use super::order::Next;
use crate::volume::gel::{CELLS, ROW, TEXELS, Texel};

/// Bytes that memory hands out together.
const LINE: usize = 64;
/// Texels of a layer of a brick.
const LAYER: usize = ROW * ROW;

/// A brick that rays of a tile may meet.
pub(super) struct Ahead<'a, T> {
    pub next: Next,
    /// Its cells that are sampled; `None` for a brick that is not stored.
    pub words: Option<&'a [u64; CELLS]>,
    pub texels: &'a [T; TEXELS],
}

impl<T: Texel> Ahead<'_, T> {
    /// Asks memory for the layers of texels around cells that are sampled.
    #[inline(always)]
    pub fn fetch(&self) {
        let Some(words) = self.words else { return };
        let mut asked = 0;
        for (z, _) in words.iter().enumerate().filter(|(_, word)| **word != 0) {
            let end = (z + 2) * LAYER;
            for first in (asked.max(z * LAYER)..end).step_by(LINE / size_of::<T>()) {
                prefetch_index(&self.texels[..], first);
            }
            asked = end;
        }
    }
}
