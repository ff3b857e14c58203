//! A layer of opacities and colours under its lights: `c_T = Σ c_i β_i` (equation 4), made into gel.

use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::components::TexelKind;
use crate::light::strength::VoxelStrength;
use crate::volume::bricks::{BrickPlace, Bricks, EDGE, VOXELS};
use crate::volume::gel::{BRIGHT, FAINT, Fill, GelBricks, ROW, TEXELS, Texel};
use crate::volume::interest::Interest;

/// Colours of the interesting voxels of a layer, and what weakens them.
#[derive(Debug)]
pub(crate) struct LitLayer<'a> {
    /// α.
    pub opacity: &'a Bricks<f32>,
    /// What no shadow weakens.
    pub base: &'a Bricks<[f32; 3]>,
    /// c_i and β_i of each light that casts a shadow; `None` is β = 1.
    pub shadowed: Vec<(&'a Bricks<[f32; 3]>, Option<&'a VoxelStrength>)>,
}

impl LitLayer<'_> {
    /// The associated gel: `c_T · α` and α. `Auto` is decided by what there is.
    #[must_use]
    pub fn gel(&self, kind: TexelKind) -> GelBricks {
        let kind = if kind == TexelKind::Auto { self.suited() } else { kind };
        let interest = Interest::of(self.opacity, kind);
        let [nx, ny, _] = interest.counts;
        let holds = |[x, y, z]: [usize; 3]| interest.holds((z * ny + y) * nx + x);
        GelBricks::make(kind, self.opacity.size(), holds, self)
    }

    /// 16-bit texels where their steps are small against the gel and none of its colours is above 1; else 32-bit ones.
    fn suited(&self) -> TexelKind {
        let bricks: Vec<_> = self.opacity.stored().collect();
        let opaque = bricks.par_iter().any(|(_, alpha)| alpha.iter().any(|alpha| *alpha > FAINT));
        let bright = |place: BrickPlace| {
            let channel =
                |bricks: &Bricks<[f32; 3]>| bricks.brick(place.brick).map_or(0.0, brightest);
            let full = |strength: Option<&VoxelStrength>| strength.map_or(1.0, VoxelStrength::most);
            let shadowed = self.shadowed.iter();
            let shadowed: f32 = shadowed.map(|(light, beta)| channel(light) * full(*beta)).sum();
            channel(self.base) + shadowed > BRIGHT
        };
        let bright = || bricks.par_iter().any(|(place, _)| bright(*place));
        if opaque && !bright() { TexelKind::U16 } else { TexelKind::F32 }
    }

    /// Fills the texels from the first on that are of some brick's voxels: of `extent` of its first ones.
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn fill_from<T: Texel>(&self, brick: [usize; 3], extent: [usize; 3], texels: &mut [T]) {
        let Some(opacity) = self.opacity.brick(brick) else { return };
        let base = self.base.brick(brick);
        for (z, y) in (0..extent[2]).flat_map(|z| (0..extent[1]).map(move |y| (z, y))) {
            let within = (z * EDGE + y) * EDGE;
            let opacity = row_of(opacity, within);
            let made = &mut texels[(z * ROW + y) * ROW..][..extent[0]];
            if opacity[..made.len()].iter().all(|alpha| *alpha <= 0.0) {
                continue;
            }
            let mut colors = base.map_or([[0.0; 3]; EDGE], |base| *row_of(base, within));
            for (light, strength) in &self.shadowed {
                let Some(light) = light.brick(brick) else { continue };
                let betas = betas(*strength, brick, within);
                for ((color, light), beta) in
                    colors.iter_mut().zip(row_of(light, within)).zip(betas)
                {
                    *color = (Vec3::from(*color) + Vec3::from(*light) * beta).to_array();
                }
            }
            for ((texel, [r, g, b]), &a) in made.iter_mut().zip(colors).zip(opacity) {
                *texel = T::store(Vec4::new(r * a, g * a, b * a, a));
            }
        }
    }
}

impl Fill for LitLayer<'_> {
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn fill<T: Texel>(&self, _: [usize; 3], brick: [usize; 3], texels: &mut [T; TEXELS]) {
        // Its own voxels, then the first plane, line or voxel of each brick after it; what a brick has outside the grid is clear.
        let counts = self.opacity.counts();
        for corner in 0..8_usize {
            let after: [usize; 3] = std::array::from_fn(|axis| corner >> axis & 1);
            let from: [usize; 3] = std::array::from_fn(|axis| brick[axis] + after[axis]);
            if (0..3).all(|axis| from[axis] < counts[axis]) {
                let extent = after.map(|after| if after == 1 { 1 } else { EDGE });
                let [x, y, z] = after.map(|after| after * EDGE);
                self.fill_from(from, extent, &mut texels[(z * ROW + y) * ROW + x..]);
            }
        }
    }
}

/// The row of a brick's voxels that begins with the one at `within`.
#[inline]
fn row_of<T>(brick: &[T; VOXELS], within: usize) -> &[T; EDGE] {
    &brick.as_chunks().0[within / EDGE]
}

