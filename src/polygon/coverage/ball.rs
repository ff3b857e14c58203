//! The convolution kernel: a ball of constant weight, and how opaque a voxel gets that it cuts from a polygon (paper §3).
//!
//! As printed, the ball has a radius of one voxel and α_G = α_P · coverage. Such a layer lets light through that the
//! polygon stops: an opaque plane is a tent of opacity, no matter how it is sampled. The calibrated ball reaches two voxels
//! along the normal. It spreads *optical depth*, τ = −ln(1 − α), for depths add along a ray: a voxel at height h gets the
//! part w(h) = (2 − |h|)/4 of it, whose values a voxel apart always sum to 1. A narrower tent is not told from its
//! neighbours well enough by tri-linear interpolation: planes aslant in the grid would ripple (a trapezoid that reaches 3/2
//! was measured at 1.5 times the ripple). Rays interpolate α instead of τ, which loses a few per cent: `calibration`
//! finds by how much τ has to grow.
//!
//! Towards opaque polygons (α over 0.99) the layer is lifted until, at α = 1, every voxel within one voxel of the plane
//! is opaque: then α = 1 over the whole width between two planes of voxels and no sample distance up to a voxel misses it.

use super::calibration::Calibration;
use super::flat::Flat;
use super::layer::{REACH, tent};
use crate::components::{Surface, Voxelize};
use crate::volume::grid::Grid;

/// Up to here optical depth is spread; between here and 1 the layer is lifted to opaque.
const TRANSLUCENT: f64 = 0.99;

/// What the voxels near a polygon of one opacity get.
#[derive(Debug, Clone, PartialEq)]
pub struct Ball {
    opacity: f64,
    calibration: Option<Calibration>,
}

impl Ball {
    /// The ball as the paper prints it: radius one voxel, α_G = α_P · coverage. `opacity` is α_P, clamped to 0..=1.
    #[must_use]
    pub fn printed(opacity: f64) -> Self {
        Self { opacity: in_range(opacity), calibration: None }
    }

    /// The calibrated ball: a polygon seen face-on has opacity `opacity` (α_P, clamped to 0..=1) at every phase.
    ///
    /// `unit` is u, the thickness that a voxel's opacity is stated for, world units above 0. Samples are taken to be a
    /// smallest spacing of `grid` apart. `flats` are what it is used for: they bound the thicknesses of layers.
    #[must_use]
    pub fn calibrated(opacity: f64, unit: f64, grid: &Grid, flats: &[Flat]) -> Self {
        let layers = || flats.iter().map(|flat| flat.layer);
        let thinnest = layers().fold(f64::INFINITY, f64::min);
        let thickest = layers().fold(0.0, f64::max);
        let opacity = in_range(opacity);
        let deepest = -libm::log1p(-opacity.min(TRANSLUCENT));
        let distance = grid.spacing().min_element();
        let calibration = Calibration::new(deepest, unit, distance, [thinnest, thickest]);
        Self { opacity, calibration: Some(calibration) }
    }

    /// The ball that a polygon of `surface` and `voxelize` states.
    #[must_use]
    pub fn stated(
        surface: &Surface,
        voxelize: &Voxelize,
        unit: f64,
        grid: &Grid,
        flats: &[Flat],
    ) -> Self {
        let opacity = f64::from(surface.opacity);
        if voxelize.calibrated {
            Self::calibrated(opacity, unit, grid, flats)
        } else {
            Self::printed(opacity)
        }
    }

    /// How far from the plane voxels are touched, voxels.
    #[must_use]
    pub fn reach(&self) -> f64 {
        if self.calibration.is_some() { REACH } else { 1.0 }
    }

    /// ρ, the radius of the disc that a plane at `height` voxels cuts, voxels; 1 at the centre, 0 from the reach on.
    ///
    /// The calibrated ball is stretched along the normal only, so that edges are as sharp as the paper's.
    #[must_use]
    pub fn radius(&self, height: f64) -> f64 {
        let height = height / self.reach();
        (1.0 - height * height).max(0.0).sqrt()
    }

    /// How much a polygon at `height` counts, beside others, for the colour of the voxel: 0..=1.
    #[must_use]
    pub fn weight(&self, height: f64) -> f64 {
        match self.calibration {
            None => (1.0 - height * height).max(0.0),
            Some(_) => 2.0 * tent(height),
        }
    }

    /// α_G of a voxel, 0..=1: the polygon covers `part` of the disc (0..=1, or more where faces overlap), whose plane is
    /// at `height` voxels, where a voxel is `layer` world units thick along the normal.
    #[must_use]
    pub fn opacity(&self, part: f64, height: f64, layer: f64) -> f64 {
        self.filled(part, layer).opacity(height)
    }

    /// The voxels of which a polygon covers the same part of their discs: what is left to know is their height.
    #[must_use]
    pub fn filled(&self, part: f64, layer: f64) -> Filled {
        let Some(calibration) = &self.calibration else {
            return Filled::Printed { part, opacity: self.opacity };
        };
        let opacity = self.opacity * part.min(1.0);
        let depth = calibration.depth_in_layer(-libm::log1p(-opacity.min(TRANSLUCENT)), layer);
        let lift = ((opacity - TRANSLUCENT) / (1.0 - TRANSLUCENT)).max(0.0);
        Filled::Calibrated { depth, lift, near: layered(depth, 1.0) }
    }

