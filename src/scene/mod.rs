//! Scenes: TOML to entities with components, names and overrides.

/// A scene that cannot be used: what was found where, what was expected and what to do.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct SceneError {
    /// The sentence.
    pub message: String,
}
