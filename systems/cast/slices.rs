//! Rays through a volume's own voxels, slice by slice, as they are in memory, and not one after the other: Lacroute and
//! Levoy, "Fast volume rendering using a shear-warp factorization", 1994.
//!
//! Of parallel rays on the lattice of a volume's voxels, all pass a plane across the lattice alike: at the same place between
//! the voxels around. So the weights of a sample are the plane's, its texels are a row's, and what hides a sample is a bit in a
//! row of bits. `shear` says where the planes and rays are; a `tile` of rays goes through the bricks that its `beam` meets, the
//! nearest first, and through the slices of each `brick`, where its `cells` are not empty. Samples lie as far apart as those
//! of any ray, on planes in place of depths; what a ray sees depends on no tile and no other ray. The picture is made of them
//! by [`voxel_resampling`](crate::view).

mod beam;
mod brick;
mod cells;
mod shear;
mod tile;

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use super::inputs::{Inputs, Placed, Sampled};
use super::rays;
use crate::components::Sampling;
use crate::error::Error;
use crate::schedule::Watch;
use crate::view::camera::Camera;
use crate::view::samples::{Counts, Layout, SampleArray};
use crate::view::voxel_rays::VoxelRays;
use crate::volume::gel::{GelBricks, Texel, Texels};
use crate::volume::grid::Grid;
use crate::volume::pyramid::Pyramid;
use beam::Beam;
use shear::Shear;
use tile::{HIGH, Tile, WIDE};

/// The gel that rays through voxels are asked for, and all that a view has of it; `None` where rays go through pixels.
pub(super) fn asked<'a>(
    inputs: &'a Inputs,
    camera: &Camera,
) -> Option<(&'a Placed, &'a GelBricks)> {
    let [placed] = &inputs.volumes[..] else { return None };
    let Sampled::Gel(gel) = &placed.content else { return None };
    let alone = inputs.polygons.is_empty()
        && inputs.projections.is_empty()
        && inputs.shafts.is_empty()
        && gel.ambient.is_none();
    (inputs.sampling.per_voxel > 0 && alone && camera.eye.is_none()).then_some((placed, &gel.lit))
}

/// Casts them for a picture of such a layout.
pub(super) fn cast(
    inputs: &Inputs,
    camera: &Camera,
    (placed, gel): (&Placed, &GelBricks),
    (layout, watch): (Layout, &Watch),
) -> Result<SampleArray, Error> {
    let sampling = &inputs.sampling;
    let distance = rays::distance(inputs);
    let shear = Shear::new(&placed.grid, camera, distance, sampling)
        .map_err(|problem| Error::entity("view", problem))?;
    let (stop, ratio) = (rays::stop(sampling) as f32, distance / placed.unit);
    let pyramid = placed.pyramid.as_ref();
    let (rays, counts) = crate::with_texels!(gel, texels => {
        let level = Level::new();
        let sought = Sought { shear: &shear, texels, pyramid, stop, ratio, level };
        sought.cast(watch)?
    });
    let mut array = SampleArray::without_rays(layout);
    (array.voxel_rays, array.counts) = (Some(rays), counts);
    Ok(array)
}

/// The bytes that such rays through a grid take; `None` where none can be cast.
pub(super) fn bytes(
    grid: &Grid,
    camera: &Camera,
    distance: f64,
    sampling: &Sampling,
) -> Option<u64> {
    let shear = Shear::new(grid, camera, distance, sampling).ok()?;
    let colors = shear.rays().iter().product::<usize>() * size_of::<[f32; 4]>();
    let tables = shear.phases.iter().map(|slices| size_of_val(&slices[..])).sum::<usize>();
    let tiles = rayon::current_num_threads() * shear.phases.len() * tile::BYTES;
    Some((colors + tables + tiles) as u64)
}

