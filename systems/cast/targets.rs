//! What refinement asks for: rays at places of the picture, and the three colours that they bring back.

use glam::DVec2;

use super::lanes::{LANES, Packet};
use crate::components::Sampling;
use crate::view::samples::{Counts, Layout, POSITIONS};

/// Whether edges are looked for: they may ask for more than a ray a pixel, and not all positions have rays in any case.
pub fn looks_for_edges(sampling: &Sampling) -> bool {
    (sampling.finest as usize) < POSITIONS && sampling.coarsest > sampling.finest
}

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
    /// Finds what is empty for all rays of packets that lie within the outline of `group`: the next that are cast.
    fn scout(&self, group: &Packet, scratch: &mut Self::Scratch, counts: &mut Counts);
    /// Casts the wanted rays of a packet and puts what they saw into `rays`; whether there was anything to be seen, else
    /// `rays` are as they were.
    #[must_use]
    fn cast(
        &self,
        packet: &Packet,
        rays: &mut [RayColors; LANES],
        scratch: &mut Self::Scratch,
        counts: &mut Counts,
    ) -> bool;
}

/// Blocks that may be opened for each that lies along the picture's width and its height.
const TIMES_ROUND: usize = 24;

/// Where outlines of polygons ask for rays, whatever the rays around them saw; nothing where that is not asked for.
#[derive(Default)]
pub(crate) struct Crossed {
    /// Where regions are split to a ray a pixel from the start.
    pub outlines: Option<Outlines>,
    /// Where they are split to the finest: where polygons are so thin that rays a pixel apart may miss them.
    pub thin: Option<Outlines>,
    /// How many blocks may be opened for rays below a pixel; `None`: as many as outlines ask for, which a plan knows.
    pub most: Option<usize>,
}

/// The most blocks that are opened where volumes have surfaces, whose silhouettes no plan knows: many times round a picture.
pub fn most_opened(layout: &Layout) -> usize {
    layout.blocks().iter().sum::<usize>() * TIMES_ROUND
}

/// Where outlines are: a flag for each square of positions.
pub(crate) struct Outlines {
    /// Side of the flagged squares, in positions.
    pub side: usize,
    /// Flagged squares across.
    pub across: usize,
    /// The flags, x fastest.
    pub crossed: Vec<bool>,
}

impl Outlines {
    /// No outline, over squares of `side` positions.
    pub fn none(layout: &Layout, side: usize) -> Self {
        let [across, down] = layout.positions().map(|n| (n - 1).div_ceil(side));
        Self { side, across, crossed: vec![false; across * down] }
    }

    /// A place of the window, in pixels, in squares.
    pub fn square(&self, layout: &Layout, window: DVec2) -> DVec2 {
        ((window - 0.5) * POSITIONS as f64 + layout.margin as f64) / self.side as f64
    }

    /// Marks every square that the edge from `p` to `q` (in squares) crosses, and its neighbours within a rounding error.
    pub fn mark(&mut self, p: DVec2, q: DVec2) {
        const SLACK: f64 = 1e-6;
        let down = (self.crossed.len() / self.across) as f64;
        let (least, most) = (p.min(q) - SLACK, p.max(q) + SLACK);
        if least.cmpge(DVec2::ZERO).all() && most.x < self.across as f64 && most.y < down {
            let [from, to] = [least, most].map(|end| (end.x as usize, end.y as usize));
            if from == to {
                self.crossed[from.1 * self.across + from.0] = true;
                return;
            }
        }
        let (low, high) = if p.y <= q.y { (p, q) } else { (q, p) };
        if high.y + SLACK < 0.0 {
            return;
        }
        // Casts saturate, and cut off what is not below 0.
        let rows = (low.y - SLACK).max(0.0) as usize..=(high.y + SLACK).min(down - 1.0) as usize;
        let slope = if high.y > low.y { (high.x - low.x) / (high.y - low.y) } else { 0.0 };
        for row in rows {
            let (from, to) = if high.y > low.y {
                let at = |y: f64| low.x + (y.clamp(low.y, high.y) - low.y) * slope;
                (at(row as f64), at(row as f64 + 1.0))
            } else {
                (low.x, high.x)
            };
            let first = (from.min(to) - SLACK).max(0.0) as usize;
            let last = (from.max(to) + SLACK).min(self.across as f64 - 1.0);
            if last >= 0.0 {
                for x in first..=last as usize {
                    self.crossed[row * self.across + x] = true;
                }
            }
        }
    }

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
