//! The labels of a scene's segmentations: read, colored and laid over the voxels that they belong to.

use super::kept::{KeptLabels, Labeled};
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
    let own = Some(scalars.clone());
    let made = kept_or_made(loading, entry, (labels, own), |loading, grid| {
        let looks = looks(loading, entry, labels)?;
        loading.afford(grid.voxels() as u64 * BYTES)?;
        let numbers = nearest(scalars, grid, grid);
        let (scalars, transfer, tint) = alone(&numbers, grid.size, &looks, labels.smooth_voxels);
        let classify = Classify { transfer, ..Classify::default() };
        let is_seen = is_any_seen(&numbers, &looks);
        Ok(Labeled { classified: Some((scalars, classify)), tint, is_seen })
    })?;
    if let Some(Labeled { classified: Some(classified), tint, .. }) = made {
        loading.add(entry, classified);
        loading.add(entry, (tint,));
    }
    Ok(())
}

/// Labels of a file as mask and tint of the volume on the entity.
pub(super) fn over_volume(
    loading: &mut Loading,
    entry: usize,
    (labels, file): (&Labels, &str),
) -> Result<(), Error> {
    let made = kept_or_made(loading, entry, (labels, None), |loading, grid| {
        let looks = looks(loading, entry, labels)?;
        let (from, scalars) = of_labels(loading, entry, file)?;
        loading.afford(grid.voxels() as u64 * BYTES)?;
        let numbers = nearest(&scalars, &from, grid);
        let outside = labels.outside.unwrap_or(1.0);
        let tint = over(&numbers, grid.size, &looks, labels.smooth_voxels, outside);
        Ok(Labeled { classified: None, tint, is_seen: is_any_seen(&numbers, &looks) })
    })?;
    if let Some(Labeled { tint, .. }) = made {
        loading.add(entry, (tint,));
    }
    Ok(())
}

/// What an earlier loading made of labels; else what `make` makes for the volume's grid, kept for the next. `None` without a
/// grid.
fn kept_or_made(
    loading: &mut Loading,
    entry: usize,
    (labels, own): (&Labels, Option<Scalars>),
    make: impl FnOnce(&mut Loading, &Grid) -> Result<Labeled, Error>,
) -> Result<Option<Labeled>, Error> {
    let Some(grid) = loading.get::<Grid>(entry) else { return Ok(None) };
    let name = loading.entries[entry].name.clone();
    let is_same =
        |kept: &&KeptLabels| kept.stated == *labels && kept.grid == grid && kept.own == own;
    let labeled = if let Some(kept) = loading.kept.labels.get(&name).filter(is_same) {
        loading.files.extend(kept.files.iter().cloned());
        kept.labeled.clone()
    } else {
        let before = loading.files.len();
        let labeled = make(loading, &grid)?;
        let files = loading.files[before..].to_vec();
        let kept =
            KeptLabels { stated: labels.clone(), grid, own, labeled: labeled.clone(), files };
        loading.kept.labels.insert(name, kept);
        labeled
    };
    if !labeled.is_seen {
        // A table that no voxel answers to is most often one of another segmentation.
        loading.warn(
            entry,
            "no voxel has a label that is seen; check `labels.table` against `gelray info`",
        );
    }
    Ok(Some(labeled))
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

fn is_any_seen(numbers: &[u32], looks: &Looks) -> bool {
    let seen = |label: &u32| {
        looks.known.get(label).map_or(looks.others && *label > 0, |look| look.1 > 0.0)
    };
    numbers.iter().any(seen)
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
