//! The footprint of a square of the picture in a texture: a parallelogram, the columns of a matrix (paper figure 2).

use glam::{DMat2, DVec2};

/// Texels that the slower filters read for one lookup, about; larger footprints are averaged over a coarser level.
pub(super) const MOST_TEXELS: f64 = 4096.0;

/// Textures that a footprint spans at most: beyond, it is held there and stays finite.
const LIMIT: f64 = 1e6;

/// The parallelogram that a square of the picture covers in texture space, where the texture itself is [0, 1]².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Footprint(DMat2);

impl Footprint {
    /// The footprint with the sides `across` and `down`, in textures.
    ///
    /// Sides are held within a million textures; what is not a number counts as 0. No side is a point.
    #[must_use]
    pub fn new(across: DVec2, down: DVec2) -> Self {
        let held = |x: f64| if x.is_nan() { 0.0 } else { x.clamp(-LIMIT, LIMIT) };
        let side = |s: DVec2| DVec2::new(held(s.x), held(s.y));
        Self(DMat2::from_cols(side(across), side(down)))
    }

    /// The sides as columns, in textures.
    #[must_use]
    pub fn sides(&self) -> DMat2 {
        self.0
    }

    /// The sides in texels of a level of `size`.
    pub(super) fn in_texels(&self, size: [usize; 2]) -> DMat2 {
        let scale = DVec2::new(size[0] as f64, size[1] as f64);
        DMat2::from_cols(self.0.x_axis * scale, self.0.y_axis * scale)
    }
}

/// A matrix as the sum of a turn and of a reflection, each scaled: `(turn, reflection)`.
///
/// Its singular values are the sum and the difference of their lengths.
fn parts(m: DMat2) -> (DVec2, DVec2) {
    let [a, c, b, d] = m.to_cols_array();
    (DVec2::new(a + d, c - b) / 2.0, DVec2::new(a - d, c + b) / 2.0)
}

/// The larger singular value: the longest that a unit square's side can become.
pub(super) fn longest(m: DMat2) -> f64 {
    let (turn, reflection) = parts(m);
    turn.length() + reflection.length()
}

/// The same matrix with its singular values raised to at least 1, so that a footprint is at least a texel wide.
///
/// Averaged over an aligned square of one texel, square texels become their bilinear interpolation: that is how a
/// magnified texture is smooth.
pub(super) fn widened(m: DMat2) -> DMat2 {
    let (turn, reflection) = parts(m);
    let (q, r) = (turn.length(), reflection.length());
    let (long, short) = ((q + r).max(1.0), (q - r).abs().max(1.0).copysign(q - r));
    let turn = turn.try_normalize().unwrap_or(DVec2::X) * f64::midpoint(long, short);
    let reflection = reflection.try_normalize().unwrap_or(DVec2::X) * ((long - short) / 2.0);
    DMat2::from_cols(
        DVec2::new(turn.x + reflection.x, turn.y + reflection.y),
        DVec2::new(reflection.y - turn.y, turn.x - reflection.x),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widening_raises_small_singular_values_to_one_and_keeps_the_rest() {
        let turned = DMat2::from_angle(0.4);
        let thin = turned * DMat2::from_diagonal(DVec2::new(7.0, 0.1)) * DMat2::from_angle(1.1);
        let wide = turned * DMat2::from_diagonal(DVec2::new(7.0, 1.0)) * DMat2::from_angle(1.1);
        assert!(widened(thin).abs_diff_eq(wide, 1e-12));
        assert!(widened(wide).abs_diff_eq(wide, 1e-12));
        assert!(widened(turned * -3.0).abs_diff_eq(turned * -3.0, 1e-12));
        assert!((longest(thin) - 7.0).abs() < 1e-12);
    }

    #[test]
    fn a_point_is_widened_to_the_aligned_texel_and_a_mirror_image_stays_one() {
        assert_eq!(widened(DMat2::ZERO), DMat2::IDENTITY);
        let mirror = DMat2::from_diagonal(DVec2::new(0.5, -0.25));
        assert!(widened(mirror).abs_diff_eq(DMat2::from_diagonal(DVec2::new(1.0, -1.0)), 1e-15));
    }

    #[test]
    fn sides_are_held_finite() {
        let huge = Footprint::new(DVec2::new(f64::INFINITY, f64::NAN), DVec2::new(-1e300, 2.0));
        assert_eq!(huge.sides().to_cols_array(), [1e6, 0.0, -1e6, 2.0]);
    }
}
