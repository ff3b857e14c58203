//! What lies in the braincase: folded brain with ventricles, in fluid.

use super::row::SIZE;
use crate::phantom::shapes::Piece;
use crate::phantom::solid::{Slice, Solid, coverage};

const FLUID: f32 = 1034.0;
const WHITE: f32 = 1064.0;
const GREY: f32 = 1090.0;

/// The lateral ventricles with their horns, and the third and fourth.
const VENTRICLES: &[Piece] = &[
    Piece::capsule([5.0, -26.0, 38.0], [10.0, 24.0, 46.0], [3.5, 5.0]).both().soft(2.0),
    Piece::capsule([10.0, 24.0, 46.0], [18.0, 46.0, 36.0], [5.0, 2.5]).both().soft(3.0),
    Piece::capsule([11.0, 24.0, 44.0], [26.0, 4.0, 18.0], [4.0, 2.0]).both().soft(3.0),
    Piece::ellipsoid([0.0, 4.0, 28.0], [1.8, 12.0, 9.0]),
    Piece::ellipsoid([0.0, 44.0, 0.0], [5.0, 4.0, 8.0]),
];

/// The cerebellum.
const CEREBELLUM: &[Piece] =
    &[Piece::ellipsoid([19.0, 54.0, -1.0], [30.0, 26.0, 18.0]).both().soft(6.0)];

/// Sine and cosine along one axis: the folds are products of them.
type Waves = Vec<[f32; 2]>;

/// The brain, ready for slices.
pub struct Brain {
    ventricles: Solid,
    cerebellum: Solid,
    waves: [Waves; 3],
}

impl Brain {
    pub fn new() -> Self {
        let waves = std::array::from_fn(|axis| {
            let wave = |millimetre| {
                let (sine, cosine) = libm::sincosf(millimetre as f32 / [3.1, 3.4, 3.2][axis]);
                [sine, cosine]
            };
            (0..SIZE[0]).map(wave).collect()
        });
        Self { ventricles: Solid::new(VENTRICLES), cerebellum: Solid::new(CEREBELLUM), waves }
    }

    pub fn slice(&self, k: usize, z: f32) -> BrainSlice<'_> {
        BrainSlice {
            ventricles: self.ventricles.slice(z),
            cerebellum: self.cerebellum.slice(z),
            waves: &self.waves,
            k,
            z,
        }
    }
}

/// The brain near one slice.
pub struct BrainSlice<'a> {
    ventricles: Slice<'a>,
    cerebellum: Slice<'a>,
    waves: &'a [Waves; 3],
    k: usize,
    z: f32,
}

impl BrainSlice<'_> {
    /// The values of row j at places `xs` whose depth under the inside of the skull is `depths`, into `out`.
    pub fn row(&self, xs: &[f32], (j, y): (usize, f32), depths: &[f32], out: &mut [f32]) {
        let mut distances = vec![crate::phantom::solid::FAR; xs.len()];
        let cerebellum = self.cerebellum.lay(xs, y, &mut distances);
        let [sy, cy] = self.waves[1][j];
        let [sz, cz] = self.waves[2][self.k];
        for (i, value) in out.iter_mut().enumerate() {
            let [sx, cx] = self.waves[0][i];
            let fold = sx * cy + sy * cz + sz * cx;
            *value = cerebrum(fold, depths[i], xs[i], self.z);
        }
        let leaves = self.waves[2][(self.k * 4 + j * 2) % SIZE[0]][0];
        for i in cerebellum {
            let tent = coverage(distances[i].abs() - 1.5, 2.0);
            let inside = coverage(distances[i], 2.0);
            let leaf = 1074.0 + 10.0 * leaves - 40.0 * tent;
            out[i] += (leaf - out[i]) * inside.max(tent);
        }
        distances.fill(crate::phantom::solid::FAR);
        for i in self.ventricles.lay(xs, y, &mut distances) {
            out[i] += (FLUID - 4.0 - out[i]) * coverage(distances[i], 2.0);
        }
    }
}

/// Fluid, then a folded band of grey matter, then white, by the depth under the skull; the falx divides the halves.
fn cerebrum(fold: f32, depth: f32, x: f32, z: f32) -> f32 {
    let shallow = 1.0 - ((depth - 9.0) / 13.0).clamp(0.0, 1.0);
    let sulcus = (1.0 - fold.abs() * 3.0).max(0.0) * shallow;
    let grey = (1.0 - (fold.abs() - 0.5).max(0.0) * 1.6).max(0.0) * shallow;
    let tissue = WHITE + (GREY - WHITE) * grey;
    let falx = if z > 48.0 { (1.0 - x.abs() / 2.5).max(0.0) } else { 0.0 };
    let fluid = sulcus.max(falx).max(1.0 - ((depth - 1.0) / 2.0).clamp(0.0, 1.0));
    tissue + (FLUID - tissue) * fluid
}
