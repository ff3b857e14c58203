//! What can go wrong, by whose fault: one sentence each, with the remedy.

mod scene;

use std::path::PathBuf;

pub use scene::{Blame, SceneError};

/// A failure, told in one sentence that names what was found, what was expected and what to do.
///
/// The variants say whose fault it is and may become more.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene (or an override of it) states something that cannot be rendered.
    #[error("{0}")]
    Scene(Box<SceneError>),
    /// An entity of the scene is at fault: its name and the sentence.
    #[error("entity `{entity}`: {problem}")]
    Entity {
        /// The entity's name in the scene.
        entity: String,
        /// What was found, what was expected and what to do.
        problem: String,
    },
    /// An array or a number that a caller handed over in memory does not do.
    #[error("{what}: {problem}")]
    Input {
        /// What it was meant for: `volume`, `triangles`, `picture`, …
        what: &'static str,
        /// What was found, what was expected and what to do.
        problem: String,
    },
    /// A file cannot be opened, read or written.
    #[error("{}: {problem}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What was found, what was expected and what to do.
        problem: String,
    },
    /// A file can be read and is not what it says it is, or of no known format.
    #[error("{}: {problem}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// What was found, what was expected and what to do.
        problem: String,
    },
    /// More memory may be needed than is allowed.
    #[error(
        "up to {needed} bytes are needed and {allowed} are allowed; allow more, or choose a smaller `size`, volume or texture, or a smaller `texel`"
    )]
    Memory {
        /// Bytes that are needed at the most.
        needed: u64,
        /// Bytes that were allowed.
        allowed: u64,
    },
    /// The system does not give what the work needs, such as one more thread: a sentence.
    #[error("{0}")]
    System(String),
    /// The work was stopped on request; what was finished stays.
    #[error("interrupted: finished files are whole, nothing half-written is left")]
    Interrupted,
    /// A system and the schedule disagree: a defect of gelray, never of the input.
    #[error("the schedule is not sound: {0}")]
    Schedule(String),
}

impl Error {
    /// An error of something handed over in memory.
    pub fn input(what: &'static str, problem: impl Into<String>) -> Self {
        Self::Input { what, problem: problem.into() }
    }

    /// An error of what the file at `path` holds.
    pub fn format(path: impl Into<PathBuf>, problem: impl Into<String>) -> Self {
        Self::Format { path: path.into(), problem: problem.into() }
    }

    /// An error of reaching the file at `path`.
    pub fn file(path: impl Into<PathBuf>, problem: impl Into<String>) -> Self {
        Self::File { path: path.into(), problem: problem.into() }
    }

    /// An error of the entity called `entity`.
    pub fn entity(entity: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Entity { entity: entity.into(), problem: problem.into() }
    }
}

impl From<SceneError> for Error {
    fn from(error: SceneError) -> Self {
        Self::Scene(Box::new(error))
    }
}
