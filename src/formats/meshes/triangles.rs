//! Triangles as files of meshes hold them, and polygons taken apart into them.

use std::path::PathBuf;

use glam::DVec3;

use super::super::stream::room;
use crate::components::{Color, Space};

/// Triangles of a file, in its own coordinates.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Triangles {
    /// Points, in the file's order.
    pub vertices: Vec<DVec3>,
    /// The color of each vertex; empty where the file states none.
    pub colors: Vec<Color>,
    /// Three indices into `vertices` each, counter-clockwise seen from outside where the file keeps to that.
    pub faces: Vec<[u32; 3]>,
    /// Which way its axes run, where its format says so.
    pub space: Option<Space>,
    /// World units (mm) in one of its units, where its format says so.
    pub unit_mm: Option<f64>,
    /// Other files that it names and that were read.
    pub beside: Vec<PathBuf>,
    /// Sentences about what was left out or taken apart.
    pub warnings: Vec<String>,
}

impl Triangles {
    /// The color of a triangle: the mean of its corners', in linear light; `None` where vertices have none.
    #[must_use]
    pub(crate) fn color(&self, face: [u32; 3]) -> Option<Color> {
        let [a, b, c] = face.map(|at| self.colors.get(at as usize).map(|color| color.0));
        Some(Color((a? + b? + c?) / 3.0))
    }
}

/// Adds a polygon as a fan of triangles around its first vertex.
pub(crate) fn add_fan(faces: &mut Vec<[u32; 3]>, polygon: &[u32]) {
    let Some((&first, rest)) = polygon.split_first() else { return };
    faces.extend(rest.windows(2).map(|pair| [first, pair[0], pair[1]]));
}

/// Adds a strip: each triangle of three corners in a row, every second one turned over.
pub(crate) fn add_strip(faces: &mut Vec<[u32; 3]>, corners: &[u32]) {
    let turned = |(at, three): (usize, &[u32])| match at % 2 {
        0 => [three[0], three[1], three[2]],
        _ => [three[1], three[0], three[2]],
    };
    faces.extend(corners.windows(3).enumerate().map(turned));
}

/// The sentence about polygons of more than three corners, if there were any.
pub(crate) fn fans(polygons: usize) -> Option<String> {
    (polygons > 0).then(|| {
        format!("{polygons} of its polygons have more than 3 corners and are split into triangles from their first")
    })
}

/// Room for so many values more, which the file has bytes for.
pub(crate) fn reserve<T>(values: &mut Vec<T>, count: usize) -> Result<(), String> {
    room(values, count)
}
