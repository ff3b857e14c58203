//! What a scene states of a volume file (its `volume` keys), and the grid that comes of it and of the file's header.

use glam::{DAffine3, DMat3, DVec3};

use crate::volume::grid::Grid;

/// What a scene says of a volume file; all of it may be left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stated {
    /// Voxels on each axis of a headerless file.
    pub size: Option<[usize; 3]>,
    /// Number type of a headerless file, as NRRD names it (`uint8`, `unsigned short`, `float`, …).
    pub voxel_type: Option<String>,
    /// Byte order of a headerless file of more than one byte a number: `little` or `big`.
    pub endian: Option<String>,
    /// Spacing in world units that replaces the file's; negative flips the axis about the volume's centre.
    pub spacing_mm: Option<[f64; 3]>,
    /// Which channel is read of a file of several, 0 the first.
    pub channel: Option<usize>,
    /// Which time is read of a file of several, 0 the first.
    pub time: Option<usize>,
}

impl Stated {
    /// Fails where the stated spacing is none.
    pub(super) fn check(&self) -> Result<(), String> {
        match self.spacing_mm {
            Some(spacing) if !spacing.iter().all(|s| s.is_normal()) => Err(format!(
                "`spacing_mm` is {spacing:?}, and each of the three must be finite and not 0; state the distance between voxels on each axis, negative to flip it"
            )),
            _ => Ok(()),
        }
    }

    /// The grid of a file: its header's placement, with the stated spacing in place of the header's.
    ///
    /// The first voxel stays where it was, except on a flipped axis: there the last voxel takes its place, so that the
    /// domain fills the same part of the world. A column without a direction (0 or NaN) takes that of its own axis.
    pub(super) fn grid(&self, size: [usize; 3], file: DAffine3) -> Result<Grid, String> {
        let placed = self.spacing_mm.map_or(file, |spacing| respaced(size, file, spacing));
        let columns = [placed.x_axis, placed.y_axis, placed.z_axis];
        if !columns.iter().all(|column| column.length().is_normal()) {
            let found = columns.map(DVec3::length);
            return Err(format!(
                "its spacing is {found:?}, and each of the three must be finite and not 0; correct the header or state `spacing_mm` for this volume"
            ));
        }
        Grid::new(size, placed)
    }

    /// What is stated of a key that chooses among the volumes of a file: `channel` or `time`.
    fn choice(&self, key: &str) -> Option<usize> {
        if key == "channel" { self.channel } else { self.time }
    }

    /// Which of `count` channels or times is read, as `key` says, and a sentence where it says nothing of several; `names` are
    /// what some of them are called. Fails where there are not so many.
    pub(super) fn chosen(
        &self,
        key: &str,
        count: usize,
        names: &[String],
    ) -> Result<(usize, Option<String>), String> {
        match self.choice(key) {
            Some(wanted) if wanted >= count => Err(format!(
                "`{key}` is {wanted}, and it has {count} {key}s, the first of which is 0; correct it"
            )),
            Some(wanted) => Ok((wanted, None)),
            None if count <= 1 => Ok((0, None)),
            None => {
                let names = names.iter().filter(|name| !name.is_empty()).take(20);
                let names: Vec<_> = names.map(|name| format!("`{name}`")).collect();
                let names = if names.is_empty() {
                    String::new()
                } else {
                    format!(" ({})", names.join(", "))
                };
                let said = format!(
                    "of its {count} {key}s{names} the first is read; state `{key}` for another, 1 to {} (`--{key} 1` without a scene)",
                    count - 1
                );
                Ok((0, Some(said)))
            }
        }
    }

    /// A warning for each key that only a file of several volumes has a use for, but those that the format `takes`.
    pub(super) fn unused_choices(&self, takes: &[&str]) -> impl Iterator<Item = String> {
        let stated = |key: &&str| self.choice(key).is_some() && !takes.contains(key);
        ["channel", "time"].into_iter().filter(stated).map(|key| {
            format!(
                "the file's format has no more than one `{key}` a file: the stated one is not used"
            )
        })
    }

    /// A warning for each key that only a headerless file has a use for.
    pub(super) fn unused(&self) -> impl Iterator<Item = String> {
        [
            ("size", self.size.is_some()),
            ("voxel_type", self.voxel_type.is_some()),
            ("endian", self.endian.is_some()),
        ]
        .into_iter()
        .filter(|(_, stated)| *stated)
        .map(|(key, _)| {
            format!("the file's own header says its {key}: the stated `{key}` is not used")
        })
    }
}

fn respaced(size: [usize; 3], file: DAffine3, spacing: [f64; 3]) -> DAffine3 {
    let mut matrix = DMat3::ZERO;
    let mut origin = file.translation;
    for axis in 0..3 {
        let along = file.matrix3.col(axis);
        let direction = along.try_normalize().unwrap_or_else(|| DMat3::IDENTITY.col(axis));
        let step = direction * spacing[axis];
        *matrix.col_mut(axis) = step;
        if spacing[axis] < 0.0 {
            origin -= step * size[axis].saturating_sub(1) as f64;
        }
    }
    DAffine3 { matrix3: matrix, translation: origin }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spaced(spacing: [f64; 3]) -> Stated {
        Stated { spacing_mm: Some(spacing), ..Stated::default() }
    }

    fn file() -> DAffine3 {
        let matrix =
            DMat3::from_cols(DVec3::new(0.0, 2.0, 0.0), DVec3::new(-3.0, 0.0, 0.0), DVec3::Z);
        DAffine3 { matrix3: matrix, translation: DVec3::new(10.0, 20.0, 30.0) }
    }

    #[test]
    fn a_stated_spacing_keeps_directions_and_the_first_voxel() {
        let grid = spaced([1.0, 1.0, 5.0]).grid([3, 4, 5], file()).unwrap();
        assert_eq!(grid.spacing(), DVec3::new(1.0, 1.0, 5.0));
        let last = grid.index_to_world.transform_point3(DVec3::new(2.0, 3.0, 4.0));
        assert_eq!(last, DVec3::new(7.0, 22.0, 50.0));
    }

    #[test]
    fn a_negative_spacing_flips_within_the_same_part_of_the_world() {
        let size = [3, 4, 5];
        let plain = spaced([2.0, 3.0, 5.0]).grid(size, file()).unwrap();
        let flipped = spaced([2.0, 3.0, -5.0]).grid(size, file()).unwrap();
        for (x, y, z) in [(0.0, 0.0, 0.0), (1.0, 2.0, 4.0), (2.0, 3.0, 1.0)] {
            assert_eq!(
                plain.index_to_world.transform_point3(DVec3::new(x, y, z)),
                flipped.index_to_world.transform_point3(DVec3::new(x, y, 4.0 - z))
            );
        }
    }

    #[test]
    fn a_stated_spacing_repairs_a_header_without_one() {
        let broken = DAffine3::from_scale(DVec3::new(0.0, f64::NAN, 1.0));
        assert!(Stated::default().grid([2; 3], broken).unwrap_err().contains("spacing_mm"));
        let grid = spaced([1.0, 2.0, 3.0]).grid([2; 3], broken).unwrap();
        assert_eq!(grid.index_to_world.matrix3, DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0)));
    }

    #[test]
    fn a_spacing_of_zero_or_nan_is_refused_with_a_remedy() {
        for wrong in [0.0, f64::NAN, f64::INFINITY] {
            assert!(spaced([1.0, wrong, 1.0]).check().unwrap_err().contains("negative to flip"));
        }
        assert_eq!(spaced([1.0, -2.0, 1.0]).check(), Ok(()));
    }
}
