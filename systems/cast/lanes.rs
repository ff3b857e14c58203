//! Sixteen rays side by side: a tile of four by four neighbours on the lattice, at the same sample at the same time.

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
    /// The position of ray 0, counted from the middle of pixel (0, 0).
    pub first: [i64; 2],
    /// Positions from each ray to the next: what each stands for.
    pub step: usize,
    /// Which rays are wanted.
    pub wanted: Lanes,
}

impl Packet {
    /// The position of a ray, counted from the middle of pixel (0, 0).
    pub fn position(&self, lane: usize) -> [i64; 2] {
        let [x, y] = [lane % SIDE, lane / SIDE].map(|n| (n * self.step) as i64);
        [self.first[0] + x, self.first[1] + y]
    }
}
