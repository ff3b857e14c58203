//! A scene half-way: what is stated, what has been read so far, and where files are looked for.

use std::path::{Path, PathBuf};

use hecs::World;

use super::error::Text;
use super::kept::Kept;
use super::parse::Entry;
use super::source::Ready;
use crate::error::{Error, SceneError};
use crate::resolve::{Fault, resolve};

/// A scene half-way: its text, what is stated, and what has been read so far.
pub(super) struct Loading<'t> {
    pub text: Text<'t>,
    pub entries: Vec<Entry<'t>>,
    pub folders: Folders,
    pub world: World,
    pub warnings: Vec<String>,
    /// Files that are nowhere and that something stands in for.
    pub missing: Vec<String>,
    /// Every file that was read, and those that a header in it names.
    pub files: Vec<PathBuf>,
    /// Bytes that what was read takes.
    pub bytes: u64,
    /// A file that was read before the scene was.
    pub ready: Option<Ready>,
    /// The most bytes that what is read may take; `None`: as many as there are.
    pub most_bytes: Option<u64>,
    /// What an earlier loading left, and this one leaves for the next.
    pub kept: &'t mut Kept,
}

impl Loading<'_> {
    /// The positions of the entries of some nouns, in the order of the scene.
    pub fn nouns(&self, nouns: &[&str]) -> Vec<usize> {
        (0..self.entries.len()).filter(|&i| nouns.contains(&self.entries[i].noun)).collect()
    }

    /// A copy of a component of an entry, if it has it.
    pub fn get<T: Clone + Send + Sync + 'static>(&self, entry: usize) -> Option<T> {
        self.world.get::<&T>(self.entries[entry].entity).ok().map(|component| (*component).clone())
    }

    /// Puts components on the entity of an entry.
    pub fn add(&mut self, entry: usize, components: impl hecs::DynamicBundle) {
        // The entity was spawned from this very entry and none is ever taken away.
        let _ = self.world.insert(self.entries[entry].entity, components);
    }

    /// Fills in what the scene leaves out, and keeps what was guessed as warnings.
    pub fn resolve(&mut self) -> Result<(), Error> {
        let notices = resolve(&mut self.world).map_err(|fault| self.located(fault))?;
        let told = notices.iter().map(|notice| notice.within(&self.world));
        self.warnings.extend(told.collect::<Vec<_>>());
        Ok(())
    }

    /// A fault of the world, at its line of the scene.
    fn located(&self, fault: Fault) -> Error {
        let Fault { entity, component, path, problem } = fault;
        let entry = self.entries.iter().position(|entry| Some(entry.entity) == entity);
        match entry {
            Some(entry) => self.error(entry, component, &path, problem),
            None => SceneError::elsewhere(self.text.file, problem).into(),
        }
    }

    /// An error of a component of an entry: `problem` is the rest of a sentence that the entity's name begins.
    pub fn error(
        &self,
        entry: usize,
        component: &str,
        path: &str,
        problem: impl AsRef<str>,
    ) -> Error {
        self.entries[entry].fault(component, path, problem).within(self.text).into()
    }

    /// The error of a file that is nowhere; `problem` is the rest of a sentence that the entity's name begins.
    pub fn nowhere(
        &self,
        entry: usize,
        (component, path): (&str, &str),
        file: &str,
        problem: impl AsRef<str>,
    ) -> Error {
        let fault = self.entries[entry].fault(component, path, problem).within(self.text);
        SceneError { missing: Some(file.into()), ..fault }.into()
    }

    /// Counts an array of `bytes` that is to be read; an error if it and those before are more than may be.
    pub fn afford(&mut self, bytes: u64) -> Result<(), Error> {
        self.bytes = self.bytes.saturating_add(bytes);
        self.afford_passing(0)
    }

    /// An error if what was counted and `bytes` beside, which are given back soon, are more than may be.
    pub fn afford_passing(&self, bytes: u64) -> Result<(), Error> {
        let needed = self.bytes.saturating_add(bytes);
        match self.most_bytes {
            Some(allowed) if needed > allowed => Err(Error::Memory { needed, allowed }),
            _ => Ok(()),
        }
    }

    /// Keeps a warning about an entry.
    pub fn warn(&mut self, entry: usize, problem: impl AsRef<str>) {
        self.warnings.push(format!("entity `{}`: {}", self.entries[entry].name, problem.as_ref()));
    }
}

/// Where files are looked for.
pub(super) struct Folders {
    pub scene: PathBuf,
    pub data: Vec<PathBuf>,
}

impl Folders {
    /// The file (or, for a series of slices, the folder) of that path: in the scene's folder, in each data folder, or in
    /// the folders in it, in the order of their names.
    pub fn find(&self, file: &str) -> Option<PathBuf> {
        let direct =
            std::iter::once(self.scene.join(file)).chain(self.data.iter().flat_map(|folder| {
                std::iter::once(folder.join(file))
                    .chain(inner(folder).into_iter().map(|f| f.join(file)))
            }));
        direct.into_iter().find(|path| path.exists())
    }

    /// The sentence about a file that is nowhere: where it was looked for.
    pub fn missing(&self, file: &str) -> String {
        if file == "~" || file.starts_with("~/") {
            return format!(
                "`{file}` begins with `~`, which only a shell takes for the home folder; write the folder's full path"
            );
        }
        let folder = |folder: &PathBuf| format!("`{}`", folder.display());
        let scene = if self.scene == Path::new(".") {
            "the working folder".to_owned()
        } else {
            format!("the scene's folder {}", folder(&self.scene))
        };
        let data: Vec<_> = self.data.iter().map(folder).collect();
        match data.len() {
            0 => format!("`{file}` is not in {scene}, and no data folder is given"),
            1 => format!(
                "`{file}` is not in {scene}, nor in the data folder {} or a folder in it",
                data[0]
            ),
            _ => format!(
                "`{file}` is not in {scene}, nor in the data folders {} or a folder in them",
                data.join(", ")
            ),
        }
    }
}

/// The folders in a folder, in the order of their names; none if it cannot be read.
fn inner(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut folders: Vec<_> = entries.map(|e| e.path()).filter(|path| path.is_dir()).collect();
    folders.sort();
    folders
}
