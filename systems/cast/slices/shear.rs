//! Where rays through voxels are: the planes of their samples, and the lattice that they lie on (Lacroute 1994, §3).
//!
//! Of a volume's axes w is the one along which a ray crosses most voxels; u and v are the others, u the one that lies in
//! rows of memory where it can. A ray is at u = U + σ_u (w − w_0), with σ_u at most 1: on a plane of constant w rays whose U
//! are 1 apart are a voxel apart. Where more than a ray a voxel is asked for, lattices are laid between one another: their
//! *phases* differ in the fraction of U and V. Rows of a phase may be two voxels apart: half a ray a voxel, or one and a half.

use glam::{DVec2, DVec3};

use crate::components::Sampling;
use crate::view::camera::Camera;
use crate::view::voxel_rays::LatticePlaces;
use crate::volume::grid::Grid;

/// Most rays along an axis of a voxel, however much longer it is than its other axes.
const MOST_PARTS: usize = 8;
/// Most planes of samples: each phase has a table of them.
const MOST_PLANES: f64 = 262_144.0;

/// The lattice of the rays through a volume, as one view sees it.
pub(super) struct Shear {
    /// Which of the volume's axes are u, v and w.
    pub axes: [usize; 3],
    /// The lattice's phases along u and v.
    pub parts: [usize; 2],
    /// Voxels between rows of a phase's rays along v: 1, or 2 where `parts` rows lie on each two voxels.
    pub apart: usize,
    /// The least whole U and V of rays.
    pub first: [i64; 2],
    /// How many of them a phase has.
    pub count: [usize; 2],
    /// Voxels along u, v and w.
    pub size: [usize; 3],
    /// Whether u and v grow along a ray.
    pub ahead: [bool; 2],
    /// The planes of samples, the nearest first, as each phase passes them; u fastest.
    pub phases: Vec<Vec<Slice>>,
    /// Where pixels are on the lattice of all phases.
    pub places: LatticePlaces,
}

/// A plane of samples, as the rays of one phase pass it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slice {
    /// Between which voxels along w it is: the one before.
    pub cell: i64,
    /// Rays are in the cells of u = U + shift, and so along v.
    pub shift: [i64; 2],
    /// Of the four voxels around each ray on a plane of voxels, u fastest; they sum to 1.
    pub weights: [f32; 4],
    /// How much the two planes of voxels count, the one before and the one after; they sum to 1.
    pub planes: [f32; 2],
}

impl Shear {
    /// For samples `distance` apart, world units; the error names the remedy.
    pub fn new(
        grid: &Grid,
        camera: &Camera,
        distance: f64,
        sampling: &Sampling,
    ) -> Result<Self, String> {
        let to_index = grid.world_to_index();
        let step = to_index.transform_vector3(camera.forward * distance).to_array();
        let further = |most: usize, axis: usize| {
            if step[axis].abs() > step[most].abs() { axis } else { most }
        };
        let w = (0..3).fold(0, further);
        let axes = [[1, 2, 0], [0, 2, 1], [0, 1, 2]][w];
        let size = axes.map(|axis| grid.size[axis]);
        let last = (size[2] - 1) as f64;
        let planes = planes(last, step[w]).ok_or_else(|| {
            format!("a sample distance of {distance} is {:.1e} voxels; choose `sampling.distance_mm` near the voxel spacing", step[w].abs())
        })?;
        let slope = [0, 1].map(|axis| step[axes[axis]] / step[w]);
        let middle = last / 2.0;
        let spacing = grid.spacing();
        let wanted = [0, 1]
            .map(|axis| sampling.per_voxel.sqrt() * spacing[axes[axis]] / spacing.min_element());
        let (parts, apart) = rays_of_a_voxel(wanted);
        // From a window position to U and V.
        let lattice = |window: DVec2| {
            let at = to_index.transform_point3(camera.origin(window)).to_array();
            DVec2::from([0, 1].map(|axis| at[axes[axis]] - slope[axis] * (at[w] - middle)))
        };
        let margin = sampling.pixel_filter.reach() as f64;
        let seen = LatticePlaces::of(lattice).bounds(camera.size, margin);
        let steps = [1, apart];
        let reached = [0, 1].map(|axis| {
            let lean = slope[axis].abs() * middle;
            let last = (size[axis] - 1) as f64;
            reached((last, lean), seen.map(|end| end[axis]), steps[axis])
        });
        let first = reached.map(|(first, _)| first);
        let parts_of = [0, 1].map(|axis| parts[axis] as f64 / steps[axis] as f64);
        let from = DVec2::from(first.map(|first| first as f64));
        Ok(Self {
            axes,
            parts,
            apart,
            first,
            count: reached.map(|(_, count)| count),
            size,
            ahead: [0, 1].map(|axis| step[axes[axis]] > 0.0),
            phases: phases(&planes, (parts, apart), (slope, middle)),
            places: LatticePlaces::of(|window| (lattice(window) - from) * DVec2::from(parts_of)),
        })
    }

    /// What is at `[u, v, w]`, along x, y and z.
    #[inline]
    pub fn xyz(&self, uvw: [usize; 3]) -> [usize; 3] {
        let mut xyz = [0; 3];
        self.axes.into_iter().zip(uvw).for_each(|(axis, at)| xyz[axis] = at);
        xyz
    }

    /// Rays of all phases, across and down.
    pub fn rays(&self) -> [usize; 2] {
        [0, 1].map(|axis| self.count[axis] * self.parts[axis])
    }
}

