//! A cut through a volume: opacity falls from whole to none over one voxel, so that a cut face shows no stairs.

use glam::{DAffine3, DVec3};

use crate::components::Clip;
use crate::volume::grid::Grid;

/// A stated [`Clip`] over the voxels of a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    clip: Clip,
    index_to_world: DAffine3,
    /// Over how much the opacity falls: the smallest spacing, world units.
    width: f64,
}

/// How much of a block of voxels a cut leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Left {
    /// All of it, as it was.
    Whole,
    /// Ask each voxel.
    Part,
    /// Nothing.
    Nothing,
}

impl Cut {
    /// The cut that `clip` makes in a volume on `grid`.
    #[must_use]
    pub fn new(clip: &Clip, grid: &Grid) -> Self {
        let width = grid.spacing().min_element();
        Self { clip: clip.clone(), index_to_world: grid.index_to_world, width }
    }

    /// What is left of the `extent` voxels from `first` on; `Part` where a bounding sphere cannot tell.
    #[must_use]
    pub fn left(&self, first: [usize; 3], extent: [usize; 3]) -> Left {
        let half = DVec3::from(extent.map(|n| n.saturating_sub(1) as f64 / 2.0));
        let middle = DVec3::from(first.map(|n| n as f64)) + half;
        let m = self.index_to_world.matrix3;
        let radius =
            m.x_axis.length() * half.x + m.y_axis.length() * half.y + m.z_axis.length() * half.z;
        let inside = self.clip.distance(self.index_to_world.transform_point3(middle));
        if inside - radius >= self.width / 2.0 {
            Left::Whole
        } else if inside + radius <= -self.width / 2.0 {
            Left::Nothing
        } else {
            Left::Part
        }
    }

    /// What the opacity of a voxel is multiplied by, 0..=1: 1/2 on the cut itself.
    #[must_use]
    pub fn factor(&self, voxel: [usize; 3]) -> f32 {
        let voxel = DVec3::from(voxel.map(|n| n as f64));
        let inside = self.clip.distance(self.index_to_world.transform_point3(voxel));
        // The distance is no NaN: a plane or box that is one cuts nothing.
        (inside / self.width + 0.5).clamp(0.0, 1.0) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        Grid::axis_aligned([20, 10, 10], [1.0, 2.0, -3.0], [5.0, 0.0, 0.0]).unwrap()
    }

    #[test]
    fn opacity_falls_from_whole_to_none_over_the_smallest_spacing() {
        let plane = |d: f64| Clip { planes: vec![[2.0, 0.0, 0.0, 2.0 * d]], r#box: None };
        let factors = |d: f64| [9, 10, 11].map(|x| Cut::new(&plane(d), &grid()).factor([x, 3, 4]));
        assert_eq!(factors(15.0), [1.0, 0.5, 0.0]);
        assert_eq!(factors(15.25), [1.0, 0.75, 0.0]);
        assert_eq!(factors(15.5), [1.0, 1.0, 0.0]);
    }

    #[test]
    fn what_is_said_of_a_block_is_true_of_each_of_its_voxels() {
        let clip = Clip {
            planes: vec![[1.0, 1.0, 0.0, 25.0]],
            r#box: Some([[0.0, 0.0, -12.0], [9.5, 8.0, 0.0]]),
        };
        let cut = Cut::new(&clip, &grid());
        let mut seen = [0; 3];
        for (x, y, z) in (0..720).map(|i| (i % 18, i / 18 % 8, i / 144 * 2)) {
            let left = cut.left([x, y, z], [2; 3]);
            seen[left as usize] += 1;
            for at in 0..8 {
                let factor = cut.factor([x + (at & 1), y + (at >> 1 & 1), z + (at >> 2)]);
                match left {
                    Left::Whole => assert_eq!(factor, 1.0),
                    Left::Nothing => assert_eq!(factor, 0.0),
                    Left::Part => assert!((0.0..=1.0).contains(&factor)),
                }
            }
        }
        assert!(seen.iter().all(|&n| n > 0), "{seen:?}");
    }
}
