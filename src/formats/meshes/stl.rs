//! STL, binary and text: triangles without an order of their vertices in common.

use std::path::Path;

use glam::DVec3;

use super::triangles::{Triangles, reserve};

/// Bytes before the triangles of a binary file: a comment and their number.
const HEADER: usize = 84;
/// Bytes of a triangle: its normal, which is not read, three vertices and two bytes of anything.
const TRIANGLE: usize = 50;

/// Reads a file: binary where it is as long as its number of triangles says, else text where it begins so.
pub(super) fn read(bytes: &[u8], _: &Path) -> Result<Triangles, String> {
    let count = bytes.get(80..HEADER).and_then(<[u8]>::first_chunk).copied();
    let count = count.map_or(0, u32::from_le_bytes) as usize;
    let needed = HEADER + count * TRIANGLE;
    let text = bytes.trim_ascii_start().starts_with(b"solid");
    if text && bytes.len() != needed {
        return read_text(bytes);
    }
    if bytes.len() < needed.max(HEADER) {
        return Err(format!(
            "is truncated: {count} triangles need {needed} bytes and {} were found; fetch the file again",
            bytes.len()
        ));
    }
    let mut triangles = Triangles::default();
    reserve(&mut triangles.vertices, 3 * count)?;
    for triangle in bytes[HEADER..needed].chunks_exact(TRIANGLE) {
        let corners = triangle[12..48].chunks_exact(12).map(|corner| {
            let number = |at: usize| {
                let four = corner[at..].first_chunk().copied().unwrap_or_default();
                f64::from(f32::from_le_bytes(four))
            };
            DVec3::new(number(0), number(4), number(8))
        });
        add(&mut triangles, corners);
    }
    if bytes.len() > needed {
        let left = bytes.len() - needed;
        triangles.warnings.push(format!("{left} bytes follow the last triangle and are not used"));
    }
    Ok(triangles)
}

fn add(triangles: &mut Triangles, corners: impl Iterator<Item = DVec3>) {
    let first = triangles.vertices.len() as u32;
    triangles.vertices.extend(corners);
    triangles.faces.push([first, first + 1, first + 2]);
}

/// Lines `vertex x y z`, three to a triangle; the others only frame them.
fn read_text(bytes: &[u8]) -> Result<Triangles, String> {
    let mut triangles = Triangles::default();
    let mut corners = Vec::new();
    for (at, line) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let line = String::from_utf8_lossy(line);
        let mut words = line.split_whitespace();
        match words.next() {
            Some("vertex") => {
                let numbers: Option<Vec<f64>> = words.map(|word| word.parse().ok()).collect();
                let three = numbers.and_then(|numbers| numbers.try_into().ok());
                let three: [f64; 3] = three.ok_or_else(|| {
                    format!("line {} is no vertex of three numbers; fetch the file again", at + 1)
                })?;
                corners.push(DVec3::from(three));
            }
            Some("endfacet") if corners.len() == 3 => add(&mut triangles, corners.drain(..)),
            Some("endfacet") => {
                return Err(format!(
                    "line {} ends a facet of {} vertices, and 3 are expected; fetch the file again",
                    at + 1,
                    corners.len()
                ));
            }
            _ => {}
        }
    }
    if corners.is_empty() {
        Ok(triangles)
    } else {
        Err("ends within a facet; fetch the file again".to_owned())
    }
}