/// Where planes `step` apart lie between 0 and the `last` voxel, the nearest first, and it half a step from where rays come
/// in; `None` for too many of them.
fn planes(last: f64, step: f64) -> Option<Vec<f64>> {
    let count = (last / step.abs() + 0.5).floor();
    let place = |k: usize| {
        let way = ((k as f64 + 0.5) * step.abs()).min(last);
        if step > 0.0 { way } else { last - way }
    };
    (count <= MOST_PLANES).then(|| (0..count as usize).map(place).collect())
}

/// How many rays a voxel has along u and v, and how many voxels rows of them are apart: as nearly as can be so many as are
/// `wanted` along both axes together, of those the ones most nearly as far apart along one as along the other, and of those the
/// fewest along either.
fn rays_of_a_voxel(wanted: [f64; 2]) -> ([usize; 2], usize) {
    let wanted = wanted.map(|rays| rays.min(MOST_PARTS as f64));
    let several = (1..=MOST_PARTS).flat_map(|u| (1..=MOST_PARTS).map(move |v| ([u, v], 1)));
    let odd = (1..=MOST_PARTS).step_by(2);
    let all = several.chain((1..=MOST_PARTS).flat_map(|u| odd.clone().map(move |v| ([u, v], 2))));
    let off = |&([u, v], apart): &([usize; 2], usize)| {
        let more = [u as f64 / wanted[0], v as f64 / apart as f64 / wanted[1]].map(f64::ln);
        // To a millionth: what differs by rounding is alike.
        let off = |off: f64| (off.abs() * 1e6).round() as u64;
        (off(more[0] + more[1]), off(more[0] - more[1]), u.max(v))
    };
    all.min_by_key(off).unwrap_or(([1; 2], 1))
}

/// The first of the whole U of rays, `step` apart, and how many there are, between 0 and the `last` voxel and as far as rays
/// `lean` from there on either side, and not further than is seen; two more on each side, for what is interpolated.
fn reached((last, lean): (f64, f64), [least, most]: [f64; 2], step: usize) -> (i64, usize) {
    let more = 2 * step as i64;
    let first = (-lean).max(least).floor() as i64 - more;
    let end = (last + lean).min(most).ceil() as i64 + more + 1;
    (first, ((end - first).max(0) as usize).div_ceil(step))
}

/// The planes as each phase passes them.
fn phases(
    planes: &[f64],
    (parts, apart): ([usize; 2], usize),
    (slope, middle): ([f64; 2], f64),
) -> Vec<Vec<Slice>> {
    let of = |phase: DVec2| {
        let from = |plane: f64| phase + (plane - middle) * DVec2::from(slope);
        planes.iter().map(|&plane| slice(plane, from(plane))).collect()
    };
    let row = |b: usize| {
        let along = (b * apart) as f64 / parts[1] as f64;
        let part = move |a: usize| [a as f64 / parts[0] as f64, along];
        (0..parts[0]).map(move |a| DVec2::from(part(a)))
    };
    (0..parts[1]).flat_map(row).map(of).collect()
}

/// The plane at `w`, where a ray of U = V = 0 is at `from`.
fn slice(w: f64, from: DVec2) -> Slice {
    let at = DVec3::new(from.x, from.y, w);
    let cell = at.floor();
    let far = (at - cell).as_vec3();
    let near = 1.0 - far;
    let weight = |n: usize| {
        let side = |axis: usize| if n >> axis & 1 == 1 { far[axis] } else { near[axis] };
        side(0) * side(1)
    };
    let (shift, planes) = ([cell.x as i64, cell.y as i64], [near.z, far.z]);
    Slice { cell: cell.z as i64, shift, weights: std::array::from_fn(weight), planes }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one_and_are_those_of_the_place_in_the_cell() {
        let slice = slice(3.25, DVec2::new(-1.5, 2.75));
        assert_eq!((slice.cell, slice.shift), (3, [-2, 2]));
        assert!((slice.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        assert!((slice.weights[0] - 0.5 * 0.25).abs() < 1e-6);
        assert!((slice.weights[3] - 0.5 * 0.75).abs() < 1e-6);
        assert_eq!(slice.planes, [0.75, 0.25]);
    }

    #[test]
    fn as_many_rays_as_are_asked_for_are_spread_evenly() {
        let of = |rays: f64, spacing: [f64; 2]| {
            rays_of_a_voxel(spacing.map(|spacing| rays.sqrt() * spacing))
        };
        assert_eq!(of(0.5, [1.0; 2]), ([1, 1], 2));
        assert_eq!(of(1.0, [1.0; 2]), ([1, 1], 1));
        assert_eq!(of(4.0, [1.0; 2]), ([2, 2], 1));
        assert_eq!(of(16.0, [1.0; 2]), ([4, 4], 1));
        assert_eq!(of(2.0, [1.0; 2]).0.iter().product::<usize>(), 2);
        // Of voxels twice as long along v a face is twice as large.
        assert_eq!(of(1.0, [1.0, 2.0]), ([1, 2], 1));
        assert_eq!(of(0.5, [1.0, 2.0]), ([1, 1], 1));
        assert_eq!(of(2.0, [1.0, 2.0]), ([2, 2], 1));
        assert_eq!(of(1.0, [1.0, 1e9]).0, [1, MOST_PARTS]);
    }
}
