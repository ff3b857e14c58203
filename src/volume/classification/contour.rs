//! Isovalue contours: what is above `f_v`, or the region around it of Levoy 1988, clear at a distance stated in voxels.

use glam::{DVec3, Vec3};

use super::numbers::{opacity_in_range, square};
use crate::components::{Color, Contour, Form};

/// One or more contours: of what is above, `α_v · (f − f_v) / (r g)`, at most α_v; of the region around,
/// `α_v (1 − |f_v − f| / (r g))`.
#[derive(Debug, Clone, PartialEq)]
pub struct Contours(Vec<Line>);

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    /// f_v.
    pub value: f64,
    /// α_v.
    pub opacity: f64,
    /// r² in world units.
    pub squared_reach: f64,
    pub form: Form,
    /// Of a surface, whether it bounds what is above it.
    is_capped: bool,
    color: DVec3,
}

impl Line {
    /// Whether it has no thickness: it is where values cross it, and takes up no voxel.
    #[inline]
    pub fn is_surface(&self) -> bool {
        self.squared_reach == 0.0
    }

    /// Whether it is of all that is above it, and opaque there.
    fn is_solid(&self) -> bool {
        self.form == Form::Above && self.opacity >= 1.0
    }

    /// α of this contour alone at scalar `f` and squared gradient `gg`; 0 for a NaN.
    #[inline]
    fn opacity(&self, f: f64, gg: f64) -> f64 {
        if self.is_surface() {
            return 0.0;
        }
        let away = self.value - f;
        let (square, reach) = (away * away, self.squared_reach * gg);
        match self.form {
            Form::Above if away > 0.0 || away.is_nan() => 0.0,
            Form::Above if square < reach => self.opacity * (square / reach).sqrt(),
            Form::Above => self.opacity,
            Form::Around if square < reach => self.opacity * (1.0 - (square / reach).sqrt()),
            Form::Around if square == 0.0 => self.opacity,
            Form::Around => 0.0,
        }
    }
}

/// A contour without thickness: a surface at a value, found between voxels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharpContour {
    /// f_v.
    pub value: f32,
    /// α_v of the surface itself, in 0..=1, however thick a slab it is met in.
    pub opacity: f32,
    /// Linear.
    pub color: Vec3,
    /// Whether it bounds what is above, and so is closed where the grid ends and where it is cut.
    pub is_capped: bool,
}

impl Contours {
    pub(super) fn lines(&self) -> &[Line] {
        &self.0
    }

    /// Those without thickness.
    pub fn surfaces(&self) -> Vec<SharpContour> {
        let surface = |line: &Line| SharpContour {
            value: line.value as f32,
            opacity: line.opacity as f32,
            color: line.color.as_vec3(),
            is_capped: line.is_capped,
        };
        self.0.iter().filter(|line| line.is_surface() && line.opacity > 0.0).map(surface).collect()
    }

    /// Whether one of them has some thickness.
    pub fn has_gel(&self) -> bool {
        self.0.iter().any(|line| !line.is_surface() && line.opacity > 0.0)
    }

    /// Contours of a volume of opacity unit `unit`; those without a colour of their own take `color`.
    pub fn new(stated: &[Contour], color: DVec3, unit: f64) -> Self {
        let line = |contour: &Contour| {
            let reach = (f64::from(contour.thickness_voxels) * unit).max(0.0);
            Line {
                value: f64::from(contour.value),
                opacity: opacity_in_range(contour.opacity),
                squared_reach: reach * reach,
                // What has no thickness is around its value alone.
                form: if reach == 0.0 { Form::Around } else { contour.form },
                is_capped: reach == 0.0 && contour.form == Form::Above,
                color: contour.color.map_or(color, |Color(own)| own.as_dvec3()),
            }
        };
        Self(stated.iter().map(line).collect())
    }

    /// `1 − Π (1 − α_n)`.
    #[inline]
    pub fn opacity(&self, f: f64, gradient: [f32; 3]) -> f64 {
        let gg = square(gradient);
        self.0.iter().fold(0.0, |alpha, line| {
            let own = line.opacity(f, gg);
            alpha + (1.0 - alpha) * own
        })
    }

    /// The scalars at which a contour may be seen, if that does not depend on the gradient.
    pub fn risen(&self) -> Option<Vec<[f64; 2]>> {
        let seen = self.0.iter().filter(|line| line.opacity > 0.0);
        let risen = |line: &Line| match line.form {
            Form::Above => Some([line.value, f64::INFINITY]),
            Form::Around => line.is_surface().then_some([line.value; 2]),
        };
        seen.map(risen).collect()
    }

