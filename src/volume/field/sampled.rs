//! Where a field is asked for, and what it is there: at one place, and at four side by side.

/// Places that are sampled side by side.
pub const FOUR: usize = 4;

/// A place in a grid: a cell by its first voxel, and how far it is through the cell on each axis, 0..=1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spot {
    /// The cell.
    pub cell: [usize; 3],
    /// The way through it.
    pub part: [f32; 3],
}

/// What a field is at a place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sampled {
    /// f; a NaN where a voxel that it is made of is no finite number.
    pub value: f32,
    /// ∇f in the world; zero where a voxel that it needs is no number.
    pub gradient: [f32; 3],
}

/// What a field is at four places; each is as in [`Sampled`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SampledFour {
    /// f.
    pub values: [f32; FOUR],
    /// ∇f in the world, axis by axis.
    pub gradients: [[f32; FOUR]; 3],
}

impl SampledFour {
    /// What it is at one of them.
    #[must_use]
    #[inline]
    pub fn one(&self, at: usize) -> Sampled {
        let [x, y, z] = &self.gradients;
        Sampled { value: self.values[at], gradient: [x[at], y[at], z[at]] }
    }
}
