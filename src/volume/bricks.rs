//! Sparse bricks for everything made per voxel: 8 × 8 × 8 voxels each, stored only where something is.

use std::sync::Arc;

use rayon::prelude::*;

/// Voxels (or cells) along one edge of a brick.
pub const EDGE: usize = 8;
/// Voxels in a brick.
pub const VOXELS: usize = EDGE * EDGE * EDGE;
/// The table's entry for a brick that is not stored.
const EMPTY: u32 = u32::MAX;

/// One value a voxel, in bricks of 8³; a brick in which nothing is takes no memory. Shared by pointer, equality is identity.
#[derive(Debug)]
pub struct Bricks<T>(Arc<Stored<T>>);

#[derive(Debug)]
struct Stored<T> {
    size: [usize; 3],
    counts: [usize; 3],
    /// For each brick, x fastest: its place within its layer, or `EMPTY`.
    table: Vec<u32>,
    /// The stored bricks of each layer of bricks in z, one after the other; a voxel of a brick is at (z · 8 + y) · 8 + x.
    layers: Vec<Vec<T>>,
}

impl<T> Clone for Bricks<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> PartialEq for Bricks<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// The first voxel and the extent of a brick: what lies outside the grid is left out of `extent`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BrickPlace {
    /// The brick, counted in bricks.
    pub brick: [usize; 3],
    /// Its first voxel.
    pub first: [usize; 3],
    /// Voxels of it that the grid has on each axis, 1..=8.
    pub extent: [usize; 3],
}

impl BrickPlace {
    /// A brick of a grid of `size` voxels.
    #[must_use]
    pub fn new(brick: [usize; 3], size: [usize; 3]) -> Self {
        let first = brick.map(|b| b * EDGE);
        let extent = std::array::from_fn(|axis| EDGE.min(size[axis] - first[axis]));
        Self { brick, first, extent }
    }

    /// Every voxel of the brick that the grid has: its place in the brick and its index in the grid; x fastest.
    pub fn voxels(self) -> impl Iterator<Item = (usize, [usize; 3])> {
        let [fx, fy, fz] = self.first;
        let [ex, ey, ez] = self.extent;
        (0..ez).flat_map(move |z| {
            (0..ey).flat_map(move |y| {
                (0..ex).map(move |x| ((z * EDGE + y) * EDGE + x, [fx + x, fy + y, fz + z]))
            })
        })
    }
}

impl<T: Copy + Default + Send + Sync> Bricks<T> {
    /// Makes the bricks of a grid of `size` voxels, layers of them side by side.
    ///
    /// `make` fills one brick, which comes zeroed (`T::default()`), and says whether it is to be stored.
    pub fn make(
        size: [usize; 3],
        make: impl Fn(BrickPlace, &mut [T; VOXELS]) -> bool + Send + Sync,
    ) -> Self {
        Self::make_where(size, |_| true, make)
    }

    /// [`Bricks::make`], of which the bricks that `may_hold` denies are neither made nor stored.
    pub(crate) fn make_where(
        size: [usize; 3],
        may_hold: impl Fn(BrickPlace) -> bool + Send + Sync,
        make: impl Fn(BrickPlace, &mut [T; VOXELS]) -> bool + Send + Sync,
    ) -> Self {
        let counts = size.map(|n| n.div_ceil(EDGE));
        let per_layer = counts[0] * counts[1];
        let mut table = vec![EMPTY; per_layer * counts[2]];
        let layer = |(z, table): (usize, &mut [u32])| {
            let place = |at| BrickPlace::new([at % counts[0], at / counts[0], z], size);
            let asked: Vec<_> = (0..table.len()).filter(|&at| may_hold(place(at))).collect();
            // Made where they stay, among zeros that come from the system for nothing.
            let (mut voxels, mut stored) = (vec![T::default(); asked.len() * VOXELS], 0);
            for at in asked {
                let made = &mut voxels.as_chunks_mut::<VOXELS>().0[stored];
                if make(place(at), made) {
                    table[at] = stored as u32;
                    stored += 1;
                } else {
                    made.fill(T::default());
                }
            }
            voxels.truncate(stored * VOXELS);
            voxels.shrink_to_fit();
            voxels
        };
        let layers = table.par_chunks_mut(per_layer).enumerate().map(layer).collect();
        Self(Arc::new(Stored { size, counts, table, layers }))
    }