    /// Whether a contour may be seen at scalars from `low` to `high` and gradients no longer than `steepest`: 1, else 0.
    #[inline]
    pub fn show<const N: usize>(
        &self,
        [low, high, steepest]: [&[f64; N]; 3],
        shown: &mut [u64; N],
    ) {
        for line in self.0.iter().filter(|line| line.opacity > 0.0) {
            let is_around = u64::from(line.form == Form::Around);
            for n in 0..N {
                let above = if is_around == 1 { low[n] - line.value } else { 0.0 };
                let away = above.max(line.value - high[n]).max(0.0);
                let reach = line.squared_reach * steepest[n] * steepest[n];
                let below = is_around & u64::from(away * away < reach);
                shown[n] |= u64::from(away == 0.0) | below;
            }
        }
    }

    /// Whether α is 1 at all scalars from `low` on, at gradients no longer than `steepest`.
    pub fn are_opaque(&self, low: f64, steepest: f64) -> bool {
        self.0.iter().filter(|line| line.is_solid()).any(|line| {
            let inside = low - line.value;
            inside > 0.0 && inside * inside >= line.squared_reach * steepest * steepest
        })
    }

    /// Whether α is 1 anywhere that [`are_opaque`](Self::are_opaque) knows of.
    pub fn may_be_opaque(&self) -> bool {
        self.0.iter().any(Line::is_solid)
    }

    /// The mean of the contours' colours, each weighted by its opacity; `None` where there is none.
    pub fn color(&self, f: f64, gradient: [f32; 3]) -> Option<DVec3> {
        let gg = square(gradient);
        let weighted = self.0.iter().map(|line| (line.opacity(f, gg), line.color));
        super::numbers::weighted_mean(weighted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contour(value: f32, opacity: f32, thickness_voxels: f32) -> Contour {
        Contour { value, opacity, thickness_voxels, form: Form::Around, color: None }
    }

    #[test]
    fn what_is_above_is_opaque_from_its_thickness_on_and_nothing_below_is_seen() {
        let above = Contour { form: Form::Above, ..contour(100.0, 0.8, 2.0) };
        let contours = Contours::new(&[above], DVec3::ONE, 1.5);
        let at = |f: f64| contours.opacity(f, [0.0, 8.0, 6.0]);
        assert!((at(115.0) - 0.4).abs() < 1e-7);
        assert_eq!([at(130.0), at(4000.0), at(f64::INFINITY)], [f64::from(0.8_f32); 3]);
        // A boundary from 0 to 90, as steep as one likes, does not reach 100.
        assert_eq!([at(100.0), at(99.0), at(-5.0), at(f64::NAN)], [0.0; 4]);
        let flat = |f| contours.opacity(f, [0.0; 3]);
        assert_eq!(
            [flat(100.0), flat(101.0), flat(99.0)],
            [f64::from(0.8_f32), f64::from(0.8_f32), 0.0]
        );
    }

    #[test]
    fn a_contour_falls_from_its_opacity_to_nothing_over_its_thickness() {
        // r = 2 voxels of 1.5 mm, g = 10 per mm: the contour reaches 30 units of f to each side.
        let contours = Contours::new(&[contour(100.0, 0.8, 2.0)], DVec3::ONE, 1.5);
        let at = |f: f64| contours.opacity(f, [0.0, 8.0, 6.0]);
        assert_eq!(at(100.0), f64::from(0.8_f32));
        assert!((at(85.0) - 0.4).abs() < 1e-7 && (at(115.0) - 0.4).abs() < 1e-7);
        assert!((at(124.0) - 0.16).abs() < 1e-7);
        assert_eq!([at(130.0), at(69.0), at(f64::INFINITY), at(f64::NAN)], [0.0; 4]);
    }

    #[test]
    fn where_nothing_changes_only_the_isovalue_itself_is_opaque() {
        let contours = Contours::new(&[contour(100.0, 0.8, 2.0)], DVec3::ONE, 1.0);
        assert_eq!(contours.opacity(100.0, [0.0; 3]), f64::from(0.8_f32));
        assert_eq!(contours.opacity(100.000_01, [0.0; 3]), 0.0);
    }

    #[test]
    fn several_contours_composite_and_mix_their_colors_by_opacity() {
        let red = Contour { color: Some(Color(glam::Vec3::X)), ..contour(0.0, 1.0, 1.0) };
        let blue = Contour { color: Some(Color(glam::Vec3::Z)), ..contour(10.0, 0.5, 1.0) };
        let contours = Contours::new(&[red, blue], DVec3::ONE, 1.0);
        // At f = 4 and g = 10: α_1 = 0.6, α_2 = 0.5 · 0.4 = 0.2.
        let gradient = [10.0, 0.0, 0.0];
        assert!((contours.opacity(4.0, gradient) - 0.68).abs() < 1e-12);
        let color = contours.color(4.0, gradient).unwrap();
        assert!(color.distance(DVec3::new(0.75, 0.0, 0.25)) < 1e-12);
        assert_eq!(contours.color(40.0, gradient), None);
    }
}
