//! Volumes from arrays in memory, as `ndarray` and NumPy lay them out.

use glam::DVec3;

use crate::error::Error;
use crate::shared::Shared;
use crate::volume::grid::{Grid, Painted, Scalars};

/// The components of a volume of scalars, from an array whose last axis runs fastest.
///
/// `shape` and `spacing` are in the order of the array's axes: slices, rows, columns, which are z, y, x of the world. So an
/// `ndarray::Array3` in standard layout and a C-ordered NumPy array give their slice and their shape as they are. Spacings
/// are world units above 0. The middle of the volume lies at the world's origin; replace the [`Grid`] for another place.
/// `voxels` is a `Vec`, which is taken without a copy, or a slice, of any type in [`Scalars`].
pub fn volume(
    voxels: impl Into<Scalars>,
    shape: [usize; 3],
    spacing: [f64; 3],
) -> Result<(Grid, Scalars), Error> {
    let voxels = voxels.into();
    let grid = placed(voxels.len(), shape, spacing)?;
    Ok((grid, voxels))
}

/// The components of a volume whose voxels are RGBA with straight alpha: classified and shaded already.
///
/// Array, shape and spacing are those of [`volume`]; colors are as [`Painted`] has them.
pub fn painted_volume(
    voxels: impl Into<Painted>,
    shape: [usize; 3],
    spacing: [f64; 3],
) -> Result<(Grid, Painted), Error> {
    let voxels = voxels.into();
    let grid = placed(voxels.len(), shape, spacing)?;
    Ok((grid, voxels))
}

/// The grid of an array of `len` voxels, around the world's origin.
fn placed(len: usize, shape: [usize; 3], spacing: [f64; 3]) -> Result<Grid, Error> {
    let wrong = |problem| Error::input("volume", problem);
    let needed = shape.iter().try_fold(1_usize, |product, &n| product.checked_mul(n));
    if needed != Some(len) {
        return Err(wrong(format!(
            "{len} voxels do not fill a shape of {shape:?}; hand over as many as the three sizes multiply to"
        )));
    }
    if !spacing.iter().all(|length| length.is_finite() && *length > 0.0) {
        return Err(wrong(format!(
            "a spacing of {spacing:?} places no voxels; state three lengths above 0 in world units"
        )));
    }
    let ([nz, ny, nx], [dz, dy, dx]) = (shape, spacing);
    let (size, spacing) = ([nx, ny, nz], DVec3::new(dx, dy, dz));
    let last = DVec3::from(size.map(|n| n.saturating_sub(1) as f64));
    Grid::axis_aligned(size, spacing.to_array(), (-0.5 * last * spacing).to_array()).map_err(wrong)
}

macro_rules! from_arrays {
    ($whole:ident: $($kind:ident = $element:ty),*) => {$(
        impl From<Vec<$element>> for $whole {
            fn from(values: Vec<$element>) -> Self {
                Self::$kind(Shared::new(values))
            }
        }
        impl From<&[$element]> for $whole {
            fn from(values: &[$element]) -> Self {
                values.to_vec().into()
            }
        }
        impl From<&Vec<$element>> for $whole {
            fn from(values: &Vec<$element>) -> Self {
                values.as_slice().into()
            }
        }
    )*};
}
from_arrays!(Scalars: U8 = u8, I8 = i8, U16 = u16, I16 = i16, U32 = u32, I32 = i32, U64 = u64, I64 = i64, F32 = f32, F64 = f64);
from_arrays!(Painted: U8 = [u8; 4], U16 = [u16; 4], F32 = [f32; 4]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_axis_runs_fastest_and_is_x() {
        let voxels: Vec<u16> = (0..24).collect();
        let (grid, scalars) = volume(voxels, [4, 3, 2], [5.0, 1.0, 0.5]).unwrap();
        assert_eq!(grid.size, [2, 3, 4]);
        assert_eq!(grid.spacing(), DVec3::new(0.5, 1.0, 5.0));
        assert_eq!(scalars.value(grid.offset([1, 2, 3])), 23.0);
        assert_eq!(scalars.value(grid.offset([1, 0, 0])), 1.0);
        assert_eq!(grid.corners().iter().sum::<DVec3>(), DVec3::ZERO);
    }

    #[test]
    fn arrays_that_do_not_fit_are_refused_with_a_sentence() {
        let refused = |len: usize, shape, spacing| match volume(vec![0.0_f32; len], shape, spacing)
        {
            Err(Error::Input { what: "volume", problem }) => problem,
            other => panic!("{other:?}"),
        };
        assert!(refused(7, [2; 3], [1.0; 3]).contains("7 voxels do not fill a shape of [2, 2, 2]"));
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(refused(8, [2; 3], [1.0, wrong, 1.0]).contains("above 0"));
        }
        assert!(refused(4, [1, 2, 2], [1.0; 3]).contains("at least 2"));
        assert!(refused(0, [0, 1 << 40, 1 << 40], [1.0; 3]).contains("at least 2"));
        assert!(refused(0, [1 << 40, 1 << 40, 0], [1.0; 3]).contains("do not fill"));
        let paint = painted_volume(vec![[0_u8; 4]; 9], [2; 3], [1.0; 3]);
        assert!(matches!(paint, Err(Error::Input { .. })));
    }
}
