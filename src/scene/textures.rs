//! Textures found and given to the polygons and lights that name them.

use glam::DVec3;

use super::loading::Loading;
use crate::components::{Polygon, Projects, Texture, Textured, Voxelize};
use crate::error::Error;
use crate::formats::read_picture;
use crate::light::strength::ProjectedBy;
use crate::phantom;
use crate::polygon::texture;
use crate::polygon::texture::TexturedBy;
use crate::view::extent::Extent;
use crate::view::picture::Picture;
use crate::volume::grid::Grid;

/// Reads every texture, then resolves `textured` and `projects`.
pub(super) fn bring_in(loading: &mut Loading, extent: Extent) -> Result<(), Error> {
    for entry in loading.nouns(&["texture"]) {
        if let Some(texture) = loading.get::<Texture>(entry) {
            let picture = read(loading, entry, &texture)?;
            loading.add(entry, (picture,));
        }
    }
    for entry in loading.nouns(&["polygon", "mesh"]) {
        if let Some(textured) = loading.get::<Textured>(entry) {
            let picture = named(loading, entry, "textured", &textured.texture)?;
            let corners = corners(loading, entry, &textured)?;
            if loading.get::<Voxelize>(entry).is_some() {
                loading.warn(entry, "its texture is not shown, since `voxelize` draws it without the hybrid ray tracer; take one of the two away");
            }
            let texture = texture::Texture::new(&picture, textured.wrap, textured.filter);
            loading.add(entry, (TexturedBy { textured, texture, corners },));
        }
    }
    for entry in loading.nouns(&["light"]) {
        if let Some(projects) = loading.get::<Projects>(entry) {
            let picture = named(loading, entry, "projects", &projects.texture)?;
            let center = projects.center.map_or_else(|| middle(loading, extent), DVec3::from);
            let up = projects.up.map_or(DVec3::Z, DVec3::from);
            loading.add(entry, (ProjectedBy { projects, picture, center, up },));
        }
    }
    Ok(())
}

/// The centre of the volume, or of everything where there is none.
fn middle(loading: &Loading, extent: Extent) -> DVec3 {
    let grid = loading.nouns(&["volume"]).first().and_then(|&entry| loading.get::<Grid>(entry));
    grid.and_then(|grid| Extent::of(grid.corners())).unwrap_or(extent).center()
}

/// The picture of a texture: its formula, its file, or what stands in for its file.
fn read(loading: &mut Loading, entry: usize, texture: &Texture) -> Result<Picture, Error> {
    let made = |loading: &Loading, key, name: &str| {
        phantom::texture(name).map_err(|problem| loading.error(entry, "texture", key, problem))
    };
    if let Some(formula) = &texture.formula {
        return made(loading, "formula", formula);
    }
    let file = texture.file.as_deref().unwrap_or_default();
    if let Some(path) = loading.folders.find(file) {
        return read_picture(&path);
    }
    let missing = format!(
        "`{file}` is not in {} nor in the folders of the data folders",
        loading.folders.list()
    );
    let Some(formula) = &texture.stand_in else {
        let problem = format!("{missing}; give its folder with --data DIR or state a `stand_in`");
        return Err(loading.error(entry, "texture", "file", problem));
    };
    let remedy = "give its folder with --data DIR";
    loading.warn(entry, format!("{missing}: the formula `{formula}` stands in for it; {remedy}"));
    made(loading, "stand_in", formula)
}

/// The picture of the texture called `name`: an entity of the scene, else a formula.
fn named(loading: &Loading, entry: usize, key: &str, name: &str) -> Result<Picture, Error> {
    let textures = loading.nouns(&["texture"]);
    let stated = textures.iter().find(|&&texture| loading.entries[texture].name == name);
    if let Some(picture) = stated.and_then(|&texture| loading.get::<Picture>(texture)) {
        return Ok(picture);
    }
    phantom::texture(name).map_err(|problem| {
        let stated: Vec<_> =
            textures.iter().map(|&t| format!("`{}`", loading.entries[t].name)).collect();
        let stated = if stated.is_empty() { "none".to_owned() } else { stated.join(", ") };
        let problem = format!(
            "no texture of the scene is called `{name}` (there are: {stated}), and {problem}"
        );
        loading.error(entry, key, "texture", problem)
    })
}

/// The world points of the texture's top left, top right and bottom left.
fn corners(loading: &Loading, entry: usize, textured: &Textured) -> Result<[DVec3; 3], Error> {
    let of_polygon = || match loading.get::<Polygon>(entry)?.vertices[..] {
        [first, second, .., last] => Some([first, second, last]),
        _ => None,
    };
    let Some(corners) = textured.corners.or_else(of_polygon) else {
        let problem = "a mesh says nothing about where its texture lies; state `corners`";
        return Err(loading.error(entry, "textured", "", problem));
    };
    let corners = corners.map(DVec3::from);
    let (across, down) = (corners[1] - corners[0], corners[2] - corners[0]);
    if across.cross(down).length() <= 1e-12 * across.length() * down.length() {
        let problem = "the corners of its texture lie on one line; state three that span it";
        return Err(loading.error(entry, "textured", "corners", problem));
    }
    Ok(corners)
}
