//! Where on the picture the rays of a tile are: on a lattice of their own, or wherever rays are wanted.

/// Rays along the side of a tile.
pub const SIDE: usize = 4;
/// Rays of a tile.
pub const LANES: usize = SIDE * SIDE;

/// Positions of sixteen rays, counted from the middle of pixel (0, 0).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TilePlaces {
    /// The first of a lattice of 4 × 4 that they are on, or lie within.
    pub first: [i64; 2],
    /// From each of the lattice to the next, both ways.
    pub apart: i64,
    /// How far right of and below the first they are, if not on the lattice.
    off: Option<[[u16; 2]; LANES]>,
}

impl TilePlaces {
    /// A lattice: ray n is at `(n mod 4, n / 4)`.
    pub fn lattice(first: [i64; 2], apart: usize) -> Self {
        Self { first, apart: apart as i64, off: None }
    }

    /// Rays at single positions, as many as a tile has at the most; those that are left over stand where the last one does.
    pub fn single(at: &[[i64; 2]]) -> Self {
        let first = std::array::from_fn(|axis| at.iter().map(|at| at[axis]).min().unwrap_or(0));
        let own = |lane: usize| at.get(lane).or(at.last()).copied().unwrap_or(first);
        let off = |lane: usize| std::array::from_fn(|axis| (own(lane)[axis] - first[axis]) as u16);
        Self::scattered(first, std::array::from_fn(off))
    }

    /// Rays at some distances from `first`, right of it and below.
    pub fn scattered(first: [i64; 2], off: [[u16; 2]; LANES]) -> Self {
        let farthest = off.as_flattened().iter().max().copied().unwrap_or(0);
        let apart = usize::from(farthest).div_ceil(SIDE - 1).max(1) as i64;
        Self { first, apart, off: Some(off) }
    }

    /// The position of a ray.
    #[inline]
    pub fn position(&self, lane: usize) -> [i64; 2] {
        let [x, y] = match &self.off {
            Some(off) => off[lane].map(i64::from),
            None => [lane % SIDE, lane / SIDE].map(|n| n as i64 * self.apart),
        };
        [self.first[0] + x, self.first[1] + y]
    }

    /// Whether they are not on the lattice, but within it.
    pub fn are_scattered(&self) -> bool {
        self.off.is_some()
    }
}
