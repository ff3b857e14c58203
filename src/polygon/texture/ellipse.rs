//! The elliptical weighted average: a Gaussian as wide as the footprint, cut off at an ellipse (Heckbert 1989).

use std::f64::consts::{PI, TAU};

use glam::{DMat2, DVec2, DVec3, DVec4, Vec4};

use super::footprint::{Footprint, MOST_TEXELS, widened};
use super::mip::MipLevel;
use crate::components::Wrap;

/// Variance of a square of side 1 along each axis: that of the pixel carried to the texture, and that of a texel.
const SQUARE: f64 = 1.0 / 12.0;

/// Squared distance, in standard deviations, at which the Gaussian is cut off.
const CUT: f64 = 8.0;

/// A Gaussian in the plane: exp(−(a x² + 2 b x y + c y²) / 2).
#[derive(Clone, Copy)]
struct Gaussian {
    /// Variance along x, covariance, variance along y.
    variance: DVec3,
    determinant: f64,
}

impl Gaussian {
    /// As wide as the parallelogram of `sides` together with the square texels that it is laid on: the same variances.
    fn new(sides: DMat2) -> Self {
        let (p, q) = (sides.x_axis, sides.y_axis);
        let variance = DVec3::new(
            (p.x * p.x + q.x * q.x + 1.0) * SQUARE,
            (p.x * p.y + q.x * q.y) * SQUARE,
            (p.y * p.y + q.y * q.y + 1.0) * SQUARE,
        );
        Self { variance, determinant: variance.x * variance.z - variance.y * variance.y }
    }

    /// About how many texels it covers.
    fn texels(&self) -> f64 {
        PI * CUT * self.determinant.sqrt()
            + 2.0 * (CUT * (self.variance.x + self.variance.z)).sqrt()
    }
}

/// The mean weighed by the Gaussian, in the finest level where it covers not too many texels.
pub(super) fn average(
    levels: &[MipLevel],
    wrap: [Wrap; 2],
    uv: DVec2,
    footprint: &Footprint,
) -> Vec4 {
    let gaussian = |level: &MipLevel| Gaussian::new(widened(footprint.in_texels(level.size)));
    let fits = |level: &&MipLevel| gaussian(level).texels() <= MOST_TEXELS;
    if let Some(level) = levels.iter().find(fits) {
        return mean(level, wrap, uv, gaussian(level));
    }
    let last = &levels[levels.len() - 1];
    // Hundreds of textures in each direction: the mean of what repeats, and the part that a single one is.
    let part = if wrap == [Wrap::Vanish; 2] { density(gaussian(last), uv - 0.5) } else { 1.0 };
    last.texels[0] * part as f32
}

/// The Gaussian's density at a distance from its centre, at most 1.
fn density(g: Gaussian, from: DVec2) -> f64 {
    let (x, y, v) = (from.x, from.y, g.variance);
    let distance = (v.z * x * x - 2.0 * v.y * x * y + v.x * y * y) / g.determinant;
    (libm::exp(-distance / 2.0) / (TAU * g.determinant.sqrt())).min(1.0)
}

/// The mean of a level's texels, each weighed by the Gaussian at its centre.
fn mean(level: &MipLevel, wrap: [Wrap; 2], uv: DVec2, g: Gaussian) -> Vec4 {
    let at = uv * DVec2::new(level.size[0] as f64, level.size[1] as f64) - 0.5;
    let reach = (CUT * g.variance.z).sqrt();
    let (mut sum, mut total) = (DVec4::ZERO, 0.0);
    for row in (at.y - reach).ceil() as i64..=(at.y + reach).floor() as i64 {
        let texels = wrap[1]
            .texel(row, level.size[1])
            .map_or(&[][..], |y| &level.texels[y * level.size[0]..][..level.size[0]]);
        let (row_sum, row_total) = weighed_row(texels, wrap[0], at.x, row as f64 - at.y, g);
        sum += row_sum;
        total += row_total;
    }
    if total == 0.0 { Vec4::ZERO } else { (sum / total).as_vec4() }
}

/// The weighed sum and the weights of a row, `y` below the centre; of a row that has vanished only the weights.
fn weighed_row(texels: &[Vec4], wrap: Wrap, middle: f64, y: f64, g: Gaussian) -> (DVec4, f64) {
    // Within a row the Gaussian is one about a middle of its own, of variance `narrow`.
    let (middle, narrow) = (middle + y * g.variance.y / g.variance.z, g.determinant / g.variance.z);
    let height = y * y / g.variance.z;
    let reach = (narrow * (CUT - height).max(0.0)).sqrt();
    let (first, last) = ((middle - reach).ceil() as i64, (middle + reach).floor() as i64);
    let x = first as f64 - middle;
    // From texel to texel it is multiplied by a ratio, and the ratio by a constant: three exponentials a row.
    let mut weight = libm::exp(-(height + x * x / narrow) / 2.0);
    let mut ratio = libm::exp(-(2.0 * x + 1.0) / narrow / 2.0);
    let falling = libm::exp(-1.0 / narrow);
    let (mut sum, mut total) = (DVec4::ZERO, 0.0);
    for column in first..=last {
        if !texels.is_empty()
            && let Some(x) = wrap.texel(column, texels.len())
        {
            sum += texels[x].as_dvec4() * weight;
        }
        total += weight;
        weight *= ratio;
        ratio *= falling;
    }
    (sum, total)
}
