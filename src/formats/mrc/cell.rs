//! Where the voxels of a map are: fractions of a crystal's cell, which may be oblique.

use glam::{DAffine3, DMat3, DVec3};

use super::header::Header;

/// From column, row and section to the map's coordinates in Å.
///
/// X lies along the cell's first edge and Y in the plane of the first two, as in files of atoms. The first voxel is at
/// the origin of words 50 to 52 where that is not 0, else at the start counted in voxels of the cell.
pub(super) fn affine(header: &Header, warnings: &mut Vec<String>) -> DAffine3 {
    let steps = steps(header, warnings);
    let matrix3 =
        DMat3::from_cols(steps[header.axes[0]], steps[header.axes[1]], steps[header.axes[2]]);
    let origin = DVec3::from(header.origin);
    let translation = if origin.is_finite() && origin != DVec3::ZERO {
        origin
    } else {
        matrix3 * DVec3::from(header.start.map(f64::from))
    };
    DAffine3 { matrix3, translation }
}

/// From a voxel to the next along X, Y and Z of the cell.
fn steps(header: &Header, warnings: &mut Vec<String>) -> [DVec3; 3] {
    if !header.lengths.iter().all(|&length| length > 0.0 && length.is_finite()) {
        warnings.push(format!(
            "its cell of {:?} is none: voxels are taken as 1 Å apart; state `spacing_mm` if they are not",
            header.lengths
        ));
        return [DVec3::X, DVec3::Y, DVec3::Z];
    }
    let edges = edges(header, warnings);
    std::array::from_fn(|axis| {
        let stated = header.sampling[axis];
        let along = header.axes.iter().position(|&a| a == axis).unwrap_or(axis);
        let voxels = if stated > 0 { f64::from(stated) } else { header.size[along] as f64 };
        edges[axis] / voxels
    })
}

/// The edges of the cell.
fn edges(header: &Header, warnings: &mut Vec<String>) -> [DVec3; 3] {
    let [a, b, c] = header.lengths;
    let [(alpha, _), (beta, _), (gamma, sine)] = header.angles.map(cosine_and_sine);
    let x = beta;
    let y = (alpha - beta * gamma) / sine;
    let height = 1.0 - x * x - y * y;
    let open = header.angles.iter().all(|&angle| angle > 0.0 && angle < 180.0);
    if !open || height <= 1e-9 {
        warnings.push(format!(
            "its cell has angles of {:?} degrees, which span no space: right angles are taken",
            header.angles
        ));
        return [a * DVec3::X, b * DVec3::Y, c * DVec3::Z];
    }
    [a * DVec3::X, b * DVec3::new(gamma, sine, 0.0), c * DVec3::new(x, y, height.sqrt())]
}

/// Exact at right angles, as nearly all cells have.
fn cosine_and_sine(degrees: f64) -> (f64, f64) {
    #[allow(clippy::float_cmp, reason = "the header's own 90")]
    if degrees == 90.0 {
        return (0.0, 1.0);
    }
    (libm::cos(degrees.to_radians()), libm::sin(degrees.to_radians()))
}
