//! The volumes of a scene: their voxels found and placed, their classification resolved to numbers.

use std::path::Path;

use glam::DVec3;

use super::kept::KeptVolume;
use super::loading::Loading;
use super::{labels, named};
use crate::components::{
    Classify, Contour, Labels, Level, Material, OpacityUnit, Projection, Reconstruct, Volume,
};
use crate::error::Error;
use crate::formats::{Loaded, Stated, Voxels, read_volume, survey};
use crate::phantom;
use crate::volume::grid::{Grid, Scalars};

/// Reads every volume that the scene states.
pub(super) fn read(loading: &mut Loading) -> Result<(), Error> {
    loading.nouns(&["volume"]).into_iter().try_for_each(|entry| read_and_place(loading, entry))
}

fn read_and_place(loading: &mut Loading, entry: usize) -> Result<(), Error> {
    let Some(volume) = loading.get::<Volume>(entry) else { return Ok(()) };
    let (read, stands_in) = kept_or_read(loading, entry, &volume)?;
    for warning in read.warnings {
        loading.warn(entry, warning);
    }
    let spacing = if stands_in { None } else { volume.spacing_mm };
    let grid = placed(&read.grid, spacing, volume.center)
        .map_err(|problem| loading.error(entry, "volume", "spacing_mm", problem))?;
    loading.add(entry, (grid, volume.reconstruct));
    if let Some(unit) = volume.opacity_unit_mm {
        loading.add(entry, (OpacityUnit(unit),));
    }
    match read.voxels {
        Voxels::Scalars(scalars) => match loading.get::<Labels>(entry) {
            Some(stated) => match stated.file.clone() {
                Some(file) => {
                    labels::over_volume(loading, entry, (&stated, &file))?;
                    classified(loading, entry, scalars)
                }
                None => labels::by_themselves(loading, entry, (&stated, &scalars)),
            },
            None => classified(loading, entry, scalars),
        },
        Voxels::Painted(painted) => {
            for (key, stated) in [
                ("classify", loading.get::<Classify<Level>>(entry).is_some()),
                ("material", loading.get::<Material>(entry).is_some()),
                ("labels", loading.get::<Labels>(entry).is_some()),
            ] {
                if stated {
                    let problem = format!(
                        "`{key}` has no use: the volume is RGBA, classified and shaded already; take it away"
                    );
                    return Err(loading.error(entry, key, "", problem));
                }
            }
            loading.add(entry, (painted,));
            Ok(())
        }
    }
}

/// The voxels that an earlier loading read, wherever they are placed now; else they are read, and kept for the next.
fn kept_or_read(
    loading: &mut Loading,
    entry: usize,
    volume: &Volume,
) -> Result<(Loaded, bool), Error> {
    let reconstruct = Reconstruct::default();
    let stated = Volume { center: None, opacity_unit_mm: None, reconstruct, ..volume.clone() };
    let name = loading.entries[entry].name.clone();
    if let Some(kept) = loading.kept.volumes.get(&name).filter(|kept| kept.stated == stated) {
        loading.files.extend(kept.files.iter().cloned());
        return Ok((kept.loaded.clone(), kept.stands_in));
    }
    let before = loading.files.len();
    let (loaded, stands_in) = voxels(loading, entry, volume)?;
    let files = loading.files[before..].to_vec();
    let kept = KeptVolume { stated, loaded: loaded.clone(), stands_in, files };
    loading.kept.volumes.insert(name, kept);
    Ok((loaded, stands_in))
}

/// The voxels of the file, or of what stands in for it.
fn voxels(loading: &mut Loading, entry: usize, volume: &Volume) -> Result<(Loaded, bool), Error> {
    let stated = Stated {
        size: volume.size,
        voxel_type: volume.voxel_type.clone(),
        endian: volume.endian.clone(),
        // The sign is a flip about the middle, which is done to any format alike once it is read.
        spacing_mm: volume.spacing_mm.map(|spacing| spacing.map(f64::abs)),
        channel: volume.channel,
        time: volume.time,
    };
    if let Some(read) = read_one(loading, entry, "file", &volume.file, &stated)? {
        return Ok((read, false));
    }
    let missing = loading.folders.missing(&volume.file);
    let remedy = "name its folder as a data folder";
    let Some(stand_in) = &volume.stand_in else {
        let problem = format!("{missing}; {remedy} or state a `stand_in`");
        return Err(loading.nowhere(entry, ("volume", "file"), &volume.file, problem));
    };
    let Some(read) = read_one(loading, entry, "stand_in", stand_in, &Stated::default())? else {
        let problem = format!("{missing}, and neither is its stand-in `{stand_in}`; {remedy}");
        return Err(loading.nowhere(entry, ("volume", "stand_in"), &volume.file, problem));
    };
    loading.warn(entry, format!("{missing}: `{stand_in}` stands in for it; {remedy}"));
    loading.missing.push(volume.file.clone());
    Ok((read, true))
}

