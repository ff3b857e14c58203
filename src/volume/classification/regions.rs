//! Region boundaries of Levoy 1988: tissues touch in order of value, and what is seen is where one meets the next.

use glam::DVec3;

use super::curve::{Curve, Risen};
use super::numbers::{opacity_in_range, square};
use crate::components::{Color, Tissue};

/// `α = g' · (α_v interpolated between the two neighbouring tissue values)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Regions {
    opacity: Curve<f64>,
    risen: Risen,
    /// Colour times opacity, so that a clear tissue lends no colour to its neighbour.
    associated: Curve<DVec3>,
    color: Curve<DVec3>,
    /// u, world units.
    unit: f64,
}

impl Regions {
    /// Tissues of a volume of opacity unit `unit`; those without a colour of their own take `color`.
    pub fn new(stated: &[Tissue], color: DVec3, unit: f64) -> Self {
        let colors = stated.iter().map(|t| t.color.map_or(color, |Color(own)| own.as_dvec3()));
        let points = || stated.iter().map(|t| (t.value, opacity_in_range(t.opacity)));
        let opacity = Curve::new(points());
        Self {
            risen: opacity.risen(),
            opacity,
            associated: Curve::new(
                points().zip(colors.clone()).map(|((value, alpha), color)| (value, color * alpha)),
            ),
            color: Curve::new(stated.iter().zip(colors).map(|(t, color)| (t.value, color))),
            unit,
        }
    }

    /// 0 outside the tissues' values and where nothing changes.
    ///
    /// g' is the gradient over that of a boundary which takes the whole step between the two tissues in one opacity
    /// unit, at most 1.
    #[inline]
    pub fn opacity(&self, f: f64, gradient: [f32; 3]) -> f64 {
        let gg = square(gradient);
        if gg == 0.0 {
            return 0.0;
        }
        let ends = self.opacity.ends().filter(|[low, high]| (*low..=*high).contains(&f));
        let (Some([_, last]), Some(alpha)) = (ends, self.opacity.value(f)) else {
            return 0.0;
        };
        // At the last tissue's own value the neighbours are that tissue and the one before it.
        let within = if f == last { last.next_down() } else { f };
        let contrast = self.opacity.around(within).map_or(0.0, |[low, high]| high.0 - low.0);
        if contrast > 0.0 { alpha * (gg.sqrt() * self.unit / contrast).min(1.0) } else { 0.0 }
    }

    /// The opacities between tissues, and u.
    pub(super) fn curve(&self) -> (&Curve<f64>, f64) {
        (&self.opacity, self.unit)
    }

    /// The scalars at which a boundary may be seen, where the gradient is longer than 0.
    pub fn risen(&self) -> &Risen {
        &self.risen
    }

    /// The two tissues' colours, weighted by what each gives to the opacity.
    pub fn color(&self, f: f64) -> Option<DVec3> {
        let alpha = self.opacity.value(f).filter(|alpha| *alpha > 0.0);
        let mixed = alpha.and_then(|alpha| Some(self.associated.value(f)? * (1.0 / alpha)));
        mixed.or_else(|| self.color.value(f))
    }

    /// The values outside of which the opacity is surely 0.
    pub fn range(&self) -> [f64; 2] {
        self.opacity.ends().unwrap_or([f64::INFINITY, f64::NEG_INFINITY])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tissue(value: f32, opacity: f32, color: Option<Color>) -> Tissue {
        Tissue { value, opacity, color }
    }

    fn air_skin_bone() -> Regions {
        let red = Some(Color(glam::Vec3::X));
        let tissues = [tissue(0.0, 0.0, None), tissue(100.0, 0.5, red), tissue(300.0, 1.0, None)];
        Regions::new(&tissues, DVec3::Z, 2.0)
    }

    #[test]
    fn opacity_is_interpolated_between_tissues_and_scaled_by_contrast() {
        let regions = air_skin_bone();
        // Between air and skin a gradient of 50 per mm over u = 2 mm is the whole contrast of 100.
        assert!((regions.opacity(40.0, [50.0, 0.0, 0.0]) - 0.2).abs() < 1e-12);
        assert!((regions.opacity(40.0, [15.0, 20.0, 0.0]) - 0.1).abs() < 1e-12);
        assert!((regions.opacity(40.0, [500.0, 0.0, 0.0]) - 0.2).abs() < 1e-12);
        // Between skin and bone the contrast is 200.
        assert!((regions.opacity(200.0, [50.0, 0.0, 0.0]) - 0.375).abs() < 1e-12);
        assert!((regions.opacity(300.0, [50.0, 0.0, 0.0]) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn inside_a_tissue_and_beyond_the_tissues_nothing_is_seen() {
        let regions = air_skin_bone();
        assert_eq!(regions.opacity(40.0, [0.0; 3]), 0.0);
        let beyond = [-1.0, 301.0, f64::INFINITY, f64::NAN];
        assert_eq!(beyond.map(|f| regions.opacity(f, [50.0, 0.0, 0.0])), [0.0; 4]);
        let one = Regions::new(&[tissue(5.0, 1.0, None)], DVec3::ONE, 1.0);
        assert_eq!(one.opacity(5.0, [1.0, 0.0, 0.0]), 0.0);
    }

    #[test]
    fn a_clear_tissue_lends_no_color() {
        let regions = air_skin_bone();
        assert_eq!(regions.color(40.0), Some(DVec3::X));
        // Half-way from skin (0.5) to bone (1): weights 1/3 and 2/3.
        let between = regions.color(200.0).unwrap();
        assert!(between.distance(DVec3::new(1.0 / 3.0, 0.0, 2.0 / 3.0)) < 1e-12);
    }
}
