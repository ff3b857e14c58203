//! Slabs that are thicker or thinner than the opacity unit: sixteen powers side by side.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]
#![allow(clippy::needless_range_loop, reason = "sixteen lanes at once, by their number")]

use glam::{DVec3, Vec4};

use super::lanes::LANES;
use crate::view::composite::{is_simple, recolor, thicken_each};

/// The opacities of the slabs of all rays at a sample.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Thick {
    opacity: [f64; LANES],
    /// What is left of each color.
    part: [f64; LANES],
}

impl Thick {
    /// For slabs so thick against the opacity unit; `None` where no power is to be taken.
    pub fn needed(ratios: &[f64; LANES]) -> Option<Self> {
        let simple = ratios.iter().all(|ratio| is_simple(*ratio));
        (!simple).then(Self::default)
    }

    /// Of what rays see, and how thick their slabs are against the opacity unit.
    #[inline(always)]
    pub fn fill(&mut self, seen: &[Vec4; LANES], ratios: &[f64; LANES]) {
        let mut opacities = [0.0; LANES];
        for lane in 0..LANES {
            opacities[lane] = f64::from(seen[lane].w).min(1.0);
        }
        self.opacity = thicken_each(&opacities, ratios);
        for lane in 0..LANES {
            self.part[lane] = recolor(opacities[lane], self.opacity[lane], ratios[lane]);
        }
    }

    /// The slab of a ray, by the sample that it was filled with: to the last bit what [`slab`](super::media::slab) makes.
    #[inline]
    pub fn slab(&self, sample: Vec4, lane: usize) -> (DVec3, f64) {
        (sample.truncate().as_dvec3() * self.part[lane], self.opacity[lane])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::systems::cast::media::slab;

    #[test]
    fn slabs_side_by_side_are_those_of_each_ray_alone() {
        let seen = std::array::from_fn(|lane| {
            let alpha = [0.0, 1e-6, 0.2, 0.9, 1.0, 1.000_000_1][lane % 6];
            Vec4::new(0.9, 0.5, 0.1, 1.0) * alpha
        });
        let ratios = std::array::from_fn(|lane| 0.3 + 0.1 * lane as f64);
        let mut thick = Thick::default();
        thick.fill(&seen, &ratios);
        for lane in 0..LANES {
            assert_eq!(thick.slab(seen[lane], lane), slab(seen[lane], ratios[lane]));
        }
    }
}