/// The greatest channel of a brick's colours, at least 0.
fn brightest(colors: &[[f32; 3]; VOXELS]) -> f32 {
    // Eight at a time, so that they are compared in lanes.
    let eights = colors.as_flattened().chunks_exact(8);
    let most = eights.fold([0.0; 8], |most: [f32; 8], eight| {
        std::array::from_fn(|i| if eight[i] > most[i] { eight[i] } else { most[i] })
    });
    most.into_iter().fold(0.0, f32::max)
}

/// β of eight voxels of `brick` from `within` on: 1 without a buffer, 0 where the buffer stores nothing.
fn betas(strength: Option<&VoxelStrength>, brick: [usize; 3], within: usize) -> [f32; EDGE] {
    let Some(strength) = strength else { return [1.0; EDGE] };
    let Some(stored) = strength.voxels.brick(brick) else { return [0.0; EDGE] };
    let [x, y, z] = brick.map(|brick| brick * EDGE);
    let [y, z] = [y + within / EDGE % EDGE, z + within / (EDGE * EDGE)];
    std::array::from_fn(|at| strength.beta(stored[within + at], [x + at, y, z]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::gel::{CELLS, EMPTY};

    use crate::light::strength::Receding;

    const SIZE: [usize; 3] = [20, 17, 10];

    fn alpha([x, y, z]: [usize; 3]) -> f32 {
        if x + y + z < 13 || [x, y, z] == [16, 16, 8] { 0.25 + x as f32 / 64.0 } else { 0.0 }
    }

    fn opacity() -> Bricks<f32> {
        Bricks::make(SIZE, |place, brick| {
            place.voxels().for_each(|(at, voxel)| brick[at] = alpha(voxel));
            brick.iter().any(|alpha| *alpha > 0.0)
        })
    }

    fn colors(opacity: &Bricks<f32>, color: [f32; 3]) -> Bricks<[f32; 3]> {
        opacity.map(|_, _, made| made.fill(color))
    }

    fn texel(gel: &GelBricks, voxel: [usize; 3]) -> Option<Vec4> {
        let GelBricks::F32(texels) = gel else { panic!("32-bit gel was asked for") };
        let [nx, ny, _] = texels.counts();
        let [x, y, z] = voxel.map(|n| n / CELLS);
        let brick = texels.table()[(z * ny + y) * nx + x];
        (brick != EMPTY)
            .then(|| texels.slices().sample(brick, voxel.map(|n| n % CELLS), Vec3::ZERO))
    }

    #[test]
    fn texels_are_16_bit_for_gel_that_is_opaque_somewhere_and_lit_within_1() {
        let kind = |alpha: f32, light: f32| {
            let opacity = Bricks::make(SIZE, |_, brick| {
                brick.fill(alpha);
                true
            });
            let base = Bricks::make(SIZE, |_, brick| {
                brick.fill([light, 0.5, 0.0]);
                true
            });
            LitLayer { opacity: &opacity, base: &base, shadowed: Vec::new() }.suited()
        };
        assert_eq!(kind(0.5, 1.0), TexelKind::U16);
        assert_eq!([kind(0.05, 1.0), kind(0.5, 1.5)], [TexelKind::F32; 2]);
    }

    #[test]
    fn colors_are_weakened_summed_and_associated() {
        let opacity = opacity();
        let [base, first, second] = [[0.1, 0.2, 0.3], [0.4, 0.0, 0.0], [0.0, 0.0, 0.5]]
            .map(|color| colors(&opacity, color));
        let half = opacity.map(|_, _, made| made.fill(32768));
        let strength = VoxelStrength { voxels: half, full: 0.5, receding: Receding::NONE };
        let shadowed = vec![(&first, Some(&strength)), (&second, None)];
        let gel = LitLayer { opacity: &opacity, base: &base, shadowed }.gel(TexelKind::F32);
        let beta = 32768.0 / 65535.0 * 0.5;
        for (x, y, z) in (0..3400).map(|i| (i % 20, i / 20 % 17, i / 340)) {
            let alpha = alpha([x, y, z]);
            let expected = Vec4::new(0.1 + 0.4 * beta, 0.2, 0.8, 1.0) * alpha;
            let made = texel(&gel, [x, y, z]);
            assert!(made.unwrap_or_default().abs_diff_eq(expected, 1e-6), "{x} {y} {z}: {made:?}");
        }
    }

    #[test]
    fn a_brick_is_held_exactly_if_one_of_its_nine_cubed_voxels_is_interesting() {
        let opacity = opacity();
        let base = colors(&opacity, [1.0; 3]);
        let lit_layer = LitLayer { opacity: &opacity, base: &base, shadowed: Vec::new() };
        let GelBricks::F32(gel) = lit_layer.gel(TexelKind::F32) else { panic!("as asked for") };
        let mut held = 0;
        for brick in (0..18).map(|i| [i % 3, i / 3 % 3, i / 9]) {
            let expected = (0..729).map(|i| [i % 9, i / 9 % 9, i / 81]).any(|step| {
                let voxel: [usize; 3] = std::array::from_fn(|a| brick[a] * CELLS + step[a]);
                (0..3).all(|a| voxel[a] < SIZE[a]) && alpha(voxel) > 0.0
            });
            let stored = gel.table()[(brick[2] * 3 + brick[1]) * 3 + brick[0]] != EMPTY;
            assert_eq!(stored, expected, "{brick:?}");
            held += usize::from(expected);
        }
        assert!((1..18).contains(&held));
    }
}
