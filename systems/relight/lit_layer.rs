//! A layer of opacities and colours under its lights: `c_T = Σ c_i β_i` (equation 4), made into gel.

use std::sync::Arc;

use fearless_simd::Simd;
use rayon::prelude::*;

use super::sent::Sent;
use crate::components::TexelKind;
use crate::light::lit_bricks::DARK;
use crate::schedule::Watch;
use crate::volume::bricks::{BrickPlace, Bricks, EDGE};
use crate::volume::gel::{BRIGHT, FAINT, Fill, Gel, GelBricks, ROW, TEXELS, Texel};
use crate::volume::interest::Interest;

/// The interesting voxels of a layer.
#[derive(Debug)]
pub(crate) struct LitLayer<'a> {
    /// α.
    opacity: &'a Bricks<f32>,
    /// c_T.
    sent: Sent<'a>,
    /// What no channel of `c_T` is above.
    brightest: f32,
    /// Gel of what is no longer waited for is left clear.
    watch: &'a Watch,
}

impl<'a> LitLayer<'a> {
    /// A layer of these opacities, which sends such light.
    #[must_use]
    pub fn new(opacity: &'a Bricks<f32>, sent: Sent<'a>, watch: &'a Watch) -> Self {
        let brightest = sent.brightest(opacity);
        Self { opacity, sent, brightest, watch }
    }

    /// The associated gel: `c_T · α` and α, and its interesting cells, which are those `before` if these are of the same opacities. `Auto` is decided by what there is.
    #[must_use]
    pub fn gel(&self, kind: TexelKind, before: Option<&Gel>) -> (GelBricks, Arc<Interest>) {
        let kind = if kind == TexelKind::Auto { self.suited() } else { kind };
        let known = before.and_then(|gel| gel.interest(self.opacity, kind));
        let interest = known.unwrap_or_else(|| Arc::new(Interest::of(self.opacity, kind)));
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
        if self.watch.check().is_err() {
            return;
        }
        let (mut sent, per_full) = (DARK, 1.0 / full);
        self.sent.fill(BrickPlace::new(brick, self.opacity.size()), opacity, &mut sent);
        for (row, (opacity, sent)) in opacity.as_chunks::<EDGE>().0.iter().zip(&sent).enumerate() {
            if opacity.iter().all(|alpha| *alpha <= 0.0) {
                continue;
            }
            let mut channels = [[0.0; EDGE], [0.0; EDGE], [0.0; EDGE], *opacity];
            for channel in 0..3 {
                for x in 0..EDGE {
                    let associated = sent[channel][x] * opacity[x] * per_full;
                    channels[channel][x] = if opacity[x] > 0.0 { associated } else { 0.0 };
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

#[cfg(test)]
mod tests {
    use glam::{Vec3, Vec4};

    use super::*;
    use crate::volume::gel::{CELLS, EMPTY};

    use crate::light::strength::{Receding, VoxelStrength};
    use crate::volume::voxel_colors::VoxelColors;

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

    fn colors(opacity: &Bricks<f32>, color: [f32; 3]) -> VoxelColors {
        opacity.map(|_, _, made| made.fill(color)).into()
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
            let base = VoxelColors::from(base);
            let sent = Sent::Made { base: &base, shadowed: Vec::new() };
            LitLayer::new(&opacity, sent, &Watch::default()).suited()
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
        let (watch, sent) = (Watch::default(), Sent::Made { base: &base, shadowed });
        let (gel, _) = LitLayer::new(&opacity, sent, &watch).gel(TexelKind::F32, None);
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
        let (watch, sent) = (Watch::default(), Sent::Made { base: &base, shadowed: Vec::new() });
        let layer = LitLayer::new(&opacity, sent, &watch);
        let (GelBricks::F32(gel), _) = layer.gel(TexelKind::F32, None) else {
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
