//! A scene's text to a world of entities: voxels read, polygons checked, textures found, lights and view filled in.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use hecs::World;

use super::entity::unused;
use super::error::Text;
use super::parse::{Entry, Stated, parse};
use super::source::Source;
use super::{lights, overrides, polygons, textures, view, volume};
use crate::components::{Name, Order};
use crate::error::Error;

/// A scene that can be rendered.
pub struct Scene {
    /// Its entities, with what they state and what was read for them; no product of a system yet.
    pub world: World,
    /// What was guessed or replaced, a sentence each.
    pub warnings: Vec<String>,
    /// The TOML after overrides: what a picture notes so that it can be made again.
    pub resolved: String,
    /// The scene's name: its file without folder and ending, or the embedded scene's name.
    pub name: String,
}

/// Reads a scene with its overrides (`ENTITY.COMPONENT.KEY=VALUE`) and everything that it names.
///
/// Files are looked for in the scene's folder, then in each folder of `data` and the folders in it. `exact` takes the
/// settings of [`crate::components::Sampling::exact`] for the view. The error is of the first thing found wrong.
pub fn load(
    source: &Source,
    overrides: &[String],
    data: &[PathBuf],
    exact: bool,
) -> Result<Scene, Error> {
    let resolved = overrides::apply(&source.name, &source.text, overrides)?;
    // Lines are those of the changed text, which the file on disk need not have.
    let changed = resolved != source.text;
    let file = if changed { format!("{} with --set", source.name) } else { source.name.clone() };
    let Stated { text, world, entries } = parse(Text { file: &file, text: &resolved })?;
    let folders = Folders { scene: source.folder(), data: data.to_vec() };
    let mut loading = Loading { text, world, entries, folders, warnings: Vec::new() };
    volume::bring_in(&mut loading)?;
    polygons::bring_in(&mut loading)?;
    let extent = view::extent(&loading)?;
    textures::bring_in(&mut loading, extent)?;
    lights::bring_in(&mut loading, extent)?;
    view::bring_in(&mut loading, extent, exact)?;
    let stem = Path::new(&source.name).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let Loading { world, warnings, .. } = loading;
    Ok(Scene { world, warnings, name: stem.unwrap_or_default(), resolved })
}

/// A scene half-way: its text, what is stated, and what has been read so far.
pub(super) struct Loading<'t> {
    pub text: Text<'t>,
    pub entries: Vec<Entry<'t>>,
    pub folders: Folders,
    pub world: World,
    pub warnings: Vec<String>,
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

    /// An entity that the scene does not state, with a name that is free, after all others.
    pub fn spawn(&mut self, name: &str, components: impl hecs::DynamicBundle) {
        let taken: BTreeSet<_> =
            self.world.query_mut::<&Name>().into_iter().map(|name| name.0.clone()).collect();
        let entity = self.world.spawn(components);
        let identity = (Name(unused(name, &taken)), Order(taken.len() as u32));
        let _ = self.world.insert(entity, identity);
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

    /// The folders, for sentences.
    pub fn list(&self) -> String {
        let all = std::iter::once(&self.scene).chain(&self.data);
        all.map(|folder| format!("`{}`", folder.display())).collect::<Vec<_>>().join(", ")
    }
}

/// The folders in a folder, in the order of their names; none if it cannot be read.
fn inner(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut folders: Vec<_> = entries.map(|e| e.path()).filter(|path| path.is_dir()).collect();
    folders.sort();
    folders
}
