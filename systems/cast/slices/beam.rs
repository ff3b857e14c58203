//! The bricks that the rays of a tile meet, the nearest first.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::Simd;

use super::ahead::Ahead;
use super::brick::Brick;
use super::cells::{sampled, turned, within};
use super::occupied::Occupied;
use super::order::{Layer, Next, Order, Place};
use super::shear::Shear;
use super::tile::Tile;
use crate::view::samples::Counts;
use crate::volume::gel::{CELLS, Texel, TexelSlices};
use crate::volume::pyramid::PyramidSlices;

/// What the rays of a tile go through.
pub(super) struct Beam<'a, T> {
    pub shear: &'a Shear,
    pub texels: TexelSlices<'a, T>,
    /// Which bricks have anything.
    pub occupied: &'a Occupied,
    /// Which cells are interesting; `None`: all that are stored.
    pub pyramid: Option<PyramidSlices<'a>>,
    /// A ray stops when no more than this comes through of what is behind.
    pub stop: f32,
    /// How thick slabs are against the opacity unit.
    pub ratio: f64,
}

impl<T: Texel> Beam<'_, T> {
    /// Takes the rays of tiles, a phase each, through the volume.
    #[inline(always)]
    pub fn pass<S: Simd>(&self, simd: S, tiles: &mut [Tile], place: Place, counts: &mut Counts) {
        let Some(slices) = self.shear.phases.first() else { return };
        let mut first = 0;
        while first < slices.len() {
            let layer = Layer::of(self.shear, slices, first);
            first = layer.slices.end;
            self.pass_layer(simd, tiles, place, &layer, counts);
        }
    }

    /// Through one layer, a brick behind what is asked of memory.
    #[inline(always)]
    fn pass_layer<S: Simd>(
        &self,
        simd: S,
        tiles: &mut [Tile],
        place: Place,
        layer: &Layer,
        counts: &mut Counts,
    ) {
        let counted = self.texels.counts();
        let [u, v, _] = self.shear.axes.map(|axis| counted[axis]);
        let mut order = Order::new((self.shear, self.occupied), [u, v], place, layer);
        let mut brick = None;
        loop {
            let next = order.next(tiles).map(|next| self.ahead(next, layer.number));
            let is_last = next.is_none();
            if let Some(next) = &next {
                next.fetch();
            }
            if let Some(brick) = std::mem::replace(&mut brick, next) {
                self.pass_brick(simd, tiles, place.0, (brick, layer), counts);
            }
            if is_last {
                return;
            }
        }
    }

    /// What is needed of the next brick.
    #[inline(always)]
    fn ahead(&self, next: Next, layer: i64) -> Ahead<'_, T> {
        let at = [next.at[0], next.at[1], layer].map(|at| at as usize);
        let stored = self.texels.stored_at(self.shear.xyz(at));
        let words = sampled(self.pyramid, stored);
        Ahead { next, words, texels: self.texels.texels(stored) }
    }

    /// Through one brick, where it has anything.
    #[inline(always)]
    fn pass_brick<S: Simd>(
        &self,
        simd: S,
        tiles: &mut [Tile],
        first: [i64; 2],
        (brick, layer): (Ahead<'_, T>, &Layer),
        counts: &mut Counts,
    ) {
        let Shear { axes, size, phases, .. } = self.shear;
        let Ahead { next: Next { at: [u, v], rows, columns }, words, texels } = brick;
        let Some(words) = words else { return };
        if tiles.iter().all(|tile| tile.open_in(rows) & columns == 0) {
            return;
        }
        let inside =
            [(0, u), (1, v)].map(|(axis, at)| (size[axis] - 1).saturating_sub(CELLS * at as usize));
        let inside = within(inside);
        let brick = Brick {
            texels,
            cells: match axes[2] {
                2 => turned::<2>(words),
                1 => turned::<1>(words),
                _ => turned::<0>(words),
            }
            .map(|word| word & inside),
            first: [CELLS as i64 * u - first[0], CELLS as i64 * v - first[1]],
            apart: self.shear.apart,
            is_parted: inside != u64::MAX || (self.shear.apart > 1 && phases.len() > 1),
            scale: self.texels.scale(),
            stop: self.stop,
            ratio: self.ratio,
        };
        let slices = (&phases[..], &layer.slices);
        match axes[2] {
            2 => brick.pass::<S, 2>(simd, tiles, slices, counts),
            1 => brick.pass::<S, 1>(simd, tiles, slices, counts),
            _ => brick.pass::<S, 0>(simd, tiles, slices, counts),
        }
    }
}
