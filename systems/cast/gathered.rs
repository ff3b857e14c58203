//! The rays of a band, put together to packets: tiles of neighbours where most are wanted, and where few are, those of several
//! tiles. What a ray sees does not depend on which others it goes with.

use super::band::{self, Band};
use super::lanes::{LANES, Lanes, Packet, SIDE, TilePlaces, each};
use super::targets::{Caster, RayColors};
use crate::view::samples::{Layout, POSITIONS};

/// Packets next to one another in a band: what is empty for all of them is found once.
#[derive(Clone, Copy)]
struct Group {
    /// Positions along its side.
    side: usize,
    /// Positions between the rays of a packet that is as large.
    apart: usize,
}

impl Group {
    /// That of packets of rays `step` positions apart; `None` where a band is not as high, or as far from square.
    fn of(step: usize) -> Option<Self> {
        let side = band::LEAST;
        let reach = side - step;
        (step <= 2 * POSITIONS).then(|| Self { side, apart: reach.div_ceil(SIDE - 1) })
    }
}

/// Casts the wanted rays of a band, packet by packet: those of a tile of which most are wanted as they are, others together
/// with others near them.
pub fn cast_band<C: Caster>(
    band: &mut Band<'_>,
    layout: &Layout,
    step: usize,
    wanted: &impl Fn(usize, usize) -> Lanes,
    caster: &C,
) {
    let mut casting = Casting {
        layout,
        step,
        caster,
        group: Group::of(step),
        scratch: C::Scratch::default(),
        rays: [RayColors::default(); LANES],
        sparse: Sparse::default(),
    };
    let mut begun = usize::MAX;
    band.packets(layout, step, wanted, |band, [i, j], wanted| {
        if i / band::LEAST != begun {
            casting.gathered(band);
            begun = i / band::LEAST;
            casting.scout(band, begun);
        }
        let at = |lane: usize| [i + lane % SIDE * step, j + lane / SIDE * step];
        if wanted.count_ones() >= DENSE {
            casting.cast(band, TilePlaces::lattice(casting.place([i, j]), step), at, wanted);
            return;
        }
        for lane in each(wanted) {
            casting.sparse.add(at(lane));
            if casting.sparse.count == LANES {
                casting.gathered(band);
            }
        }
    });
    casting.gathered(band);
}

/// A tile of which so many rays are wanted is cast by itself: its rays are nearer to each other.
const DENSE: u32 = 12;

/// Rays of several tiles, that are to be cast together.
#[derive(Default)]
struct Sparse {
    /// Their positions in the sample array.
    at: [[usize; 2]; LANES],
    count: usize,
}

impl Sparse {
    fn add(&mut self, at: [usize; 2]) {
        self.at[self.count] = at;
        self.count += 1;
    }
}

/// What casts the rays of one band.
struct Casting<'a, C: Caster> {
    layout: &'a Layout,
    step: usize,
    caster: &'a C,
    group: Option<Group>,
    scratch: C::Scratch,
    rays: [RayColors; LANES],
    sparse: Sparse,
}

impl<C: Caster> Casting<'_, C> {
    /// A position of the sample array, counted from the middle of pixel (0, 0).
    fn place(&self, at: [usize; 2]) -> [i64; 2] {
        at.map(|n| n as i64 - self.layout.margin as i64)
    }

    /// Looks ahead for a group of a band, by its number from the left.
    fn scout(&mut self, band: &mut Band<'_>, number: usize) {
        if let Some(Group { side, apart }) = self.group {
            let first = self.place([number * side, 0]);
            let scout = Packet::new([first[0], self.place([0, band.top()])[1]], apart, Lanes::MAX);
            self.caster.scout(&scout, &mut self.scratch, &mut band.counts);
        }
    }

    /// Casts the rays that are gathered, of which there may be none.
    fn gathered(&mut self, band: &mut Band<'_>) {
        let Sparse { at, count } = std::mem::take(&mut self.sparse);
        if count > 0 {
            let places = TilePlaces::single(&at.map(|at| self.place(at))[..count]);
            self.cast(band, places, |lane| at[lane], Lanes::MAX >> (LANES - count));
        }
    }

    /// Casts some rays, which `at` gives the positions of in the sample array.
    fn cast(
        &mut self,
        band: &mut Band<'_>,
        places: TilePlaces,
        at: impl Fn(usize) -> [usize; 2],
        wanted: Lanes,
    ) {
        let packet = Packet { places, step: self.step, wanted };
        let Self { caster, rays, scratch, .. } = self;
        let met = caster.cast(&packet, rays, scratch, &mut band.counts);
        band.write(at, wanted, met.then_some(&*rays));
    }
}
