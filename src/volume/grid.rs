//! Rectangular grids of voxels in the world, and the dense scalars measured on them (algorithm §1).

use glam::{DAffine3, DMat3, DVec3};

use crate::shared::Shared;

/// Where the voxels of a volume are: the number on each axis and the affine from voxel index to world.
///
/// The origin is the *centre* of voxel (0, 0, 0); columns are direction × spacing in millimetres (or the file's unit).
/// Anisotropic spacing, flipped axes and shear are ordinary. x runs fastest in every array of voxels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Voxels on each axis, each at least 2.
    pub size: [usize; 3],
    /// From voxel index (continuous) to world.
    pub index_to_world: DAffine3,
}

impl Grid {
    /// A grid, checked: at least two voxels on each axis, a product that fits memory, finite and invertible placement.
    ///
    /// The error is a sentence without a subject, for the caller to put the file's or entity's name before it.
    pub fn new(size: [usize; 3], index_to_world: DAffine3) -> Result<Self, String> {
        if let Some(axis) = size.iter().position(|&n| n < 2) {
            return Err(format!(
                "a size of {} on axis {axis} has no domain to render; a volume needs at least 2 voxels on each axis",
                size[axis]
            ));
        }
        size.iter()
            .try_fold(1_usize, |product, &n| product.checked_mul(n))
            .filter(|&n| n < 1 << 48)
            .ok_or_else(|| {
                format!(
                    "sizes {size:?} multiply to more voxels than memory can hold; check the header"
                )
            })?;
        let determinant = index_to_world.matrix3.determinant();
        if !index_to_world.is_finite() || !determinant.is_normal() {
            return Err(
                "its spacings or directions do not span space; each needs a finite length above 0 and its own direction"
                    .to_owned(),
            );
        }
        Ok(Self { size, index_to_world })
    }

    /// A grid along the world's axes: `spacing` (each above 0 or, for a flipped axis, below) and the first voxel's centre.
    pub fn axis_aligned(
        size: [usize; 3],
        spacing: [f64; 3],
        origin: [f64; 3],
    ) -> Result<Self, String> {
        let matrix = DMat3::from_diagonal(DVec3::from(spacing));
        Self::new(size, DAffine3 { matrix3: matrix, translation: DVec3::from(origin) })
    }

    /// Number of voxels.
    #[must_use]
    pub fn voxels(&self) -> usize {
        self.size.iter().product()
    }

    /// Position in an array of voxels, x fastest.
    #[must_use]
    pub fn offset(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    /// Distance between neighbouring voxels along each index axis, world units.
    #[must_use]
    pub fn spacing(&self) -> DVec3 {
        let m = self.index_to_world.matrix3;
        DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length())
    }

    /// From world to voxel index (continuous).
    #[must_use]
    pub fn world_to_index(&self) -> DAffine3 {
        self.index_to_world.inverse()
    }

    /// The eight corners of the domain in the world: the first and last voxel centres on each axis.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|corner| {
            let index = |axis: usize| {
                if corner >> axis & 1 == 1 { (self.size[axis] - 1) as f64 } else { 0.0 }
            };
            self.index_to_world.transform_point3(DVec3::new(index(0), index(1), index(2)))
        })
    }
}

/// One number a voxel, in the type it was stored in; `len` is the grid's number of voxels, x fastest.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs, reason = "the variants are the types")]
pub enum Scalars {
    U8(Shared<u8>),
    I8(Shared<i8>),
    U16(Shared<u16>),
    I16(Shared<i16>),
    U32(Shared<u32>),
    I32(Shared<i32>),
    U64(Shared<u64>),
    I64(Shared<i64>),
    F32(Shared<f32>),
    F64(Shared<f64>),
}

/// Four numbers a voxel, RGBA with straight alpha, classified and shaded already: no gradient, no shading is made of it.
///
/// Integer colours are sRGB and their alpha linear; float colours are linear. Alpha is the opacity per opacity unit.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs, reason = "the variants are the types")]
pub enum Painted {
    U8(Shared<[u8; 4]>),
    U16(Shared<[u16; 4]>),
    F32(Shared<[f32; 4]>),
}

