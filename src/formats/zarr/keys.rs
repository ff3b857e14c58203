//! Which chunks of an array there are: what its folder holds is looked through, and nothing is asked for by a made-up name.

use std::path::{Path, PathBuf};

use super::array::{Array, Keys};

/// A chunk that there is.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Found {
    /// Its place among chunks, on each axis.
    pub at: Vec<usize>,
    pub path: PathBuf,
    /// Bytes of its file.
    pub length: u64,
}

/// The chunks of an array that hold a number of index `fixed` on each axis that states one, in the order of their places.
pub(super) fn chunks(array: &Array, fixed: &[Option<usize>]) -> Result<Vec<Found>, String> {
    let Keys { prefixed, separator } = array.keys;
    let folder =
        if prefixed && separator == '/' { array.folder.join("c") } else { array.folder.clone() };
    let wanted = array.chunk.iter().zip(fixed).map(|(chunk, fixed)| fixed.map(|at| at / chunk));
    let counts = array.shape.iter().zip(&array.chunk).map(|(n, chunk)| n.div_ceil(*chunk));
    let wanted: Vec<_> = wanted.zip(counts).collect();
    let mut found = Vec::new();
    if separator == '/' {
        nested(&folder, &wanted, &mut Vec::new(), &mut found)?;
    } else {
        flat(&folder, prefixed, &wanted, &mut found)?;
    }
    found.sort();
    Ok(found)
}

/// Whether a place on an axis is wanted, of those that there may be.
fn is_wanted(at: usize, (only, count): (Option<usize>, usize)) -> bool {
    at < count && only.is_none_or(|only| only == at)
}

/// Chunks in folders, one an axis.
fn nested(
    folder: &Path,
    wanted: &[(Option<usize>, usize)],
    at: &mut Vec<usize>,
    found: &mut Vec<Found>,
) -> Result<(), String> {
    for (name, path) in entries(folder)? {
        let Some(place) = number(&name).filter(|&place| is_wanted(place, wanted[at.len()])) else {
            continue;
        };
        at.push(place);
        if at.len() == wanted.len() {
            keep(at.clone(), path, found)?;
        } else {
            nested(&path, wanted, at, found)?;
        }
        at.pop();
    }
    Ok(())
}

/// Chunks in one folder, their places in their names.
fn flat(
    folder: &Path,
    prefixed: bool,
    wanted: &[(Option<usize>, usize)],
    found: &mut Vec<Found>,
) -> Result<(), String> {
    for (name, path) in entries(folder)? {
        let Some(name) = (if prefixed { name.strip_prefix("c.") } else { Some(name.as_str()) })
        else {
            continue;
        };
        let at: Option<Vec<_>> = name.split('.').map(number).collect();
        let Some(at) = at.filter(|at| at.len() == wanted.len()) else { continue };
        if at.iter().zip(wanted).all(|(&at, &wanted)| is_wanted(at, wanted)) {
            keep(at, path, found)?;
        }
    }
    Ok(())
}

fn keep(at: Vec<usize>, path: PathBuf, found: &mut Vec<Found>) -> Result<(), String> {
    let file = path.metadata().map_err(|error| unreadable(&path, &error))?;
    if !file.is_file() {
        return Err(format!("its chunk `{}` is not a file; write it again", path.display()));
    }
    found.push(Found { at, path, length: file.len() });
    Ok(())
}

/// What is in a folder; nothing where there is none, for chunks of nothing but the fill value are not written.
fn entries(folder: &Path) -> Result<Vec<(String, PathBuf)>, String> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let entries = std::fs::read_dir(folder).map_err(|error| unreadable(folder, &error))?;
    let mut named = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|error| unreadable(folder, &error))?;
        named.extend(entry.file_name().to_str().map(|name| (name.to_owned(), entry.path())));
    }
    Ok(named)
}

/// A place as a key writes it, which is in one way alone.
fn number(text: &str) -> Option<usize> {
    text.parse::<usize>().ok().filter(|number| number.to_string() == text)
}

fn unreadable(path: &Path, error: &std::io::Error) -> String {
    format!("its `{}` cannot be read ({error}); check its permissions", path.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(
        names: &[&str],
        wanted: &[(Option<usize>, usize)],
        separator: char,
    ) -> Vec<Vec<usize>> {
        let folder = tempfile::tempdir().unwrap();
        for name in names {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "chunk").unwrap();
        }
        let mut found = Vec::new();
        match separator {
            '/' => nested(folder.path(), wanted, &mut Vec::new(), &mut found).unwrap(),
            _ => flat(folder.path(), false, wanted, &mut found).unwrap(),
        }
        assert!(found.iter().all(|chunk| chunk.length == 5));
        found.sort();
        found.into_iter().map(|chunk| chunk.at).collect()
    }

    #[test]
    fn keys_are_read_in_one_way_alone_and_what_lies_outside_is_left() {
        let wanted = [(None, 2), (Some(1), 3)];
        let nested = ["0/0", "0/1", "1/1", "2/1", "01/1", "+1/1", "x/1", ".zattrs"];
        assert_eq!(found(&nested, &wanted, '/'), [[0, 1], [1, 1]]);
        let flat = ["0.0", "0.1", "1.1", "2.1", "01.1", "+1.1", "x.1", "1", "0.1.1", ".zattrs"];
        assert_eq!(found(&flat, &wanted, '.'), [[0, 1], [1, 1]]);
    }
}
