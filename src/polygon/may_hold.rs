//! Which bricks of a volume may be stored, before any is made: what the sizes in a plan follow from.

use hecs::World;

use super::coverage::{Flat, REACH};
use super::face::Faces;
use crate::components::{Classify, Clip, Material, Surface, TexelKind, Voxelize};
use crate::schedule::Watch;
use crate::volume::bricks::{self, BrickPlace};
use crate::volume::classification::Classifier;
use crate::volume::clipping::{Cut, Left};
use crate::volume::gel;
use crate::volume::gradients::Gradients;
use crate::volume::grid::{Painted, Scalars};
use crate::volume::painting::Painting;
use crate::volume::ranges::Ranges;
use crate::volume::scene_volumes::{Content, SceneVolume, around, volumes};

/// For each brick of a volume, whether any of it may be seen: none is stored that this denies.
#[derive(Debug, Clone)]
pub(crate) struct MayHold {
    size: [usize; 3],
    counts: [usize; 3],
    held: Vec<bool>,
}

impl MayHold {
    /// The bricks of the volume itself, by its scalars and how they are classified and cut, or by its paint.
    #[must_use]
    pub fn of(world: &World, volume: &SceneVolume) -> Self {
        let size = volume.size();
        let counts = bricks::counts(size);
        let place = |at: usize| {
            let [nx, ny, _] = counts;
            BrickPlace::new([at % nx, at / nx % ny, at / (nx * ny)], size)
        };
        let all = counts.iter().product();
        let held = match volume.content {
            Content::Clear | Content::Projected => vec![false; all],
            Content::Painted => {
                let mut found = world.query_one::<(&Painted, Option<&Clip>)>(volume.entity);
                let Ok((painted, clip)) = found.get() else {
                    return Self { size, counts, held: vec![true; all] };
                };
                let painting = Painting::new(painted, &volume.grid, clip);
                (0..all).map(|at| painting.holds(place(at).brick)).collect()
            }
            // A contour without thickness has one where it casts a shadow.
            Content::Values => vec![true; all],
            Content::Classified => classified(world, volume, (0..all).map(place)),
        };
        Self { size, counts, held }
    }

    /// And those that the polygons touch which are scan-converted into the volume.
    #[must_use]
    pub(crate) fn with_polygons(mut self, world: &World, volume: &SceneVolume) -> Self {
        let volumes = volumes(world);
        let mut query = world.query::<&Faces>().with::<(&Voxelize, &Surface)>();
        for faces in &mut query {
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
        self
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
        let stored = (0..self.held.len()).filter(|at| stored(*at)).count() as u64;
        gel::bytes_of(kind, stored) + self.held.len() as u64 * 4
    }

    fn at(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }
}

/// For each place, whether its scalars, their gradients and the cut leave anything to be seen.
fn classified(
    world: &World,
    volume: &SceneVolume,
    places: impl ExactSizeIterator<Item = BrickPlace>,
) -> Vec<bool> {
    type Stated<'a> = (&'a Scalars, &'a Classify, Option<&'a Clip>, Option<&'a Ranges>);
    let mut found = world.query_one::<Stated<'_>>(volume.entity);
    let Ok((scalars, classify, clip, made)) = found.get() else {
        return vec![true; places.len()];
    };
    let size = volume.size();
    let ranges = made.cloned().unwrap_or_else(|| Ranges::of(scalars, size, &Watch::default()));
    let classifier = Classifier::new(classify, &Material::default(), volume.unit);
    let cut = clip.map(|clip| Cut::new(clip, &volume.grid));
    let gradients = Gradients::new(&volume.grid);
    places
        .map(|place| {
            let range = ranges.around(place.brick);
            let steepest = gradients.at_most(range.spread, place.first, place.extent);
            let cut_away = cut
                .as_ref()
                .is_some_and(|cut| cut.left(place.first, place.extent) == Left::Nothing);
            classifier.may_show(range, steepest) && !cut_away
        })
        .collect()
}
