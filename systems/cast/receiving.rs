//! Shadows on the polygons of a view: at which point nearer to a light its strength is read (paper §4).
//!
//! A polygon casts its shadow as a layer of voxels that reaches some voxels to either side of it. Where the strength were
//! read within that layer, the polygon would be in a shadow of its own, the more so the flatter the light falls: it is
//! read from where the light has not met the layer yet, or a bias nearer to the light if that is farther.

use glam::DVec3;

use crate::light::shading::Lamp;
use crate::light::strength::LightStrength;
use crate::light::strength::Shear;
use crate::polygon::coverage::REACH;
use crate::volume::grid::Grid;

/// The least cosine between a face's normal and a light that the way is stretched by: what light falls flatter than that
/// is faint, and its way would leave out what else stands in it.
const FLATTEST: f64 = 0.2;

/// The way from a point on a face of unit normal `normal` to the point whose strength of a light it gets, world units.
pub(crate) fn shadow_offset(
    normal: DVec3,
    (lamp, strength): (&Lamp, Option<&LightStrength>),
    grid: &Grid,
) -> DVec3 {
    let covector = grid.index_to_world.matrix3.transpose() * normal;
    let toward = lamp.toward.as_dvec3();
    let bias = strength.map_or(0.0, LightStrength::bias);
    // Opacities are interpolated within slices, and strengths between columns and slices: so many cells farther does
    // the layer reach.
    let slices = Shear::new(grid, toward).map(|shear| shear.axes[2]);
    let cells =
        DVec3::from(std::array::from_fn(|axis| f64::from(2 - u8::from(slices == Some(axis)))));
    let clear = REACH * covector.length() + covector.abs().dot(cells);
    toward * bias.max(clear / normal.dot(toward).abs().max(FLATTEST))
}
