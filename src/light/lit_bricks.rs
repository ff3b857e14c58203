//! Voxels under their lights, brick by brick: `c_i` of equation 4, and its sum `Σ c_i β_i`.

use std::sync::Arc;

use fearless_simd::{Level, dispatch};
use glam::Vec4;

use super::shading::{Lamp, Reflectance};
use super::side_by_side::{self, Lighting, Vectors};
use super::strength::VoxelStrength;
use super::unlit::{Unlit, brightest_color, most_reflected};
use crate::volume::bricks::{BrickPlace, Bricks, EDGE, VOXELS};
use crate::volume::classification::Classifier;
use crate::volume::clipping::Cut;
use crate::volume::gradients::Gradients;
use crate::volume::grid::Scalar;
use crate::volume::voxel_colors::{BrickColors, ColorSource};
use crate::with_scalars;

/// Voxels under a cut that are shaded by its normal alone: those between which the opacity rises, and the next.
const CUT_DEEP: f64 = 1.5;

/// A vector at every voxel of a row.
type Row = Vectors<EDGE>;

/// What the voxels of a brick send, row by row along x, y before z: linear light, not associated. Rows without a voxel that is
/// seen are left as they are, and what stands for a voxel that is clear means nothing.
pub(crate) type Rows = [Row; EDGE * EDGE];

/// No light in any row.
pub(crate) const DARK: Rows = [[[0.0; EDGE]; 3]; EDGE * EDGE];

/// A light that casts a shadow, and what is left of it; `None` is β = 1.
#[derive(Debug, Clone)]
struct Shadowed {
    lamp: Lamp,
    strength: Option<VoxelStrength>,
}

/// The voxels of a volume under some of its lights.
#[derive(Debug)]
pub(crate) struct LitBricks {
    unlit: Arc<Unlit>,
    classifier: Classifier,
    gradients: Gradients,
    cut: Option<Cut>,
    level: Level,
    how: Reflectance,
    /// Of its color, what a voxel sends whatever falls on it.
    ambient: f32,
    /// Lights that nothing weakens.
    plain: Vec<Lamp>,
    /// Those that something may.
    shadowed: Vec<Shadowed>,
}

impl LitBricks {
    /// Under the lights that cast no shadow, and ambient light unless that is kept apart.
    #[must_use]
    pub fn base(unlit: &Arc<Unlit>) -> Self {
        let ambient = if unlit.apart { 0.0 } else { unlit.material.ambient };
        Self::new(unlit, ambient, unlit.lamps.plain.clone())
    }

    /// Under each light that casts a shadow, as if it cast none.
    #[must_use]
    pub fn unshadowed(unlit: &Arc<Unlit>) -> Vec<Self> {
        let lamps = unlit.lamps.shadowed.iter();
        lamps.map(|(_, lamp)| Self::new(unlit, 0.0, vec![*lamp])).collect()
    }

    /// Under ambient light alone, where that is kept apart.
    #[must_use]
    pub fn ambient(unlit: &Arc<Unlit>) -> Option<Self> {
        unlit.apart.then(|| Self::new(unlit, unlit.material.ambient, Vec::new()))
    }

    /// Under all lights, each as strong as it still is, with ambient light as in [`base`](Self::base); `strengths` of those
    /// that cast shadows are in the order of the scene, and `None` is β = 1.
    #[must_use]
    pub fn shadowed(unlit: &Arc<Unlit>, strengths: &[Option<VoxelStrength>]) -> Self {
        let strength = |at: usize| strengths.get(at).cloned().flatten();
        let shadowed = unlit.lamps.shadowed.iter().enumerate();
        let shadowed =
            shadowed.map(|(at, (_, lamp))| Shadowed { lamp: *lamp, strength: strength(at) });
        Self { shadowed: shadowed.collect(), ..Self::base(unlit) }
    }

    fn new(unlit: &Arc<Unlit>, ambient: f32, plain: Vec<Lamp>) -> Self {
        Self {
            classifier: Classifier::new(&unlit.classify, &unlit.material, unlit.unit.0),
            gradients: Gradients::new(&unlit.grid),
            cut: unlit.clip.as_ref().map(|clip| Cut::new(clip, &unlit.grid)),
            level: Level::new(),
            how: Reflectance::from(&unlit.material),
            unlit: Arc::clone(unlit),
            ambient,
            plain,
            shadowed: Vec::new(),
        }
    }

