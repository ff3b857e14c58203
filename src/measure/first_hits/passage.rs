//! A ray's passage through a volume, slab by slab: those before its grid and behind it, and those where its pyramid knows that
//! nothing is seen, are leapt over.

use glam::{DAffine3, DVec3};

use crate::volume::grid::Grid;
use crate::volume::pyramid::{BLOCK, Pyramid, PyramidSlices};

/// Nearer than this to where something may be seen nothing is leapt over, cells: far more than what is rounded.
const MARGIN: f64 = 1.0 / 64.0;

/// Where in a slab it is looked for what that shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sought {
    /// In the cell at its middle.
    AtMiddle,
    /// At both its ends too, whatever lies between them: a value that is no number parts what is seen from what is not.
    AtEnds,
    /// At both its ends too, of values that go steadily from one cell to the next: what is between two of them is in a cell
    /// between them.
    BetweenEnds,
}

/// Where a volume may show anything.
pub(super) struct Room {
    to_index: DAffine3,
    /// The first and the last voxel, between which alone anything is seen.
    pub ends: [DVec3; 2],
    pub pyramid: Option<Pyramid>,
    sought: Sought,
}

/// A ray in a volume.
pub(super) struct Passage<'a> {
    pyramid: Option<PyramidSlices<'a>>,
    /// How many blocks a slab's middle is away from what is seen, at the least, where the slab is known to be empty.
    apart: u8,
    /// How far it has to be from the ends of such blocks, cells.
    beside: DVec3,
    /// How far a slab reaches from its middle, cells, where all its cells are looked up; and the last voxel.
    looked_up: Option<(DVec3, DVec3)>,
    /// The index at the middle of slab 0, and from that of each to that of the next.
    first: DVec3,
    step: DVec3,
    /// The slabs that lie in the grid, to the one behind the last of them.
    within: [usize; 2],
    /// The slab that was found last.
    found: Option<usize>,
}

impl Room {
    /// That of a volume on a grid, of which a pyramid may tell where nothing is seen.
    pub fn new(grid: &Grid, pyramid: Option<Pyramid>, sought: Sought) -> Self {
        let last = DVec3::from(grid.size.map(|n| n as f64 - 1.0));
        Self { to_index: grid.world_to_index(), ends: [DVec3::ZERO, last], pyramid, sought }
    }

    /// The passage of a ray by the world point in the middle of its slab 0, and its way through a slab.
    pub fn passage(&self, (middle, way): (DVec3, DVec3)) -> Passage<'_> {
        let (first, step) = (self.to_index.transform_point3(middle), self.to_index.matrix3 * way);
        let half = step.abs() / 2.0;
        let (apart, beside, is_known) = match self.sought {
            Sought::AtMiddle => (1, DVec3::ZERO, true),
            // Of slabs that reach farther than a block everything is looked at.
            Sought::AtEnds => (2, DVec3::ZERO, half.max_element() < BLOCK as f64),
            Sought::BetweenEnds => (1, half, true),
        };
        // Cells of a longer slab would be many.
        let is_short = self.sought == Sought::BetweenEnds && half.max_element() <= 1.0;
        Passage {
            pyramid: self.pyramid.as_ref().map(Pyramid::slices).filter(|_| is_known),
            apart,
            beside: beside + MARGIN,
            looked_up: is_short.then_some((half + MARGIN, self.ends[1])),
            first,
            step,
            within: within((first, step), [self.ends[0] - half, self.ends[1] + half]),
            found: None,
        }
    }
}

impl Passage<'_> {
    /// The first slab, from a slab on, in which anything may be seen; behind all where there is none. The slabs that are asked
    /// from do not go back.
    pub fn next(&mut self, slab: usize) -> usize {
        match self.found {
            Some(found) if found >= slab => found,
            _ => *self.found.insert(self.sought(slab)),
        }
    }

    fn sought(&self, slab: usize) -> usize {
        let mut slab = slab.max(self.within[0]);
        while slab < self.within[1] {
            let empty = self.empty(slab);
            if empty == 0 {
                return slab;
            }
            slab = slab.saturating_add(empty);
        }
        usize::MAX
    }

    /// How many slabs from one on are known to be empty.
    fn empty(&self, slab: usize) -> usize {
        let Some(pyramid) = self.pyramid else { return 0 };
        let at = self.first + self.step * slab as f64;
        let block = (at / BLOCK as f64).floor();
        let away = pyramid.distance((block * BLOCK as f64).as_i64vec3().to_array());
        let leapt = away.checked_sub(self.apart).map_or(0, |room| self.leap((at, block), room));
        let is_clear = || {
            self.looked_up.is_some_and(|(half, last)| {
                let cells = |at: DVec3| at.clamp(DVec3::ZERO, last).to_array().map(|n| n as usize);
                let (low, high) = (cells(at - half), cells(at + half));
                !pyramid.shows_any(std::array::from_fn(|axis| [low[axis], high[axis]]))
            })
        };
        if leapt == 0 { usize::from(is_clear()) } else { leapt }
    }

    /// How many slabs, from one by the index of its middle on, have theirs in its own block and `room` blocks around it.
    fn leap(&self, (at, block): (DVec3, DVec3), room: u8) -> usize {
        let (side, room) = (BLOCK as f64, f64::from(room));
        let low = (block - room) * side + self.beside;
        let high = (block + room + 1.0) * side - self.beside;
        if !(at.cmpge(low) & at.cmple(high)).all() {
            return 0;
        }
        let left = DVec3::select(self.step.cmplt(DVec3::ZERO), at - low, high - at);
        ((left / self.step.abs()).min_element() as usize).saturating_add(1)
    }
}

/// The slabs whose middles lie between two indices, a little more than those: the first of them, and the one behind the last.
fn within((first, step): (DVec3, DVec3), [low, high]: [DVec3; 2]) -> [usize; 2] {
    let (mut begin, mut end) = (0.0, f64::INFINITY);
    for axis in 0..3 {
        let [low, high] = [low[axis] - MARGIN - first[axis], high[axis] + MARGIN - first[axis]];
        if step[axis] == 0.0 {
            if low > 0.0 || high < 0.0 {
                return [0; 2];
            }
            continue;
        }
        let [one, other] = [low / step[axis], high / step[axis]];
        (begin, end) = (one.min(other).max(begin), one.max(other).min(end));
    }
    if end < begin { [0; 2] } else { [begin as usize, (end as usize).saturating_add(1)] }
}
