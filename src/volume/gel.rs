//! The coloured, semi-transparent gel that rays sample: bricks of associated RGBA with an apron.
//!
//! A brick holds 8³ *cells* (the cube between eight neighbouring voxels) and for them 9³ texels: the ninth of each row
//! repeats the next brick's first, so that a sample touches one brick. Texels beyond the last voxel are zero, so that a
//! sample on the last plane of voxels needs no clamp. A brick without an interesting voxel takes no memory.

mod texel;

use std::sync::Arc;

use fearless_simd::{Level, dispatch};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::components::TexelKind;
use crate::schedule::Product;
use crate::volume::bricks::Bricks;
use crate::volume::cells::marked_cells;
pub use texel::{BRIGHT, FAINT, Texel};

/// Cells along one edge of a brick.
pub const CELLS: usize = 8;
/// Texels along one edge of a brick.
pub(crate) const ROW: usize = CELLS + 1;
/// Texels of a brick.
pub const TEXELS: usize = ROW * ROW * ROW;
/// The table's entry for a brick that is not stored.
pub(crate) const EMPTY: u32 = u32::MAX;

/// The gel in one number type. Shared by pointer, equality is identity.
#[derive(Debug)]
pub struct Texels<T>(Arc<Stored<T>>);

#[derive(Debug)]
struct Stored<T> {
    counts: [usize; 3],
    table: Vec<u32>,
    /// The texels of the stored bricks, and of a last one of zeros that stands for all that are not stored.
    texels: Vec<T>,
}

impl<T> Clone for Texels<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> PartialEq for Texels<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// What gel is made of.
pub trait Fill: Sync {
    /// Fills the 9³ texels of a brick, which come clear, with associated RGBA of the voxels from its first on; those outside
    /// the grid, of `size` voxels, stay clear.
    fn fill<T: Texel>(&self, size: [usize; 3], brick: [usize; 3], texels: &mut [T; TEXELS]);
}

/// Row by row: of 9 voxels from voxel `first` on along x, which come clear. It is asked for voxels inside the grid alone; the
/// row is as short as the grid ends.
impl<F: Fn([usize; 3], &mut [Vec4]) + Sync> Fill for F {
    fn fill<T: Texel>(&self, size: [usize; 3], brick: [usize; 3], texels: &mut [T; TEXELS]) {
        let first = brick.map(|b| b * CELLS);
        let extent: [usize; 3] = std::array::from_fn(|axis| ROW.min(size[axis] - first[axis]));
        let mut row = [Vec4::ZERO; ROW];
        for (z, y) in (0..extent[2]).flat_map(|z| (0..extent[1]).map(move |y| (z, y))) {
            row.fill(Vec4::ZERO);
            self([first[0], first[1] + y, first[2] + z], &mut row[..extent[0]]);
            let made = &mut texels[(z * ROW + y) * ROW..][..extent[0]];
            made.iter_mut().zip(&row).for_each(|(texel, channels)| *texel = T::store(*channels));
        }
    }
}

impl<T: Texel> Texels<T> {
    /// Makes the gel of a grid of `size` voxels.
    ///
    /// `holds(brick)` says whether a brick is stored (whether one of the 9³ voxels from its first on is interesting).
    pub fn make(
        size: [usize; 3],
        holds: impl Fn([usize; 3]) -> bool + Sync,
        made_of: &impl Fill,
    ) -> Self {
        let counts = size.map(|n| n.div_ceil(CELLS));
        let [nx, ny, nz] = counts;
        let place = |at: usize| [at % nx, at / nx % ny, at / (nx * ny)];
        let mut table: Vec<u32> = (0..nx * ny * nz)
            .into_par_iter()
            .map(|at| if holds(place(at)) { 0 } else { EMPTY })
            .collect();
        let mut stored = Vec::new();
        for (at, entry) in table.iter_mut().enumerate().filter(|(_, entry)| **entry != EMPTY) {
            *entry = stored.len() as u32;
            stored.push(place(at));
        }
        // Filled where they stay: zeros come from the system for nothing, and a copy of what is made would cost as much again.
        let (mut texels, level) = (vec![T::default(); (stored.len() + 1) * TEXELS], Level::new());
        let places = texels.as_chunks_mut::<TEXELS>().0.par_iter_mut().zip(&stored);
        places.for_each(|(texels, &brick)| {
            dispatch!(level, _simd => made_of.fill(size, brick, texels));
        });
        Self(Arc::new(Stored { counts, table, texels }))
    }