/// A number type that a scanner's file may hold.
pub trait Scalar: Copy + Send + Sync + 'static {
    /// The value as the renderer computes with it; exact for up to 16 bits.
    fn value(self) -> f32;
    /// `self − other` without overflow, rounded once.
    fn minus(self, other: Self) -> f32;
    /// The smaller number; the other where one is a NaN.
    #[must_use]
    fn least(self, other: Self) -> Self;
    /// The larger number; the other where one is a NaN.
    #[must_use]
    fn most(self, other: Self) -> Self;
    /// The largest and the smallest of all numbers, infinite ones included: what every range lies between.
    const ENDS: [Self; 2];
    /// Whether there is a NaN among the numbers of this type.
    const HAS_NAN: bool;
}

macro_rules! scalar {
    ($($kind:ident => $wide:ident, $most:ident, $least:ident, $nan:literal;)*) => {$(
        #[allow(clippy::cast_lossless, reason = "one body for all types")]
        impl Scalar for $kind {
            #[inline]
            fn value(self) -> f32 { self as f32 }
            #[inline]
            fn minus(self, other: Self) -> f32 { (self as $wide - other as $wide) as f32 }
            #[inline]
            fn least(self, other: Self) -> Self { self.min(other) }
            #[inline]
            fn most(self, other: Self) -> Self { self.max(other) }
            const ENDS: [Self; 2] = [$kind::$most, $kind::$least];
            const HAS_NAN: bool = $nan;
        }
    )*};
}
scalar! {
    u8 => i32, MAX, MIN, false;
    i8 => i32, MAX, MIN, false;
    u16 => i32, MAX, MIN, false;
    i16 => i32, MAX, MIN, false;
    u32 => i64, MAX, MIN, false;
    i32 => i64, MAX, MIN, false;
    u64 => i128, MAX, MIN, false;
    i64 => i128, MAX, MIN, false;
    f32 => f64, INFINITY, NEG_INFINITY, true;
    f64 => f64, INFINITY, NEG_INFINITY, true;
}

/// Runs an expression on the typed slice inside [`Scalars`]: `with_scalars!(scalars, values => expression)`.
#[macro_export]
macro_rules! with_scalars {
    ($scalars:expr, $values:ident => $body:expr) => {
        match $scalars {
            $crate::volume::grid::Scalars::U8($values) => $body,
            $crate::volume::grid::Scalars::I8($values) => $body,
            $crate::volume::grid::Scalars::U16($values) => $body,
            $crate::volume::grid::Scalars::I16($values) => $body,
            $crate::volume::grid::Scalars::U32($values) => $body,
            $crate::volume::grid::Scalars::I32($values) => $body,
            $crate::volume::grid::Scalars::U64($values) => $body,
            $crate::volume::grid::Scalars::I64($values) => $body,
            $crate::volume::grid::Scalars::F32($values) => $body,
            $crate::volume::grid::Scalars::F64($values) => $body,
        }
    };
}

impl Scalars {
    /// Number of voxels.
    #[must_use]
    pub fn len(&self) -> usize {
        with_scalars!(self, values => values.len())
    }

    /// Whether there is no voxel.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes that the values take.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        with_scalars!(self, values => values.bytes())
    }

    /// The value of one voxel; panics past the end.
    #[must_use]
    pub fn value(&self, offset: usize) -> f32 {
        with_scalars!(self, values => values[offset].value())
    }
}

/// The smallest spacing of some grids, world units: how far samples are apart where nothing is stated; `None` without a grid.
#[must_use]
pub fn smallest_spacing(grids: impl IntoIterator<Item = Grid>) -> Option<f64> {
    grids.into_iter().map(|grid| grid.spacing().min_element()).reduce(f64::min)
}

impl Painted {
    /// Number of voxels.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::U8(values) => values.len(),
            Self::U16(values) => values.len(),
            Self::F32(values) => values.len(),
        }
    }

    /// Whether there is no voxel.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes that the values take.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        match self {
            Self::U8(values) => values.bytes(),
            Self::U16(values) => values.bytes(),
            Self::F32(values) => values.bytes(),
        }
    }
}
