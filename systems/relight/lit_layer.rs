//! A layer of opacities and colours under its lights: `c_T = Σ c_i β_i` (equation 4), made into gel.

use fearless_simd::Simd;
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
    /// What no channel of `c_T` is above.
    pub brightest: f32,
}

impl<'a> LitLayer<'a> {
    /// A layer of which no channel of `c_T` is above `known`, if that is known; else as near as can be told brick by brick.
    #[must_use]
    pub fn new(
        opacity: &'a Bricks<f32>,
        base: &'a Bricks<[f32; 3]>,
        shadowed: Vec<(&'a Bricks<[f32; 3]>, Option<&'a VoxelStrength>)>,
        known: Option<f32>,
    ) -> Self {
        let layer = Self { opacity, base, shadowed, brightest: f32::INFINITY };
        Self { brightest: known.unwrap_or_else(|| layer.measured()), ..layer }
    }

    /// The associated gel: `c_T · α` and α, and its interesting cells. `Auto` is decided by what there is.
    #[must_use]
    pub fn gel(&self, kind: TexelKind) -> (GelBricks, Interest) {
        let kind = if kind == TexelKind::Auto { self.suited() } else { kind };
        let interest = Interest::of(self.opacity, kind);
        (self.in_cells(&interest, kind), interest)
    }

    /// The gel where some cells are interesting, in numbers of `kind`.
    #[must_use]
    pub fn in_cells(&self, interest: &Interest, kind: TexelKind) -> GelBricks {
        let [nx, ny, _] = interest.counts;
        let holds = |[x, y, z]: [usize; 3]| interest.holds((z * ny + y) * nx + x);
        GelBricks::make(kind, self.opacity.size(), holds, self)
    }

    /// 16-bit texels where their steps are small against the gel, which is opaque somewhere and nowhere very bright; else 32-bit
    /// ones.
    fn suited(&self) -> TexelKind {
        let bricks: Vec<_> = self.opacity.stored().collect();
        let opaque =
            || bricks.par_iter().any(|(_, alpha)| alpha.iter().any(|alpha| *alpha > FAINT));
        if self.brightest <= BRIGHT && opaque() { TexelKind::U16 } else { TexelKind::F32 }
    }

    /// The sum over the lights of the brightest channels of any brick.
    fn measured(&self) -> f32 {
        let bricks: Vec<_> = self.opacity.stored().map(|(place, _)| place).collect();
        let most = |place: &BrickPlace| {
            let channel =
                |bricks: &Bricks<[f32; 3]>| bricks.brick(place.brick).map_or(0.0, brightest);
            let full = |strength: Option<&VoxelStrength>| strength.map_or(1.0, VoxelStrength::most);
            let shadowed = self.shadowed.iter();
            let shadowed: f32 = shadowed.map(|(light, beta)| channel(light) * full(*beta)).sum();
            channel(self.base) + shadowed
        };
        bricks.par_iter().map(most).reduce(|| 0.0, f32::max)
    }
}

impl Fill for LitLayer<'_> {
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn fill<S: Simd, T: Texel>(
        &self,
        simd: S,
        (_, brick): ([usize; 3], [usize; 3]),
        full: f32,
        texels: &mut [T; TEXELS],
    ) {
        let Some(opacity) = self.opacity.brick(brick) else { return };
        let (base, per_full) = (self.base.brick(brick), 1.0 / full);
        for (row, opacity) in opacity.as_chunks::<EDGE>().0.iter().enumerate() {
            if opacity.iter().all(|alpha| *alpha <= 0.0) {
                continue;
            }
            let within = row * EDGE;
            let mut colors = base.map_or([[0.0; 3]; EDGE], |base| base.as_chunks().0[row]);
            for (light, strength) in &self.shadowed {
                let Some(light) = light.brick(brick) else { continue };
                let betas = betas(*strength, brick, within);
                for x in 0..EDGE {
                    for channel in 0..3 {
                        colors[x][channel] += light[within + x][channel] * betas[x];
                    }
                }
            }
            let mut channels = [[0.0; EDGE], [0.0; EDGE], [0.0; EDGE], *opacity];
            for x in 0..EDGE {
                for channel in 0..3 {
                    channels[channel][x] = colors[x][channel] * opacity[x] * per_full;
                }
            }
            let made = &mut texels[(row / EDGE * ROW + row % EDGE) * ROW..][..EDGE];
            made.copy_from_slice(&T::store_row(simd, &channels));
        }
    }

    fn brightest(&self) -> f32 {
        self.brightest.max(1.0)
    }
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
    use glam::{Vec3, Vec4};

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
    fn texels_are_16_bit_for_gel_that_is_opaque_somewhere_and_not_very_bright() {
        let kind = |alpha: f32, light: f32| {
            let opacity = Bricks::make(SIZE, |_, brick| {
                brick.fill(alpha);
                true
            });
            let base = Bricks::make(SIZE, |_, brick| {
                brick.fill([light, 0.5, 0.0]);
                true
            });
            LitLayer { opacity: &opacity, base: &base, shadowed: Vec::new(), brightest: light }
                .suited()
        };
        assert_eq!(kind(0.5, 1.0), TexelKind::U16);
        assert_eq!(kind(0.5, 3.9), TexelKind::U16);
        assert_eq!([kind(0.05, 1.0), kind(0.5, 4.1)], [TexelKind::F32; 2]);
    }

    #[test]
    fn colors_are_weakened_summed_and_associated() {
        let opacity = opacity();
        let [base, first, second] = [[0.1, 0.2, 0.3], [0.4, 0.0, 0.0], [0.0, 0.0, 0.5]]
            .map(|color| colors(&opacity, color));
        let half = opacity.map(|_, _, made| made.fill(32768));
        let strength = VoxelStrength { voxels: half, full: 0.5, receding: Receding::NONE };
        let shadowed = vec![(&first, Some(&strength)), (&second, None)];
        let gel = LitLayer { opacity: &opacity, base: &base, shadowed, brightest: 1.0 };
        let (gel, _) = gel.gel(TexelKind::F32);
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
        let shadowed = Vec::new();
        let lit_layer = LitLayer { opacity: &opacity, base: &base, shadowed, brightest: 1.0 };
        let (GelBricks::F32(gel), _) = lit_layer.gel(TexelKind::F32) else {
            panic!("as asked for")
        };
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
