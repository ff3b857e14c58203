//! Compositing: slabs, slivers and the operator `over` (TR88-052 equations 1, 2a and 2b).

use glam::DVec3;

use super::powers::one_minus_power;

/// The opacity of a slab `ratio` times as thick as one of opacity `opacity`:
/// `1 − (1 − opacity)^ratio`, TR88-052 equations (2a) and (2b).
///
/// `opacity` is in 0..=1 and `ratio` in 0..; the result is in 0..=1 and exact at ratios 0 and 1. An opacity of 1 stays
/// opaque at every thickness above 0. Written with `ln (1 − α)` and `e^y − 1`: the direct form loses every digit of opacities
/// under 1e-7. The parts of a split slab composite to the whole to within 2 ulp of 1.
#[must_use]
#[inline]
pub fn thicken(opacity: f64, ratio: f64) -> f64 {
    if ratio == 1.0 {
        opacity
    } else if ratio == 0.5 {
        // Interpolation may leave an opacity a hair above 1.
        opacity / (1.0 + (1.0 - opacity).max(0.0).sqrt())
    } else if ratio == 2.0 {
        opacity * (2.0 - opacity)
    } else if ratio <= 0.0 {
        0.0
    } else if opacity >= 1.0 {
        1.0
    } else {
        power_alone(opacity, ratio)
    }
}

/// A power where few are taken: apart, so that what takes none is short.
#[inline(never)]
fn power_alone(opacity: f64, ratio: f64) -> f64 {
    one_minus_power(opacity, ratio)
}

/// Whether [`thicken`] by that takes no power.
#[must_use]
#[inline]
pub(crate) fn is_simple(ratio: f64) -> bool {
    ratio == 1.0 || ratio == 0.5 || ratio == 2.0 || ratio <= 0.0
}

/// Several slabs side by side, each as [`thicken`] makes it alone.
#[allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]
#[must_use]
#[inline(always)]
pub(crate) fn thicken_each<const N: usize>(opacities: &[f64; N], ratios: &[f64; N]) -> [f64; N] {
    let mut made = [0.0; N];
    let (mut any_simple, mut all_simple) = (false, true);
    for ratio in ratios {
        any_simple |= is_simple(*ratio);
        all_simple &= is_simple(*ratio);
    }
    if !all_simple {
        for at in 0..N {
            let power = one_minus_power(opacities[at], ratios[at]);
            made[at] = if opacities[at] >= 1.0 { 1.0 } else { power };
        }
    }
    if any_simple {
        for at in (0..N).filter(|&at| is_simple(ratios[at])) {
            made[at] = thicken(opacities[at], ratios[at]);
        }
    }
    made
}

/// What the associated colour of a slab is multiplied by as its opacity goes from `opacity` to `thickened`:
/// `thickened / opacity`, and its limit `ratio` as the opacity goes to 0.
#[must_use]
#[inline]
pub(crate) fn recolor(opacity: f64, thickened: f64, ratio: f64) -> f64 {
    if opacity > 0.0 { thickened / opacity } else { ratio }
}

/// The slab in which several gels overlap, each given by its associated colour and opacity: optical depths `−ln (1 − α)`
/// add, and colours weigh by them.
///
/// Opacities are in 0..=1. Of gels with opacity 1 only those are seen, alike; one without opacity adds nothing, but for its
/// colour's limit. The parts come back sorted, so that no bit of the result depends on their order; one part is itself.
#[must_use]
pub fn overlap(parts: &mut [(DVec3, f64)]) -> (DVec3, f64) {
    if let [only] = parts {
        return *only;
    }
    let key = |(color, opacity): &(DVec3, f64)| [*opacity, color.x, color.y, color.z];
    parts.sort_unstable_by(|a, b| {
        let channels = key(a).into_iter().zip(key(b));
        channels.fold(std::cmp::Ordering::Equal, |order, (a, b)| order.then(a.total_cmp(&b)))
    });
    let opaque = parts.iter().filter(|(_, opacity)| *opacity >= 1.0).count();
    if opaque > 0 {
        let sum: DVec3 = parts[parts.len() - opaque..].iter().map(|(color, _)| *color).sum();
        return (sum / opaque as f64, 1.0);
    }
    let (mut color, mut depth) = (DVec3::ZERO, 0.0);
    for &(associated, opacity) in &*parts {
        let own = -libm::log1p(-opacity);
        color += associated * if opacity > 0.0 { own / opacity } else { 1.0 };
        depth += own;
    }
    let opacity = -libm::expm1(-depth);
    (color * if depth > 0.0 { opacity / depth } else { 1.0 }, opacity)
}