    /// Bricks on each axis.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        self.0.counts
    }

    /// The place in the table of the brick around a cell.
    #[must_use]
    pub fn entry(&self, cell: [usize; 3]) -> u32 {
        let [x, y, z] = cell.map(|n| n / CELLS);
        ((z * self.counts()[1] + y) * self.counts()[0] + x) as u32
    }

    /// For each brick of the grid, x fastest: its number among the stored ones, or `EMPTY`.
    #[must_use]
    pub fn table(&self) -> &[u32] {
        &self.0.table
    }

    /// The texels of the stored bricks, x fastest.
    #[must_use]
    pub fn bricks(&self) -> &[[T; TEXELS]] {
        let bricks = self.0.bricks();
        &bricks[..bricks.len() - 1]
    }

    /// The arrays behind the pointers, for rays.
    #[must_use]
    pub fn slices(&self) -> TexelSlices<'_, T> {
        let Stored { counts, table, .. } = &*self.0;
        TexelSlices { counts: *counts, table, bricks: self.0.bricks() }
    }

    /// Which cells of stored brick `brick` are interesting: bit `8 y + x` of word `z`, set if one of its eight texels
    /// has an opacity above zero. Level 0 of the paper's pyramid.
    #[must_use]
    pub(crate) fn interesting_cells(&self, brick: u32) -> [u64; CELLS] {
        let texels = &self.0.bricks()[brick as usize];
        let opaque = |z: usize, y: usize| {
            let row = &texels[(z * ROW + y) * ROW..][..ROW];
            row.iter()
                .enumerate()
                .fold(0_u64, |bits, (x, texel)| bits | u64::from(texel.load().w > 0.0) << x)
        };
        marked_cells(opaque)
    }

    /// Bytes that the bricks and their table take.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        (self.0.texels.len() * size_of::<T>() + self.0.table.len() * 4) as u64
    }
}

impl<T> Stored<T> {
    /// The stored bricks, and the one of zeros.
    fn bricks(&self) -> &[[T; TEXELS]] {
        self.texels.as_chunks().0
    }
}

/// The arrays of some gel, a pointer nearer.
#[derive(Debug, Clone, Copy)]
pub struct TexelSlices<'a, T> {
    counts: [usize; 3],
    table: &'a [u32],
    bricks: &'a [[T; TEXELS]],
}

impl<'a, T: Texel> TexelSlices<'a, T> {
    /// Bricks on each axis.
    #[must_use]
    #[inline]
    pub fn counts(self) -> [usize; 3] {
        self.counts
    }

    /// The number of a brick among the stored ones, by its place in the table; `EMPTY` outside the table too.
    #[must_use]
    #[inline]
    pub fn stored(self, entry: u32) -> u32 {
        self.table.get(entry as usize).copied().unwrap_or(EMPTY)
    }

