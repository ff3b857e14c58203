//! The bricks that the rays of a tile meet, the nearest first.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::Simd;

use super::brick::Brick;
use super::cells::{sampled, turned, within};
use super::occupied::Occupied;
use super::shear::{Shear, Slice};
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

/// The first ray of a tile, U and V, and rays across and down.
type Place = ([i64; 2], [usize; 2]);

/// The slices within one layer of bricks, and how far rays move along u and v among them.
struct Layer {
    number: i64,
    slices: std::ops::Range<usize>,
    least: [i64; 2],
    most: [i64; 2],
}

impl<T: Texel> Beam<'_, T> {
    /// Takes the rays of tiles, a phase each, through the volume.
    #[inline(always)]
    pub fn pass<S: Simd>(&self, simd: S, tiles: &mut [Tile], place: Place, counts: &mut Counts) {
        let Some(slices) = self.shear.phases.first() else { return };
        let mut first = 0;
        while first < slices.len() {
            let layer = self.layer(slices, first);
            first = layer.slices.end;
            self.pass_layer(simd, tiles, place, &layer, counts);
        }
    }

    /// The layer of bricks that slice `first` is the first in.
    fn layer(&self, slices: &[Slice], first: usize) -> Layer {
        let number = slices[first].cell / CELLS as i64;
        let more = slices[first..].iter().take_while(|slice| slice.cell / CELLS as i64 == number);
        let end = first + more.count();
        let ends = [slices[first].shift, slices[end - 1].shift];
        let least = [0, 1].map(|axis| ends[0][axis].min(ends[1][axis]));
        // Rays of other phases may be one cell further.
        let other = self.shear.parts.map(|parts| i64::from(parts > 1));
        let most = [0, 1].map(|axis| ends[0][axis].max(ends[1][axis]) + other[axis]);
        Layer { number, slices: first..end, least, most }
    }

    /// Through one layer: along each of its axes the bricks that rays come to first go before those that they leave to.
    #[inline(always)]
    fn pass_layer<S: Simd>(
        &self,
        simd: S,
        tiles: &mut [Tile],
        (first, size): Place,
        layer: &Layer,
        counts: &mut Counts,
    ) {
        let Shear { axes, ahead, apart, .. } = self.shear;
        let (edge, apart) = (CELLS as i64, [1, *apart as i64]);
        let counted = self.texels.counts();
        let bricks = axes.map(|axis| counted[axis] as i64);
        let low = [0, 1].map(|axis| (first[axis] + layer.least[axis]).div_euclid(edge).max(0));
        let high = [0, 1].map(|axis| {
            let last = first[axis] + apart[axis] * (size[axis] as i64 - 1) + layer.most[axis];
            last.div_euclid(edge).min(bricks[axis] - 1)
        });
        // The rays of a tile that a brick may be met by, along one axis.
        let reached = |axis: usize, brick: i64| {
            let from = edge * brick - first[axis];
            let [from, to] = [from - layer.most[axis], from + edge - layer.least[axis]];
            let to = to.max(0) as usize;
            [from.max(0) as usize / apart[axis] as usize, to.div_ceil(apart[axis] as usize)]
                .map(|at| at.min(size[axis]))
        };
        if low[0] > high[0] {
            return;
        }
        let along = [low[0], high[0]].map(|u| u as usize);
        for v in 0..=high[1] - low[1] {
            let v = if ahead[1] { low[1] + v } else { high[1] - v };
            let rows = reached(1, v);
            let mut bricks = self.occupied.among(along, [v, layer.number].map(|at| at as usize));
            if rows[0] >= rows[1] || bricks == 0 {
                continue;
            }
            let open = tiles.iter().fold(0, |any, tile| any | tile.open_in(rows));
            while bricks != 0 {
                let behind = if ahead[0] { bricks.trailing_zeros() } else { bricks.ilog2() };
                bricks &= !(1 << behind);
                let u = low[0] + i64::from(behind);
                let columns = reached(0, u);
                if columns[0] < columns[1] && open & Tile::columns(columns) != 0 {
                    self.pass_brick(simd, tiles, (first, rows, columns), ([u, v], layer), counts);
                }
            }
        }
    }

    /// Through one brick, where it has anything.
    #[inline(always)]
    fn pass_brick<S: Simd>(
        &self,
        simd: S,
        tiles: &mut [Tile],
        (first, rows, columns): ([i64; 2], [usize; 2], [usize; 2]),
        ([u, v], layer): ([i64; 2], &Layer),
        counts: &mut Counts,
    ) {
        let Shear { axes, size, phases, .. } = self.shear;
        let mut at = [0; 3];
        (at[axes[0]], at[axes[1]], at[axes[2]]) = (u as usize, v as usize, layer.number as usize);
        let stored = self.texels.stored_at(at);
        let Some(words) = sampled(self.pyramid, stored) else { return };
        let inside =
            [(0, u), (1, v)].map(|(axis, at)| (size[axis] - 1).saturating_sub(CELLS * at as usize));
        let inside = within(inside);
        let columns = Tile::columns(columns);
        let mut cells = None;
        for (tile, slices) in tiles.iter_mut().zip(phases) {
            if tile.open_in(rows) & columns == 0 {
                continue;
            }
            let cells = cells.get_or_insert_with(|| {
                match axes[2] {
                    2 => turned::<2>(words),
                    1 => turned::<1>(words),
                    _ => turned::<0>(words),
                }
                .map(|word| word & inside)
            });
            tile.meet();
            let brick = Brick {
                texels: self.texels.texels(stored),
                cells,
                first: [CELLS as i64 * u - first[0], CELLS as i64 * v - first[1]],
                apart: self.shear.apart,
                is_last: inside != u64::MAX,
                scale: self.texels.scale(),
                stop: self.stop,
                ratio: self.ratio,
            };
            let slices = &slices[layer.slices.clone()];
            match axes[2] {
                2 => brick.pass::<S, 2>(simd, slices, tile, counts),
                1 => brick.pass::<S, 1>(simd, slices, tile, counts),
                _ => brick.pass::<S, 0>(simd, slices, tile, counts),
            }
        }
    }
}