/// What a ray has gathered so far, front to back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gathered {
    /// Associated colour.
    pub color: DVec3,
    /// What still comes through of what lies behind: 1 − α, in 0..=1.
    pub through: f64,
}

impl Gathered {
    /// Nothing yet.
    pub const NOTHING: Self = Self { color: DVec3::ZERO, through: 1.0 };

    /// Puts something of associated colour `color` and opacity `opacity` behind what there is.
    #[inline]
    pub fn under(&mut self, color: DVec3, opacity: f64) {
        self.color += self.through * color;
        self.through *= 1.0 - opacity;
    }

    /// α, in 0..=1.
    #[must_use]
    #[inline]
    pub fn opacity(&self) -> f64 {
        1.0 - self.through
    }

    /// Associated RGBA. A ray that was stopped (`through` at or under `stop_at`, both above 0) is taken as opaque: the
    /// colour gathered so far stands for the rest too. No channel changes by more than `stop_at` for colours in 0..=α.
    #[must_use]
    pub fn rgba(&self, stop_at: f64) -> [f32; 4] {
        if self.through <= stop_at && self.through > 0.0 {
            let [r, g, b] = (self.color / self.opacity()).to_array();
            return [r as f32, g as f32, b as f32, 1.0];
        }
        let [r, g, b] = self.color.to_array();
        [r as f32, g as f32, b as f32, self.opacity() as f32]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// §10 of the algorithm: from clear to opaque by way of the last f32 before 1.
    const OPACITIES: [f64; 9] =
        [0.0, 1e-9, 1e-7, 1e-3, 0.25, 0.5, 0.999, 1.0 - 1.0 / 16_777_216.0, 1.0];

    #[test]
    fn a_slab_split_anywhere_composites_to_the_whole() {
        for opacity in OPACITIES {
            for place in 0..=64 {
                let part = f64::from(place) / 64.0;
                let mut split = Gathered::NOTHING;
                for ratio in [part, 1.0 - part] {
                    let sliver = thicken(opacity, ratio);
                    split.under(DVec3::splat(recolor(opacity, sliver, ratio) * opacity), sliver);
                }
                assert!(
                    (split.opacity() - opacity).abs() <= 2.0 * f64::EPSILON,
                    "{opacity} {part}"
                );
                assert!((split.color.x - opacity).abs() <= 2.0 * f64::EPSILON, "{opacity} {part}");
            }
        }
    }

    #[test]
    fn a_slab_split_by_up_to_eight_polygons_composites_to_the_whole() {
        for opacity in OPACITIES {
            for polygons in 1..=8_u32 {
                let mut split = Gathered::NOTHING;
                let mut last = 0.0;
                for j in 1..=polygons + 1 {
                    // Uneven places, the first two coincident.
                    let place =
                        if j > polygons { 1.0 } else { f64::from(j.max(2) - 1).sqrt() / 3.0 };
                    split.under(DVec3::ZERO, thicken(opacity, place - last));
                    last = place;
                }
                assert!(
                    (split.opacity() - opacity).abs() <= 2.0 * f64::EPSILON,
                    "{opacity} {polygons}"
                );
            }
        }
    }

    #[test]
    fn slivers_of_every_thickness_are_finite_and_in_range() {
        for opacity in OPACITIES {
            for ratio in [0.0, 1e-9, 1e-6, 1.0 - f64::EPSILON, 1.0, 1.0 + 1e-9, 1e3] {
                let sliver = thicken(opacity, ratio);
                assert!((0.0..=1.0).contains(&sliver), "{opacity} {ratio} {sliver}");
                assert!(recolor(opacity, sliver, ratio).is_finite());
            }
        }
        assert_eq!([thicken(1.0, 0.0), thicken(1.0, 1e-300)], [0.0, 1.0]);
    }

    #[test]
    fn the_special_thicknesses_agree_with_the_general_one() {
        for opacity in OPACITIES.into_iter().filter(|&o| o < 1.0) {
            for ratio in [0.5, 2.0] {
                let general = -libm::expm1(ratio * libm::log1p(-opacity));
                assert!((thicken(opacity, ratio) - general).abs() <= 2.0 * f64::EPSILON);
            }
        }
    }

    #[test]
    fn slabs_side_by_side_are_as_thick_as_each_alone() {
        for ratio in [1e-6, 0.3, 0.5, 0.7, 1.0, 2.0, 37.0] {
            let ratios = std::array::from_fn(|n| if n % 4 == 3 { 0.5 } else { ratio });
            let made = thicken_each(&OPACITIES, &ratios);
            let alone = std::array::from_fn(|n| thicken(OPACITIES[n], ratios[n]));
            assert_eq!(made.map(f64::to_bits), alone.map(f64::to_bits));
        }
    }

    #[test]
    fn a_million_faint_layers_keep_every_digit() {
        let (faint, layers) = (1e-7, 1_000_000);
        let mut ray = Gathered::NOTHING;
        (0..layers).for_each(|_| ray.under(DVec3::splat(faint), faint));
        let expected = thicken(faint, f64::from(layers));
        assert!((ray.opacity() - expected).abs() < 1e-9);
        assert!((ray.color.x - expected).abs() < 1e-9);
    }

    #[test]
    fn overlapping_gels_add_their_optical_depths_and_weigh_their_colors_by_them() {
        for (a, b) in OPACITIES.into_iter().flat_map(|a| OPACITIES.map(|b| (a, b))) {
            let (red, blue) = (DVec3::X * a, DVec3::Z * b);
            let (color, opacity) = overlap(&mut [(red, a), (blue, b)]);
            assert!(
                (opacity - (1.0 - (1.0 - a) * (1.0 - b))).abs() <= 4.0 * f64::EPSILON,
                "{a} {b}"
            );
            assert_eq!(overlap(&mut [(blue, b), (red, a)]), (color, opacity));
            assert!((color.x + color.z - opacity).abs() <= 4.0 * f64::EPSILON, "{a} {b} {color}");
            if a == b && a > 0.0 {
                assert_eq!(color.x, color.z);
            }
        }
        assert_eq!(overlap(&mut [(DVec3::X, 1.0), (DVec3::Y * 0.5, 0.5)]), (DVec3::X, 1.0));
    }

    #[test]
    fn a_gel_in_two_halves_of_its_optical_depth_overlaps_to_the_whole_in_any_order() {
        for opacity in OPACITIES {
            let color = DVec3::new(0.9, 0.4, 0.0) * opacity;
            let parts = [0.5, 0.3, 0.2].map(|part| {
                let thin = thicken(opacity, part);
                (color * recolor(opacity, thin, part), thin)
            });
            let mut orders = [[0, 1, 2], [2, 1, 0], [1, 2, 0]].map(|order| order.map(|i| parts[i]));
            let wholes = orders.each_mut().map(|parts| overlap(parts));
            assert!(wholes.iter().all(|whole| *whole == wholes[0]));
            assert!((wholes[0].1 - opacity).abs() <= 4.0 * f64::EPSILON, "{opacity}");
            assert!(wholes[0].0.distance(color) <= 8.0 * f64::EPSILON, "{opacity}");
        }
    }

    #[test]
    fn a_stopped_ray_is_off_by_no_more_than_where_it_stopped() {
        let mut ray = Gathered::NOTHING;
        ray.under(DVec3::new(0.9, 0.5, 0.0), 0.985);
        let [r, g, b, a] = ray.rgba(0.02).map(f64::from);
        for (channel, least) in [(r, 0.9), (g, 0.5), (b, 0.0)] {
            assert!((least - 1e-6..=least + 0.02).contains(&channel));
        }
        assert_eq!(a, 1.0);
        assert_eq!(ray.rgba(0.0)[3], 0.985);
    }
}
