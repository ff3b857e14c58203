//! Voxels that came painted, read in linear light (algorithm §1: compositing is linear).

use std::sync::LazyLock;

use crate::components::color::to_linear;
use crate::grid::Painted;

/// Linear intensities of 8-bit and 16-bit sRGB channels.
static LINEAR: LazyLock<[Vec<f32>; 2]> = LazyLock::new(|| {
    [255_u16, 65535].map(|most| {
        (0..=most).map(|channel| to_linear(f32::from(channel) / f32::from(most))).collect()
    })
});

impl Painted {
    /// The colour, not associated, and the opacity per opacity unit of one voxel, in linear light; panics past the end.
    ///
    /// The opacity is in 0..=1 and 0 for a NaN; colours are finite and not below 0, and 0 where they are no number.
    #[must_use]
    pub fn linear(&self, offset: usize) -> [f32; 4] {
        let [eight, sixteen] = &*LINEAR;
        match self {
            Self::U8(values) => {
                let [r, g, b, a] = values[offset];
                let [r, g, b] = [r, g, b].map(|channel| eight[usize::from(channel)]);
                [r, g, b, f32::from(a) / 255.0]
            }
            Self::U16(values) => {
                let [r, g, b, a] = values[offset];
                let [r, g, b] = [r, g, b].map(|channel| sixteen[usize::from(channel)]);
                [r, g, b, f32::from(a) / 65535.0]
            }
            Self::F32(values) => {
                let [r, g, b, a] = values[offset];
                let [r, g, b] = [r, g, b].map(|c| if c.is_finite() { c.max(0.0) } else { 0.0 });
                [r, g, b, if a > 0.0 { a.min(1.0) } else { 0.0 }]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Shared;

    #[test]
    fn integers_are_srgb_with_linear_alpha_and_floats_are_linear_and_made_safe() {
        let eight = Painted::U8(Shared::new(vec![[255, 188, 0, 51]])).linear(0);
        let sixteen = Painted::U16(Shared::new(vec![[65535, 188 * 257, 0, 13107]])).linear(0);
        for [r, g, b, a] in [eight, sixteen] {
            assert!(r == 1.0 && (g - 0.5029).abs() < 1e-4 && b == 0.0 && (a - 0.2).abs() < 1e-7);
        }
        let float = vec![[0.25, -1.0, f32::INFINITY, f32::NAN], [3.0, f32::NAN, 0.5, 7.0]];
        let float = Painted::F32(Shared::new(float));
        assert_eq!(
            [float.linear(0), float.linear(1)],
            [[0.25, 0.0, 0.0, 0.0], [3.0, 0.0, 0.5, 1.0]]
        );
    }
}
