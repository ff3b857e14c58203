//! Piecewise-linear transfer functions of the scalar, optionally times one of the gradient.

use glam::DVec3;

use super::curve::{Curve, Risen};
use super::integral::Piece;
use super::numbers::{fraction, opacity_in_range, square};
use crate::components::{Color, TransferPoint};

/// What every other program calls a transfer function.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Transfer {
    opacity: Curve<f64>,
    risen: Risen,
    color: Curve<DVec3>,
    /// A factor of the gradient magnitude.
    factor: Option<Curve<f64>>,
    /// The least magnitude at which that is above 0.
    factor_from: f64,
}

impl Transfer {
    /// A transfer function with its factors `[magnitude, factor]`; points without a colour of their own take `color`.
    pub fn new(stated: &[TransferPoint], factors: &[[f32; 2]], color: DVec3) -> Self {
        let own = |p: &TransferPoint| p.color.map_or(color, |Color(own)| own.as_dvec3());
        let factor =
            Curve::new(factors.iter().map(|[magnitude, factor]| (*magnitude, f64::from(*factor))));
        let opacity = Curve::new(stated.iter().map(|p| (p.value, opacity_in_range(p.opacity))));
        let factor = factor.ends().map(|_| factor);
        Self {
            risen: opacity.risen(),
            opacity,
            factor_from: factor.as_ref().map_or(0.0, |factor| factor.risen().least(0.0)),
            color: Curve::new(stated.iter().map(|p| (p.value, own(p)))),
            factor,
        }
    }

    /// The opacity at `f`, times the factor at the gradient's magnitude.
    #[inline]
    pub fn opacity(&self, f: f64, gradient: [f32; 3]) -> f64 {
        let alpha = self.opacity.value(f).unwrap_or(0.0);
        match &self.factor {
            Some(factor) if alpha > 0.0 => {
                alpha * factor.value(square(gradient).sqrt()).unwrap_or(0.0)
            }
            _ => alpha,
        }
    }

    /// The opacity, and the factor of the gradient's magnitude.
    pub(super) fn curves(&self) -> (&Curve<f64>, Option<&Curve<f64>>) {
        (&self.opacity, self.factor.as_ref())
    }

    /// What a ray sees, in that order, as the scalar goes evenly from a finite value to another, each piece handed to `see`;
    /// opacities are times the factor at the gradient's magnitude.
    pub fn along(&self, [from, to]: [f64; 2], gradient: [f32; 3], mut see: impl FnMut(Piece)) {
        let factor = self
            .factor
            .as_ref()
            .map_or(1.0, |factor| fraction(factor.value(square(gradient).sqrt()).unwrap_or(0.0)));
        if from == to {
            let alpha = self.opacity.value(from).unwrap_or(0.0) * factor;
            let color = self.color.value(from).unwrap_or_default();
            Piece::new(1.0, [alpha; 2], [color; 2]).into_iter().for_each(see);
            return;
        }
        // Opacities and colours have their points in the same places.
        for (alphas, colors) in self.opacity.pieces([from, to]).zip(self.color.pieces([from, to])) {
            let part = (alphas[1].0 - alphas[0].0) / (to - from);
            let piece = Piece::new(part, alphas.map(|a| a.1 * factor), colors.map(|c| c.1));
            piece.into_iter().for_each(&mut see);
        }
    }

    /// The scalars at which anything may be seen, where the gradient is at least [`factor_from`](Self::factor_from) long.
    pub fn risen(&self) -> &Risen {
        &self.risen
    }

    /// The least gradient magnitude at which anything may be seen; ∞ if there is none.
    pub fn factor_from(&self) -> f64 {
        self.factor_from
    }

    /// Whether the opacity depends on the gradient.
    pub(crate) fn is_of_gradient(&self) -> bool {
        self.factor.is_some()
    }

    /// The colour at `f`; `None` without points.
    pub fn color(&self, f: f64) -> Option<DVec3> {
        self.color.value(f)
    }

    /// Whether α is 1 at all scalars from `low` to `high`.
    pub fn is_opaque(&self, [low, high]: [f64; 2]) -> bool {
        let between = self.opacity.points().iter().filter(|(at, _)| (low..=high).contains(at));
        let ends = [low, high].map(|end| self.opacity.value(end).unwrap_or(0.0));
        let mut all = between.map(|(_, alpha)| *alpha).chain(ends);
        // A straight line between ones may be rounded.
        self.factor.is_none() && low <= high && all.all(|alpha| alpha > 1.0 - 1e-12)
    }

    /// Whether α is 1 anywhere that [`is_opaque`](Self::is_opaque) knows of.
    pub fn may_be_opaque(&self) -> bool {
        self.factor.is_none() && self.opacity.points().iter().any(|(_, alpha)| *alpha >= 1.0)
    }

    /// The values outside of which the opacity is surely 0.
    pub fn range(&self) -> [f64; 2] {
        self.opacity.support()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transfer_function_is_interpolated_and_weighted_by_the_gradient() {
        let point = |value, opacity, color| TransferPoint { value, opacity, color };
        let points = [point(10.0, 0.0, Some(Color(glam::Vec3::X))), point(20.0, 0.8, None)];
        let plain = Transfer::new(&points, &[], DVec3::Z);
        let weighted = Transfer::new(&points, &[[2.0, 0.0], [4.0, 1.0]], DVec3::Z);
        let gradient = [0.0, 0.0, 3.0];
        assert!((plain.opacity(15.0, gradient) - 0.4).abs() < 1e-7);
        assert!((weighted.opacity(15.0, gradient) - 0.2).abs() < 1e-7);
        assert_eq!(weighted.opacity(15.0, [1.0, 0.0, 0.0]), 0.0);
        assert_eq!(plain.opacity(f64::INFINITY, gradient), f64::from(0.8_f32));
        assert_eq!(plain.color(12.5), Some(DVec3::new(0.75, 0.0, 0.25)));
        assert_eq!(plain.range(), [10.0, f64::INFINITY]);
    }
}
