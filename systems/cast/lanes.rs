//! Sixteen rays side by side: a tile of four by four neighbours on the lattice, at the same sample at the same time.

pub(crate) use crate::view::walk::TilePlaces;
pub use crate::view::walk::{LANES, SIDE};

/// A set of a tile's rays: bit n is ray n, at `(n mod 4, n / 4)`.
pub(crate) type Lanes = u16;

/// The rays of a set, in their order.
#[inline]
pub fn each(mut lanes: Lanes) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = lanes.trailing_zeros() as usize;
        (lanes != 0).then(|| {
            lanes &= lanes - 1;
            lane
        })
    })
}

/// The rays that are cast together.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Packet {
    /// Where they are.
    pub places: TilePlaces,
    /// Positions between neighbouring rays of their level: what each stands for.
    pub step: usize,
    /// Which rays are wanted.
    pub wanted: Lanes,
}

impl Packet {
    /// Rays `step` positions apart, the first of them at `first`, counted from the middle of pixel (0, 0).
    pub fn new(first: [i64; 2], step: usize, wanted: Lanes) -> Self {
        Self { places: TilePlaces::lattice(first, step), step, wanted }
    }

    /// The position of a ray, counted from the middle of pixel (0, 0).
    #[inline]
    pub fn position(&self, lane: usize) -> [i64; 2] {
        self.places.position(lane)
    }
}
