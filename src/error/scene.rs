//! A scene that cannot be used: what was found where, what was expected and what to do.

use std::ops::Range;
use std::sync::Arc;

/// One fault of a scene, with the text that it stands in: shows as one sentence.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{place}: {message}")]
pub struct SceneError {
    /// The sentence: what was found, what was expected and what to do.
    pub message: String,
    /// `file:line:column`, both from 1; or what else is at fault, as an override of the scene.
    pub place: String,
    /// The text of the scene, or of the override; empty where no text is to blame.
    pub text: Arc<str>,
    /// The bytes of the text that are at fault.
    pub span: Option<Range<usize>>,
}

impl SceneError {
    /// A fault that no line of a scene is to blame for.
    pub fn elsewhere(place: impl Into<String>, message: impl Into<String>) -> Self {
        Self { message: message.into(), place: place.into(), text: Arc::default(), span: None }
    }
}
