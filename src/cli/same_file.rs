//! Whether two paths lead to one file: by the file's identity where it is there, by its folder and name where it is not.

use std::fs::Metadata;
use std::path::{Path, PathBuf};

/// Whether two paths lead to one file, over links of both kinds. Devices and pipes take what comes: they are never one.
pub fn same_file(a: &Path, b: &Path) -> bool {
    match (a.metadata(), b.metadata()) {
        (Ok(first), Ok(second)) => {
            first.is_file() && second.is_file() && (same(&first, &second) || place(a) == place(b))
        }
        (Err(_), Err(_)) => place(a) == place(b),
        _ => false,
    }
}

#[cfg(unix)]
fn same(a: &Metadata, b: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

#[cfg(not(unix))]
fn same(_: &Metadata, _: &Metadata) -> bool {
    false
}

/// A path without its links and detours, as far as there is a file or a folder.
fn place(path: &Path) -> PathBuf {
    let whole = |path: &Path| path.canonicalize().ok();
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let beside = || Some(whole(folder.unwrap_or(Path::new(".")))?.join(path.file_name()?));
    whole(path).or_else(beside).unwrap_or_else(|| path.to_owned())
}
