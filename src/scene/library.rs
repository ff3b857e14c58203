//! The pictures that polygons and lights of a scene name: each is read once, when it is first asked for.

use std::collections::HashMap;

use super::loading::Loading;
use crate::components::{Texture, Textured};
use crate::error::Error;
use crate::formats::read_picture;
use crate::phantom;
use crate::polygon::texture;
use crate::view::picture::Picture;

/// Textures by name, and those that were read.
pub(super) struct Library {
    /// The entry of each texture that the scene states, by its name.
    stated: HashMap<String, usize>,
    /// Names of the textures of the scene, in its order.
    names: Vec<String>,
    /// Pictures that were read, and the first texture made of each.
    read: HashMap<String, (Picture, Option<texture::Texture>)>,
}

impl Library {
    /// The textures that a scene states; none is read yet.
    pub fn of(loading: &Loading) -> Self {
        let entries = loading.nouns(&["texture"]);
        let name = |entry: usize| loading.entries[entry].name.clone();
        let names = entries.iter().map(|&entry| name(entry)).collect();
        let stated = entries.iter().map(|&entry| (name(entry), entry)).collect();
        Self { stated, names, read: HashMap::new() }
    }

    /// The picture of the texture called `name`: an entity of the scene, else a formula. `entry` is who asks, under `key`.
    pub fn picture(
        &mut self,
        loading: &mut Loading,
        entry: usize,
        key: &str,
        name: &str,
    ) -> Result<Picture, Error> {
        if let Some((picture, _)) = self.read.get(name) {
            return Ok(picture.clone());
        }
        let stated = self.stated.get(name).copied();
        let component = stated.and_then(|entry| loading.get::<Texture>(entry));
        let picture = match (stated, component) {
            (Some(stated), Some(texture)) => read(loading, stated, &texture)?,
            _ => phantom::texture(name).map_err(|problem| {
                loading.error(entry, key, "texture", self.unknown(name, &problem))
            })?,
        };
        self.read.insert(name.to_owned(), (picture.clone(), None));
        Ok(picture)
    }

    /// The picture that `textured` names, which was read, ready for lookups; its texels are shared.
    pub fn texture(&mut self, picture: &Picture, textured: &Textured) -> texture::Texture {
        let Textured { wrap, filter, .. } = *textured;
        let made = self.read.get_mut(&textured.texture).map(|(_, made)| made);
        if let Some(Some(made)) = &made {
            return made.with(wrap, filter);
        }
        let texture = texture::Texture::new(picture, wrap, filter);
        if let Some(made) = made {
            *made = Some(texture.clone());
        }
        texture
    }

    /// Warns of the textures that nothing asked for: a sentence for all of them.
    pub fn warn_of_unused(&self, loading: &mut Loading) {
        let mut unused = self.names.iter().filter(|name| !self.read.contains_key(*name));
        let Some(first) = unused.next() else { return };
        let more = match unused.count() {
            0 => "is not read: nothing names it".to_owned(),
            count => format!("and {count} more textures are not read: nothing names them"),
        };
        let remedy = "state `textured` or `projects`, or take it away";
        loading.warnings.push(format!("entity `{first}` {more}; {remedy}"));
    }

    fn unknown(&self, name: &str, problem: &str) -> String {
        let stated: Vec<_> = self.names.iter().map(|name| format!("`{name}`")).collect();
        let stated = if stated.is_empty() { "none".to_owned() } else { stated.join(", ") };
        format!("no texture of the scene is called `{name}` (there are: {stated}), and {problem}")
    }
}

/// What a texture of the scene holds: its formula, its file, or what stands in for its file.
fn read(loading: &mut Loading, entry: usize, texture: &Texture) -> Result<Picture, Error> {
    let made = |loading: &Loading, key, name: &str| {
        phantom::texture(name).map_err(|problem| loading.error(entry, "texture", key, problem))
    };
    if let Some(formula) = &texture.formula {
        return made(loading, "formula", formula);
    }
    let file = texture.file.as_deref().unwrap_or_default();
    if let Some(path) = loading.folders.find(file) {
        loading.files.push(path.clone());
        return read_picture(&path);
    }
    let missing = loading.folders.missing(file);
    let Some(formula) = &texture.stand_in else {
        let problem = format!("{missing}; give its folder with --data DIR or state a `stand_in`");
        return Err(loading.error(entry, "texture", "file", problem));
    };
    let remedy = "give its folder with --data DIR";
    loading.warn(entry, format!("{missing}: the formula `{formula}` stands in for it; {remedy}"));
    made(loading, "stand_in", formula)
}
