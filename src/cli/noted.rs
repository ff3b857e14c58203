//! What a picture says of itself: all that it takes to make it again, and no clock time.

use gelray::scene::Scene;

use super::failure::Failure;
use super::flags::Flags;
use super::stats::Counted;

/// The version of gelray.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The notes of a picture; `data` is the digest of the files that it is of, where that is noted.
pub fn notes(
    scene: &Scene,
    counts: &Counted,
    flags: &Flags,
    data: Option<&str>,
) -> Result<Vec<(String, String)>, Failure> {
    let counts = serde_json::to_string(counts)
        .map_err(|error| Failure::Said(format!("the counts cannot be noted ({error})")))?;
    let mut notes = telling_notes(&scene.name, &scene.resolved, flags, data);
    notes.insert(3, ("counts".to_owned(), counts));
    Ok(notes)
}

/// The notes of a picture that are known before it is rendered.
pub fn telling_notes(
    scene: &str,
    settings: &str,
    flags: &Flags,
    data: Option<&str>,
) -> Vec<(String, String)> {
    let version = format!("gelray {VERSION}");
    let exact = flags.exact.then_some(("exact", "true"));
    let notes = [("version", version.as_str()), ("scene", scene), ("settings", settings)];
    let notes = notes.into_iter().chain(exact).chain(data.map(|data| ("data", data)));
    notes.map(|(name, text)| (name.to_owned(), text.to_owned())).collect()
}
