//! Groups of Zarr that are no image: the volumes in them.

use std::path::{Path, PathBuf};

use super::image::Image;
use super::node::Node;

/// How deep arrays are looked for in groups, and how many folders are looked through.
const MOST_DEEP: usize = 4;
const MOST_FOLDERS: usize = 2000;

/// The most volumes that are named in a sentence.
const MOST_NAMED: usize = 20;

/// The one volume in a group that is no image itself; the error lists them where there are several.
pub(super) fn only_volume(folder: &Path) -> Result<PathBuf, String> {
    let mut found = Vec::new();
    volumes(folder, 0, &mut { MOST_FOLDERS }, &mut found);
    let shown = |path: &PathBuf| path.display().to_string();
    match &found[..] {
        [] => Err("is a group of Zarr without an array of three axes; name the folder that holds the array".to_owned()),
        [only] => Ok(only.clone()),
        _ => {
            let names: Vec<_> = found.iter().take(MOST_NAMED).map(shown).collect();
            let more = if found.len() > MOST_NAMED { " and more" } else { "" };
            Err(format!("holds {} volumes; name one of them: {}{more}", found.len(), names.join(", ")))
        }
    }
}

/// Images and arrays of at least three axes in a group, in the order of their names.
fn volumes(folder: &Path, deep: usize, left: &mut usize, found: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut inner: Vec<_> = entries.map(|e| e.path()).filter(|path| path.is_dir()).collect();
    inner.sort();
    for path in inner {
        if *left == 0 {
            return;
        }
        *left -= 1;
        match Node::read(&path) {
            Ok(Some(Node::Array(array))) if array.shape.len() >= 3 => found.push(path),
            Ok(Some(Node::Group(attributes))) => {
                if Image::of(&attributes).is_ok_and(|image| image.is_some()) {
                    found.push(path);
                } else if deep < MOST_DEEP {
                    volumes(&path, deep + 1, left, found);
                }
            }
            // What cannot be read says why where it is named.
            Err(_) => found.push(path),
            Ok(_) => {}
        }
    }
}
