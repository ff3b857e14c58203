//! A field as a density of emitters (Sabella 1988): of a ray its greatest value is a hue, how deep it lies a saturation, and how
//! much the ray's way emits a brightness.
//!
//! A density ρ emits ρ and attenuates what comes from behind it by τ ρ a unit of the way: I = ∫ exp(−τ ∫ρ) ρ ds. That is
//! (1 − exp(−τ P)) / τ with P = ∫ρ ds, whatever the order of what is dense and what is not; 1 / τ is what is seen of endless
//! gel of density 1, and the brightness is the part of it, 1 − exp(−τ P).

use glam::DVec3;

use crate::components::Classify;
use crate::view::camera::Camera;
use crate::volume::grid::Grid;

/// τ over the longest side of the grid: of a volume of density 1 all through, e⁻⁴ is missing.
const ATTENUATION: f64 = 4.0;

/// How much of a color's saturation is lost at the far end of the volume.
const FADED: f64 = 0.9;

/// What a view needs to know of a volume of emitters.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Emitters {
    /// The values of density 0 and 1: the first and the last of the transfer function.
    ends: [f64; 2],
    /// The depths of the nearest and the farthest corner of the grid, world units.
    depths: [f64; 2],
    /// τ, a world unit.
    attenuation: f64,
}

impl Emitters {
    /// The emitters of a volume on a grid, seen by a camera; `classify` has a transfer function.
    pub fn new(classify: &Classify, grid: &Grid, camera: &Camera) -> Self {
        let values = classify.transfer.iter().map(|point| f64::from(point.value));
        let ends = span(values);
        let depths = span(grid.corners().into_iter().map(|corner| camera.depth(corner)));
        let depths = [depths[0].max(camera.nearest()), depths[1]];
        let cells = grid.size.map(|n| (n - 1) as f64);
        let sides = grid.spacing() * DVec3::from(cells);
        Self { ends, depths, attenuation: ATTENUATION / sides.max_element() }
    }

    /// The value up to which the density is 0.
    pub fn empty_to(&self) -> f32 {
        // Never above it, so that nothing is left out.
        let empty = self.ends[0] as f32;
        if f64::from(empty) > self.ends[0] { empty.next_down() } else { empty }
    }

    /// ρ of a value, 0..=1: how far it is from the first value of the transfer function to the last; 0 of a NaN.
    pub fn density(&self, value: f32) -> f64 {
        let [low, high] = self.ends;
        let f = f64::from(value);
        if f > low { ((f - low) / (high - low)).min(1.0) } else { 0.0 }
    }

    /// The linear color of a ray: `color` is that of its greatest value, which lies at `depth` (world units), and `way` is P,
    /// world units.
    ///
    /// Paler with the depth by the saturation of HSV, which moves channels to their greatest; times the brightness.
    pub fn shown(&self, color: DVec3, depth: f64, way: f64) -> DVec3 {
        let [near, far] = self.depths;
        let deep = ((depth - near) / (far - near)).clamp(0.0, 1.0);
        let pale = DVec3::splat(color.max_element());
        let brightness = -(-self.attenuation * way).exp_m1();
        color.lerp(pale, FADED * deep) * brightness
    }
}

/// The least and the greatest of numbers.
fn span(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    let wider = |[low, high]: [f64; 2], n: f64| [low.min(n), high.max(n)];
    numbers.fold([f64::INFINITY, f64::NEG_INFINITY], wider)
}

#[cfg(test)]
mod tests {
    use super::*;

    const EMITTERS: Emitters =
        Emitters { ends: [2.0, 6.0], depths: [-10.0, 30.0], attenuation: 0.1 };

    #[test]
    fn density_rises_from_the_first_value_to_the_last() {
        let values = [f32::NEG_INFINITY, 1.0, 2.0, 3.0, 6.0, 9.0, f32::INFINITY, f32::NAN];
        let densities = values.map(|value| EMITTERS.density(value));
        assert_eq!(densities, [0.0, 0.0, 0.0, 0.25, 1.0, 1.0, 1.0, 0.0]);
        let step = Emitters { ends: [2.0; 2], ..EMITTERS };
        assert_eq!([2.0, 2.5].map(|value| step.density(value)), [0.0, 1.0]);
        for low in [0.1, 0.3, -0.7, 1e10 + 0.3] {
            let emitters = Emitters { ends: [low, 1e20], ..EMITTERS };
            assert_eq!(emitters.density(emitters.empty_to()), 0.0);
        }
    }

    #[test]
    fn the_brightness_is_the_attenuated_integral_over_that_of_endless_gel() {
        for seed in 1..20_u32 {
            let density =
                |at: u32| f64::from(at.wrapping_mul(seed * 2_654_435_769) >> 16) / 65536.0;
            let (mut through, mut emitted, mut way) = (1.0_f64, 0.0, 0.0);
            // A slab emits as much as it keeps from what is behind it, over τ.
            for rho in (0..30).map(density) {
                let clear = (-0.1 * rho * 0.7).exp();
                emitted += through * (1.0 - clear) / 0.1;
                through *= clear;
                way += rho * 0.7;
            }
            let shown = EMITTERS.shown(DVec3::ONE, 5.0, way);
            assert!((shown - DVec3::splat(emitted * 0.1)).abs().max_element() < 1e-14);
        }
    }

    #[test]
    fn a_color_keeps_its_value_and_hue_and_pales_with_the_depth() {
        let color = DVec3::new(0.5, 0.1, 0.3);
        let endless = |depth: f64| EMITTERS.shown(color, depth, 1e9);
        assert_eq!(endless(-10.0), color);
        assert_eq!(endless(-30.0), color, "before the volume is no nearer than it");
        let half = endless(10.0);
        assert!(half.abs_diff_eq(DVec3::new(0.5, 0.1 + 0.45 * 0.4, 0.3 + 0.45 * 0.2), 1e-15));
        assert!(endless(30.0).abs_diff_eq(DVec3::new(0.5, 0.46, 0.48), 1e-15));
        assert_eq!(EMITTERS.shown(color, 0.0, 0.0), DVec3::ZERO);
    }
}