    /// What no channel of any voxel is above.
    #[must_use]
    pub fn brightest(&self) -> f32 {
        let Unlit { classify, material, tint, .. } = &*self.unlit;
        let plain = self.plain.iter().map(|lamp| most_reflected(lamp, &self.how));
        let shadowed = self.shadowed.iter().map(|light| {
            let strength = light.strength.as_ref().map_or(1.0, VoxelStrength::most);
            most_reflected(&light.lamp, &self.how) * strength
        });
        let lights = self.ambient + plain.chain(shadowed).sum::<f32>();
        brightest_color(classify, material, tint.as_ref()) * lights
    }

    /// α_V of the volume.
    #[must_use]
    pub fn opacity(&self) -> &Bricks<f32> {
        &self.unlit.opacity.voxels
    }

    /// Lights the voxels of the brick at `place` that have an opacity `alpha` above 0.
    pub fn light(&self, place: BrickPlace, alpha: &[f32; VOXELS], lit: &mut Rows) {
        with_scalars!(&self.unlit.scalars, values => {
            dispatch!(self.level, _simd => self.rows(values, (place, alpha), lit));
        });
    }

    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn rows<T: Scalar>(
        &self,
        values: &[T],
        (place, alpha): (BrickPlace, &[f32; VOXELS]),
        lit: &mut Rows,
    ) {
        let ([x, y, z], n) = (place.first, place.extent[0]);
        // From a voxel under that layer on no normal is turned.
        let shallow = |cut: &&Cut| !cut.is_deeper(place.first, place.extent, CUT_DEEP + 1.0);
        let cut = self.cut.as_ref().filter(shallow);
        let plain = Lighting { ambient: self.ambient, lamps: &self.plain, how: self.how };
        let rows = alpha.as_chunks::<EDGE>().0.iter().zip(lit);
        for (row, (alpha, lit)) in rows.enumerate() {
            if alpha.iter().all(|alpha| *alpha <= 0.0) {
                continue;
            }
            let first = [x, y + row % EDGE, z + row / EDGE];
            let gradients = self.gradients.side_by_side(values, first, n);
            let mut normals = side_by_side::normals(&gradients);
            if let Some(cut) = cut {
                for at in 0..n {
                    let section = cut.under([x + at, first[1], first[2]]);
                    let normal = section.turned(side_by_side::one(&normals, at), CUT_DEEP);
                    side_by_side::set(&mut normals, at, normal);
                }
            }
            let from = self.unlit.grid.offset(first);
            let colors = self.colors(&values[from..][..n], &gradients, from);
            *lit = plain.sent(&colors, &normals);
            for light in &self.shadowed {
                let lamps = std::slice::from_ref(&light.lamp);
                let alone = Lighting { ambient: 0.0, lamps, how: self.how };
                add(
                    lit,
                    &alone.sent(&colors, &normals),
                    VoxelStrength::row(light.strength.as_ref(), place.brick, row),
                );
            }
        }
    }

    /// c_p of the voxels of a row, tinted; `from` is the place of its first one.
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn colors<T: Scalar>(&self, values: &[T], gradients: &Row, from: usize) -> Row {
        let tint = self.unlit.tint.as_ref();
        if let (Some(color), None) = (self.classifier.only_color(), tint) {
            return side_by_side::all(color);
        }
        let mut colors = [[0.0; EDGE]; 3];
        for (at, value) in values.iter().enumerate() {
            let gradient = side_by_side::one(gradients, at).to_array();
            let color = self.classifier.color(value.value(), gradient);
            let tint = tint.map_or(Vec4::ZERO, |tint| tint.colors[from + at]);
            let tinted = if tint.w == 0.0 { color } else { color.lerp(tint.truncate(), tint.w) };
            side_by_side::set(&mut colors, at, tinted);
        }
        colors
    }
}

impl ColorSource for LitBricks {
    fn fill(&self, place: BrickPlace, colors: &mut BrickColors) -> bool {
        let Some(alpha) = self.opacity().brick(place.brick) else { return false };
        let mut lit = DARK;
        self.light(place, alpha, &mut lit);
        for (at, color) in colors.iter_mut().enumerate() {
            let own = side_by_side::one(&lit[at / EDGE], at % EDGE).to_array();
            *color = if alpha[at] > 0.0 { own } else { [0.0; 3] };
        }
        true
    }

    fn brightest(&self, place: BrickPlace) -> f32 {
        self.opacity().brick(place.brick).map_or(0.0, |_| Self::brightest(self))
    }

    fn bytes(&self) -> u64 {
        0
    }
}

/// Adds light that is weakened voxel by voxel.
#[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
#[inline(always)]
pub(crate) fn add(sum: &mut Row, light: &Row, betas: [f32; EDGE]) {
    for channel in 0..3 {
        for at in 0..EDGE {
            sum[channel][at] += light[channel][at] * betas[at];
        }
    }
}
