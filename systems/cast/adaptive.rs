//! Adaptive sampling and refinement (paper §2 and §6; Levoy, "Volume rendering by adaptive refinement", 1990).
//!
//! Rays are first cast on a coarse grid of positions. A square region whose corners differ in C is split into four, down
//! to a ray a pixel; below that only where the ranges of both C_G and C_A say that a polygon's edge is seen. Level after
//! level, over bands of beams: which regions split is decided from the level before alone, so that the picture does not
//! depend on bands or threads.

use std::slice::ChunksMut;

use glam::DVec2;
use rayon::prelude::*;

use super::beams::{Beams, SIDE};
use crate::components::Sampling;
use crate::error::Error;
use crate::samples::{Counts, Layout, POSITIONS, Planes, SampleArray};
use crate::schedule::Watch;

/// What the three colours of a ray are: C, C_A and C_G, associated RGBA.
#[derive(Debug, Clone, Copy, Default)]
pub struct Ray {
    /// C.
    pub full: [f32; 4],
    /// C_A.
    pub attenuated: [f32; 4],
    /// C_G.
    pub geometric: [f32; 4],
}

/// Casts the ray through window position (pixels) in the beam of a number.
pub trait Caster: Sync {
    /// What a thread needs beside the caster, made once a band: nothing is allocated in a ray.
    type Scratch: Default;
    /// Casts one ray.
    fn cast(
        &self,
        beam: usize,
        window: DVec2,
        scratch: &mut Self::Scratch,
        counts: &mut Counts,
    ) -> Ray;
}

/// Where regions are to be split to a ray a pixel from the start: a flag for each block of 8 × 8 positions.
pub struct Outlines {
    /// Side of the flagged squares, in positions.
    pub side: usize,
    /// Flagged squares across.
    pub across: usize,
    /// The flags, x fastest.
    pub crossed: Vec<bool>,
}

impl Outlines {
    /// Whether an outline crosses the region of `side` positions from `(i, j)` on.
    fn cross(&self, i: usize, j: usize, side: usize) -> bool {
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

/// The sample array while it is refined.
pub struct Refinement<'a, C> {
    layout: Layout,
    beams: Beams,
    sampling: &'a Sampling,
    outlines: Option<&'a Outlines>,
    caster: &'a C,
    full: Planes,
    /// C_A and C_G, where polygons may ask for supersampling.
    edges: Option<[Planes; 2]>,
    cast: Vec<u16>,
    counts: Counts,
}

/// Which regions of one level are split, x fastest.
struct Level {
    side: usize,
    across: usize,
    split: Vec<bool>,
}

impl Level {
    fn split(&self, x: usize, y: usize) -> bool {
        self.split[y * self.across + x]
    }
}

/// The part of the planes that one band of beams owns.
struct Band<'b> {
    full: Vec<&'b mut [[f32; 4]]>,
    edges: Option<[Vec<&'b mut [[f32; 4]]>; 2]>,
    cast: &'b mut [u16],
    counts: Counts,
}

impl<'a, C: Caster> Refinement<'a, C> {
    /// A sample array without a ray.
    pub fn new(
        layout: Layout,
        sampling: &'a Sampling,
        polygons: bool,
        outlines: Option<&'a Outlines>,
        caster: &'a C,
    ) -> Self {
        let below_a_pixel = polygons && sampling.finest < POSITIONS as u32;
        let supersampled = below_a_pixel && sampling.coarsest as usize > sampling.finest as usize;
        Self {
            layout,
            beams: Beams::new(layout),
            sampling,
            outlines,
            caster,
            full: Planes::new(&layout),
            edges: supersampled.then(|| [Planes::new(&layout), Planes::new(&layout)]),
            cast: vec![0; layout.blocks().iter().product()],
            counts: Counts::default(),
        }
    }

    /// Casts, splits and casts again, from the coarsest regions to the finest.
    pub fn refine(mut self, watch: &Watch) -> Result<SampleArray, Error> {
        let finest = self.sampling.finest as usize;
        let mut splits = vec![0_u8; self.cast.len()];
        if self.layout.coarsest < POSITIONS {
            splits.fill(if self.layout.coarsest == 1 { 0b1_1111 } else { 1 });
        }
        self.cast_where(self.layout.coarsest, |_, _| true, watch)?;
        let mut parent: Option<Level> = None;
        let mut side = self.layout.coarsest;
        while side > finest && (side > POSITIONS || self.edges.is_some()) {
            let level = self.decide(side, parent.as_ref());
            note(&mut splits, &level, self.layout.blocks()[0]);
            self.cast_split(&level, watch)?;
            parent = Some(level);
            side /= 2;
        }
        let Self { layout, full, cast, counts, .. } = self;
        Ok(SampleArray { layout, colors: full, cast, splits, counts })
    }

    /// Which regions of `side` positions split: those of split parents whose corners differ.
    fn decide(&self, side: usize, parent: Option<&Level>) -> Level {
        let [across, down] = self.layout.regions.map(|n| n * self.layout.coarsest / side);
        let mut split = vec![false; across * down];
        split.par_chunks_mut(across).enumerate().for_each(|(y, row)| {
            for (x, split) in row.iter_mut().enumerate() {
                *split = parent.is_none_or(|p| p.split(x / 2, y / 2))
                    && self.differs(x * side, y * side, side);
            }
        });
        Level { side, across, split }
    }

    /// Whether the corners of a region differ by more than is tolerated.
    fn differs(&self, i: usize, j: usize, side: usize) -> bool {
        let corners = [(i, j), (i + side, j), (i, j + side), (i + side, j + side)];
        let range = |planes: &Planes| range(corners.map(|(i, j)| planes.value(&self.layout, i, j)));
        if side > POSITIONS {
            let tolerance = self.sampling.tolerance;
            return tolerance <= 0.0
                || self.outlines.is_some_and(|outlines| outlines.cross(i, j, side))
                || range(&self.full) > tolerance;
        }
        let tolerance = self.sampling.edge_tolerance;
        self.edges
            .as_ref()
            .is_some_and(|edges| edges.iter().all(|planes| range(planes) > tolerance))
    }

