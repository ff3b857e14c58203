//! First contact with a mesh: a scene for the triangles of a file that comes without one.

use std::path::Path;

use super::light::{LIGHTS, key};
use crate::formats::meshes::mesh_format;
use crate::scene::source::Source;

/// A scene for the mesh in a file, which its name tells, and a sentence about how it was taken.
///
/// Nothing is read of it yet. `size` is in pixels.
pub(super) fn scene(path: &Path, size: [u32; 2]) -> (Source, String) {
    let name = path.display().to_string();
    let quoted = toml::Value::String(name.clone()).to_string();
    let up =
        mesh_format(path).is_some_and(|format| ["obj", "gltf", "glb"].contains(&format.extension));
    let (space, axes) = if up {
        ("y-up", "y up, as modelers write it")
    } else {
        ("lps", "z up, as scanners have it")
    };
    let said = format!("a mesh, taken with {axes}; another way is stated as `space` of its `mesh`");
    let [width, height] = size;
    let text = format!(
        "# A mesh.\n[[entity]]\nname = \"mesh\"\nmesh = {{ file = {quoted}, space = \"{space}\" }}\nsmooth = {{ crease_degrees = 45.0 }}\nsurface = {{ color = \"#e8dcc8\", ambient = 0.06, diffuse = 0.86, specular = 0.1, shininess = 24 }}\n{}{LIGHTS}\n[[entity]]\nname = \"observer\"\nview = {{ azimuth = 25.0, elevation = 12.0, size = [{width}, {height}], background = \"#101418\" }}\n",
        key(false)
    );
    let said = format!("{name}: {said}");
    (Source::inline(name, text), said)
}