/// What rays go through, and how.
struct Sought<'a, T> {
    shear: &'a Shear,
    texels: &'a Texels<T>,
    /// What tells which cells are empty; `None`: all are sampled.
    pyramid: Option<&'a Pyramid>,
    /// A ray stops when no more than this comes through of what is behind.
    stop: f32,
    /// Δ against the opacity unit.
    ratio: f64,
    /// The instructions that rays are cast with; no bit depends on them.
    level: Level,
}

impl<T: Texel> Sought<'_, T> {
    /// All rays, in bands of tiles: no band depends on another.
    fn cast(&self, watch: &Watch) -> Result<(VoxelRays, Counts), Error> {
        let shear = self.shear;
        let size = shear.rays();
        let mut colors = vec![[0.0; 4]; size[0] * size[1]];
        let high = HIGH * shear.parts[1];
        let bands = colors.par_chunks_mut((size[0] * high).max(1)).enumerate();
        watch.expect(bands.len() as u64);
        let band = |(number, rows): (usize, &mut [[f32; 4]])| {
            watch.check()?;
            let done = self.band(number * HIGH, rows);
            watch.advance();
            Ok(done)
        };
        let done: Vec<Done> = bands.map(band).collect::<Result<_, Error>>()?;
        let all = done.iter().fold(Done::nothing(), Done::join);
        let met = if all.met[0][0] < all.met[1][0] { all.met } else { [[0; 2]; 2] };
        Ok((VoxelRays { size, colors, met, places: shear.places }, all.counts))
    }

    /// The rays from lattice row `top` on, tile by tile, written to their `rows`.
    fn band(&self, top: usize, rows: &mut [[f32; 4]]) -> Done {
        let shear = self.shear;
        let [across, parts] = [shear.rays()[0], shear.parts[0]];
        let high = rows.len() / across / shear.parts[1];
        let beam = Beam {
            shear,
            texels: self.texels.slices(),
            pyramid: self.pyramid.map(Pyramid::slices),
            stop: self.stop,
            ratio: self.ratio,
        };
        let mut tiles: Vec<Tile> = shear.phases.iter().map(|_| Tile::default()).collect();
        let (mut done, level) = (Done::nothing(), self.level);
        for left in (0..shear.count[0]).step_by(WIDE) {
            let size = [WIDE.min(shear.count[0] - left), high];
            let first = [left as i64 + shear.first[0], top as i64 + shear.first[1]];
            for tile in &mut tiles {
                tile.open(size);
            }
            dispatch!(level, simd => beam.pass(simd, &mut tiles, (first, size), &mut done.counts));
            done.counts.rays += (size[0] * size[1] * tiles.len()) as u64;
            for (tile, number) in tiles.iter().zip(0..).filter(|(tile, _)| tile.is_met()) {
                let (a, b) = (number % parts, number / parts);
                for j in 0..high {
                    let row = j * shear.parts[1] + b;
                    let colors = tile.colors(j, size[0], self.stop);
                    let written = &mut rows[row * across..][..across];
                    for (i, color) in colors.enumerate() {
                        if let Some(color) = color {
                            let column = (left + i) * parts + a;
                            written[column] = color;
                            done.note([column, top * shear.parts[1] + row]);
                        }
                    }
                }
            }
        }
        done
    }
}

/// What some rays met, and what that took.
struct Done {
    /// The first column and row of a ray that met anything, and one past the last.
    met: [[usize; 2]; 2],
    counts: Counts,
}

impl Done {
    fn nothing() -> Self {
        Self { met: [[usize::MAX; 2], [0; 2]], counts: Counts::default() }
    }

    /// That a ray met something.
    fn note(&mut self, at: [usize; 2]) {
        self.widen([at, at.map(|n| n + 1)]);
    }

    fn widen(&mut self, [low, high]: [[usize; 2]; 2]) {
        let [least, most] = self.met;
        let least = [least[0].min(low[0]), least[1].min(low[1])];
        self.met = [least, [most[0].max(high[0]), most[1].max(high[1])]];
    }

    fn join(mut self, other: &Self) -> Self {
        self.widen(other.met);
        self.counts += other.counts;
        self
    }
}

#[cfg(test)]
mod tests;
