//! A scene's text to a world of entities: voxels read, polygons checked, textures found, lights and view filled in.

use std::path::{Path, PathBuf};

use hecs::World;

use super::error::Text;
use super::kept::Kept;
use super::loading::{Folders, Loading};
use super::parse::{ParsedScene, parse};
use super::source::Source;
use super::{meshes, molecules, overrides, textures, volume};
use crate::components::Sampling;
use crate::error::{Blame, Error, SceneError};

/// A scene that can be rendered.
pub struct Scene {
    /// Its entities, with what they state and what was read for them; no product of a system yet.
    pub world: World,
    /// What was guessed or replaced, a sentence each.
    pub warnings: Vec<String>,
    /// The files that were found nowhere and that something stands in for: other folders of data may have them.
    pub missing: Vec<String>,
    /// The TOML after overrides: what a picture notes so that it can be made again.
    pub resolved: String,
    /// Every file that was read beside the scene's own: volumes, the data files that their headers name, textures, and what meshes name.
    pub files: Vec<PathBuf>,
    /// The scene's name: its file without folder and ending, or the embedded scene's name.
    pub name: String,
}

/// Reads a scene with its overrides (`ENTITY.COMPONENT.KEY=VALUE`) and everything that it names.
///
/// Files are looked for in the scene's folder, then in each folder of `data` and the folders in it. `exact` takes the
/// settings of [`Sampling::exact`] for the view. The error is of the first thing found wrong.
pub fn load(
    source: &Source,
    overrides: &[String],
    data: &[PathBuf],
    exact: bool,
) -> Result<Scene, Error> {
    load_within(source, overrides, data, exact, None)
}

/// [`load`], but for volumes and textures that would take more than `most_bytes`: an error before the one that is too much
/// is read.
pub fn load_within(
    source: &Source,
    overrides: &[String],
    data: &[PathBuf],
    exact: bool,
    most_bytes: Option<u64>,
) -> Result<Scene, Error> {
    let (source, data) = (source.clone(), data.to_vec());
    let loads = Loads { source, data, exact, most_bytes };
    load_keeping(&loads, overrides, &mut Kept::default())
}

/// How a scene is loaded, whatever is set in it: the arguments of [`load_within`].
#[derive(Debug, Clone)]
pub struct Loads {
    /// Where the scene's text comes from.
    pub source: Source,
    /// Folders of data.
    pub data: Vec<PathBuf>,
    /// Whether the view takes the settings of [`Sampling::exact`].
    pub exact: bool,
    /// The most bytes of what is read.
    pub most_bytes: Option<u64>,
}

/// [`load_within`], but that what is read stays in `kept`, for [`Scene::restate`].
pub fn load_keeping(loads: &Loads, overrides: &[String], kept: &mut Kept) -> Result<Scene, Error> {
    let source = &loads.source;
    let resolved = overrides::apply(&source.name, &source.text, overrides)?;
    // Lines are those of the changed text, which the file on disk need not have.
    let changed = resolved != source.text;
    let mut loading = stated(&resolved, loads, kept).map_err(|error| blamed(error, changed))?;
    loading.resolve().map_err(|error| blamed(error, changed))?;
    if loads.exact {
        take_exact_settings(&mut loading.world);
    }
    let stem = Path::new(&source.name).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let Loading { world, warnings, missing, files, .. } = loading;
    Ok(Scene { world, warnings, missing, files, name: stem.unwrap_or_default(), resolved })
}

/// A scene's text after its overrides: what [`Scene::resolved`] is, without a file being read.
pub fn overridden(source: &Source, overrides: &[String]) -> Result<String, Error> {
    Ok(overrides::apply(&source.name, &source.text, overrides)?)
}

/// A fault of a text that overrides have changed may be theirs.
pub(super) fn blamed(error: Error, changed: bool) -> Error {
    match error {
        Error::Scene(fault) if changed => {
            Error::Scene(Box::new(SceneError { blame: Blame::Overridden, ..*fault }))
        }
        error => error,
    }
}

/// The scene of a text, with everything read that it names, and nothing filled in that it leaves out.
pub(super) fn stated<'t>(
    resolved: &'t str,
    loads: &'t Loads,
    kept: &'t mut Kept,
) -> Result<Loading<'t>, Error> {
    let Loads { source, data, most_bytes, .. } = loads;
    let ParsedScene { text, world, entries } = parse(Text { file: &source.name, text: resolved })?;
    let folders = Folders { scene: source.folder(), data: data.clone() };
    let mut loading = Loading {
        text,
        world,
        entries,
        folders,
        warnings: Vec::new(),
        missing: Vec::new(),
        files: Vec::new(),
        bytes: 0,
        ready: source.ready.clone(),
        most_bytes: *most_bytes,
        kept,
    };
    volume::read(&mut loading)?;
    meshes::read(&mut loading)?;
    molecules::read(&mut loading)?;
    textures::read(&mut loading)?;
    Ok(loading)
}

/// Replaces what the view states by the settings of [`Sampling::exact`].
pub(super) fn take_exact_settings(world: &mut World) {
    for sampling in world.query_mut::<&mut Sampling>() {
        *sampling = sampling.exact();
    }
}
