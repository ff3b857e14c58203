//! Where a scene's text comes from: a file, or the table of scenes that are part of the program.

use std::io::Read;
use std::path::{Path, PathBuf};

use super::nearest::suggestion;
use crate::error::Error;
use crate::error::SceneError;
use crate::formats::{Loaded, Stated, is_volume};

/// The scenes that are part of the program, by name; the first is rendered where none is named.
pub static EMBEDDED: [(&str, &str); 21] = [
    ("head", include_str!("../../scenes/head.toml")),
    ("minimal_1", include_str!("../../scenes/minimal_1.toml")),
    ("minimal_2", include_str!("../../scenes/minimal_2.toml")),
    ("minimal_3", include_str!("../../scenes/minimal_3.toml")),
    ("minimal_4", include_str!("../../scenes/minimal_4.toml")),
    ("minimal_5", include_str!("../../scenes/minimal_5.toml")),
    ("minimal_6", include_str!("../../scenes/minimal_6.toml")),
    ("figure_06a", include_str!("../../scenes/figure_06a.toml")),
    ("figure_06b", include_str!("../../scenes/figure_06b.toml")),
    ("figure_07a", include_str!("../../scenes/figure_07a.toml")),
    ("figure_07b", include_str!("../../scenes/figure_07b.toml")),
    ("figure_08a", include_str!("../../scenes/figure_08a.toml")),
    ("figure_08b", include_str!("../../scenes/figure_08b.toml")),
    ("figure_09", include_str!("../../scenes/figure_09.toml")),
    ("figure_10", include_str!("../../scenes/figure_10.toml")),
    ("figure_11", include_str!("../../scenes/figure_11.toml")),
    ("figure_12", include_str!("../../scenes/figure_12.toml")),
    ("shaft", include_str!("../../scenes/shaft.toml")),
    ("sharp", include_str!("../../scenes/sharp.toml")),
    ("annotated", include_str!("../../scenes/annotated.toml")),
    ("keyframes", include_str!("../../scenes/keyframes.toml")),
];

/// The text of a scene, and the file it was read from.
#[derive(Debug, Clone)]
pub struct Source {
    /// TOML.
    pub text: String,
    /// Paths in the scene are relative to this file's folder; `None` for an embedded scene.
    pub path: Option<PathBuf>,
    /// How messages and pictures name the scene: the file as given, or the embedded scene's name.
    pub name: String,
    /// A file that was read already, for its scene to be made: loading takes its voxels.
    pub(super) ready: Option<Ready>,
}

/// The voxels of a file, with what was stated of it when they were read.
#[derive(Debug, Clone)]
pub(super) struct Ready {
    pub path: PathBuf,
    pub stated: Stated,
    pub loaded: Loaded,
}

/// The longest scene that is read, in bytes: half a million polygons.
const LONGEST: u64 = 64 << 20;

/// The bytes of an ordinary file of at most [`LONGEST`]; devices and pipes may never end.
fn ordinary(path: &Path) -> Result<Vec<u8>, String> {
    let unreadable = |e| format!("the scene cannot be read: {e}; check the path");
    let found = std::fs::metadata(path).map_err(unreadable)?;
    if !found.is_file() && !found.is_dir() {
        return Err(
            "is a device or a pipe, which may never end; save the scene in a file".to_owned()
        );
    }
    if is_volume(path) {
        return Err("is a volume and a scene is expected; write a scene of two lines, `[[entity]]` and `volume = { file = \"…\" }`, and render that".to_owned());
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(LONGEST + 1).read_to_end(&mut bytes))
        .map_err(unreadable)?;
    if bytes.len() as u64 > LONGEST {
        return Err(format!(
            "is longer than {LONGEST} bytes, the most that a scene may have; split it, or keep vertices in fewer digits"
        ));
    }
    Ok(bytes)
}

impl Source {
    /// Reads a scene from a file of UTF-8 text.
    pub fn read(path: impl Into<PathBuf>) -> Result<Self, Error> {
        let path = path.into();
        let bytes = ordinary(&path).map_err(|problem| Error::file(&path, problem))?;
        let text = String::from_utf8(bytes).map_err(|e| {
            let at = e.utf8_error().valid_up_to();
            Error::format(
                &path,
                format!("byte {at} is not UTF-8 text; a scene is TOML, write it as UTF-8"),
            )
        })?;
        let text = text.trim_start_matches('\u{feff}').to_owned();
        Ok(Self { text, name: path.display().to_string(), path: Some(path), ready: None })
    }

    /// The embedded scene of that name; the error lists the names there are.
    pub fn embedded(name: &str) -> Result<Self, Error> {
        let known: Vec<_> = EMBEDDED.iter().map(|(name, _)| *name).collect();
        let scene = EMBEDDED.iter().find(|(known, _)| *known == name).ok_or_else(|| {
            let message = format!("there is no such scene; {}", suggestion(name, &known));
            SceneError::elsewhere(format!("scene `{name}`"), message)
        })?;
        Ok(Self { text: scene.1.to_owned(), path: None, name: name.to_owned(), ready: None })
    }

    /// A scene that stands in no file: `name` is what messages call it.
    pub fn inline(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { text: text.into(), path: None, name: name.into(), ready: None }
    }

    /// The file of that path if there is one, else the embedded scene of that name.
    pub fn open(argument: impl AsRef<Path>) -> Result<Self, Error> {
        let path = argument.as_ref();
        // A name with a folder or an ending is meant as a file: its own error says more than a list of scenes.
        let meant = path.components().count() > 1 || path.extension().is_some();
        let found = path.is_file() || meant;
        if found { Self::read(path) } else { Self::embedded(&path.to_string_lossy()) }
    }

    /// The folder that the scene's paths are relative to; the working folder for an embedded scene.
    #[must_use]
    pub fn folder(&self) -> PathBuf {
        let parent = self.path.as_deref().and_then(Path::parent).map(Path::to_path_buf);
        parent.filter(|p| !p.as_os_str().is_empty()).unwrap_or_else(|| PathBuf::from("."))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_that_is_not_there_lists_those_that_are() {
        let error = Source::embedded("hed").unwrap_err().to_string();
        assert!(error.contains("did you mean `head`?") && error.contains("figure_11"), "{error}");
    }

    #[test]
    fn a_name_with_an_ending_is_a_file_and_a_bare_name_is_an_embedded_scene() {
        assert!(matches!(Source::open("nowhere.toml"), Err(Error::File { .. })));
        assert_eq!(Source::open("minimal_1").unwrap().path, None);
    }

    #[test]
    fn a_file_that_is_not_text_is_refused_by_its_first_bad_byte() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), b"[[entity]]\n\xff").unwrap();
        let error = Source::read(file.path()).unwrap_err().to_string();
        assert!(error.contains("byte 11"), "{error}");
    }
}
