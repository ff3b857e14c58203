//! What gel is kept in: bricks of associated RGBA with an apron.
//!
//! A brick holds 8³ *cells* (the cube between eight neighbouring voxels) and for them 9³ texels: the ninth of each row
//! repeats the next brick's first, so that a sample touches one brick. Texels beyond the last voxel are zero, so that a
//! sample on the last plane of voxels needs no clamp. A brick without an interesting voxel takes no memory.

mod apron;

use std::sync::Arc;

use fearless_simd::{Level, Simd, dispatch};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::volume::cells::marked_cells;
use crate::volume::texel::{CELLS, EMPTY, ROW, TEXELS, Texel};

/// The gel in one number type. Shared by pointer, equality is identity.
#[derive(Debug)]
pub struct Texels<T>(Arc<Stored<T>>);

#[derive(Debug)]
struct Stored<T> {
    counts: [usize; 3],
    table: Vec<u32>,
    /// What the stored channels are multiplied by.
    scale: Vec4,
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
    /// Fills the texels of the 8³ voxels of a brick, which come clear, with associated RGBA; those outside the grid stay clear.
    /// `place` is the size of the grid in voxels, and which brick of it that is. Colors are kept in parts of `full`.
    fn fill<S: Simd, T: Texel>(
        &self,
        simd: S,
        place: ([usize; 3], [usize; 3]),
        full: f32,
        texels: &mut [T; TEXELS],
    );

    /// What no channel of a color is above, at least 1: whole numbers are parts of it.
    fn brightest(&self) -> f32 {
        1.0
    }
}

/// Row by row: of 8 voxels from voxel `first` on along x, which come clear; no color of theirs is above 1. It is asked for
/// voxels inside the grid alone; the row is as short as the grid ends.
impl<F: Fn([usize; 3], &mut [Vec4]) + Sync> Fill for F {
    fn fill<S: Simd, T: Texel>(
        &self,
        simd: S,
        (size, brick): ([usize; 3], [usize; 3]),
        _: f32,
        texels: &mut [T; TEXELS],
    ) {
        let first = brick.map(|b| b * CELLS);
        let extent: [usize; 3] = std::array::from_fn(|axis| CELLS.min(size[axis] - first[axis]));
        let mut row = [Vec4::ZERO; CELLS];
        for (z, y) in (0..extent[2]).flat_map(|z| (0..extent[1]).map(move |y| (z, y))) {
            row.fill(Vec4::ZERO);
            self([first[0], first[1] + y, first[2] + z], &mut row[..extent[0]]);
            let made = &mut texels[(z * ROW + y) * ROW..][..extent[0]];
            let mut channels = [[0.0; CELLS]; 4];
            for (x, voxel) in row.iter().enumerate() {
                for (channel, value) in channels.iter_mut().zip(voxel.to_array()) {
                    channel[x] = value;
                }
            }
            made.copy_from_slice(&T::store_row(simd, &channels)[..made.len()]);
        }
    }
}

impl<T: Texel> Texels<T> {
    /// Makes the gel of a grid of `size` voxels.
    ///
    /// `holds(brick)` says whether a brick is stored: whether one of the 9³ voxels from its first on is interesting. What one
    /// that is not has is clear for those around it too.
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
        let full = if T::SCALE < 1.0 { made_of.brightest() } else { 1.0 };
        apron::fill(counts, &table, &stored, texels.as_chunks_mut().0, |texels, brick| {
            dispatch!(level, simd => made_of.fill(simd, (size, brick), full, texels));
        });
        let scale = Vec3::splat(T::SCALE * full).extend(T::SCALE);
        Self(Arc::new(Stored { counts, table, scale, texels }))
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
        let Stored { counts, table, scale, .. } = &*self.0;
        TexelSlices { counts: *counts, table, scale: *scale, bricks: self.0.bricks() }
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
    scale: Vec4,
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

    /// The number of a brick of the grid among the stored ones, or `EMPTY`.
    #[must_use]
    #[inline]
    pub(crate) fn stored_at(self, [x, y, z]: [usize; 3]) -> u32 {
        self.stored(((z * self.counts[1] + y) * self.counts[0] + x) as u32)
    }

    /// What the channels of texels are multiplied by.
    #[must_use]
    #[inline]
    pub(crate) fn scale(self) -> Vec4 {
        self.scale
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
        (z0 + (z1 - z0) * at.z) * self.scale
    }
}

#[cfg(test)]
mod tests;
