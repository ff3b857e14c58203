//! The array of sample colours of a view: 4 × 4 positions a pixel, where rays were cast, and what they saw (paper §6).

use std::sync::Arc;

use glam::DVec2;

use super::voxel_rays::VoxelRays;
use crate::schedule::Product;

/// Positions along a pixel's side.
pub const POSITIONS: usize = 4;

/// What was counted while rays were cast: facts about the picture, not about the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct Counts {
    /// Rays cast.
    pub rays: u64,
    /// Samples of the volume that were taken.
    pub samples: u64,
    /// Times that a ray found its cell empty, and leaps that a packet took over room in which none meets anything.
    pub cells_skipped: u64,
    /// Samples that packets of sixteen rays looked at together.
    pub packet_steps: u64,
    /// Polygons met by rays and composited into C.
    pub polygon_hits: u64,
    /// Parts of slabs that polygons had split.
    pub slivers: u64,
}

impl std::ops::AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.samples += other.samples;
        self.cells_skipped += other.cells_skipped;
        self.packet_steps += other.packet_steps;
        self.polygon_hits += other.polygon_hits;
        self.slivers += other.slivers;
    }
}

/// The colours of a view's sample array. Shared by pointer, equality is identity.
#[derive(Debug, Clone)]
pub struct Samples(pub Arc<SampleArray>);

impl Product for Samples {}

impl PartialEq for Samples {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// Where the positions of a sample array are: pixel `p` is centred at position `4 p + margin`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Pixels across and down.
    pub size: [usize; 2],
    /// The position of the middle of pixel (0, 0), a multiple of 4.
    pub margin: usize,
    /// Regions of `coarsest` positions a side, across and down; positions run from 0 to `regions · coarsest`.
    pub regions: [usize; 2],
    /// The side of the first regions, in positions.
    pub coarsest: usize,
}

impl Layout {
    /// The layout for pictures of `size` pixels whose filter reaches `reach` positions from a pixel's middle.
    #[must_use]
    pub fn new(size: [usize; 2], coarsest: usize, reach: usize) -> Self {
        let margin = reach.next_multiple_of(POSITIONS);
        let regions = size.map(|n| (POSITIONS * (n - 1) + margin + reach).div_ceil(coarsest));
        Self { size, margin, regions, coarsest }
    }

    /// Positions across and down.
    #[must_use]
    pub fn positions(&self) -> [usize; 2] {
        self.regions.map(|n| n * self.coarsest + 1)
    }

    /// Blocks of 4 × 4 positions across and down.
    #[must_use]
    pub fn blocks(&self) -> [usize; 2] {
        self.positions().map(|n| n.div_ceil(POSITIONS))
    }

    /// Place of a position in its block, 0..16, and of the block among the blocks.
    #[must_use]
    #[inline]
    pub fn place(&self, i: usize, j: usize) -> (usize, usize) {
        let plane = (j % POSITIONS) * POSITIONS + i % POSITIONS;
        (plane, (j / POSITIONS) * self.blocks()[0] + i / POSITIONS)
    }

    /// Window coordinate of a position along either axis, in pixels from the picture's corner.
    #[must_use]
    pub fn window(&self, position: usize) -> f64 {
        (position as f64 - self.margin as f64) / POSITIONS as f64 + 0.5
    }
}

/// The table's entry for a block that has no positions of its own between the lattice's.
pub const NONE: u32 = u32::MAX;

/// One associated RGBA a position: every fourth position for all of the picture, and those between in the blocks that
/// were opened for them, so that memory goes where the rays are.
#[derive(Debug, Default)]
pub struct Colors {
    /// The position (0, 0) of each block, x fastest.
    pub lattice: Vec<[f32; 4]>,
    /// The positions of each opened block, at `4 (j mod 4) + (i mod 4)`; the first is unused.
    pub fine: Vec<[[f32; 4]; POSITIONS * POSITIONS]>,
}

impl Colors {
    /// Zeros, and no block opened.
    #[must_use]
    pub fn new(layout: &Layout) -> Self {
        Self { lattice: vec![[0.0; 4]; layout.blocks().iter().product()], fine: Vec::new() }
    }

