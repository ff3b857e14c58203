//! A scene that cannot be used: what was found where, what was expected and what to do.

use std::ops::Range;

use crate::error::SceneError;

/// The text of a scene under its name: what spans point into.
#[derive(Debug, Clone, Copy)]
pub(super) struct Text<'t> {
    /// The name of the file.
    pub file: &'t str,
    /// What is in it.
    pub text: &'t str,
}

impl Text<'_> {
    /// A fault at some bytes of the text.
    pub fn error(self, span: Range<usize>, message: impl Into<String>) -> SceneError {
        let before = self.text.get(..span.start).unwrap_or(self.text);
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
        SceneError {
            at: Some([line as u32, column as u32]),
            text: self.text.into(),
            span: Some(span),
            ..SceneError::elsewhere(self.file, message)
        }
    }
}

/// A fault in some bytes of a text that is not at hand.
#[derive(Debug)]
pub(super) struct Fault {
    /// The bytes.
    pub span: Range<usize>,
    /// The sentence.
    pub message: String,
}

impl Fault {
    /// A fault at some bytes.
    pub fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { span, message: message.into() }
    }

    /// The error, once the text is at hand.
    pub fn within(self, text: Text) -> SceneError {
        text.error(self.span, self.message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_from_one_in_characters() {
        let text = Text { file: "a.toml", text: "x = 1\ncö = 2\n" };
        assert_eq!(text.error(0..1, "no").to_string(), "a.toml:1:1: no");
        let at = text.text.rfind('=').unwrap();
        assert_eq!(text.error(at..at + 1, "no").at, Some([2, 4]));
        assert_eq!(text.error(999..1000, "no").at, Some([3, 1]));
    }
}
