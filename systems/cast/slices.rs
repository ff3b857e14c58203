//! Rays through a volume's own voxels, slice by slice, as they are in memory, and not one after the other: Lacroute and
//! Levoy, "Fast volume rendering using a shear-warp factorization", 1994.
//!
//! Of parallel rays on the lattice of a volume's voxels, all pass a plane across the lattice alike: at the same place between
//! the voxels around. So the weights of a sample are the plane's, its texels are a row's, and what hides a sample is a bit in a
//! row of bits. `shear` says where the planes and rays are; a `tile` of rays goes through the bricks that its `beam` meets, the
//! nearest first, and through the slices of each `brick`, where its `cells` are not empty. Samples lie as far apart as those
//! of any ray, on planes in place of depths; what a ray sees depends on no tile and no other ray. The picture is made of them
//! by [`voxel_resampling`](crate::view).

mod ahead;
mod beam;
mod brick;
mod cells;
mod fours;
mod occupied;
mod order;
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
use occupied::Occupied;
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
    (inputs.sampling.per_voxel > 0.0 && alone && camera.eye.is_none()).then_some((placed, &gel.lit))
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
    let [across, down] = shear.rays();
    let rays = down * (across * size_of::<[f32; 4]>() + size_of::<[u32; 2]>());
    let tables = shear.phases.iter().map(|slices| size_of_val(&slices[..])).sum::<usize>();
    let tiles = rayon::current_num_threads() * shear.phases.len() * tile::BYTES;
    Some((rays + tables + tiles) as u64)
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

/// Rows of rays: their colors, and of each row the columns that met anything.
type Rows<'r> = (&'r mut [[f32; 4]], &'r mut [[u32; 2]]);

impl<T: Texel> Sought<'_, T> {
    /// All rays, in bands of tiles: no band depends on another.
    fn cast(&self, watch: &Watch) -> Result<(VoxelRays, Counts), Error> {
        let shear = self.shear;
        let size = shear.rays();
        let occupied = self.occupied();
        let mut colors = vec![[0.0; 4]; size[0] * size[1]];
        let mut met = vec![[0; 2]; size[1]];
        let high = HIGH * shear.parts[1];
        let bands = colors.par_chunks_mut((size[0] * high).max(1)).zip(met.par_chunks_mut(high));
        watch.expect(bands.len() as u64);
        let band = |(number, rows): (usize, Rows<'_>)| {
            watch.check()?;
            let done = self.band(number * HIGH, rows, &occupied);
            watch.advance();
            Ok(done)
        };
        let done: Vec<(Counts, f32)> = bands.enumerate().map(band).collect::<Result<_, Error>>()?;
        let (mut counts, mut excess) = (Counts::default(), 0.0_f32);
        for (of_band, of_brightest) in done {
            counts += of_band;
            excess = excess.max(of_brightest);
        }
        Ok((VoxelRays { size, colors, met, excess, places: shear.places }, counts))
    }

    /// The bricks that have cells to be sampled.
    fn occupied(&self) -> Occupied {
        let (texels, pyramid) = (self.texels.slices(), self.pyramid.map(Pyramid::slices));
        let [u, v, w] = self.shear.axes;
        let counts = texels.counts();
        Occupied::of([u, v, w].map(|axis| counts[axis]), |at| {
            cells::sampled(pyramid, texels.stored_at(self.shear.xyz(at))).is_some()
        })
    }

    /// The rays from row `top` of a phase on, tile by tile, written to their rows of colors and of columns that met anything;
    /// by how much the brightest is above its opacity.
    fn band(&self, top: usize, (rows, met): Rows<'_>, occupied: &Occupied) -> (Counts, f32) {
        let shear = self.shear;
        let [across, parts] = [shear.rays()[0], shear.parts[0]];
        let high = met.len() / shear.parts[1];
        let beam = Beam {
            shear,
            texels: self.texels.slices(),
            occupied,
            pyramid: self.pyramid.map(Pyramid::slices),
            stop: self.stop,
            ratio: self.ratio,
        };
        let mut tiles: Vec<Tile> = shear.phases.iter().map(|_| Tile::default()).collect();
        let (mut counts, mut excess, level) = (Counts::default(), 0.0_f32, self.level);
        for left in (0..shear.count[0]).step_by(WIDE) {
            let size = [WIDE.min(shear.count[0] - left), high];
            let [u, v] = [left, top * shear.apart].map(|n| n as i64);
            let first = [u + shear.first[0], v + shear.first[1]];
            for tile in &mut tiles {
                tile.open(size);
            }
            dispatch!(level, simd => beam.pass(simd, &mut tiles, (first, size), &mut counts));
            counts.rays += (size[0] * size[1] * tiles.len()) as u64;
            for (tile, number) in tiles.iter().zip(0..).filter(|(tile, _)| tile.is_met()) {
                let (a, b) = (number % parts, number / parts);
                for j in 0..high {
                    let row = j * shear.parts[1] + b;
                    let written = &mut rows[row * across..][left * parts + a..across];
                    let (columns, most) =
                        dispatch!(level, simd => tile.write(simd, j, self.stop, (written, parts)));
                    if columns[0] < columns[1] {
                        for column in [columns[0], columns[1] - 1] {
                            met[row] = widened(met[row], ((left + column) * parts + a) as u32);
                        }
                        excess = excess.max(most);
                    }
                }
            }
        }
        (counts, excess)
    }
}

/// Columns `[from, to)`, and another.
fn widened([from, to]: [u32; 2], column: u32) -> [u32; 2] {
    let from = if from < to { from.min(column) } else { column };
    [from, to.max(column + 1)]
}

#[cfg(test)]
mod tests;
