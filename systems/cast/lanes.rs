//! Up to sixteen rays side by side: neighbours on the lattice, at the same sample at the same time.

use crate::view::ray::Ray;

/// The most rays of a packet.
pub const LANES: usize = 16;

/// A set of a packet's rays: bit n is ray n.
pub type Lanes = u16;

/// The rays of a set, in their order.
pub fn each(mut lanes: Lanes) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = lanes.trailing_zeros() as usize;
        (lanes != 0).then(|| {
            lanes &= lanes - 1;
            lane
        })
    })
}

/// The set of the first `count` rays.
pub fn first(count: usize) -> Lanes {
    (((1_u32 << count) - 1) & 0xffff) as Lanes
}

/// A packet as what it meets sees it.
#[derive(Debug, Clone, Copy)]
pub struct Packet<'p> {
    /// Its rays, at most [`LANES`].
    pub rays: &'p [Ray],
    /// The numbers of the beams that they lie in, a number a ray.
    pub beams: &'p [usize],
}
