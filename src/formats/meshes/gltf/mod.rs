//! glTF 2.0 (`.gltf` with its buffers beside it or in it, `.glb`): the triangles of a scene's nodes and their base colors, in meters and with y up.

mod accessor;
mod attributes;
mod base_color;
mod buffers;
mod document;
mod looks;
mod place;

use std::path::Path;

use glam::DMat4;

use super::pictures::{PictureAlpha, say_once};
use super::triangles::{Triangles, add_fan, add_strip, reserve};
use crate::components::Space;
use accessor::{floats, indices};
use attributes::{Colored, Vertices};
use base_color::BaseColors;
use buffers::Buffers;
use document::{Document, Primitive};

/// Nodes that are looked at: no scene that is drawn here has more, and a graph in a circle has no end.
const MOST_NODES: usize = 100_000;

/// Vertices and triangles that a byte of a file and its buffers may stand for, by placing a mesh many times; a million always may.
const MOST_OF_A_BYTE: usize = 16;

/// Extensions of how pictures are stored and laid that are read.
const PICTURES: [&str; 2] = ["KHR_texture_transform", "EXT_texture_webp"];

/// Reads the triangles that the file's scene places, in the colors and as opaque as vertices and materials have them, and the pictures on them.
pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Triangles, String> {
    let (text, own) = buffers::chunks(bytes)?;
    let document: Document = serde_json::from_slice(text)
        .map_err(|problem| format!("its JSON is not glTF ({problem}); export it again"))?;
    refuse(&document)?;
    let mut buffers = Buffers::new(&document, own, path)?;
    let mut triangles = Triangles {
        space: Some(Space::YUp),
        unit_mm: Some(1000.0),
        beside: std::mem::take(&mut buffers.files),
        ..Triangles::default()
    };
    let held = bytes.len() + buffers.bytes.iter().map(|buffer| buffer.len()).sum::<usize>();
    let most = held.saturating_mul(MOST_OF_A_BYTE).max(1 << 20);
    let mut base_colors = BaseColors::new(&document, &buffers, (path, held));
    let (mut left_out, mut colored) = (0, false);
    for (mesh, matrix) in place::placed(&document, MOST_NODES)? {
        for primitive in &mesh.primitives {
            match primitive.mode {
                4..=6 => {
                    let before = (triangles.vertices.len() as u32, triangles.faces.len());
                    let own = add(&mut triangles, &document, &buffers, (primitive, matrix))?;
                    colored |= own.is_stated;
                    let (number, look) = base_colors.of(primitive);
                    if let (PictureAlpha::Cut { .. }, Some(_), true) =
                        (look, number, own.has_alpha())
                    {
                        say_once(
                            &mut triangles.warnings,
                            "some of its pictures are cut where the alpha of vertices counts too; pictures are cut by their own, and triangles left out by the mean of their vertices'",
                        );
                    }
                    triangles.pictured.resize(triangles.faces.len(), number.unwrap_or(u32::MAX));
                    let alphas = triangles.faces[before.1..]
                        .iter()
                        .map(|face| own.alpha(face.map(|corner| corner - before.0)));
                    let seen = alphas.map(|alpha| look.seen(alpha, number.is_some()));
                    triangles.opacities.extend(seen);
                }
                _ => left_out += 1,
            }
            if triangles.vertices.len() + triangles.faces.len() > most {
                return Err("places its meshes so often that they are more than 16 times what the file holds; export it with fewer copies".to_owned());
            }
        }
    }
    if !colored {
        triangles.colors.clear();
    }
    if left_out > 0 {
        triangles
            .warnings
            .push(format!("{left_out} of its parts are points or lines, and are left out"));
    }
    base_colors.say_unread();
    triangles.pictures = base_colors.pictures;
    triangles.warnings.extend(base_colors.warnings);
    if triangles.pictures.is_empty() {
        triangles.pictured = Vec::new();
    }
    if triangles.opacities.iter().all(|&opacity| opacity >= 1.0) {
        triangles.opacities = Vec::new();
    }
    Ok(triangles)
}

/// Says what a file needs that is not read.
fn refuse(document: &Document) -> Result<(), String> {
    let version = &document.asset.version;
    if !version.starts_with("2.") {
        return Err(format!("is glTF {version}, and 2.0 is read; export it again"));
    }
    // These change how a surface looks, and not where it is.
    let needed =
        |name: &&String| !name.starts_with("KHR_materials") && !PICTURES.contains(&name.as_str());
    match document.extensions_required.iter().find(needed) {
        Some(name) => Err(format!(
            "needs the extension {name}, which is not read; export it without (such as without compression)"
        )),
        None => Ok(()),
    }
}

/// Adds a primitive's triangles, and tells of the colors of its vertices.
fn add(
    triangles: &mut Triangles,
    document: &Document,
    buffers: &Buffers,
    (primitive, matrix): (&Primitive, DMat4),
) -> Result<Colored, String> {
    let Some(&positions) = primitive.attributes.get("POSITION") else {
        return Ok(Colored::default());
    };
    let points = floats(document, buffers, positions)?;
    if points.width != 3 {
        return Err("has positions that are not of three numbers; export it again".to_owned());
    }
    let count = points.values.len() / 3;
    let first = triangles.vertices.len();
    if u32::try_from(first + count).is_err() {
        return Err("has more than 2³² vertices; split it".to_owned());
    }
    reserve(&mut triangles.vertices, count)?;
    let point =
        |three: &[f64]| matrix.transform_point3(glam::DVec3::new(three[0], three[1], three[2]));
    triangles.vertices.extend(points.values.chunks_exact(3).map(point));
    let vertices = Vertices { document, buffers, primitive, matrix, first, count };
    let colored = vertices.color(&mut triangles.colors)?;
    vertices.bend(&mut triangles.normals.values)?;
    vertices.lay(&mut triangles.places.values)?;
    let corners: Vec<u32> = match primitive.indices {
        Some(accessor) => indices(document, buffers, accessor)?,
        None => (0..count as u32).collect(),
    };
    if corners.iter().any(|&corner| corner as usize >= count) {
        return Err(
            "has a triangle that names a vertex it does not have; export it again".to_owned()
        );
    }
    // What is mirrored runs the other way around.
    let mirrored = matrix.determinant() < 0.0;
    let faces = faces(&corners, primitive.mode).into_iter().map(|[a, b, c]| {
        let face = if mirrored { [a, c, b] } else { [a, b, c] };
        face.map(|corner| corner + first as u32)
    });
    triangles.faces.extend(faces);
    Ok(colored)
}

/// Triangles of a list (mode 4), a strip (5) or a fan (6).
fn faces(corners: &[u32], mode: u32) -> Vec<[u32; 3]> {
    let mut faces = Vec::new();
    match mode {
        4 => faces.extend(corners.chunks_exact(3).map(|three| [three[0], three[1], three[2]])),
        5 => add_strip(&mut faces, corners),
        _ => add_fan(&mut faces, corners),
    }
    faces
}
