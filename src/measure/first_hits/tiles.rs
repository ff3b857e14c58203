//! Which faces a pixel may meet: put to the tiles of pixels that they are drawn in, so that it asks those near it alone.

/// Pixels along the side of a tile.
const TILE: usize = 8;
/// What is drawn in more tiles is not put to each of them, but looked at by all: so lists are as long as faces are many.
const WIDE: usize = 64;

/// A rectangle of pixels, of which it has one at the least.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pixels {
    first: [u32; 2],
    last: [u32; 2],
}

impl Pixels {
    /// The pixels of a picture of some size whose middles lie between two window positions, across and down; `None` where
    /// there are none.
    pub fn between(ends: [[f64; 2]; 2], size: [usize; 2]) -> Option<Self> {
        let (mut first, mut last) = ([0; 2], [0; 2]);
        for axis in 0..2 {
            let [low, high] = [(ends[axis][0] - 0.5).ceil(), (ends[axis][1] - 0.5).floor()];
            let (low, high) = (low.max(0.0), high.min(size[axis] as f64 - 1.0));
            if low > high {
                return None;
            }
            (first[axis], last[axis]) = (low as u32, high as u32);
        }
        Some(Self { first, last })
    }

    /// Whether a pixel is one of them.
    pub fn hold(self, pixel: [usize; 2]) -> bool {
        (0..2).all(|a| self.first[a] as usize <= pixel[a] && pixel[a] <= self.last[a] as usize)
    }

    /// The first and the last tile that they lie in, across and down.
    fn tiles(self) -> [[usize; 2]; 2] {
        [self.first, self.last].map(|end| end.map(|n| n as usize / TILE))
    }

    /// Whether they lie in more tiles than are listed one by one.
    fn are_wide(self) -> bool {
        let [first, last] = self.tiles();
        (last[0] - first[0] + 1) * (last[1] - first[1] + 1) > WIDE
    }

    /// Whether some lie in the tile at a place among tiles.
    fn reach(self, tile: [usize; 2]) -> bool {
        let [first, last] = self.tiles();
        (0..2).all(|a| first[a] <= tile[a] && tile[a] <= last[a])
    }
}

/// The tiles of a picture, and which faces are drawn in each.
pub(super) struct Tiles {
    /// Of the picture, pixels.
    size: [usize; 2],
    /// Tiles across and down.
    counts: [usize; 2],
    drawn: Vec<Pixels>,
    /// Where in `listed` each tile's begin, and where the last one's end.
    begins: Vec<usize>,
    /// Faces of a tile, by their place among all, then those of the next.
    listed: Vec<u32>,
    /// Faces that are drawn in many tiles.
    wide: Vec<u32>,
}

impl Tiles {
    /// Of a picture of some size, and faces by the pixels that each is `drawn` in.
    pub fn new(size: [usize; 2], drawn: Vec<Pixels>) -> Self {
        let counts = size.map(|n| n.div_ceil(TILE));
        let all = || (0..).zip(&drawn);
        let narrow = || {
            let places = |(at, pixels): (u32, &Pixels)| {
                let [first, last] = pixels.tiles();
                let rows = (first[1]..=last[1]).map(move |y| y * counts[0]);
                rows.flat_map(move |row| (first[0]..=last[0]).map(move |x| (row + x, at)))
            };
            all().filter(|(_, pixels)| !pixels.are_wide()).flat_map(places)
        };
        let wide = all().filter(|(_, pixels)| pixels.are_wide()).map(|(at, _)| at).collect();
        // Counted first, and then each put to its place.
        let mut begins = vec![0; counts[0] * counts[1] + 1];
        narrow().for_each(|(tile, _)| begins[tile + 1] += 1);
        for tile in 1..begins.len() {
            begins[tile] += begins[tile - 1];
        }
        let mut listed = vec![0; begins.last().copied().unwrap_or(0)];
        let mut next = begins.clone();
        for (tile, at) in narrow() {
            listed[next[tile]] = at;
            next[tile] += 1;
        }
        Self { size, counts, drawn, begins, listed, wide }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.counts[0] * self.counts[1]
    }

    /// The faces that are drawn in a tile, by their place among all and in that order, with the pixels that each is drawn in.
    pub fn near(&self, tile: usize) -> Vec<(usize, Pixels)> {
        let own = &self.listed[self.begins[tile]..self.begins[tile + 1]];
        let place = [tile % self.counts[0], tile / self.counts[0]];
        let of = |at: &u32| (*at as usize, self.drawn[*at as usize]);
        let wide = self.wide.iter().map(of).filter(|(_, pixels)| pixels.reach(place));
        let mut near: Vec<_> = own.iter().map(of).chain(wide).collect();
        near.sort_unstable_by_key(|(at, _)| *at);
        near
    }

    /// The pixels of a tile, row by row.
    pub fn pixels(&self, tile: usize) -> impl Iterator<Item = [usize; 2]> {
        let [[left, right], [top, bottom]] = self.sides(tile);
        (top..bottom).flat_map(move |y| (left..right).map(move |x| [x, y]))
    }

    /// The tile of a pixel, and the place that it has among its pixels.
    pub fn place(&self, [x, y]: [usize; 2]) -> (usize, usize) {
        let tile = y / TILE * self.counts[0] + x / TILE;
        let [[left, right], [top, _]] = self.sides(tile);
        (tile, (y - top) * (right - left) + x - left)
    }

    /// Where a tile begins and ends, across and down.
    fn sides(&self, tile: usize) -> [[usize; 2]; 2] {
        let place = [tile % self.counts[0], tile / self.counts[0]];
        [0, 1].map(|axis| {
            let begin = place[axis] * TILE;
            [begin, (begin + TILE).min(self.size[axis])]
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn every_pixel_finds_the_faces_that_hold_it_among_those_of_its_tile(
            size in [1_usize..200, 1_usize..90],
            ends in prop::collection::vec([[-50.0..250.0_f64, -50.0..250.0], [-20.0..120.0, -20.0..120.0]], 0..60),
            whole in any::<bool>(),
        ) {
            let everywhere = [[f64::NEG_INFINITY, f64::INFINITY]; 2];
            let ends = ends.into_iter().map(|ends| ends.map(|[a, b]| [a.min(b), a.max(b)]));
            let ends = ends.chain(whole.then_some(everywhere)).collect::<Vec<_>>();
            let drawn: Vec<_> = ends.iter().filter_map(|ends| Some((*ends, Pixels::between(*ends, size)?))).collect();
            let tiles = Tiles::new(size, drawn.iter().map(|(_, pixels)| *pixels).collect());
            let mut met = 0;
            for tile in 0..tiles.count() {
                let near = tiles.near(tile);
                for (within, pixel) in tiles.pixels(tile).enumerate() {
                    prop_assert_eq!(tiles.place(pixel), (tile, within));
                    let middle = pixel.map(|n| n as f64 + 0.5);
                    let holds = |ends: &[[f64; 2]; 2]| (0..2).all(|a| ends[a][0] <= middle[a] && middle[a] <= ends[a][1]);
                    let expected: Vec<usize> =
                        drawn.iter().enumerate().filter(|(_, (ends, _))| holds(ends)).map(|(at, _)| at).collect();
                    let found: Vec<usize> =
                        near.iter().filter(|(_, pixels)| pixels.hold(pixel)).map(|(at, _)| *at).collect();
                    prop_assert_eq!(found, expected);
                    met += 1;
                }
            }
            prop_assert_eq!(met, size[0] * size[1]);
        }
    }
}
