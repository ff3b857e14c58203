//! The array of sample colours of a view: 4 × 4 positions a pixel, where rays were cast, and what they saw (paper §6).

use std::sync::Arc;

/// Positions along a pixel's side.
pub const POSITIONS: usize = 4;

/// What was counted while rays were cast: facts about the picture, not about the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct Counts {
    /// Rays cast.
    pub rays: u64,
    /// Samples of the volume that were interpolated.
    pub samples: u64,
    /// Times that a ray stepped over an empty cell of the pyramid, of whatever level.
    pub cells_skipped: u64,
    /// Polygons met by rays.
    pub polygon_hits: u64,
    /// Slabs' parts composited where polygons split a slab.
    pub slivers: u64,
}

impl std::ops::AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.samples += other.samples;
        self.cells_skipped += other.cells_skipped;
        self.polygon_hits += other.polygon_hits;
        self.slivers += other.slivers;
    }
}

/// The colours of a view's sample array. Shared by pointer, equality is identity.
#[derive(Debug, Clone)]
pub struct Samples(pub Arc<SampleArray>);

impl PartialEq for Samples {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// One associated RGBA a position, in sixteen planes: the positions that lie alike in their block of 4 × 4 share one,
/// so that a picture of a ray a pixel touches one plane of memory.
#[derive(Debug)]
pub struct SampleArray {
    /// Pixels across and down.
    pub size: [usize; 2],
    /// The position of the middle of pixel (0, 0): pixel `p` is centred at `4 p + margin`.
    pub margin: usize,
    /// Blocks of 4 × 4 positions across and down.
    pub blocks: [usize; 2],
    /// For each place `4 (y mod 4) + (x mod 4)` in a block: C of every block, x fastest.
    pub planes: Vec<Vec<[f32; 4]>>,
    /// For each block: bit `4 (y mod 4) + (x mod 4)` is set where a ray was cast.
    pub cast: Vec<u16>,
    /// The side of the smallest region around each position, see `resample`: for each 4-position region, its split level.
    pub splits: Vec<u8>,
    /// What was counted.
    pub counts: Counts,
}
