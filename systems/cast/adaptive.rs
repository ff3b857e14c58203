//! Adaptive sampling and refinement (paper §2 and §6; Levoy, "Volume rendering by adaptive refinement", 1990).
//!
//! Rays are first cast on a coarse grid of positions. A square region whose corners differ in C is split into four, down
//! to a ray a pixel; below that only where the ranges of both C_G and C_A say that an edge is seen, of a polygon or a surface
//! of values, at that level and at those before: C knows textures, and where a texture happens to split a region tells nothing of edges. Level after
//! level, over bands of packets: which regions split is decided from the level before alone, so that the picture does not
//! depend on bands or threads.

use rayon::prelude::*;

use super::band::{Band, cut};
use super::edges::EdgeColors;
use super::gathered::cast_band;
use super::lanes::Lanes;
use super::level::Regions;
use super::preview::Preview;
use super::targets::{Caster, Crossed, Outlines, looks_for_edges};
use crate::components::Sampling;
use crate::error::Error;
use crate::schedule::Watch;
use crate::view::samples::{Colors, Counts, Layout, NONE, POSITIONS, SampleArray};

/// The sample array while it is refined.
pub(crate) struct Refinement<'a, C> {
    sampling: &'a Sampling,
    crossed: &'a Crossed,
    caster: &'a C,
    array: SampleArray,
    /// C_A and C_G, where polygons, or surfaces of values, may ask for supersampling.
    edges: Option<EdgeColors>,
}

impl<'a, C: Caster> Refinement<'a, C> {
    /// A sample array without a ray.
    pub fn new(
        layout: Layout,
        sampling: &'a Sampling,
        edges: bool,
        crossed: &'a Crossed,
        caster: &'a C,
    ) -> Self {
        let supersampled = edges && looks_for_edges(sampling);
        let blocks = layout.blocks().iter().product();
        let array = SampleArray {
            layout,
            colors: Colors::new(&layout),
            opened: vec![NONE; blocks],
            cast: vec![0; blocks],
            splits: vec![0; blocks],
            voxel_rays: None,
            counts: Counts::default(),
        };
        let edges = supersampled.then(|| EdgeColors::new(&layout));
        Self { sampling, crossed, caster, array, edges }
    }

    /// Casts, splits and casts again, from the coarsest regions to the finest; shows what is known meanwhile to who looks on.
    pub(crate) fn refine(
        mut self,
        watch: &Watch,
        mut preview: Option<&mut Preview<'_>>,
    ) -> Result<SampleArray, Error> {
        let (finest, layout) = (self.sampling.finest as usize, self.array.layout);
        if layout.coarsest < POSITIONS {
            self.array.splits.fill(if layout.coarsest == 1 { 0b1_1111 } else { 1 });
            self.open(|_, _| true);
        }
        self.cast_where(layout.coarsest, |_, _| Lanes::MAX, watch, preview.as_deref())?;
        let mut parent: Option<Regions> = None;
        let mut side = layout.coarsest;
        while side > finest && (side > POSITIONS || self.edges.is_some()) {
            if let Some(preview) = &mut preview {
                preview.level(&self.array);
            }
            let mut level = self.decide(side, parent.as_ref());
            if let Some(most) = self.crossed.most.filter(|_| side == POSITIONS) {
                level.spare(most, layout.blocks(), |x, y| self.contrast(x * side, y * side, side));
            }
            level.note(&mut self.array.splits, layout.blocks()[0]);
            if side == POSITIONS {
                // The new positions on a region's right and lower edges are its neighbours'.
                self.open(|x, y| {
                    level.split(x, y)
                        || (x > 0 && level.split(x - 1, y))
                        || (y > 0 && level.split(x, y - 1))
                });
            }
            self.cast_where(side / 2, |a, b| level.asked(a, b), watch, preview.as_deref())?;
            parent = Some(level);
            side /= 2;
        }
        Ok(self.array)
    }

    /// Opens the blocks that are to have positions of their own.
    fn open(&mut self, wanted: impl Fn(usize, usize) -> bool) {
        let across = self.array.layout.blocks()[0];
        let mut count = 0;
        for (y, opened) in self.array.opened.chunks_mut(across).enumerate() {
            for (x, opened) in opened.iter_mut().enumerate() {
                if wanted(x, y) {
                    *opened = count;
                    count += 1;
                }
            }
        }
        self.array.colors.fine = vec![[[0.0; 4]; POSITIONS * POSITIONS]; count as usize];
        self.edges.iter_mut().for_each(|edges| edges.open(count as usize));
    }

    /// Which regions of `side` positions split: those of split parents whose corners differ.
    fn decide(&self, side: usize, parent: Option<&Regions>) -> Regions {
        let layout = &self.array.layout;
        let mut level = Regions::new(layout.regions.map(|n| n * layout.coarsest / side), side);
        let across = level.across;
        let rows = level.split.par_chunks_mut(across).zip(level.edges.par_chunks_mut(across));
        rows.enumerate().for_each(|(y, (split, edges))| {
            let mut decide = |x: usize, may_have_edge: bool| {
                edges[x] = may_have_edge && self.has_edge(x * side, y * side, side);
                split[x] = edges[x] || self.differs(x * side, y * side, side);
            };
            let Some(parent) = parent else { return (0..across).for_each(|x| decide(x, true)) };
            for x in (0..across / 2).filter(|x| parent.split(*x, y / 2)) {
                let [_, may_have_edge] = parent.at(x, y / 2);
                for child in [2 * x, 2 * x + 1] {
                    decide(child, may_have_edge);
                }
            }
        });
        level
    }