    /// For each brick of the grid, x fastest: its number among the stored ones, or `EMPTY`.
    #[must_use]
    #[inline]
    pub(crate) fn table(self) -> &'a [u32] {
        self.table
    }

    /// The texels of a stored brick, x fastest; zeros for `EMPTY`.
    #[must_use]
    #[inline]
    pub fn texels(self, brick: u32) -> &'a [T; TEXELS] {
        &self.bricks[(brick as usize).min(self.bricks.len() - 1)]
    }

    /// Tri-linear interpolation in a cell of stored brick `brick`, or of zeros for `EMPTY`: `cell` in 0..8, `at` in
    /// 0..1 within the cell.
    ///
    /// The result is associated RGBA per opacity unit; exactly zero where all eight texels are.
    #[must_use]
    #[inline]
    pub fn sample(self, brick: u32, cell: [usize; 3], at: Vec3) -> Vec4 {
        let texels = self.texels(brick);
        let first = ((cell[2] & 7) * ROW + (cell[1] & 7)) * ROW + (cell[0] & 7);
        let row = |offset: usize| {
            let pair = &texels[first + offset..first + offset + 2];
            let (low, high) = (pair[0].load(), pair[1].load());
            low + (high - low) * at.x
        };
        let (y0, y1) = (row(0), row(ROW));
        let z0 = y0 + (y1 - y0) * at.y;
        let (y0, y1) = (row(ROW * ROW), row(ROW * ROW + ROW));
        let z1 = y0 + (y1 - y0) * at.y;
        (z0 + (z1 - z0) * at.z) * T::SCALE
    }
}

/// The coloured, semi-transparent gel that rays meet: c_T · α_C and α_C (equation 4).
#[derive(Debug, Clone, PartialEq)]
pub struct Gel {
    /// Colour and opacity; the reflected part alone of the colour where `ambient` is apart.
    pub lit: GelBricks,
    /// The ambient part of the colour (and the opacity again), where a depth cue is stated.
    pub ambient: Option<GelBricks>,
    /// The opacities that it is made of, if they are kept: other light on the same makes no other cells interesting.
    pub opacity: Option<Bricks<f32>>,
}

impl Product for Gel {}

/// The gel, in the number type that the view's `sampling` states.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs, reason = "the variants are the types")]
pub enum GelBricks {
    F32(Texels<[f32; 4]>),
    U16(Texels<[u16; 4]>),
    U8(Texels<[u8; 4]>),
}

/// Runs an expression on the typed texels inside [`GelBricks`]: `with_texels!(gel, texels => expression)`.
#[macro_export]
macro_rules! with_texels {
    ($gel:expr, $texels:ident => $body:expr) => {
        match $gel {
            $crate::volume::gel::GelBricks::F32($texels) => $body,
            $crate::volume::gel::GelBricks::U16($texels) => $body,
            $crate::volume::gel::GelBricks::U8($texels) => $body,
        }
    };
}

impl GelBricks {
    /// [`Texels::make`] in the type of `kind`; in 32 bits where that is left open.
    pub fn make(
        kind: TexelKind,
        size: [usize; 3],
        holds: impl Fn([usize; 3]) -> bool + Sync,
        made_of: &impl Fill,
    ) -> Self {
        match kind {
            TexelKind::Auto | TexelKind::F32 => Self::F32(Texels::make(size, holds, made_of)),
            TexelKind::U16 => Self::U16(Texels::make(size, holds, made_of)),
            TexelKind::U8 => Self::U8(Texels::make(size, holds, made_of)),
        }
    }

    /// The numbers that it is kept in.
    #[must_use]
    pub fn kind(&self) -> TexelKind {
        match self {
            Self::F32(_) => TexelKind::F32,
            Self::U16(_) => TexelKind::U16,
            Self::U8(_) => TexelKind::U8,
        }
    }

    /// Bytes that the bricks and their table take.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        with_texels!(self, texels => texels.bytes())
    }
}

/// The most bytes of `stored` bricks of gel, and of the one of zeros.
#[must_use]
pub(crate) fn bytes_of(kind: TexelKind, stored: u64) -> u64 {
    let texel = match kind {
        TexelKind::Auto | TexelKind::F32 => 16,
        TexelKind::U16 => 8,
        TexelKind::U8 => 4,
    };
    (stored + 1) * TEXELS as u64 * texel
}

#[cfg(test)]
mod tests;
