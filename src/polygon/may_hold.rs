//! Which bricks of a volume may be stored, before any is made: what the sizes in a plan follow from.

use hecs::World;
use rayon::prelude::*;

use super::coverage::{Flat, REACH};
use super::face::Faces;
use crate::components::{Classify, Clip, Surface, TexelKind, Voxelize};
use crate::schedule::Watch;
use crate::view::observer;
use crate::volume::bricks::{self, BrickPlace};
use crate::volume::gel::{self, FAINT};
use crate::volume::grid::{Painted, Scalars};
use crate::volume::labels::Tint;
use crate::volume::opacities::Opacities;
use crate::volume::painting::Painting;
use crate::volume::ranges::Ranges;
use crate::volume::scene_volumes::{Content, SceneVolume, around, volumes};

/// Bricks of a volume that are classified for a plan, evenly spread over those that may be seen.
const LOOKED_AT: usize = 512;

/// For each brick of a volume, whether any of it may be seen: none is stored that this denies.
#[derive(Debug, Clone)]
pub(crate) struct MayHold {
    size: [usize; 3],
    counts: [usize; 3],
    held: Vec<bool>,
    looked: Looked,
}

/// What a look at some of the bricks tells.
#[derive(Debug, Clone, Copy)]
struct Looked {
    /// The part of those that may be seen that are, 0..=1.
    seen: f64,
    /// Whether some voxel is surely above [`FAINT`].
    opaque: bool,
}

impl MayHold {
    /// The bricks of the volume itself, by its scalars and how they are classified and cut, or by its paint.
    #[must_use]
    pub fn of(world: &World, volume: &SceneVolume) -> Self {
        let size = volume.size();
        let counts = bricks::counts(size);
        let [nx, ny, _] = counts;
        let all: usize = counts.iter().product();
        let unknown = Looked { seen: 1.0, opaque: false };
        let (held, looked) = match volume.content {
            Content::Clear | Content::Projected => (vec![false; all], unknown),
            Content::Painted => {
                let mut found = world.query_one::<(&Painted, Option<&Clip>)>(volume.entity);
                let Ok((painted, clip)) = found.get() else {
                    return Self { size, counts, held: vec![true; all], looked: unknown };
                };
                let painting = Painting::new(painted, &volume.grid, clip);
                let holds = |at| painting.holds([at % nx, at / nx % ny, at / (nx * ny)]);
                ((0..all).into_par_iter().map(holds).collect(), unknown)
            }
            // A contour without thickness has one where it casts a shadow.
            Content::Values => (vec![true; all], unknown),
            Content::Classified => {
                classified(world, volume).unwrap_or_else(|| (vec![true; all], unknown))
            }
        };
        Self { size, counts, held, looked }
    }

    /// The part of what may be seen that is expected to be, 0..=1.
    #[must_use]
    pub fn seen(&self) -> f64 {
        self.looked.seen
    }

    /// Whether some voxel of a volume that is classified is surely not faint.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.looked.opaque
    }

    /// And those that the polygons touch which are scan-converted into the volume.
    #[must_use]
    pub(crate) fn with_polygons(mut self, world: &World, volume: &SceneVolume) -> Self {
        let mut query = world.query::<&Faces>().with::<(&Voxelize, &Surface)>();
        self.touch(world, volume, query.iter());
        self
    }

    /// And those that any polygons touch: what is traced casts its shadow into the volume too.
    #[must_use]
    pub(crate) fn with_casters(mut self, world: &World, volume: &SceneVolume) -> Self {
        let mut query = world.query::<&Faces>().with::<&Surface>();
        self.touch(world, volume, query.iter());
        self
    }

    fn touch<'a>(
        &mut self,
        world: &World,
        volume: &SceneVolume,
        polygons: impl Iterator<Item = &'a Faces>,
    ) {
        let volumes = volumes(world);
        for faces in polygons {
            let into = around(&volumes, || faces.middle());
            if into.is_none_or(|into| into.entity != volume.entity) {
                continue;
            }
            for flat in faces.0.iter().filter_map(|face| Flat::new(face, &volume.grid)) {
                for near in flat.bricks(REACH, self.size) {
                    let at = self.at([near.zyx[2], near.zyx[1], near.zyx[0]]);
                    self.held[at] = true;
                }
            }
        }
    }

    /// The most bytes that bricks of `T` take, with their table.
    #[must_use]
    pub fn bytes<T>(&self) -> u64 {
        let held = self.held.iter().filter(|held| **held).count();
        (held * bricks::VOXELS * size_of::<T>() + self.held.len() * 4) as u64
    }

    /// The most bytes that gel takes: a brick of it is stored where one of the eight bricks from it on is.
    #[must_use]
    pub fn gel_bytes(&self, kind: TexelKind) -> u64 {
        let [nx, ny, nz] = self.counts;
        let stored = |at: usize| {
            let [x, y, z] = [at % nx, at / nx % ny, at / (nx * ny)];
            let after = |n: usize, most: usize| n..(n + 2).min(most);
            after(z, nz)
                .any(|z| after(y, ny).any(|y| after(x, nx).any(|x| self.held[self.at([x, y, z])])))
        };
        let layer = |z: usize| (nx * ny * z..nx * ny * (z + 1)).filter(|at| stored(*at)).count();
        let layers: Vec<u64> = (0..nz).map(|z| layer(z) as u64).collect();
        // While aprons are filled the faces of two layers are kept beside.
        let two = layers.windows(2).map(|two| two[0] + two[1]).max().unwrap_or(layers[0]);
        gel::bytes_of(kind, layers.iter().sum(), two) + self.held.len() as u64 * 4
    }

    fn at(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }
}

/// The bricks of a volume that may be seen; how many of them are, and whether one is sure to be opaque, by those looked at.
fn classified(world: &World, volume: &SceneVolume) -> Option<(Vec<bool>, Looked)> {
    type Stated<'a> =
        (&'a Scalars, &'a Classify, Option<&'a Clip>, Option<&'a Tint>, Option<&'a Ranges>);
    let mut found = world.query_one::<Stated<'_>>(volume.entity);
    let (scalars, classify, clip, tint, made) = found.get().ok()?;
    let size = volume.size();
    let [nx, ny, _] = bricks::counts(size);
    let place = |at: usize| BrickPlace::new([at % nx, at / nx % ny, at / (nx * ny)], size);
    let ranges = made.cloned().unwrap_or_else(|| Ranges::of(scalars, size, &Watch::default()));
    let opacities = Opacities::new((scalars, &volume.grid), (classify, volume.unit), clip, tint);
    let held = opacities.held(&ranges, observer::stays_outside(world, &volume.grid));
    let may: Vec<usize> = (0..held.len()).filter(|at| held[*at]).collect();
    let looked: Vec<(bool, bool)> = may
        .par_iter()
        .step_by(may.len().div_ceil(LOOKED_AT).max(1))
        .map(|at| {
            let mut brick = [0.0; bricks::VOXELS];
            let seen = opacities.fill(&ranges, place(*at), &mut brick);
            (seen, brick.iter().any(|alpha| *alpha > FAINT))
        })
        .collect();
    let seen = looked.iter().filter(|(seen, _)| *seen).count();
    let opaque = looked.iter().any(|(_, opaque)| *opaque);
    Some((held, Looked { seen: seen as f64 / looked.len().max(1) as f64, opaque }))
}
