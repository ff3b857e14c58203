//! PLY, text and binary of either byte order: the vertices, their colors, normals and places in a texture, and the faces of a
//! file, whatever else it holds.

mod elements;
mod header;
mod source;

use std::path::Path;

use super::triangles::{Triangles, fans};
use elements::{Polygon, Vertex};
use header::header;
use source::{Source, truncated};

/// Reads the vertices' x, y and z, their red, green and blue (sRGB), their normals and places in a texture, and the faces'
/// lists of vertices, and of places in a texture, which go before those of vertices.
pub(super) fn read(bytes: &[u8], _: &Path) -> Result<Triangles, String> {
    let (writing, elements, body) = header(bytes)?;
    let mut source = Source { writing, bytes: body };
    let mut triangles = Triangles::default();
    let mut polygons = 0;
    for element in &elements {
        let (vertex, polygon) = (Vertex::of(element), Polygon::of(element));
        if polygon.as_ref().is_some_and(Polygon::has_places) {
            triangles.places.values.clear();
        }
        // An element has a byte at least, unless it has no property at all.
        if element.count > source.bytes.len() {
            return Err(truncated());
        }
        let mut row = vec![Vec::new(); element.properties.len()];
        for _ in 0..element.count {
            for (property, values) in element.properties.iter().zip(&mut row) {
                source.values(property, values)?;
            }
            if let Some(vertex) = &vertex {
                vertex.add(&row, &mut triangles);
            }
            if let Some(polygon) = &polygon {
                polygons += usize::from(polygon.add(&row, &mut triangles)? > 3);
            }
        }
    }
    triangles.warnings.extend(fans(polygons));
    triangles.places.tidy();
    Ok(triangles)
}
