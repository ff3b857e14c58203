//! What can go wrong, by whose fault: one sentence each, with the remedy.

mod scene;

use std::path::PathBuf;

pub use scene::SceneError;

/// A failure, told in one sentence that names what was found, what was expected and what to do.
#[derive(Debug, thiserror::Error)]
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
    /// A file cannot be read or is not what it says it is.
    #[error("{}: {problem}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What was found, what was expected and what to do.
        problem: String,
    },
    /// The plan needs more memory than `--max-memory` allows.
    #[error(
        "the plan needs up to {needed} bytes and --max-memory allows {allowed}; raise the limit, choose a smaller `size` or volume, or a smaller `texel`"
    )]
    Memory {
        /// Bytes that the plan needs at the most.
        needed: u64,
        /// Bytes that were allowed.
        allowed: u64,
    },
    /// The work was stopped on request (exit code 130); what was finished stays.
    #[error("interrupted: finished files are whole, nothing half-written is left")]
    Interrupted,
    /// A system and the schedule disagree: a defect of gelray, never of the input.
    #[error("the schedule is not sound: {0}")]
    Schedule(String),
}

impl Error {
    /// An error of the file at `path`.
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
