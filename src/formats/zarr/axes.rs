//! What the axes of an array are: which three are of space, and what is taken of the others.

use glam::{DAffine3, DMat3, DVec3};

use crate::formats::Stated;

/// An axis of an array.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    pub name: String,
    pub kind: Kind,
    /// From the index on it to the world: how far apart, and where the first is, both in millimeters where it has a unit.
    pub scale: f64,
    pub offset: f64,
}

/// What an axis is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Space,
    Channel,
    Time,
    Other,
}

/// Which numbers of an array are voxels.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct View {
    /// For each axis of the array the index that is taken of it; `None` for those of voxels.
    pub fixed: Vec<Option<usize>>,
    /// The array's axes of x, y and z, and before them, where voxels are RGBA, that of their four numbers.
    pub axes: Vec<usize>,
    /// Voxels on each axis, and where they lie.
    pub size: [usize; 3],
    pub placed: DAffine3,
    /// Sentences about what is taken of an axis.
    pub said: Vec<String>,
}

impl Axis {
    /// An axis of a name, without a scale.
    pub fn named(name: &str) -> Self {
        let kind = match name.to_lowercase().as_str() {
            "t" | "time" => Kind::Time,
            "c" | "channel" | "channels" => Kind::Channel,
            _ => Kind::Space,
        };
        Self { name: name.to_owned(), kind, scale: 1.0, offset: 0.0 }
    }
}

impl View {
    /// The voxels of an array of that shape; `labels` are names of its channels.
    pub fn of(
        mut axes: Vec<Axis>,
        shape: &[usize],
        labels: &[String],
        stated: &Stated,
    ) -> Result<Self, String> {
        if axes.len() != shape.len() {
            return Err(format!(
                "has {} axes and {} are described; correct its metadata",
                shape.len(),
                axes.len()
            ));
        }
        let [x, y, z] = space(&mut axes)?;
        let mut said = Vec::new();
        let mut fixed = vec![None; axes.len()];
        for (at, axis) in axes.iter().enumerate().filter(|(at, _)| ![x, y, z].contains(at)) {
            fixed[at] = Some(taken(axis, shape[at], labels, stated, &mut said)?);
        }
        for (key, kind, wanted) in
            [("channel", Kind::Channel, stated.channel), ("time", Kind::Time, stated.time)]
        {
            if wanted.is_some() && !axes.iter().any(|axis| axis.kind == kind) {
                said.push(format!("its array has no axis for `{key}`, which is not used"));
            }
        }
        let three = |of: fn(&Axis) -> f64| DVec3::new(of(&axes[x]), of(&axes[y]), of(&axes[z]));
        let placed = DAffine3 {
            matrix3: DMat3::from_diagonal(three(|axis| axis.scale)),
            translation: three(|axis| axis.offset),
        };
        let size = [x, y, z].map(|axis| shape[axis]);
        Ok(Self { fixed, axes: vec![x, y, z], size, placed, said })
    }

    /// RGBA voxels: the axes are z, y, x and that of the four numbers.
    pub fn painted(shape: [usize; 4]) -> Self {
        let [z, y, x, _] = shape;
        Self {
            fixed: vec![None; 4],
            axes: vec![3, 2, 1, 0],
            size: [x, y, z],
            placed: DAffine3::IDENTITY,
            said: Vec::new(),
        }
    }
}

/// The axes of x, y and z: by these names, or else the last is x. Others of space, before them, are none.
fn space(axes: &mut [Axis]) -> Result<[usize; 3], String> {
    let found: Vec<_> = (0..axes.len()).rev().filter(|&at| axes[at].kind == Kind::Space).collect();
    let Some((last, others)) = found.split_first_chunk::<3>() else {
        return Err(format!(
            "has {} axes of space, and a volume has three (z, y, x); name an array of three",
            found.len()
        ));
    };
    for &at in others {
        axes[at].kind = Kind::Other;
    }
    let of = |name: &str| last.iter().copied().find(|&at| axes[at].name.eq_ignore_ascii_case(name));
    match [of("x"), of("y"), of("z")] {
        [Some(x), Some(y), Some(z)] => Ok([x, y, z]),
        _ => Ok(*last),
    }
}

/// The index that is taken of an axis that is not one of voxels.
fn taken(
    axis: &Axis,
    count: usize,
    labels: &[String],
    stated: &Stated,
    said: &mut Vec<String>,
) -> Result<usize, String> {
    let (key, names) = match axis.kind {
        Kind::Channel => ("channel", labels),
        Kind::Time => ("time", &[][..]),
        _ if count == 1 => return Ok(0),
        _ => {
            return Err(format!(
                "has an axis{} of {count} beside the three of space; take one of them, as an array of its own",
                if axis.name.is_empty() { String::new() } else { format!(" `{}`", axis.name) }
            ));
        }
    };
    let (at, what) = stated.chosen(key, count, names)?;
    said.extend(what);
    Ok(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(names: &[&str]) -> Vec<Axis> {
        let axis =
            |(at, name): (usize, &&str)| Axis { scale: 1.0 + at as f64, ..Axis::named(name) };
        names.iter().enumerate().map(axis).collect()
    }

    #[test]
    fn the_axes_of_space_are_found_by_name_or_else_the_last_is_x() {
        let of =
            |names: &[&str]| View::of(axes(names), &[5, 6, 7], &[], &Stated::default()).unwrap();
        assert_eq!(of(&["z", "y", "x"]).size, [7, 6, 5]);
        assert_eq!(of(&["X", "Y", "Z"]).size, [5, 6, 7]);
        assert_eq!(of(&["", "", ""]).size, [7, 6, 5]);
        let view = of(&["x", "z", "y"]);
        assert_eq!(view.axes, [0, 2, 1]);
        assert_eq!(view.placed.matrix3, DMat3::from_diagonal(DVec3::new(1.0, 3.0, 2.0)));
    }

    #[test]
    fn of_channels_and_times_the_first_is_taken_and_that_is_said() {
        let labels = ["DAPI".to_owned(), "GFP".to_owned()];
        let of = |stated: &Stated| {
            View::of(axes(&["t", "c", "z", "y", "x"]), &[1, 2, 5, 6, 7], &labels, stated)
        };
        let view = of(&Stated::default()).unwrap();
        assert_eq!(view.fixed, [Some(0), Some(0), None, None, None]);
        assert!(
            view.said[0].contains("(`DAPI`, `GFP`)") && view.said.len() == 1,
            "{:?}",
            view.said
        );
        let second = Stated { channel: Some(1), ..Stated::default() };
        let view = of(&second).unwrap();
        assert_eq!((view.fixed[1], view.said), (Some(1), vec![]));
        let third = Stated { channel: Some(2), ..Stated::default() };
        assert!(of(&third).unwrap_err().contains("it has 2 channels"));
        let view = View::of(axes(&["z", "y", "x"]), &[5, 6, 7], &[], &second).unwrap();
        assert!(view.said[0].contains("no axis for `channel`"));
    }

    #[test]
    fn axes_too_few_or_too_many_are_said() {
        let of = |names: &[&str], shape: &[usize]| {
            View::of(axes(names), shape, &[], &Stated::default()).map(|view| view.fixed)
        };
        assert!(of(&["y", "x"], &[6, 7]).unwrap_err().contains("2 axes of space"));
        assert!(of(&["", "", "", ""], &[2, 5, 6, 7]).unwrap_err().contains("an axis of 2"));
        assert_eq!(of(&["", "", "", ""], &[1, 5, 6, 7]).unwrap()[0], Some(0));
        assert!(of(&["y", "x"], &[6]).unwrap_err().contains("are described"));
    }
}
