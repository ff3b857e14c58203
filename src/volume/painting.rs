//! Painted volumes: RGBA that came classified and shaded, brought to linear light and cut where a clip says so.

use std::sync::LazyLock;

use glam::{Vec3, Vec4};

use crate::components::color::to_linear;
use crate::components::{Clip, TexelKind};
use crate::volume::clipping::{Cut, Left};
use crate::volume::gel::{CELLS, FAINT};
use crate::volume::grid::{Grid, Painted};

/// Linear intensity of every 8-bit sRGB channel.
static LINEAR_8: LazyLock<Vec<f32>> = LazyLock::new(|| table(255));
/// Linear intensity of every 16-bit sRGB channel.
static LINEAR_16: LazyLock<Vec<f32>> = LazyLock::new(|| table(65535));

fn table(most: u16) -> Vec<f32> {
    (0..=most).map(|n| to_linear(f32::from(n) / f32::from(most))).collect()
}

/// A voxel that came with a colour and an opacity.
trait Paint: Copy {
    /// α in 0..=1; 0 for a NaN.
    fn opacity(self) -> f32;
    /// Straight linear colour, finite and not negative.
    fn color(self) -> Vec3;
}

impl Paint for [u8; 4] {
    fn opacity(self) -> f32 {
        f32::from(self[3]) / 255.0
    }
    fn color(self) -> Vec3 {
        let [r, g, b, _] = self.map(|channel| LINEAR_8[usize::from(channel)]);
        Vec3::new(r, g, b)
    }
}

impl Paint for [u16; 4] {
    fn opacity(self) -> f32 {
        f32::from(self[3]) / 65535.0
    }
    fn color(self) -> Vec3 {
        let [r, g, b, _] = self.map(|channel| LINEAR_16[usize::from(channel)]);
        Vec3::new(r, g, b)
    }
}

impl Paint for [f32; 4] {
    fn opacity(self) -> f32 {
        if self[3] > 0.0 { self[3].min(1.0) } else { 0.0 }
    }
    fn color(self) -> Vec3 {
        let [r, g, b, _] = self.map(|c| if c.is_finite() { c.max(0.0) } else { 0.0 });
        Vec3::new(r, g, b)
    }
}

/// A painted volume on its grid, after clipping.
#[derive(Debug)]
pub(crate) struct Painting<'a> {
    painted: &'a Painted,
    grid: Grid,
    cut: Option<Cut>,
}

impl<'a> Painting<'a> {
    /// The painting of `painted` on `grid`, with what `clip` cuts away taken off its opacity.
    #[must_use]
    pub fn new(painted: &'a Painted, grid: &Grid, clip: Option<&Clip>) -> Self {
        Self { painted, grid: *grid, cut: clip.map(|clip| Cut::new(clip, grid)) }
    }

    /// Whether a brick of gel is stored: whether one of the 9³ voxels from its first on is interesting.
    #[must_use]
    pub fn holds(&self, brick: [usize; 3]) -> bool {
        let first = brick.map(|b| b * CELLS);
        let extent =
            std::array::from_fn(|axis| (CELLS + 1).min(self.grid.size[axis] - first[axis]));
        self.left(first, extent) != Left::Nothing
            && match self.painted {
                Painted::U8(values) => self.is_seen(values, first, extent),
                Painted::U16(values) => self.is_seen(values, first, extent),
                Painted::F32(values) => self.is_seen(values, first, extent),
            }
    }

    /// 16-bit texels for integers some of which are not faint, which colours of integers are never too bright for; else 32-bit
    /// ones.
    #[must_use]
    pub(crate) fn suited(&self) -> TexelKind {
        fn is_faint<T: Paint>(values: &[T]) -> bool {
            values.iter().all(|voxel| voxel.opacity() <= FAINT)
        }
        let faint = match self.painted {
            Painted::U8(values) => is_faint(values),
            Painted::U16(values) => is_faint(values),
            Painted::F32(_) => true,
        };
        if faint { TexelKind::F32 } else { TexelKind::U16 }
    }

