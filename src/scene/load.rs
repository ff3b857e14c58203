//! A scene's text to a world of entities: voxels read, polygons checked, textures found, lights and view filled in.

use std::path::{Path, PathBuf};

use hecs::World;

use super::error::Text;
use super::loading::{Folders, Loading};
use super::parse::{Stated, parse};
use super::source::Source;
use super::{lights, overrides, polygons, textures, view, volume};
use crate::error::Error;

/// A scene that can be rendered.
pub struct Scene {
    /// Its entities, with what they state and what was read for them; no product of a system yet.
    pub world: World,
    /// What was guessed or replaced, a sentence each.
    pub warnings: Vec<String>,
    /// The TOML after overrides: what a picture notes so that it can be made again.
    pub resolved: String,
    /// Every file that was read beside the scene's own: volumes, the data files that their headers name, and textures.
    pub files: Vec<PathBuf>,
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
    let resolved = overrides::apply(&source.name, &source.text, overrides)?;
    // Lines are those of the changed text, which the file on disk need not have.
    let changed = resolved != source.text;
    let file = if changed { format!("{} with --set", source.name) } else { source.name.clone() };
    let Stated { text, world, entries } = parse(Text { file: &file, text: &resolved })?;
    let folders = Folders { scene: source.folder(), data: data.to_vec() };
    let mut loading = Loading {
        text,
        world,
        entries,
        folders,
        warnings: Vec::new(),
        files: Vec::new(),
        bytes: 0,
        most_bytes,
    };
    volume::bring_in(&mut loading)?;
    polygons::bring_in(&mut loading)?;
    let extent = view::extent(&loading)?;
    textures::bring_in(&mut loading, extent)?;
    lights::bring_in(&mut loading, extent)?;
    view::bring_in(&mut loading, extent, exact)?;
    let stem = Path::new(&source.name).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let Loading { world, warnings, files, .. } = loading;
    Ok(Scene { world, warnings, files, name: stem.unwrap_or_default(), resolved })
}
