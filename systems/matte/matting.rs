//! The matting operators at one voxel: Porter and Duff's algebra, held to where the polygon is (paper §3, algorithm §8).
//!
//! Drebin, Carpenter and Hanrahan matte whole volumes. Taken so, `in` and `out` would leave nothing of the volume away
//! from the polygon, and nobody who puts a polygon in a scene means that. So an operator acts where the polygon is: with
//! f, the part of the voxel that the polygon takes up, C = f · (polygon op volume) + (1 − f) · volume. For `over`,
//! `under` and `atop` that is Porter and Duff's formula itself, whatever f is. For `in` and `out` it is theirs where
//! f = 1 and the volume alone where f = 0, with an edge between that is as smooth as the polygon's own: a hard one at
//! α_G > 0 would cut stairs into the volume.

use crate::components::Matte;

/// What a voxel's composite opacity consists of: the polygon's part and the volume's. α_C is their sum, in 0..=1, and
/// c_C the mean of the colours by these weights.
///
/// `polygon` is α_G and `volume` α_V, in 0..=1. `footprint` is f, in `polygon`..=1.
#[must_use]
#[inline]
pub fn weights(matte: Matte, polygon: f32, volume: f32, footprint: f32) -> [f32; 2] {
    match matte {
        Matte::Over => [polygon, volume * (1.0 - polygon)],
        Matte::Under => [polygon * (1.0 - volume), volume],
        Matte::In => [polygon * volume, volume * (1.0 - footprint)],
        Matte::Out => [polygon * (1.0 - volume), volume * (1.0 - footprint)],
        Matte::Atop => [polygon * volume, volume * (1.0 - polygon)],
    }
}

/// f: the part of a voxel that a polygon takes up, from α_G and what α_G is where the polygon is wholly there.
#[must_use]
#[inline]
pub fn footprint(polygon: f32, peak: f32) -> f32 {
    if polygon >= peak { 1.0 } else { (polygon / peak).max(polygon) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Matte; 5] = [Matte::Over, Matte::Under, Matte::In, Matte::Out, Matte::Atop];

    #[test]
    fn whole_polygons_matte_by_porter_and_duff_and_absent_ones_leave_the_volume() {
        for (g, v) in (0..=16).flat_map(|g| (0..=16).map(move |v| (g, v))) {
            let (g, v) = (g as f32 / 16.0, v as f32 / 16.0);
            // F_G and F_V of Porter and Duff 1984: C = F_G C_G + F_V C_V of associated colours.
            let factors = [(1.0, 1.0 - g), (1.0 - v, 1.0), (v, 0.0), (1.0 - v, 0.0), (v, 1.0 - g)];
            for (matte, (of_polygon, of_volume)) in ALL.into_iter().zip(factors) {
                assert_eq!(weights(matte, g, v, 1.0), [of_polygon * g, of_volume * v], "{matte:?}");
                assert_eq!(weights(matte, 0.0, v, 0.0), [0.0, v], "{matte:?}");
            }
        }
    }

    #[test]
    fn an_operator_at_part_of_a_voxel_is_the_operator_and_the_volume_mixed_by_that_part() {
        for (matte, f) in ALL.into_iter().flat_map(|m| (0..=8).map(move |f| (m, f as f32 / 8.0))) {
            let (stated, volume) = (0.75, 0.5);
            let whole = weights(matte, stated, volume, 1.0);
            let mixed = [f * whole[0], f * whole[1] + (1.0 - f) * volume];
            assert_eq!(weights(matte, f * stated, volume, f), mixed, "{matte:?} {f}");
        }
    }

    #[test]
    fn opacities_stay_in_range_at_the_extremes() {
        let extremes = [0.0, 1e-9, 1e-7, 0.3, 1.0 - f32::EPSILON / 2.0, 1.0];
        for (g, v) in extremes.into_iter().flat_map(|g| extremes.map(|v| (g, v))) {
            for (matte, peak) in ALL.into_iter().flat_map(|m| extremes.map(|peak| (m, peak))) {
                let f = footprint(g, peak);
                let [polygon, volume] = weights(matte, g, v, f);
                assert!((g..=1.0).contains(&f) && polygon >= 0.0 && volume >= 0.0);
                assert!(polygon + volume <= 1.0 + f32::EPSILON, "{matte:?} {g} {v} {f}");
            }
        }
    }
}