    /// The value at a position; `opened` tells for each block which of the opened it is, or [`NONE`].
    #[must_use]
    #[inline]
    pub fn value(&self, layout: &Layout, opened: &[u32], i: usize, j: usize) -> [f32; 4] {
        let (within, block) = layout.place(i, j);
        if within == 0 {
            return self.lattice[block];
        }
        self.fine.get(opened[block] as usize).map_or([0.0; 4], |fine| fine[within])
    }
}

/// C at the positions where rays were cast, and which regions were split.
#[derive(Debug)]
pub struct SampleArray {
    /// Where the positions are.
    pub layout: Layout,
    /// C, linear associated RGBA.
    pub colors: Colors,
    /// For each block: its number among the opened blocks, or [`NONE`].
    pub opened: Vec<u32>,
    /// For each block: bit `4 (j mod 4) + (i mod 4)` is set where a ray was cast.
    pub cast: Vec<u16>,
    /// For each block, which is also the region of 4 × 4 positions from its first on: bit 0 is set if it was split to
    /// regions of 2 × 2, bit `1 + 2 y + x` if that child of it was split to single positions.
    pub splits: Vec<u8>,
    /// Rays through a volume's voxels, where they were cast in place of those at positions, of which there are none then.
    pub voxel_rays: Option<VoxelRays>,
    /// What was counted.
    pub counts: Counts,
}

impl SampleArray {
    /// An array for rays that are not at its positions.
    #[must_use]
    pub(crate) fn without_rays(layout: Layout) -> Self {
        let (opened, cast, splits) = (Vec::new(), Vec::new(), Vec::new());
        let (colors, counts) = (Colors::default(), Counts::default());
        Self { layout, colors, opened, cast, splits, voxel_rays: None, counts }
    }

    /// C at a position where a ray was cast.
    #[must_use]
    #[inline]
    pub fn color(&self, i: usize, j: usize) -> [f32; 4] {
        self.colors.value(&self.layout, &self.opened, i, j)
    }

    /// Whether any ray met anything, however faint.
    #[must_use]
    pub fn meets_anything(&self) -> bool {
        let met = |color: &[f32; 4]| color[3] > 0.0;
        self.voxel_rays.as_ref().is_some_and(VoxelRays::meet_anything)
            || self.colors.lattice.iter().any(met)
            || self.colors.fine.as_flattened().iter().any(met)
    }

    /// Whether a ray was cast at a position.
    #[must_use]
    #[inline]
    pub fn is_cast(&self, i: usize, j: usize) -> bool {
        let (plane, block) = self.layout.place(i, j);
        self.cast.get(block).is_some_and(|cast| cast >> plane & 1 == 1)
    }

    /// Where rays were cast (the paper's figure 8): 4 × 4 values a pixel, row by row, of the picture's pixels alone.
    #[must_use]
    pub fn ray_map(&self) -> Vec<bool> {
        let [width, height] = self.layout.size.map(|n| n * POSITIONS);
        // A pixel's four positions are its middle, the one behind it, and the two before.
        let first = self.layout.margin - POSITIONS / 2;
        if let Some(rays) = &self.voxel_rays {
            return voxel_ray_map(rays, [width, height]);
        }
        (0..height)
            .flat_map(|j| (0..width).map(move |i| (i, j)))
            .map(|(i, j)| self.is_cast(first + i, first + j))
            .collect()
    }
}

/// Which positions of a picture, `size` of them, are the nearest to rays through voxels.
fn voxel_ray_map(rays: &VoxelRays, [width, height]: [usize; 2]) -> Vec<bool> {
    let mut map = vec![false; width * height];
    let places = (0..rays.size[1]).flat_map(|j| (0..rays.size[0]).map(move |i| [i, j]));
    for at in places {
        let window = rays.places.window(DVec2::from(at.map(|n| n as f64)));
        let position = window.map(|window| (window * POSITIONS as f64).round());
        if let Some(at) = position.filter(|at| at.min_element() >= 0.0) {
            let (x, y) = (at.x as usize, at.y as usize);
            if x < width && y < height {
                map[y * width + x] = true;
            }
        }
    }
    map
}
