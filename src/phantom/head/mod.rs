//! The head: a phantom with the numbers of a CT scan (Hounsfield + 1024) on 256 × 256 × 113 voxels, 1 × 1 × 2 mm.
//!
//! A voxel starts as air; tissue after tissue is painted over it by the part of the voxel that the tissue's solid
//! fills. Tables of shapes hold the anatomy, a file a region, in millimetres about the world's origin: +x is the
//! patient's left, +y the back, +z the top.

mod brain;
mod jaw;
mod row;
mod skin;
mod skull;

use rayon::prelude::*;

use super::simple::centred;
use super::solid::{FAR, Solid};
use crate::formats::Loaded;
use crate::shared::Shared;
use crate::volume::grid::Scalars;
use row::{AIR, EDGE, Row, SIZE};

const SPACING: [f64; 3] = [1.0, 1.0, 2.0];

/// Slices 1 mm apart from z = −114 mm, of which the slices are made.
const THIN_SLICES: usize = 2 * SIZE[2] + 3;

/// The head; see the module.
pub fn head() -> Loaded {
    let anatomy = Anatomy::new();
    let area = SIZE[0] * SIZE[1];
    let mut slices = vec![0_u16; area * THIN_SLICES];
    slices.par_chunks_mut(area).enumerate().for_each(|(k, slice)| anatomy.slice(k, slice));
    let mut voxels = vec![0_u16; area * SIZE[2]];
    voxels.par_chunks_mut(area).enumerate().for_each(|(k, slice)| thicken(&slices, k, slice));
    centred(SIZE, SPACING, Scalars::U16(Shared::new(voxels)))
}

/// Slice k: the weighted mean of five thin ones, as a scanner's slices have thickness; so edges are smooth along z too.
fn thicken(slices: &[u16], k: usize, out: &mut [u16]) {
    let [a, b, c, d, e] = std::array::from_fn(|i| &slices[(2 * k + i) * out.len()..][..out.len()]);
    for (i, voxel) in out.iter_mut().enumerate() {
        // Values stay under 4096, so that eight of them fit 16 bits.
        *voxel = (a[i] + 2 * (b[i] + c[i] + d[i]) + e[i] + 4) / 8;
    }
}

/// Every region of the head, ready for slices.
struct Anatomy {
    x: Vec<f32>,
    skin: Solid,
    skull: skull::Skull,
    brain: brain::Brain,
    jaw: jaw::Jaw,
}

impl Anatomy {
    fn new() -> Self {
        Self {
            x: (0..SIZE[0]).map(|i| i as f32 - 127.5).collect(),
            skin: Solid::new(skin::SKIN),
            skull: skull::Skull::new(),
            brain: brain::Brain::new(),
            jaw: jaw::Jaw::new(),
        }
    }

    /// Thin slice k, painted from the outside inwards.
    fn slice(&self, k: usize, out: &mut [u16]) {
        let z = k as f32 - 114.0;
        let skin = self.skin.slice(z);
        let brain = self.brain.slice(k, z);
        let skull = self.skull.slice(z);
        let jaw = self.jaw.slice(z);
        let (mut values, mut distances) = (vec![AIR; SIZE[0]], vec![FAR; SIZE[0]]);
        for (j, line) in out.chunks_mut(SIZE[0]).enumerate() {
            values.fill(AIR);
            let y = j as f32 - 127.5;
            let (values, distances) = (&mut values[..], &mut distances[..]);
            let mut row = Row { x: &self.x, y, z, values, distances };
            let range = row.lay(&skin);
            if !range.is_empty() {
                row.blend(range, EDGE, skin::tissue(y, z));
                skull.paint(&mut row, &brain, j);
            }
            // Also beside the head: the filling's streaks go on in air.
            jaw.paint(&mut row);
            for (voxel, &value) in line.iter_mut().zip(&*row.values) {
                *voxel = (value + 0.5) as u16;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::Voxels;

    /// The mean over a cube of 3³ voxels about a place in the world, mm.
    fn about(head: &Loaded, place: [f64; 3]) -> f32 {
        let Voxels::Scalars(scalars) = &head.voxels else { unreachable!() };
        let index = head.grid.world_to_index().transform_point3(place.into()).round();
        let [x, y, z] = index.to_array().map(|i| i as usize);
        let near = |i: usize| head.grid.offset([x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1]);
        (0..27).map(|i| scalars.value(near(i))).sum::<f32>() / 27.0
    }

    #[test]
    fn tissues_are_where_a_head_has_them_and_have_the_numbers_of_a_scanner() {
        let head = head();
        let places: [(&str, [f64; 3], std::ops::Range<f32>); 10] = [
            ("air before the face", [0.0, -125.0, 0.0], 24.0..26.0),
            ("brain", [30.0, 10.0, 60.0], 1055.0..1095.0),
            ("ventricle", [9.5, 20.0, 45.0], 1025.0..1050.0),
            ("eye", [30.0, -66.0, 8.0], 1040.0..1060.0),
            ("vault", [0.0, 8.0, 96.0], 1250.0..2000.0),
            ("maxillary sinus", [28.0, -50.0, -18.0], 20.0..60.0),
            ("throat", [0.0, -5.0, -70.0], 20.0..60.0),
            ("front tooth", [3.8, -78.5, -51.0], 1900.0..2700.0),
            ("filling", [24.0, -42.0, -57.5], 2700.0..3273.0),
            ("chin", [0.0, -79.0, -90.0], 1300.0..2000.0),
        ];
        for (tissue, place, expected) in places {
            let found = about(&head, place);
            assert!(expected.contains(&found), "{tissue}: {found}, not in {expected:?}");
        }
    }

    #[test]
    fn a_contour_of_the_vault_has_no_stairs() {
        let head = head();
        let Voxels::Scalars(scalars) = &head.voxels else { unreachable!() };
        // Heights, mm, at which columns along y over the left forehead first reach 540, against those beside them.
        let height = |y: usize| {
            let column = |z: usize| scalars.value(head.grid.offset([140, y, z]));
            let z = (0..SIZE[2]).rev().find(|&z| column(z) >= 540.0).unwrap();
            let part = (column(z) - 540.0) / (column(z) - column(z + 1));
            2.0 * (z as f32 + part)
        };
        let heights: Vec<f32> = (90..180).map(height).collect();
        for bend in heights.windows(3).map(|h| h[0] - 2.0 * h[1] + h[2]) {
            assert!(bend.abs() < 0.25, "a bend of {bend} mm where slices are 2 mm apart");
        }
    }
}
