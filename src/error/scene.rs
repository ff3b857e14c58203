//! A scene that cannot be used: what was found where, what was expected and what to do.

use std::sync::Arc;

use miette::{Diagnostic, NamedSource, SourceSpan};

/// One fault of a scene, with the text that it stands in: shows as one sentence, or as a marked excerpt through miette.
#[derive(Debug, Clone, thiserror::Error, Diagnostic)]
#[error("{place}: {message}")]
pub struct SceneError {
    /// The sentence: what was found, what was expected and what to do.
    pub message: String,
    /// `file:line:column`, both from 1; or what else is at fault, as `--set head.view.sise=1`.
    pub place: String,
    /// The text of the scene (or of the override) under its name.
    #[source_code]
    pub text: Arc<NamedSource<String>>,
    /// The bytes of the text that are at fault.
    #[label("here")]
    pub span: Option<SourceSpan>,
}

impl SceneError {
    /// A fault that no line of a scene is to blame for.
    pub fn elsewhere(place: impl Into<String>, message: impl Into<String>) -> Self {
        let place = place.into();
        let text = Arc::new(NamedSource::new(&place, String::new()));
        Self { message: message.into(), place, text, span: None }
    }
}
