//! Where the voxels of a NIfTI-1 file are: its affine rows, else its quaternion, else its spacings alone.

use glam::{DAffine3, DMat3, DVec3};

use super::header::Header;

/// From voxel index to world (LPS); columns may be 0 or NaN where the file says so.
pub(super) fn affine(header: &Header, warnings: &mut Vec<String>) -> DAffine3 {
    let to_lps = DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0));
    let found = stated(header, warnings);
    DAffine3 { matrix3: to_lps * found.matrix3, translation: to_lps * found.translation }
}

/// From voxel index to right, anterior, superior.
fn stated(header: &Header, warnings: &mut Vec<String>) -> DAffine3 {
    if header.affine_code > 0 {
        let rows = rows(header);
        if rows.matrix3.determinant().is_normal() && rows.is_finite() {
            return rows;
        }
        warnings.push("its sform does not span space and is not used".to_owned());
    }
    let [_, dx, dy, dz] = header.spacing.map(f64::abs);
    if header.quaternion_code > 0 {
        let [b, c, d, x, y, z] = header.quaternion;
        // A `pixdim[0]` of -1 flips the third axis; files with a 0 there mean 1.
        let handed = if header.spacing[0] < 0.0 { -1.0 } else { 1.0 };
        let matrix3 = rotation(b, c, d) * DMat3::from_diagonal(DVec3::new(dx, dy, handed * dz));
        return DAffine3 { matrix3, translation: DVec3::new(x, y, z) };
    }
    warnings.push(
        "its header states no orientation: its axes are taken as right, anterior and superior"
            .to_owned(),
    );
    DAffine3::from_scale(DVec3::new(dx, dy, dz))
}

fn rows(header: &Header) -> DAffine3 {
    let m = &header.affine;
    let column = |j: usize| DVec3::new(m[j], m[4 + j], m[8 + j]);
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}

/// The rotation of the unit quaternion whose vector part is (b, c, d) and whose real part is not negative.
fn rotation(b: f64, c: f64, d: f64) -> DMat3 {
    let square = b * b + c * c + d * d;
    // Rounded to 32 bits, a half turn may come out longer than 1.
    let (a, b, c, d) = if square > 1.0 {
        let length = square.sqrt();
        (0.0, b / length, c / length, d / length)
    } else {
        ((1.0 - square).sqrt(), b, c, d)
    };
    DMat3::from_cols(
        DVec3::new(a * a + b * b - c * c - d * d, 2.0 * (b * c + a * d), 2.0 * (b * d - a * c)),
        DVec3::new(2.0 * (b * c - a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d + a * b)),
        DVec3::new(2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a + d * d - c * c - b * b),
    )
}
