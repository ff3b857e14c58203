//! A scene that cannot be used: what was found where, what was expected and what to do.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// One fault of a scene, with the text that it stands in: shows as one sentence.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{message}", self.place())]
pub struct SceneError {
    /// The sentence: what was found, what was expected and what to do.
    pub message: String,
    /// What the scene is called: its file, or an embedded scene's name. Of a fault of an override, the override itself.
    pub name: String,
    /// Line and column, both from 1; `None` where no place in the text is to blame.
    pub at: Option<[u32; 2]>,
    /// Whose fault it is.
    pub blame: Blame,
    /// The text of the scene with its overrides; empty where no text is to blame.
    pub text: Arc<str>,
    /// The bytes of the text that are at fault.
    pub span: Option<Range<usize>>,
    /// The file that the scene names and that is nowhere, where that is the fault: another folder of data may have it.
    pub missing: Option<Box<str>>,
}

/// Whose fault it is that a scene cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Blame {
    /// The scene's.
    Scene,
    /// That of the scene or of an override: lines are those of the text that overrides changed.
    Overridden,
    /// That of one override.
    Override,
}

impl SceneError {
    /// A fault that no line of a scene is to blame for.
    pub fn elsewhere(name: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            name: name.into(),
            at: None,
            blame: Blame::Scene,
            text: Arc::default(),
            span: None,
            missing: None,
        }
    }

    /// A fault of an override, as it was given.
    pub fn of_override(change: impl Into<String>, message: impl Into<String>) -> Self {
        Self { blame: Blame::Override, ..Self::elsewhere(change, message) }
    }

    fn place(&self) -> impl fmt::Display + '_ {
        fmt::from_fn(|f| {
            match self.blame {
                Blame::Scene => write!(f, "{}", self.name)?,
                Blame::Overridden => write!(f, "{} with overrides", self.name)?,
                Blame::Override => write!(f, "override `{}`", self.name)?,
            }
            if let Some([line, column]) = self.at {
                write!(f, ":{line}:{column}")?;
            }
            f.write_str(": ")
        })
    }
}
