//! Voxels in a file of their own, which a header names relative to its own folder.

use std::path::{Path, PathBuf};

use super::stream::Stream;

/// The path of the data file that the header at `path` names.
pub fn beside(path: &Path, name: &str) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).join(name)
}

/// Reads from the data file that a header names, or from the header's own `stream` where it names none; an error says which
/// file it is about.
pub fn read<T>(
    stream: Stream,
    (path, name): (&Path, Option<&str>),
    read: impl FnOnce(Stream) -> Result<T, String>,
) -> Result<T, String> {
    let Some(name) = name else { return read(stream) };
    let beside = beside(path, name);
    Stream::open(&beside)
        .and_then(read)
        .map_err(|problem| format!("its data file `{}` {problem}", beside.display()))
}
