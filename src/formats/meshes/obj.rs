//! Wavefront OBJ: vertices, their colors, and polygons as lines of text; materials, normals and texture coordinates are not read.

use std::path::Path;

use glam::DVec3;

use super::triangles::{Triangles, add_fan, fans};
use crate::components::Color;

/// Reads the lines `v x y z`, `v x y z r g b` and `f a b c …`; the rest is left out.
pub(super) fn read(bytes: &[u8], _: &Path) -> Result<Triangles, String> {
    let mut triangles = Triangles::default();
    let mut polygons = 0;
    let mut polygon = Vec::new();
    for (at, line) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let line = String::from_utf8_lossy(line);
        let mut words = line.split_whitespace();
        let wrong = |what: &str| format!("line {} is {what}; fetch the file again", at + 1);
        match words.next() {
            Some("v") => {
                let mut number = || words.next().and_then(|word| word.parse::<f64>().ok());
                let three = number().zip(number()).zip(number());
                let ((x, y), z) = three.ok_or_else(|| wrong("no vertex of three numbers"))?;
                triangles.vertices.push(DVec3::new(x, y, z));
                let color = number().zip(number()).zip(number());
                triangles.colors.extend(color.map(|((r, g), b)| color_of([r, g, b])));
            }
            Some("f") => {
                polygon.clear();
                for word in words {
                    let index = index(word, triangles.vertices.len());
                    polygon.push(index.ok_or_else(|| wrong("no face of vertices before it"))?);
                }
                if polygon.len() < 3 {
                    return Err(wrong("a face of fewer than 3 vertices"));
                }
                polygons += usize::from(polygon.len() > 3);
                add_fan(&mut triangles.faces, &polygon);
            }
            _ => {}
        }
    }
    triangles.warnings.extend(fans(polygons));
    Ok(triangles)
}

/// The color of sRGB channels that are 0..=1.
fn color_of(channels: [f64; 3]) -> Color {
    Color::from_srgb(channels.map(|channel| (channel as f32).clamp(0.0, 1.0)))
}

/// The vertex of `7`, `7/1` or `7//2`, counted from 1, or of `-1`, counted back from the last.
fn index(word: &str, count: usize) -> Option<u32> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    let index = if number < 0 { count as i64 + number } else { number - 1 };
    u32::try_from(index).ok().filter(|&index| (index as usize) < count)
}