    /// Casts the five new positions of every split region; one that two regions share is cast once.
    fn cast_split(&mut self, level: &Level, watch: &Watch) -> Result<(), Error> {
        let half = level.side / 2;
        let (across, down) = (level.across, level.split.len() / level.across);
        let asks = |x: Option<usize>, y: Option<usize>| {
            x.zip(y).is_some_and(|(x, y)| x < across && y < down && level.split(x, y))
        };
        let wanted = |i: usize, j: usize| {
            let (a, b) = (i / half, j / half);
            let (x, y) = (Some(a / 2), Some(b / 2));
            match (a % 2, b % 2) {
                (1, 1) => asks(x, y),
                (1, 0) => asks(x, y) || asks(x, (b / 2).checked_sub(1)),
                (0, 1) => asks(x, y) || asks((a / 2).checked_sub(1), y),
                _ => false,
            }
        };
        self.cast_where(half, wanted, watch)
    }

    /// Casts a ray at every position of the lattice of `step` positions that is `wanted`, band by band.
    fn cast_where(
        &mut self,
        step: usize,
        wanted: impl Fn(usize, usize) -> bool + Sync,
        watch: &Watch,
    ) -> Result<(), Error> {
        let (beams, caster) = (self.beams, self.caster);
        let mut bands = self.bands();
        watch.expect(bands.len() as u64);
        let span = tracing::Span::current();
        let counts: Vec<Counts> = bands
            .par_iter_mut()
            .enumerate()
            .map(|(number, band)| {
                let _inside = span.enter();
                let _beam_row = tracing::trace_span!("band", number).entered();
                watch.check()?;
                band.cast(&beams, number, step, &wanted, caster);
                watch.advance();
                Ok(band.counts)
            })
            .collect::<Result<_, Error>>()?;
        for counts in counts {
            self.counts += counts;
        }
        Ok(())
    }

    /// Cuts the planes into rows of beams.
    fn bands(&mut self) -> Vec<Band<'_>> {
        let rows = SIDE / POSITIONS * self.layout.blocks()[0];
        let mut full = cut(&mut self.full, rows);
        let mut edges =
            self.edges.as_mut().map(|edges| edges.each_mut().map(|planes| cut(planes, rows)));
        self.cast
            .chunks_mut(rows)
            .map(|cast| Band {
                full: take(&mut full),
                edges: edges.as_mut().map(|edges| edges.each_mut().map(|chunks| take(chunks))),
                cast,
                counts: Counts::default(),
            })
            .collect()
    }
}

impl Band<'_> {
    fn cast<C: Caster>(
        &mut self,
        beams: &Beams,
        number: usize,
        step: usize,
        wanted: &impl Fn(usize, usize) -> bool,
        caster: &C,
    ) {
        let mut scratch = C::Scratch::default();
        let layout = &beams.layout;
        let [across, down] = layout.positions();
        let lattice = |first: usize, count: usize| {
            (first.next_multiple_of(step)..(first + SIDE).min(count)).step_by(step)
        };
        for x in 0..beams.counts[0] {
            for j in lattice(number * SIDE, down) {
                for i in lattice(x * SIDE, across).filter(|&i| wanted(i, j)) {
                    let window = DVec2::new(layout.window(i), layout.window(j));
                    let beam = number * beams.counts[0] + x;
                    let ray = caster.cast(beam, window, &mut scratch, &mut self.counts);
                    self.counts.rays += 1;
                    self.write(layout, i, j - number * SIDE, &ray);
                }
            }
        }
    }

    fn write(&mut self, layout: &Layout, i: usize, j: usize, ray: &Ray) {
        let (plane, block) = layout.place(i, j);
        self.full[plane][block] = ray.full;
        if let Some([attenuated, geometric]) = &mut self.edges {
            attenuated[plane][block] = ray.attenuated;
            geometric[plane][block] = ray.geometric;
        }
        self.cast[block] |= 1 << plane;
    }
}

/// The rows of every plane, `blocks` at a time.
fn cut(planes: &mut Planes, blocks: usize) -> Vec<ChunksMut<'_, [f32; 4]>> {
    planes.0.iter_mut().map(|plane| plane.chunks_mut(blocks)).collect()
}

/// The next rows of every plane.
fn take<'b>(chunks: &mut [ChunksMut<'b, [f32; 4]>]) -> Vec<&'b mut [[f32; 4]]> {
    chunks.iter_mut().filter_map(Iterator::next).collect()
}

/// The greatest range of any channel over four corners.
fn range(corners: [[f32; 4]; 4]) -> f32 {
    let corners = corners.map(glam::Vec4::from_array);
    let high = corners[0].max(corners[1]).max(corners[2].max(corners[3]));
    let low = corners[0].min(corners[1]).min(corners[2].min(corners[3]));
    (high - low).max_element()
}

/// Notes for the resampling which blocks of 4 × 4 positions were split, and which of their children.
fn note(splits: &mut [u8], level: &Level, blocks_across: usize) {
    if level.side > POSITIONS {
        return;
    }
    let per_block = POSITIONS / level.side;
    for (at, _) in level.split.iter().enumerate().filter(|(_, split)| **split) {
        let (x, y) = (at % level.across, at / level.across);
        let bit = if per_block == 1 { 0 } else { 1 + 2 * (y % 2) + x % 2 };
        splits[(y / per_block) * blocks_across + x / per_block] |= 1 << bit;
    }
}
