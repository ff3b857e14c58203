//! Textures found and given to the polygons and lights that name them.

use glam::DVec3;

use super::library::Library;
use super::loading::Loading;
use crate::components::{Polygon, Projects, Textured, Voxelize};
use crate::error::Error;
use crate::light::strength::ProjectedBy;
use crate::polygon::texture::TexturedBy;
use crate::view::extent::Extent;
use crate::volume::grid::Grid;

/// Resolves `textured` and `projects`: reads each texture that one of them names once, and none else.
///
/// A texture that nothing names is warned of and not looked for: its file may be missing.
pub(super) fn bring_in(loading: &mut Loading, extent: Extent) -> Result<(), Error> {
    let mut library = Library::of(loading);
    for entry in loading.nouns(&["polygon", "mesh"]) {
        if let Some(textured) = loading.get::<Textured>(entry) {
            let picture = library.picture(loading, entry, "textured", &textured.texture)?;
            let corners = corners(loading, entry, &textured)?;
            if loading.get::<Voxelize>(entry).is_some() {
                loading.warn(entry, "its texture is not shown, since `voxelize` draws it without the hybrid ray tracer; take one of the two away");
            }
            let texture = library.texture(&picture, &textured);
            loading.add(entry, (TexturedBy { textured, texture, corners },));
        }
    }
    let middle = middle(loading, extent);
    for entry in loading.nouns(&["light"]) {
        if let Some(projects) = loading.get::<Projects>(entry) {
            let picture = library.picture(loading, entry, "projects", &projects.texture)?;
            let center = projects.center.map_or(middle, DVec3::from);
            let up = projects.up.map_or(DVec3::Z, DVec3::from);
            loading.add(entry, (ProjectedBy { projects, picture, center, up },));
        }
    }
    library.warn_of_unused(loading);
    Ok(())
}

/// The centre of the volume, or of everything where there is none.
fn middle(loading: &Loading, extent: Extent) -> DVec3 {
    let grid = loading.nouns(&["volume"]).first().and_then(|&entry| loading.get::<Grid>(entry));
    grid.and_then(|grid| Extent::of(grid.corners())).unwrap_or(extent).center()
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
