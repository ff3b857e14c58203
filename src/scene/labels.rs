//! The labels of a scene's segmentations: read, colored and laid over the voxels that they belong to.

use super::loading::Loading;
use crate::components::{Classify, Labels, Level};
use crate::error::Error;
use crate::formats::label_table::read_label_table;
use crate::formats::{Stated, Voxels, read_volume, survey};
use crate::volume::grid::{Grid, Scalars};
use crate::volume::labels::{Looks, alone, distinct, nearest, over};

/// Bytes a voxel that smoothing takes: a color, the one before it, and the label.
const BYTES: u64 = 16 + 16 + 8 + 4;

/// Labels by themselves: puts what is to be classified on the entity in place of the labels that it holds.
pub(super) fn by_themselves(
    loading: &mut Loading,
    entry: usize,
    (labels, scalars): (&Labels, &Scalars),
) -> Result<(), Error> {
    if loading.get::<Classify<Level>>(entry).is_some() {
        let problem = "`classify` has no use: `labels` says how each label looks; take it away, or name the labels of this volume by `labels.file`";
        return Err(loading.error(entry, "classify", "", problem));
    }
    if labels.outside.is_some() {
        let problem = "`labels.outside` is about another volume's voxels; name the labels by `labels.file` or take it away";
        return Err(loading.error(entry, "labels", "outside", problem));
    }
    let Some(grid) = loading.get::<Grid>(entry) else { return Ok(()) };
    let looks = looks(loading, entry, labels)?;
    loading.afford(grid.voxels() as u64 * BYTES)?;
    let numbers = nearest(scalars, &grid, &grid);
    said_if_none(loading, entry, &numbers, &looks);
    let (scalars, transfer, tint) = alone(&numbers, grid.size, &looks, labels.smooth_voxels);
    let classify: Classify = Classify { transfer, ..Classify::default() };
    loading.add(entry, (scalars, classify, tint));
    Ok(())
}

/// Labels of a file as mask and tint of the volume on the entity.
pub(super) fn over_volume(
    loading: &mut Loading,
    entry: usize,
    (labels, file): (&Labels, &str),
) -> Result<(), Error> {
    let Some(grid) = loading.get::<Grid>(entry) else { return Ok(()) };
    let looks = looks(loading, entry, labels)?;
    let (from, scalars) = of_labels(loading, entry, file)?;
    loading.afford(grid.voxels() as u64 * BYTES)?;
    let numbers = nearest(&scalars, &from, &grid);
    said_if_none(loading, entry, &numbers, &looks);
    let outside = labels.outside.unwrap_or(1.0);
    let tint = over(&numbers, grid.size, &looks, labels.smooth_voxels, outside);
    loading.add(entry, (tint,));
    Ok(())
}

/// How each label looks: the table of the scene before that of a file.
fn looks(loading: &mut Loading, entry: usize, labels: &Labels) -> Result<Looks, Error> {
    let mut looks = Looks { known: std::collections::BTreeMap::new(), others: false };
    looks.others = labels.table.is_empty() && labels.colors.is_none();
    if let Some(file) = &labels.colors {
        let Some(path) = loading.folders.find(file) else {
            let missing = loading.folders.missing(file);
            let problem = format!("{missing}; name its folder as a data folder");
            return Err(loading.nowhere(entry, ("labels", "colors"), file, problem));
        };
        loading.files.push(path.clone());
        let rows = read_label_table(&path)?;
        looks.known.extend(rows.into_iter().map(|(label, color, a)| (label, (color.0, a))));
    }
    for label in &labels.table {
        let before = looks.known.get(&label.label).map(|(color, _)| *color);
        let color = label.color.map(|color| color.0).or(before);
        let color = color.unwrap_or_else(|| distinct(label.label).0);
        looks.known.insert(label.label, (color, label.opacity));
    }
    Ok(looks)
}

/// A table that no voxel answers to is most often one of another segmentation.
fn said_if_none(loading: &mut Loading, entry: usize, numbers: &[u32], looks: &Looks) {
    let seen = |label: &u32| {
        looks.known.get(label).map_or(looks.others && *label > 0, |look| look.1 > 0.0)
    };
    if !numbers.iter().any(seen) {
        loading.warn(
            entry,
            "no voxel has a label that is seen; check `labels.table` against `gelray info`",
        );
    }
}

/// The labels of another volume's file, and where they are.
fn of_labels(loading: &mut Loading, entry: usize, file: &str) -> Result<(Grid, Scalars), Error> {
    let Some(path) = loading.folders.find(file) else {
        let missing = loading.folders.missing(file);
        let problem = format!("{missing}; name its folder as a data folder");
        return Err(loading.nowhere(entry, ("labels", "file"), file, problem));
    };
    let survey = survey(&path, &Stated::default())?;
    loading.files.extend(survey.files);
    loading.afford(survey.bytes)?;
    let read = read_volume(&path, &Stated::default())?;
    match read.voxels {
        Voxels::Scalars(scalars) => Ok((read.grid, scalars)),
        Voxels::Painted(_) => {
            let problem = "names a volume of colors, and labels are numbers; name a segmentation";
            Err(loading.error(entry, "labels", "file", problem))
        }
    }
}
