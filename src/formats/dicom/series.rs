//! Which files of a folder are one series: by what their headers say, never by their names.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::super::stream::Stream;
use super::elements::recognizes;
use super::slice::Slice;

/// Slices of one series, and sentences about those that were left out.
type Series = (Vec<Slice>, Vec<String>);

/// The series that a file is of, from the files of its folder.
pub(super) fn of_file(stream: Stream, path: &Path) -> Result<Series, String> {
    let (own, ..) = Slice::read(stream, path)?;
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let (slices, damaged) = slices(folder);
    let mut slices: Vec<_> =
        slices.into_iter().filter(|slice| slice.series == own.series).collect();
    if slices.is_empty() {
        slices.push(own.clone());
    }
    Ok(alike(slices, Some(&own), damaged))
}

/// The one series in a folder; the error lists them where there are several.
pub(super) fn of_folder(folder: &Path) -> Result<Series, String> {
    let (slices, damaged) = slices(folder);
    let mut all: BTreeMap<String, Vec<Slice>> = BTreeMap::new();
    for slice in slices {
        all.entry(slice.series.clone()).or_default().push(slice);
    }
    // Scouts beside a series are not what is meant.
    let scouts = |slices: &Vec<Slice>| slices.iter().all(|slice| slice.localizer);
    if all.values().any(|slices| !scouts(slices)) {
        all.retain(|_, slices| !scouts(slices));
    }
    match all.len() {
        0 => Err(damaged.into_iter().next().unwrap_or_else(|| {
            "is a folder without slices of DICOM or an array of Zarr; name a file, or the folder that holds the series or the array itself"
                .to_owned()
        })),
        1 => Ok(alike(all.into_values().flatten().collect(), None, damaged)),
        count => {
            let row = |slices: &Vec<Slice>| {
                let first = slices.iter().map(|slice| &slice.path).min();
                let name = first.map(|path| path.display().to_string()).unwrap_or_default();
                let described = slices.first().map_or("", |slice| &slice.described);
                format!("{name} ({} slices, \"{described}\")", slices.len())
            };
            let rows: Vec<_> = all.values().map(row).collect();
            Err(format!("holds {count} series; name a file of one of them: {}", rows.join(", ")))
        }
    }
}

/// The files of a folder in the order of their names, hidden ones left out.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let seen = |path: &PathBuf| {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
        path.is_file() && !name.unwrap_or_default().starts_with('.')
    };
    let mut files: Vec<_> = entries.map(|entry| entry.path()).filter(seen).collect();
    files.sort();
    files
}

/// The headers of all files of DICOM in a folder that hold pixels, and a sentence about each that cannot be used.
fn slices(folder: &Path) -> Series {
    let read = |path: &PathBuf| {
        let mut stream = Stream::open(path).ok()?;
        // What is no DICOM at all is another's file.
        let head = stream.peek(132).ok()?;
        if !recognizes(&head) || is_directory(path) {
            return None;
        }
        let slice = Slice::read(stream, path).map(|(slice, ..)| slice);
        Some(slice.map_err(|problem| format!("its file `{}` {problem}", path.display())))
    };
    let read: Vec<_> = files(folder).par_iter().filter_map(read).collect();
    let mut slices = Vec::new();
    let mut problems = Vec::new();
    for slice in read {
        match slice {
            Ok(slice) => slices.push(slice),
            Err(problem) => problems.push(problem),
        }
    }
    (slices, problems)
}

/// The table of contents of a disc.
fn is_directory(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.eq_ignore_ascii_case("DICOMDIR"))
}

/// The slices that are alike in size, direction and spacing: those like `own`, or else the most.
fn alike(slices: Vec<Slice>, own: Option<&Slice>, mut warnings: Vec<String>) -> Series {
    let mut groups: Vec<Vec<Slice>> = Vec::new();
    for slice in slices {
        match groups.iter_mut().find(|group| like(&group[0], &slice)) {
            Some(group) => group.push(slice),
            None => groups.push(vec![slice]),
        }
    }
    let rank = |group: &Vec<Slice>| (own.is_some_and(|own| like(own, &group[0])), group.len());
    let best = (0..groups.len()).max_by_key(|&at| (rank(&groups[at]), groups.len() - at));
    let chosen = best.map(|at| groups.swap_remove(at)).unwrap_or_default();
    let others: usize = groups.iter().map(Vec::len).sum();
    if others > 0 {
        warnings.push(format!(
            "{others} of its slices are of another size, direction or spacing than the other {} and are left out",
            chosen.len()
        ));
    }
    (chosen, warnings)
}

/// Whether two slices can be of one stack.
fn like(a: &Slice, b: &Slice) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-3 * a.abs().max(b.abs());
    let ways = match (a.directions, b.directions) {
        (Some(a), Some(b)) => a.iter().zip(&b).all(|(a, b)| a.distance(*b) < 1e-3),
        (a, b) => a.is_none() && b.is_none(),
    };
    a.size == b.size && ways && a.spacing.iter().zip(&b.spacing).all(|(a, b)| near(*a, *b))
}