    /// Values made voxel by voxel in the bricks that `self` stores, and in no other.
    pub fn map<U: Copy + Default + Send + Sync>(
        &self,
        make: impl Fn(BrickPlace, &[T; VOXELS], &mut [U; VOXELS]) + Send + Sync,
    ) -> Bricks<U> {
        let is_stored = |place: BrickPlace| self.brick(place.brick).is_some();
        Bricks::make_where(self.size(), is_stored, |place, made| {
            self.brick(place.brick).is_some_and(|brick| {
                make(place, brick, made);
                true
            })
        })
    }

    /// The value of a voxel; `T::default()` where nothing is stored. Panics outside the grid.
    #[must_use]
    pub fn value(&self, [x, y, z]: [usize; 3]) -> T {
        let within = ((z % EDGE) * EDGE + y % EDGE) * EDGE + x % EDGE;
        self.brick([x / EDGE, y / EDGE, z / EDGE]).map_or_else(T::default, |brick| brick[within])
    }
}

impl<T> Bricks<T> {
    /// The grid's number of voxels on each axis.
    #[must_use]
    pub fn size(&self) -> [usize; 3] {
        self.0.size
    }

    /// Bricks on each axis.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        self.0.counts
    }

    /// The voxels of a brick, or `None` where nothing is stored. Panics outside the grid.
    #[must_use]
    pub fn brick(&self, [x, y, z]: [usize; 3]) -> Option<&[T; VOXELS]> {
        let stored = &*self.0;
        let entry = stored.table[(z * stored.counts[1] + y) * stored.counts[0] + x];
        (entry != EMPTY).then(|| &stored.layers[z].as_chunks().0[entry as usize])
    }

    /// Every stored brick, in the order of the table.
    pub fn stored(&self) -> impl Iterator<Item = (BrickPlace, &[T; VOXELS])> {
        let [nx, ny, _] = self.0.counts;
        (0..self.0.table.len()).filter_map(move |at| {
            let brick = [at % nx, at / nx % ny, at / (nx * ny)];
            self.brick(brick).map(|values| (BrickPlace::new(brick, self.0.size), values))
        })
    }

    /// Bytes that the bricks and their table take.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let voxels: usize = self.0.layers.iter().map(Vec::len).sum();
        (voxels * size_of::<T>() + self.0.table.len() * 4) as u64
    }
}

/// Bricks on each axis of a grid of `size` voxels.
#[must_use]
pub fn counts(size: [usize; 3]) -> [usize; 3] {
    size.map(|n| n.div_ceil(EDGE))
}

/// The most bytes that bricks of `T` can take on a grid of `size` voxels, for a plan.
#[must_use]
pub fn most_bytes<T>(size: [usize; 3]) -> u64 {
    let bricks: u64 = size.iter().map(|n| n.div_ceil(EDGE) as u64).product();
    bricks * (VOXELS * size_of::<T>() + 4) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_stored_is_read_back_and_the_rest_is_default() {
        let size = [19, 9, 11];
        let number = |[x, y, z]: [usize; 3]| (x + 100 * y + 10_000 * z) as u32;
        let bricks = Bricks::make(size, |place, brick| {
            place.voxels().for_each(|(at, voxel)| brick[at] = number(voxel));
            place.brick[0] != 1
        });
        for (_, voxel) in (BrickPlace { brick: [0; 3], first: [0; 3], extent: size }).voxels() {
            let expected = if voxel[0] / EDGE == 1 { 0 } else { number(voxel) };
            assert_eq!(bricks.value(voxel), expected, "{voxel:?}");
        }
        assert_eq!(bricks.stored().count(), 8);
        assert!(bricks.bytes() <= most_bytes::<u32>(size));
    }

    #[test]
    fn an_empty_volume_takes_its_table_only() {
        let bricks = Bricks::<[f32; 3]>::make([64; 3], |_, _| false);
        assert_eq!(bricks.bytes(), 512 * 4);
    }
}
