//! Calibration of scan-conversion (algorithm §8): by how much an optical depth has to grow before it is spread.
//!
//! A ray that meets the layer of voxels face-on interpolates α, not τ, between them, and −ln(1 − α) of interpolated
//! opacities is less than the interpolated depth: the layer would be too clear. How much too clear depends on the depth
//! itself, on the thickness of the voxels against the opacity unit and on the sample distance. So the layer is ray traced
//! here, once a polygon, in one dimension, over all phases of plane and samples, and the depth is scaled until the mean
//! opacity is as stated.
//!
//! What is left, of planes perpendicular to an axis, seen face-on: the phases spread by at most 2 % of the stated opacity
//! (8 % to 10 % if the opacity unit is five voxels), and a smaller sample distance moves the mean by less than 0.1 %
//! (0.2 %). Planes aslant in the grid ripple with the phase, by −4 % to +7 % at an opacity of 0.1 and ±2 % at 0.9, for
//! tri-linear interpolation does not tell the voxels' own pattern from the plane; their mean is right to 0.5 %. A sample
//! distance over a voxel may step over an opaque polygon.

use super::layer::tent;

/// Depths for which the scale is found: steps between 0 and the polygon's own.
const DEPTHS: usize = 8;
/// Thicknesses for which it is found, where faces of a mesh differ in it.
const LAYERS: usize = 5;
/// Phases of the plane between voxels, and of the samples between samples.
const PHASES: u32 = 8;

/// The scale of optical depths, by depth and by the thickness of voxels along the normal.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Calibration {
    unit: f64,
    deepest: f64,
    /// 1 / thickness, rising: the scale is nearly linear in it.
    thin: [f64; 2],
    scales: Vec<[f64; DEPTHS + 1]>,
}

impl Calibration {
    /// For depths in 0..=`deepest` and voxels `layers[0]..=layers[1]` thick, with samples `distance` apart and opacities
    /// per `unit`: all in world units, above 0.
    pub(super) fn new(deepest: f64, unit: f64, distance: f64, layers: [f64; 2]) -> Self {
        let thin = [1.0 / layers[1], 1.0 / layers[0]];
        let rows = if layers[1] - layers[0] <= 1e-9 * layers[1] { 1 } else { LAYERS };
        let row = |n: usize| {
            let place = if rows > 1 { n as f64 / (rows - 1) as f64 } else { 0.0 };
            let thin = thin[0] + (thin[1] - thin[0]) * place;
            // Steps finer than an eighth of a voxel change nothing; ones over a voxel are not calibrated for.
            let step = (distance * thin).clamp(0.125, 1.0);
            scales(deepest, unit * thin, step)
        };
        Self { unit, deepest, thin, scales: (0..rows).map(row).collect() }
    }

    /// The optical depth per opacity unit that voxels share, `layer` world units thick, for a ray that gathers `depth`.
    pub(super) fn depth_in_layer(&self, depth: f64, layer: f64) -> f64 {
        let [low, high] = self.thin;
        let row = if high > low { (1.0 / layer - low) / (high - low) } else { 0.0 };
        let (below, above, between) = neighbours(row, self.scales.len());
        let place = if self.deepest > 0.0 { depth / self.deepest } else { 0.0 };
        let (shallow, deep, part) = neighbours(place, DEPTHS + 1);
        let in_row = |row: usize| {
            let scales = &self.scales[row];
            scales[shallow] + (scales[deep] - scales[shallow]) * part
        };
        let scale = in_row(below) + (in_row(above) - in_row(below)) * between;
        depth * scale * self.unit / layer
    }
}

/// The entries of a table of `len` around `place` in 0..=1 of it, and how far it lies from the first to the second.
fn neighbours(place: f64, len: usize) -> (usize, usize, f64) {
    let place = place.clamp(0.0, 1.0) * (len - 1) as f64;
    let below = (place as usize).min(len - 1);
    (below, (below + 1).min(len - 1), place - below as f64)
}

/// The scales for depths 0, 1/8, … 1 of `deepest`, where u is `ratio` voxels and samples are `step` voxels apart.
fn scales(deepest: f64, ratio: f64, step: f64) -> [f64; DEPTHS + 1] {
    let mut scales = [1.0; DEPTHS + 1];
    for n in 1..=DEPTHS {
        let depth = deepest * n as f64 / DEPTHS as f64;
        let mut scale: f64 = scales[n - 1];
        for _ in 0..6 {
            let gathered = gathered(depth * scale * ratio, step, step / ratio);
            if gathered > 0.0 && gathered.is_finite() {
                scale = (scale * depth / gathered).clamp(1.0, 64.0);
            }
        }
        scales[n] = scale;
    }
    scales
}

/// The optical depth of the mean opacity, over all phases, of a layer whose voxels share `depth`: its rays sample every
/// `step` voxels and correct their opacity by the exponent `ratio`.
fn gathered(depth: f64, step: f64, ratio: f64) -> f64 {
    let mut opacity = 0.0;
    for plane in 0..PHASES {
        let above = |voxel: usize| voxel as f64 - 3.0 - f64::from(plane) / f64::from(PHASES);
        let layer: [f64; 8] = std::array::from_fn(|n| -libm::expm1(-depth * tent(above(n))));
        for phase in 0..PHASES {
            let mut logarithm = 0.0;
            let mut at = (f64::from(phase) + 0.5) / f64::from(PHASES) * step;
            while at < 7.0 {
                let (voxel, between) = (at as usize, at.fract());
                let alpha = layer[voxel] + (layer[voxel + 1] - layer[voxel]) * between;
                logarithm += libm::log1p(-alpha.min(1.0));
                at += step;
            }
            opacity -= libm::expm1(ratio * logarithm);
        }
    }
    -libm::log1p(-opacity / f64::from(PHASES * PHASES))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_depth_is_gathered_again_in_thin_voxels_and_thick_ones() {
        for (unit, layers) in
            [(1.0, [1.0, 1.0]), (1.0, [1.0, 4.0]), (3.0, [1.0, 2.0]), (0.5, [1.0, 1.0])]
        {
            let calibration = Calibration::new(4.6, unit, 1.0, layers);
            for depth in [1e-9, 1e-3, 0.1, 0.693, 1.7, 4.6] {
                for layer in [layers[0], f64::midpoint(layers[0], layers[1]), layers[1]] {
                    let spread = calibration.depth_in_layer(depth, layer);
                    let found = gathered(spread, 1.0 / layer, 1.0 / unit);
                    let (found, stated) = (-found.exp_m1(), -depth.exp_m1());
                    let error = ((-found).ln_1p() - (-stated).ln_1p()).abs();
                    assert!(error <= 0.02 * depth, "{unit} {layer} {depth}: {error}");
                }
            }
        }
    }

    #[test]
    fn the_scale_is_1_for_the_faintest_and_bounded_for_any_unit() {
        for unit in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
            let calibration = Calibration::new(4.6, unit, 1.0, [1.0, 1.0]);
            let scales = calibration.scales[0];
            assert!(
                scales[0] == 1.0 && scales.iter().all(|s| (1.0..=64.0).contains(s)),
                "{scales:?}"
            );
        }
    }
}
