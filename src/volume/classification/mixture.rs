//! Mixtures of materials (Drebin, Carpenter and Hanrahan 1988): a voxel is a probable part of each.

use glam::DVec3;

use super::curve::{Curve, Risen};
use super::numbers::{opacity_in_range, weighted_mean};
use crate::components::{Color, MixtureMaterial};

/// Opacity and associated colour of a voxel are sums over the materials, weighted by their probabilities.
#[derive(Debug, Clone, PartialEq)]
pub struct Mixture(Vec<Part>);

#[derive(Debug, Clone, PartialEq)]
struct Part {
    probability: Curve<f64>,
    /// Where it is probable and not clear.
    risen: Risen,
    opacity: f64,
    color: DVec3,
}

impl Mixture {
    /// A mixture of materials; those without a colour of their own take `color`.
    pub fn new(stated: &[MixtureMaterial], color: DVec3) -> Self {
        let part = |material: &MixtureMaterial| {
            let points = material.probability.iter();
            let probability = Curve::new(points.map(|[value, p]| (*value, opacity_in_range(*p))));
            let opacity = opacity_in_range(material.opacity);
            let seen = if opacity > 0.0 { probability.clone() } else { Curve::new([]) };
            let color = material.color.map_or(color, |Color(own)| own.as_dvec3());
            Part { risen: seen.risen(), probability, opacity, color }
        };
        Self(stated.iter().map(part).collect())
    }

    fn probabilities(&self, f: f64) -> impl Iterator<Item = (f64, &Part)> {
        self.0.iter().map(move |part| (part.probability.value(f).unwrap_or(0.0), part))
    }

    /// `Σ p_m α_m`, the probabilities scaled to sum to at most 1.
    #[inline]
    pub fn opacity(&self, f: f64) -> f64 {
        let (whole, sum) = self
            .probabilities(f)
            .fold((0.0, 0.0), |(whole, sum), (p, part)| (whole + p, sum + p * part.opacity));
        sum / f64::max(whole, 1.0)
    }

    /// `Σ p_m α_m c_m / Σ p_m α_m`: the sum of associated colours, taken apart from opacity; `None` where there is none.
    pub fn color(&self, f: f64) -> Option<DVec3> {
        weighted_mean(self.probabilities(f).map(|(p, part)| (p * part.opacity, part.color)))
    }

    /// The scalars at which each material may be seen.
    pub fn risen(&self) -> impl Iterator<Item = &Risen> {
        self.0.iter().map(|part| &part.risen)
    }

    /// The values outside of which the opacity is surely 0.
    pub fn range(&self) -> [f64; 2] {
        let seen = self.0.iter().filter(|part| part.opacity > 0.0);
        seen.map(|part| part.probability.support())
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [a, b]| {
                [low.min(a), high.max(b)]
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mixture_sums_what_is_probable_and_never_exceeds_certainty() {
        let material = |probability: &[[f32; 2]], opacity, color| MixtureMaterial {
            probability: probability.to_vec(),
            opacity,
            color,
        };
        let fat = material(&[[0.0, 0.0], [10.0, 1.0], [20.0, 0.0]], 0.25, None);
        let bone = material(&[[10.0, 0.0], [20.0, 1.0]], 1.0, Some(Color(glam::Vec3::X)));
        let mixture = Mixture::new(&[fat, bone.clone()], DVec3::Z);
        assert_eq!(mixture.opacity(5.0), 0.125);
        assert_eq!(mixture.opacity(15.0), 0.625);
        assert_eq!(mixture.color(15.0), Some(DVec3::new(0.8, 0.0, 0.2)));
        assert_eq!([mixture.opacity(-1.0), mixture.opacity(f64::INFINITY)], [0.0, 1.0]);
        assert_eq!(mixture.color(-1.0), None);
        assert_eq!(mixture.range(), [0.0, f64::INFINITY]);
        let twice = Mixture::new(&[bone.clone(), bone], DVec3::Z);
        assert_eq!([twice.opacity(20.0), twice.opacity(15.0)], [1.0, 1.0]);
    }
}
