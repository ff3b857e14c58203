//! The list of a sequence's files: what each shows, and which of them are there.
//!
//! It says what the frames are to be, not which are done: that is read off the files themselves. So it is written once,
//! before the first frame, every shard writes the very same bytes, and no interruption makes it wrong.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::numbered::key_of_file;
use crate::error::Error;
use crate::formats::whole::write_whole;

/// The frames of a sequence, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// The version of gelray that it is of.
    pub version: String,
    /// The scene's name.
    pub scene: String,
    /// The digest of the scene's text before anything moves, changes of it included.
    pub scene_digest: String,
    /// The digest of all data files that the scene names; `None` where it names none.
    pub data_digest: Option<String>,
    /// Frames a second.
    pub frames_per_second: String,
    /// Each frame.
    pub frames: Vec<Listed>,
}

/// A frame of a sequence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Listed {
    /// The name of its file, beside the manifest.
    pub file: String,
    /// What it sets in the scene.
    pub changes: Vec<String>,
    /// The digest of all that the picture depends on ([`super::numbered::key`]).
    pub key: String,
}

impl Manifest {
    /// Reads a manifest.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let bytes = std::fs::read(path)
            .map_err(|error| Error::file(path, format!("cannot be read ({error})")))?;
        serde_json::from_slice(&bytes).map_err(|error| {
            Error::file(path, format!("is no manifest of frames ({error}); render them again"))
        })
    }

    /// Writes the manifest, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        write_whole(path, |out| {
            serde_json::to_writer_pretty(&mut *out, self)?;
            Ok(out.write_all(b"\n")?)
        })
    }

    /// Whether a frame's file in `folder` is there, whole, and shows what it is to show.
    #[must_use]
    pub fn is_done(&self, folder: &Path, number: usize) -> bool {
        let listed = self.frames.get(number);
        listed.is_some_and(|frame| {
            key_of_file(&folder.join(&frame.file)).is_some_and(|key| key == frame.key)
        })
    }
}
