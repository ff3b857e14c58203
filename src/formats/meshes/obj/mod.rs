//! Wavefront OBJ: vertices, their colors and normals, places in a texture, polygons and what they are made of, as lines of text.

mod library;
mod line;
mod made_of;

use std::path::Path;

use glam::DVec3;

use super::triangles::{Triangles, add_fan, fans, place_upward};
use line::{argument, color_of};
use made_of::MadeOf;

/// Reads the lines `v x y z`, `v x y z r g b`, `vn x y z`, `vt u v`, `f a/t/n b/t/n c/t/n …`, `mtllib` and `usemtl`; the rest is left out.
pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Triangles, String> {
    let mut triangles = Triangles::default();
    let (mut polygons, mut made_of) = (0, MadeOf::default());
    for (at, line) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let line = String::from_utf8_lossy(line);
        let mut words = line.split_whitespace();
        let wrong = |what: &str| format!("line {} is {what}; fetch the file again", at + 1);
        let kind = words.next();
        if kind == Some("f") {
            let before = triangles.faces.len();
            polygons += usize::from(add_polygon(&mut triangles, words).map_err(wrong)? > 3);
            made_of.cover(before, triangles.faces.len());
            continue;
        }
        let mut number = || words.next().and_then(|word| word.parse::<f64>().ok());
        match kind {
            Some("v") => {
                let three = number().zip(number()).zip(number());
                let ((x, y), z) = three.ok_or_else(|| wrong("no vertex of three numbers"))?;
                triangles.vertices.push(DVec3::new(x, y, z));
                let color = number().zip(number()).zip(number());
                triangles.colors.extend(color.map(|((r, g), b)| color_of([r, g, b])));
            }
            Some("vn") => {
                let three = number().zip(number()).zip(number());
                let ((x, y), z) = three.ok_or_else(|| wrong("no normal of three numbers"))?;
                triangles.normals.values.push(DVec3::new(x, y, z));
            }
            Some("vt") => {
                let u = number().ok_or_else(|| wrong("no place in a texture"))?;
                triangles.places.values.push(place_upward(u, number().unwrap_or(0.0)));
            }
            Some("mtllib") => made_of.look_up(argument(&line), path),
            Some("usemtl") => made_of.take(argument(&line)),
            _ => {}
        }
    }
    made_of.color(&mut triangles);
    triangles.warnings.extend(fans(polygons));
    triangles.normals.tidy();
    triangles.places.tidy();
    Ok(triangles)
}

/// Adds the triangles of a polygon, whose corners are the words, and how many corners it has; the error is what is wrong.
fn add_polygon<'w>(
    triangles: &mut Triangles,
    words: impl Iterator<Item = &'w str>,
) -> Result<usize, &'static str> {
    let (mut vertices, mut places, mut normals) = (Vec::new(), Vec::new(), Vec::new());
    for word in words {
        let mut parts = word.split('/');
        let vertex = index(parts.next(), triangles.vertices.len());
        vertices.push(vertex.ok_or("no face of vertices before it")?);
        // What is not there, or not yet, is stated nowhere.
        places.push(index(parts.next(), triangles.places.values.len()).unwrap_or(u32::MAX));
        normals.push(index(parts.next(), triangles.normals.values.len()).unwrap_or(u32::MAX));
    }
    if vertices.len() < 3 {
        return Err("a face of fewer than 3 vertices");
    }
    add_fan(&mut triangles.faces, &vertices);
    add_fan(&mut triangles.places.faces, &places);
    add_fan(&mut triangles.normals.faces, &normals);
    Ok(vertices.len())
}

/// A number counted from 1 to `count`, or counted back from the last by one below 0, as an index.
fn index(word: Option<&str>, count: usize) -> Option<u32> {
    let number: i64 = word?.parse().ok()?;
    let index = if number < 0 { count as i64 + number } else { number - 1 };
    u32::try_from(index).ok().filter(|&index| (index as usize) < count)
}