/// A phantom by its name or a file by its path; `None` for a file that is nowhere.
fn read_one(
    loading: &mut Loading,
    entry: usize,
    key: &str,
    file: &str,
    stated: &Stated,
) -> Result<Option<Loaded>, Error> {
    if let Some(name) = file.strip_prefix("phantom:") {
        loading.afford(phantom::most_bytes(name.trim()))?;
        let made = phantom::phantom(name.trim());
        return made.map(Some).map_err(|problem| loading.error(entry, "volume", key, problem));
    }
    let Some(path) = loading.folders.find(file) else { return Ok(None) };
    let survey = survey(&path, stated)?;
    loading.files.extend(survey.files);
    loading.afford(survey.bytes)?;
    match &loading.ready {
        // What the scene states of the file may have been changed since.
        Some(ready) if same(&ready.path, &path) && *stated == ready.stated => {
            Ok(Some(ready.loaded.clone()))
        }
        _ => read_volume(&path, stated).map(Some),
    }
}

/// Whether two paths lead to one file or folder.
fn same(a: &Path, b: &Path) -> bool {
    a == b || a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b))
}

/// The grid with other spacings (negative flips about the middle) and its middle moved to `center`.
fn placed(
    grid: &Grid,
    spacing: Option<[f64; 3]>,
    center: Option<[f64; 3]>,
) -> Result<Grid, String> {
    let mut placement = grid.index_to_world;
    let last = DVec3::from(grid.size.map(|n| (n - 1) as f64));
    for (axis, length) in spacing.into_iter().flatten().enumerate() {
        let column = placement.matrix3.col(axis).normalize() * length;
        *placement.matrix3.col_mut(axis) = column;
        if length < 0.0 {
            placement.translation -= column * last[axis];
        }
    }
    if let Some(center) = center {
        placement.translation += DVec3::from(center) - placement.transform_point3(last / 2.0);
    }
    Grid::new(grid.size, placement)
}

/// Puts scalars on the entity, with the classification in numbers if one is stated.
fn classified(loading: &mut Loading, entry: usize, scalars: Scalars) -> Result<(), Error> {
    let projected = loading.get::<Projection>(entry).is_some();
    let reconstruct = loading.get::<Reconstruct>(entry).unwrap_or_default();
    if let Some(problem) = scalars.lost_digits() {
        loading.warn(entry, problem);
    }
    if let Some(stated) = loading.get::<Classify<Level>>(entry) {
        let classify = match named::classification(&stated, &scalars, (projected, reconstruct)) {
            Some((made, said)) => {
                if let Some(said) = said {
                    loading.warn(entry, said);
                }
                made
            }
            None => in_numbers(loading, entry, stated, &scalars)?,
        };
        let _ = loading.world.remove_one::<Classify<Level>>(loading.entries[entry].entity);
        loading.add(entry, (classify,));
    }
    loading.add(entry, (scalars,));
    Ok(())
}

/// Levels in standard deviations as numbers.
fn in_numbers(
    loading: &mut Loading,
    entry: usize,
    stated: Classify<Level>,
    scalars: &Scalars,
) -> Result<Classify, Error> {
    let any = stated.iso.iter().any(|c| matches!(c.value, Level::Sigma(_)));
    let statistics = if any { loading.kept.sigma(scalars) } else { None };
    let number = |(i, contour): (usize, Contour<Level>)| {
        let value = match (contour.value, statistics) {
            (Level::Value(value), _) => Some(value),
            (Level::Sigma(k), Some(s)) => {
                Some((s.mean + k * s.deviation) as f32).filter(|v| v.is_finite())
            }
            (Level::Sigma(_), None) => None,
        };
        let problem =
            "a level in sigma needs a volume whose mean and deviation are finite; state a number";
        let value = value
            .ok_or_else(|| loading.error(entry, "classify", &format!("iso.{i}.value"), problem))?;
        let Contour { opacity, thickness_voxels, form, color, .. } = contour;
        Ok(Contour { value, opacity, thickness_voxels, form, color })
    };
    let iso = stated.iso.into_iter().enumerate().map(number).collect::<Result<_, Error>>()?;
    let Classify { regions, transfer, gradient, materials, .. } =
        Classify::<Level> { iso: Vec::new(), ..stated };
    Ok(Classify { iso, regions, transfer, gradient, materials, ..Classify::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        Grid::axis_aligned([256, 256, 113], [1.0, 1.0, 2.0], [0.0; 3]).unwrap()
    }

    #[test]
    fn a_negative_spacing_flips_about_the_middle() {
        let flipped = placed(&grid(), Some([1.0, 1.0, -2.0]), None).unwrap();
        let at = |g: &Grid, z| g.index_to_world.transform_point3(DVec3::new(5.0, 6.0, z));
        assert_eq!(at(&flipped, 0.0), DVec3::new(5.0, 6.0, 224.0));
        assert_eq!(at(&flipped, 112.0), DVec3::new(5.0, 6.0, 0.0));
    }

    #[test]
    fn the_middle_is_moved_to_the_centre_that_is_stated() {
        let moved = placed(&grid(), Some([1.0, 1.0, -2.0]), Some([1.0, 0.0, 0.0])).unwrap();
        assert_eq!(moved.corners()[0], DVec3::new(-126.5, -127.5, 112.0));
        assert_eq!(moved.corners()[7], DVec3::new(128.5, 127.5, -112.0));
    }
}
