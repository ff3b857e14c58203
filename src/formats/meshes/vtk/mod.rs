//! VTK's older files (`.vtk`) of PolyData, text or binary, to version 5.1: their points, polygons and strips, and of points
//! their colors, normals and places in a texture.

mod attributes;
mod legacy;

use std::path::Path;

use glam::DVec3;

use super::triangles::{Triangles, add_fan, add_strip, fans, reserve};
use crate::formats::number::NumberType;
use attributes::Attributes;
use legacy::{Legacy, truncated};

/// Reads the points and what joins them, and then what is said of points.
pub(super) fn read(bytes: &[u8], _: &Path) -> Result<Triangles, String> {
    let mut lines = bytes.splitn(4, |&byte| byte == b'\n');
    if !lines.next().is_some_and(|line| line.starts_with(b"# vtk DataFile")) {
        return Err(
            "does not begin with `# vtk DataFile`; check that it is what its name says".to_owned()
        );
    }
    let text = match lines.nth(1).map(<[u8]>::trim_ascii) {
        Some(b"ASCII") => true,
        Some(b"BINARY") => false,
        _ => return Err("its third line is neither ASCII nor BINARY; save it again".to_owned()),
    };
    let mut file = Legacy { bytes: lines.next().unwrap_or_default(), text };
    if file.word() != "DATASET" || file.word() != "POLYDATA" {
        return Err("is no PolyData; save its surface as one".to_owned());
    }
    let mut triangles = Triangles::default();
    let mut attributes = Attributes::default();
    let mut split = 0;
    loop {
        match file.word().as_str() {
            "POINTS" => add_points(&mut triangles, &mut file)?,
            "POLYGONS" => {
                for corners in file.cells()? {
                    split += usize::from(corners.len() > 3);
                    add_fan(&mut triangles.faces, &corners);
                }
            }
            "TRIANGLE_STRIPS" => {
                file.cells()?.iter().for_each(|corners| add_strip(&mut triangles.faces, corners));
            }
            "VERTICES" | "LINES" => drop(file.cells()?),
            "METADATA" => file.skip_paragraph(),
            "" => break,
            first @ ("POINT_DATA" | "CELL_DATA") => {
                // The surface is whole without.
                if let Err(problem) = attributes.add(first, &mut file) {
                    let what = format!("what follows of its points is left out: it {problem}");
                    triangles.warnings.push(what);
                }
                break;
            }
            other => {
                return Err(format!(
                    "has `{other}` where points or polygons are expected; save it again"
                ));
            }
        }
    }
    triangles.warnings.extend(fans(split));
    let Attributes { colors, normals, places } = attributes;
    triangles.colors = colors;
    triangles.normals.values = normals;
    triangles.places.values = places;
    Ok(triangles)
}

fn add_points(triangles: &mut Triangles, file: &mut Legacy) -> Result<(), String> {
    let count = file.count()?;
    let kind = NumberType::named(&file.word())?;
    let points = file.numbers(kind, count.checked_mul(3).ok_or_else(truncated)?)?;
    reserve(&mut triangles.vertices, count)?;
    triangles.vertices.extend(points.chunks_exact(3).map(|p| DVec3::new(p[0], p[1], p[2])));
    Ok(())
}
