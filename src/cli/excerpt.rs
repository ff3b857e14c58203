//! A fault of a scene as a terminal shows it: the sentence under the lines that it is in, with what is wrong marked.

use gelray::Error;
use gelray::error::SceneError;
use miette::{Diagnostic, NamedSource, SourceSpan};

use super::escaped::escaped;
use super::sentence::{place, sentence};

/// A fault and the text around it, free of the text's own commands to the terminal.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error("{sentence}")]
pub struct Excerpt {
    sentence: String,
    #[source_code]
    text: NamedSource<String>,
    #[label("here")]
    span: SourceSpan,
}

impl Excerpt {
    /// The excerpt of a fault; `None` where no text is to blame.
    pub fn of(fault: &SceneError) -> Option<Self> {
        let span = fault.span.clone()?;
        let place = escaped(&place(fault));
        Some(Self {
            sentence: escaped(&sentence(&Error::from(fault.clone()))),
            text: NamedSource::new(place, spelled(&fault.text)),
            span: SourceSpan::from((span.start, span.len())),
        })
    }
}

/// A scene's text with each control character as one byte, so that what is marked stays where it is.
fn spelled(text: &str) -> String {
    let safe = |letter: char| match letter {
        '\n' | '\t' | '\r' => letter,
        _ if letter.is_ascii_control() => '?',
        _ => letter,
    };
    text.chars().map(safe).collect()
}

#[cfg(test)]
mod tests {
    use gelray::scene::{Source, load};

    use super::*;

    #[test]
    fn the_excerpt_marks_the_fault_in_the_file() {
        let source = Source::inline("a.toml", "[[entity]]\nview = { azimut = 2 }\n");
        let Err(Error::Scene(fault)) = load(&source, &[], &[], false) else { panic!() };
        let mut shown = String::new();
        let excerpt = Excerpt::of(&fault).unwrap();
        miette::NarratableReportHandler::new().render_report(&mut shown, &excerpt).unwrap();
        assert!(shown.contains("azimut = 2") && shown.contains("here"), "{shown}");
        assert!(shown.contains("a.toml:2:"), "{shown}");
    }
}
