//! Files half-written: locked while they are written, so that what a killed run left is told from what another run writes.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use tempfile::{Builder, NamedTempFile};

const PREFIX: &str = ".gelray-";
const SUFFIX: &str = ".part";

/// A temporary file in a folder, locked, as readable as any new file: the umask narrows the permissions.
///
/// It is gone when it is dropped before it is given its name.
pub(super) fn of(folder: &Path) -> io::Result<NamedTempFile> {
    loop {
        let mut builder = Builder::new();
        builder.prefix(PREFIX).suffix(SUFFIX);
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let made = builder.tempfile_in(folder)?;
        // Where there are no locks, nobody sweeps either.
        let _ = made.as_file().lock();
        // Between its making and its lock another run may have taken it for left behind.
        if made.path().exists() {
            return Ok(made);
        }
    }
}

/// Removes the half-written files of a folder that nobody writes any more; those that cannot be removed stay.
pub(super) fn sweep(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let ours = name.to_str().is_some_and(|n| n.starts_with(PREFIX) && n.ends_with(SUFFIX));
        // A link or a pipe of that name is not ours.
        if ours && entry.file_type().is_ok_and(|kind| kind.is_file()) {
            let path = entry.path();
            let left = File::options().write(true).open(&path).is_ok_and(|f| f.try_lock().is_ok());
            if left {
                let _ = fs::remove_file(path);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nobody_writes_is_swept_and_what_is_written_stays() {
        let folder = tempfile::tempdir().unwrap();
        let left = folder.path().join(".gelray-left.part");
        let other = folder.path().join("other.part");
        fs::write(&left, "half").unwrap();
        fs::write(&other, "not ours").unwrap();
        let written = of(folder.path()).unwrap();
        sweep(folder.path());
        assert!(!left.exists() && other.exists() && written.path().exists());
    }
}
