//! Output files appear whole or not at all: a temporary file in the same folder, then a rename.

use std::fs::{self, OpenOptions};
use std::io::{BufWriter, Cursor, ErrorKind, Seek, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::part;

use crate::error::Error;

/// Why a writer gave up; anything that `?` makes of an error or `.into()` of a sentence.
pub type Failure = Box<dyn std::error::Error>;

/// Where a writer puts its bytes: in order, or going back to fill in a table.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// Writes the file at `path` with `write`, whole or not at all.
///
/// Until `write` has returned `Ok`, its bytes are in a hidden temporary file beside `path`; an error or a panic removes
/// that file and leaves an older file at `path` as it was. The new file has the permissions of the older one or, where
/// there was none, those of any new file under the umask. A symbolic link is followed. Devices, pipes and the process's
/// own streams (`/dev/stdout`) cannot be renamed onto: they are written straight.
///
/// An [`Error`] inside the failure of `write` is handed on as it is; any other becomes an [`Error::File`] of `path`.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn Sink) -> Result<(), Failure>,
) -> Result<(), Error> {
    written_beside(path, write)?.appear()
}

/// A file that is written and not yet seen: dropped, it was never there.
pub struct Whole {
    path: PathBuf,
    kept: Kept,
}

/// Where the bytes wait.
enum Kept {
    /// In a file beside the one that is to appear, under its final name.
    Beside(NamedTempFile, PathBuf),
    /// In memory: a stream takes no byte back.
    Bytes(Vec<u8>),
}

/// The first half of [`write_whole`]: several files can be written and then appear together.
pub fn written_beside(
    path: &Path,
    write: impl FnOnce(&mut dyn Sink) -> Result<(), Failure>,
) -> Result<Whole, Error> {
    let kept = if is_stream(path) { in_memory(write) } else { beside(path, write) };
    kept.map(|kept| Whole { path: path.to_owned(), kept })
        .map_err(|failure| unwritable(path, failure))
}

impl Whole {
    /// Removes the file that this one is to replace.
    fn clear(&self) -> Result<(), Error> {
        match &self.kept {
            Kept::Beside(_, target) => match fs::remove_file(target) {
                Err(error) if error.kind() != ErrorKind::NotFound => {
                    Err(unwritable(&self.path, error.into()))
                }
                _ => Ok(()),
            },
            Kept::Bytes(_) => Ok(()),
        }
    }

    /// Lets the file be seen under its name, in place of an older one.
    pub fn appear(self) -> Result<(), Error> {
        let Self { path, kept } = self;
        let appeared = match kept {
            Kept::Beside(temporary, target) => {
                temporary.persist(target).map(drop).map_err(|error| error.error)
            }
            Kept::Bytes(bytes) => OpenOptions::new()
                .write(true)
                .open(&path)
                .and_then(|mut stream| stream.write_all(&bytes)),
        };
        appeared.map_err(|error| unwritable(&path, error.into()))
    }
}

/// Lets the files of one run be seen. The older ones of all but the first are gone before the first is replaced: whenever this
/// is cut off, what is there is of one run, and the first of them is there if it was before.
pub fn appear_together(files: Vec<Whole>) -> Result<(), Error> {
    files.iter().skip(1).try_for_each(Whole::clear)?;
    files.into_iter().try_for_each(Whole::appear)
}

/// Writes the file at `path` by way of a program that takes a file's name: `write` is given that of a temporary file
/// beside `path`, which is put in place when it has returned `Ok`, and removed where it has not.
pub(crate) fn write_by_name(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), Failure>,
) -> Result<(), Error> {
    let made = || -> Result<(), Failure> {
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let temporary = part::of(&folder_of(&target))?;
        write(temporary.path())?;
        temporary.persist(target)?;
        Ok(())
    };
    made().map_err(|failure| unwritable(path, failure))
}

fn unwritable(path: &Path, failure: Failure) -> Error {
    match failure.downcast::<Error>() {
        Ok(error) => *error,
        Err(failure) => Error::file(
            path,
            format!(
                "cannot be written ({failure}); check the folder and the space left, or choose another file"
            ),
        ),
    }
}

/// Finds out, before any work is done, whether [`write_whole`] would be able to write at `path`.
///
/// The sentence says what is in the way: a folder of that name, a folder that is missing or closed, a read-only file.
/// What killed runs left half-written in the folder is removed.
pub fn check_writable(path: &Path) -> Result<(), Error> {
    if is_stream(path) {
        return Ok(());
    }
    let refuse = |problem: String| Err(Error::file(path, problem));
    if path.is_dir() || path.file_name().is_none() {
        return refuse("is a folder and a file is expected; add a file's name".to_owned());
    }
    if path.metadata().is_ok_and(|older| older.permissions().readonly()) {
        return refuse("is read-only; allow writing to it or choose another file".to_owned());
    }
    let folder = folder_of(path);
    if !folder.is_dir() {
        return refuse(format!(
            "its folder {} is not there; make it first or choose another",
            folder.display()
        ));
    }
    match tempfile::tempfile_in(&folder) {
        Ok(_) => {
            part::sweep(&folder);
            Ok(())
        }
        Err(error) => refuse(format!(
            "its folder {} cannot be written to ({error}); choose another",
            folder.display()
        )),
    }
}