    /// The greatest α_G that a voxel gets from one face wherever it lies between voxels, for layers of `layer` world
    /// units; above 0 unless the polygon is clear. Where α_G is as much, the polygon is wholly there.
    #[must_use]
    pub fn peak(&self, layer: f64) -> f64 {
        self.opacity(1.0, 0.5, layer)
    }
}

/// See [`Ball::filled`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Filled {
    /// α_P and the part of the disc.
    Printed {
        /// Part of the disc, 0..=1 or more.
        part: f64,
        /// α_P.
        opacity: f64,
    },
    /// A spread optical depth.
    Calibrated {
        /// Optical depth per opacity unit that the voxels share.
        depth: f64,
        /// 0 for a spread layer, 1 for one that is lifted to opaque.
        lift: f64,
        /// α of the spread layer one voxel from the plane: what is lifted to 1.
        near: f64,
    },
}

impl Filled {
    /// α_G at `height` voxels from the plane, 0..=1.
    #[must_use]
    #[inline]
    pub fn opacity(self, height: f64) -> f64 {
        match self {
            Self::Printed { part, opacity } => {
                opacity * (part * (1.0 - height * height)).clamp(0.0, 1.0)
            }
            Self::Calibrated { depth, lift, near } => {
                let spread = layered(depth, height);
                if lift > 0.0 {
                    spread + ((spread / near).min(1.0) - spread) * lift
                } else {
                    spread
                }
            }
        }
    }
}

/// An opacity in 0..=1; 0 for what is no number.
fn in_range(opacity: f64) -> f64 {
    if opacity > 0.0 { opacity.min(1.0) } else { 0.0 }
}

/// α of a voxel that gets its part of an optical depth.
fn layered(depth: f64, height: f64) -> f64 {
    -libm::expm1(-depth * tent(height))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit_grid() -> Grid {
        Grid::axis_aligned([4; 3], [1.0; 3], [0.0; 3]).unwrap()
    }

    fn plane(grid: &Grid) -> Flat {
        let corners =
            [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0]].map(|[x, y]| glam::DVec3::new(x, y, 1.0));
        Flat::new(&crate::polygon::face::Face::new(vec![corners.to_vec()]).unwrap(), grid).unwrap()
    }

    fn calibrated(opacity: f64) -> Ball {
        let grid = unit_grid();
        Ball::calibrated(opacity, 1.0, &grid, &[plane(&grid)])
    }

    #[test]
    fn the_printed_ball_is_one_minus_the_squared_height() {
        let ball = Ball::printed(0.8);
        for (height, part, expected) in
            [(0.0, 1.0, 0.8), (0.5, 1.0, 0.6), (0.5, 0.5, 0.3), (1.0, 1.0, 0.0), (0.0, 1.7, 0.8)]
        {
            assert!((ball.opacity(part, height, 1.0) - expected).abs() < 1e-15);
        }
        assert_eq!((ball.radius(0.6), ball.reach()), (0.8, 1.0));
    }

    #[test]
    fn tents_two_voxels_wide_sum_to_one_at_every_phase() {
        for phase in 0..=64 {
            let sum: f64 = (-3..=3).map(|n| tent(f64::from(n) + f64::from(phase) / 64.0)).sum();
            assert!((sum - 1.0).abs() < 1e-15, "{phase}: {sum}");
        }
    }

    #[test]
    fn an_opaque_polygon_makes_every_voxel_within_one_voxel_opaque_and_none_past_two() {
        let ball = calibrated(1.0);
        for n in 0..=16 {
            assert_eq!(ball.opacity(1.0, f64::from(n) / 16.0, 1.0), 1.0);
        }
        assert_eq!([ball.opacity(1.0, 2.0, 1.0), ball.opacity(0.0, 0.0, 1.0)], [0.0, 0.0]);
    }

    #[test]
    fn opacity_rises_with_the_part_and_falls_with_height_for_every_opacity_even_no_number() {
        let extremes =
            [0.0, 1e-9, 1e-7, 0.3, 0.99, 0.995, 1.0 - 1.0 / 16_777_216.0, 1.0, 7.0, f64::NAN];
        for ball in extremes.into_iter().flat_map(|o| [calibrated(o), Ball::printed(o)]) {
            for (part, height) in (0..=32).flat_map(|p| (0..=32).map(move |h| (p, h))) {
                let at =
                    |p: i32, h: i32| ball.opacity(f64::from(p) / 32.0, f64::from(h) / 20.0, 1.0);
                let here = at(part, height);
                assert!((0.0..=1.0).contains(&here), "{ball:?} {part} {height} {here}");
                assert!(
                    at(part + 1, height) >= here - 1e-12 && at(part, height + 1) <= here + 1e-12
                );
                assert!(here <= ball.peak(1.0) || height < 10);
            }
        }
    }
}
