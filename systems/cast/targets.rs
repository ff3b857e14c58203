//! What refinement asks for: rays at places of the picture, and the three colours that they bring back.

use super::lanes::{LANES, Packet};
use crate::view::samples::Counts;

/// What the three colours of a ray are: C, C_A and C_G, associated RGBA.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct RayColors {
    /// C.
    pub full: [f32; 4],
    /// C_A.
    pub attenuated: [f32; 4],
    /// C_G.
    pub geometric: [f32; 4],
}

/// Casts rays.
pub(crate) trait Caster: Sync {
    /// What a thread needs beside the caster, made once a band: nothing is allocated in a ray.
    type Scratch: Default;
    /// Casts the wanted rays of a packet and puts what they saw into `rays`.
    fn cast(
        &self,
        packet: &Packet,
        rays: &mut [RayColors; LANES],
        scratch: &mut Self::Scratch,
        counts: &mut Counts,
    );
}

/// Where regions are to be split to a ray a pixel from the start: a flag for each block of 8 × 8 positions.
pub(crate) struct Outlines {
    /// Side of the flagged squares, in positions.
    pub side: usize,
    /// Flagged squares across.
    pub across: usize,
    /// The flags, x fastest.
    pub crossed: Vec<bool>,
}

impl Outlines {
    /// Whether an outline crosses the region of `side` positions from `(i, j)` on.
    pub fn cross(&self, i: usize, j: usize, side: usize) -> bool {
        let cells = (side / self.side).max(1);
        let down = self.crossed.len() / self.across;
        (j / self.side..(j / self.side + cells).min(down)).any(|y| {
            let first = i / self.side;
            self.crossed
                [y * self.across + first..y * self.across + (first + cells).min(self.across)]
                .contains(&true)
        })
    }
}