fn beside(
    path: &Path,
    write: impl FnOnce(&mut dyn Sink) -> Result<(), Failure>,
) -> Result<Kept, Failure> {
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if target.is_dir() {
        return Err("a folder has that name".into());
    }
    let temporary = part::of(&folder_of(&target))?;
    if let Ok(older) = target.metadata() {
        temporary.as_file().set_permissions(older.permissions())?;
    }
    let mut buffered = BufWriter::new(temporary);
    write(&mut buffered)?;
    let temporary = buffered.into_inner().map_err(std::io::IntoInnerError::into_error)?;
    Ok(Kept::Beside(temporary, target))
}

fn in_memory(write: impl FnOnce(&mut dyn Sink) -> Result<(), Failure>) -> Result<Kept, Failure> {
    let mut bytes = Cursor::new(Vec::new());
    write(&mut bytes)?;
    Ok(Kept::Bytes(bytes.into_inner()))
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// Whether `path` is something that bytes go through rather than stay in.
fn is_stream(path: &Path) -> bool {
    ["/dev/stdout", "/dev/stderr", "/dev/fd", "/proc"].iter().any(|own| path.starts_with(own))
        || path.metadata().is_ok_and(|found| !found.is_file() && !found.is_dir())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_writer_that_fails_half_way_leaves_nothing_and_an_older_file_untouched() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.json");
        let fail = |out: &mut dyn Sink| -> Result<(), Failure> {
            out.write_all(&vec![7; 100_000])?;
            Err("the disc is full".into())
        };
        assert!(write_whole(&path, fail).unwrap_err().to_string().contains("the disc is full"));
        assert!(names(folder.path()).is_empty());
        fs::write(&path, "older").unwrap();
        assert!(write_whole(&path, fail).is_err());
        assert_eq!(names(folder.path()), ["out.json"]);
        assert_eq!(fs::read(&path).unwrap(), b"older");
    }

    #[test]
    fn a_panic_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        let panicked = std::panic::catch_unwind(|| {
            write_whole(&path, |out| {
                out.write_all(b"half")?;
                panic!("stopped on purpose")
            })
        });
        assert!(panicked.is_err());
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn an_error_of_ours_passes_through_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        let error = write_whole(&path, |_| Err(Error::Interrupted.into())).unwrap_err();
        assert!(matches!(error, Error::Interrupted));
    }

    #[cfg(unix)]
    #[test]
    fn a_new_file_has_the_permissions_of_any_new_file_and_an_old_one_keeps_its_own() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (path, plain) = (folder.path().join("out"), folder.path().join("plain"));
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode() & 0o777;
        fs::write(&plain, "").unwrap();
        write_whole(&path, |out| Ok(out.write_all(b"1")?)).unwrap();
        assert_eq!(mode(&path), mode(&plain));
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        write_whole(&path, |out| Ok(out.write_all(b"2")?)).unwrap();
        assert_eq!((mode(&path), fs::read(&path).unwrap()), (0o640, b"2".to_vec()));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_and_a_device_is_never_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("out"), folder.path().join("link"));
        fs::write(&path, "older").unwrap();
        std::os::unix::fs::symlink(&path, &link).unwrap();
        write_whole(&link, |out| Ok(out.write_all(b"newer")?)).unwrap();
        assert!(link.symlink_metadata().unwrap().is_symlink());
        assert_eq!(fs::read(&path).unwrap(), b"newer");
        write_whole(Path::new("/dev/null"), |out| Ok(out.write_all(b"gone")?)).unwrap();
        assert!(!Path::new("/dev/null").metadata().unwrap().is_file());
    }

    #[test]
    fn files_of_one_run_are_never_seen_beside_those_of_another() {
        let folder = tempfile::tempdir().unwrap();
        let [picture, rays, stats] = ["a", "b", "c"].map(|name| folder.path().join(name));
        let written = |path: &Path, run: &str| {
            written_beside(path, |out| Ok(out.write_all(run.as_bytes())?)).unwrap()
        };
        let run = |run| vec![written(&picture, run), written(&rays, run), written(&stats, run)];
        appear_together(run("1")).unwrap();
        // The second of three cannot appear: its folder is gone, as if the run had been cut off there.
        let mut second = run("2");
        let gone = folder.path().join("gone");
        fs::create_dir(&gone).unwrap();
        second[1] = written(&gone.join("b"), "2");
        fs::remove_dir_all(&gone).unwrap();
        second.insert(2, written(&rays, "2"));
        assert!(appear_together(second).is_err());
        assert_eq!(
            (fs::read(&picture).unwrap(), names(folder.path())),
            (b"2".to_vec(), vec!["a".to_owned()])
        );
    }

    #[test]
    fn what_is_in_the_way_is_said_before_any_work_is_done() {
        let folder = tempfile::tempdir().unwrap();
        let problem = |path: &Path| check_writable(path).unwrap_err().to_string();
        assert!(problem(folder.path()).contains("is a folder"));
        assert!(problem(&folder.path().join("missing/out.png")).contains("is not there"));
        check_writable(&folder.path().join("out.png")).unwrap();
        assert!(names(folder.path()).is_empty());
    }
}