    fn is_seen<T: Paint>(&self, values: &[T], first: [usize; 3], extent: [usize; 3]) -> bool {
        let [x, y, z] = first;
        let mut starts =
            (0..extent[2]).flat_map(|dz| (0..extent[1]).map(move |dy| [y + dy, z + dz]));
        starts.any(|[y, z]| {
            let voxels = values[self.grid.offset([x, y, z])..][..extent[0]].iter().enumerate();
            let mut seen = voxels.filter(|(_, voxel)| voxel.opacity() > 0.0);
            seen.any(|(dx, _)| self.factor([x + dx, y, z]) > 0.0)
        })
    }

    /// Straight linear colour and opacity of the voxels of `row`, from voxel `first` on along x.
    pub fn row(&self, first: [usize; 3], row: &mut [Vec4]) {
        let offset = self.grid.offset(first);
        match self.painted {
            Painted::U8(values) => fill(&values[offset..], row),
            Painted::U16(values) => fill(&values[offset..], row),
            Painted::F32(values) => fill(&values[offset..], row),
        }
        if self.left(first, [row.len(), 1, 1]) != Left::Whole {
            for (x, voxel) in row.iter_mut().enumerate() {
                voxel.w *= self.factor([first[0] + x, first[1], first[2]]);
            }
        }
    }

    fn factor(&self, voxel: [usize; 3]) -> f32 {
        self.cut.as_ref().map_or(1.0, |cut| cut.factor(voxel))
    }

    fn left(&self, first: [usize; 3], extent: [usize; 3]) -> Left {
        self.cut.as_ref().map_or(Left::Whole, |cut| cut.left(first, extent))
    }
}

fn fill<T: Paint>(values: &[T], row: &mut [Vec4]) {
    for (voxel, value) in row.iter_mut().zip(values) {
        *voxel = value.color().extend(value.opacity());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::Shared;

    fn grid() -> Grid {
        Grid::axis_aligned([17, 9, 9], [1.0; 3], [0.0; 3]).unwrap()
    }

    fn row(painted: &Painted, clip: Option<&Clip>) -> [Vec4; 9] {
        let mut row = [Vec4::ZERO; 9];
        Painting::new(painted, &grid(), clip).row([8, 3, 4], &mut row);
        row
    }

    #[test]
    fn integer_colors_are_srgb_and_float_colors_linear_and_alpha_is_linear_in_both() {
        let voxels = grid().voxels();
        let eight = Painted::U8(Shared::new(vec![[255, 128, 0, 51]; voxels]));
        let sixteen = Painted::U16(Shared::new(vec![[65535, 128 * 257, 0, 13107]; voxels]));
        let float = Painted::F32(Shared::new(vec![[1.0, 0.215_860_5, 0.0, 0.2]; voxels]));
        for painted in [eight, sixteen, float] {
            let [voxel, ..] = row(&painted, None);
            assert!(voxel.abs_diff_eq(Vec4::new(1.0, 0.215_860_5, 0.0, 0.2), 1e-6), "{voxel}");
        }
    }

    #[test]
    fn what_is_no_number_is_clear_and_black() {
        let voxels = grid().voxels();
        let paint = |rgba| row(&Painted::F32(Shared::new(vec![rgba; voxels])), None)[0];
        assert_eq!(paint([f32::NAN, -1.0, 2.0, f32::NAN]), Vec4::new(0.0, 0.0, 2.0, 0.0));
        assert_eq!(paint([f32::INFINITY, 0.5, 0.0, 7.0]), Vec4::new(0.0, 0.5, 0.0, 1.0));
    }

    #[test]
    fn a_clip_takes_opacity_and_with_it_bricks() {
        let painted = Painted::U8(Shared::new(vec![[255; 4]; grid().voxels()]));
        let clip = Clip { planes: vec![[1.0, 0.0, 0.0, 10.0]], r#box: None };
        let alphas = row(&painted, Some(&clip)).map(|voxel| voxel.w);
        assert_eq!(alphas, [1.0, 1.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let painting = Painting::new(&painted, &grid(), Some(&clip));
        let held = [0, 1, 2].map(|x| painting.holds([x, 1, 1]));
        assert_eq!(held, [true, true, false]);
    }
}
