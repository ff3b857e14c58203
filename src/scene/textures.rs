//! The pictures of a scene's textures: each that a polygon or a light names is read, once, and none else.

use std::collections::HashSet;

use super::kept::KeptPicture;
use super::loading::Loading;
use crate::components::{Projects, Texture, Textured};
use crate::error::Error;
use crate::formats::pictures::weighed;
use crate::formats::read_picture;
use crate::phantom;
use crate::view::picture::Picture;

/// Puts its picture on every texture that something names.
///
/// A texture that nothing names is warned of and not looked for: its file may be missing.
pub(super) fn read(loading: &mut Loading) -> Result<(), Error> {
    let mut named = HashSet::new();
    for entry in 0..loading.entries.len() {
        let textured = loading.get::<Textured>(entry).map(|textured| textured.texture);
        let projects = loading.get::<Projects>(entry).map(|projects| projects.texture);
        named.extend(textured.into_iter().chain(projects));
    }
    let entries = loading.nouns(&["texture"]);
    let (read, unread): (Vec<usize>, Vec<usize>) =
        entries.into_iter().partition(|&entry| named.contains(&loading.entries[entry].name));
    for entry in read {
        if let Some(texture) = loading.get::<Texture>(entry) {
            let picture = kept_or_read(loading, entry, &texture)?;
            loading.add(entry, (picture,));
        }
    }
    warn_of(&unread, loading);
    Ok(())
}

/// Warns of the textures that nothing names: a sentence for all of them.
fn warn_of(unread: &[usize], loading: &mut Loading) {
    let Some((&first, rest)) = unread.split_first() else { return };
    let more = match rest.len() {
        0 => "is not read: nothing names it".to_owned(),
        count => format!("and {count} more textures are not read: nothing names them"),
    };
    let (first, remedy) =
        (&loading.entries[first].name, "state `textured` or `projects`, or take it away");
    let warning = format!("entity `{first}` {more}; {remedy}");
    loading.warnings.push(warning);
}

/// The picture that an earlier loading read; else it is read, and kept for the next.
fn kept_or_read(loading: &mut Loading, entry: usize, texture: &Texture) -> Result<Picture, Error> {
    let name = loading.entries[entry].name.clone();
    if let Some(kept) = loading.kept.pictures.get(&name).filter(|kept| kept.stated == *texture) {
        loading.files.extend(kept.files.iter().cloned());
        return Ok(kept.picture.clone());
    }
    let before = loading.files.len();
    let picture = picture(loading, entry, texture)?;
    let files = loading.files[before..].to_vec();
    let kept = KeptPicture { stated: texture.clone(), picture: picture.clone(), files };
    loading.kept.pictures.insert(name, kept);
    Ok(picture)
}

/// Bytes of a picture of `kept` bytes with the levels that are made of it for polygons: its texels again, and a third more.
fn mapped(kept: u64) -> u64 {
    kept.saturating_mul(7).div_ceil(3)
}

/// What a texture of the scene holds: its formula, its file, or what stands in for its file.
fn picture(loading: &mut Loading, entry: usize, texture: &Texture) -> Result<Picture, Error> {
    let made = |loading: &mut Loading, key, name: &str| {
        loading.afford(mapped(phantom::TEXTURE_BYTES))?;
        phantom::texture(name).map_err(|problem| loading.error(entry, "texture", key, problem))
    };
    if let Some(formula) = &texture.formula {
        return made(loading, "formula", formula);
    }
    let file = texture.file.as_deref().unwrap_or_default();
    if let Some(path) = loading.folders.find(file) {
        loading.files.push(path.clone());
        let weight = weighed(&path)?;
        loading.afford(weight.kept)?;
        loading.afford_passing(weight.passing)?;
        loading.afford(mapped(weight.kept) - weight.kept)?;
        return read_picture(&path);
    }
    let missing = loading.folders.missing(file);
    let Some(formula) = &texture.stand_in else {
        let problem = format!("{missing}; name its folder as a data folder or state a `stand_in`");
        return Err(loading.nowhere(entry, ("texture", "file"), file, problem));
    };
    let remedy = "name its folder as a data folder";
    loading.warn(entry, format!("{missing}: the formula `{formula}` stands in for it; {remedy}"));
    loading.missing.push(file.to_owned());
    made(loading, "stand_in", formula)
}