    /// Whether a region is split whatever textures show: where corners say that an edge is seen, or an outline crosses it;
    /// below a pixel, the outline of a polygon that is thinner than that.
    fn has_edge(&self, i: usize, j: usize, side: usize) -> bool {
        let crossed = |outlines: &Option<Outlines>| {
            outlines.as_ref().is_some_and(|outlines| outlines.cross(i, j, side))
        };
        let above_a_pixel =
            side > POSITIONS && (self.sampling.tolerance <= 0.0 || crossed(&self.crossed.outlines));
        let is_edge = |ranges: [f32; 2]| ranges.iter().all(|r| *r > self.sampling.edge_tolerance);
        above_a_pixel
            || crossed(&self.crossed.thin)
            || self.edges.as_ref().is_some_and(|edges| is_edge(self.ranges(edges, i, j, side)))
    }

    /// How clearly corners say that an edge is seen; without bound where the outline of a thin polygon does.
    fn contrast(&self, i: usize, j: usize, side: usize) -> f32 {
        if self.crossed.thin.as_ref().is_some_and(|thin| thin.cross(i, j, side)) {
            return f32::INFINITY;
        }
        let ranges = self.edges.as_ref().map(|edges| self.ranges(edges, i, j, side));
        ranges.map_or(f32::INFINITY, |[attenuated, geometric]| attenuated.min(geometric))
    }

    /// Whether the corners of a region of more than a pixel differ in C by more than is tolerated.
    fn differs(&self, i: usize, j: usize, side: usize) -> bool {
        side > POSITIONS
            && range(corners(i, j, side).map(|[i, j]| self.array.color(i, j)))
                > self.sampling.tolerance
    }

    /// The greatest ranges of any channel of C_A and of C_G over the corners of a region.
    fn ranges(&self, edges: &EdgeColors, i: usize, j: usize, side: usize) -> [f32; 2] {
        let SampleArray { layout, opened, .. } = &self.array;
        let corners = corners(i, j, side).map(|corner| edges.at(layout, opened, corner));
        [0, 1].map(|of| range(corners.map(|pair| pair[of])))
    }

    /// Casts a ray at every position of the lattice of `step` positions that is `wanted`, band by band; for who looks on, some
    /// bands after the other.
    fn cast_where(
        &mut self,
        step: usize,
        wanted: impl Fn(usize, usize) -> Lanes + Sync,
        watch: &Watch,
        preview: Option<&Preview<'_>>,
    ) -> Result<(), Error> {
        let (layout, caster) = (self.array.layout, self.caster);
        let at_once = preview.map_or(usize::MAX, |_| 2 * rayon::current_num_threads());
        let mut done = 0;
        loop {
            let SampleArray { colors, opened, cast, counts, .. } = &mut self.array;
            let mut bands = cut(&layout, step, (colors, self.edges.as_mut()), opened, cast);
            if done == 0 {
                watch.expect(bands.len() as u64);
            }
            let mut rows = 0;
            for bands in bands[done..].chunks_mut(at_once) {
                *counts += cast_bands(bands, watch, |band| {
                    cast_band(band, &layout, step, &wanted, caster);
                })?;
                done += bands.len();
                rows = bands.last().map_or(rows, Band::bottom);
                if preview.is_some_and(Preview::is_due) {
                    break;
                }
            }
            if done >= bands.len() {
                return Ok(());
            }
            if let Some(preview) = preview {
                preview.rows(&self.array, rows);
            }
        }
    }
}

/// Casts some bands side by side, each in a span of its own; what was counted in all of them.
fn cast_bands(
    bands: &mut [Band<'_>],
    watch: &Watch,
    cast: impl Fn(&mut Band<'_>) + Sync,
) -> Result<Counts, Error> {
    let span = tracing::Span::current();
    let counted: Vec<Counts> = bands
        .par_iter_mut()
        .map(|band| {
            let _inside = span.enter();
            let _rows = tracing::trace_span!("band", number = band.number).entered();
            watch.check()?;
            cast(band);
            watch.advance();
            Ok(band.counts)
        })
        .collect::<Result<_, Error>>()?;
    let mut counts = Counts::default();
    for counted in counted {
        counts += counted;
    }
    Ok(counts)
}

/// The corners of the region of `side` positions from `(i, j)` on.
fn corners(i: usize, j: usize, side: usize) -> [[usize; 2]; 4] {
    [[i, j], [i + side, j], [i, j + side], [i + side, j + side]]
}

/// The greatest range of any channel over four corners.
fn range(corners: [[f32; 4]; 4]) -> f32 {
    let corners = corners.map(glam::Vec4::from_array);
    let high = corners[0].max(corners[1]).max(corners[2].max(corners[3]));
    let low = corners[0].min(corners[1]).min(corners[2].min(corners[3]));
    (high - low).max_element()
}
