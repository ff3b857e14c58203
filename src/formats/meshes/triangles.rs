//! Triangles as files of meshes hold them, and polygons taken apart into them.

use std::path::PathBuf;

use glam::{DVec2, DVec3};

use super::super::stream::room;
use super::pictures::MeshPicture;
use crate::components::{Color, Space};

/// What a file states at the corners of its triangles, such as normals; empty where it states none.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct AtCorners<T> {
    /// The values, in the file's order.
    pub values: Vec<T>,
    /// Three indices into `values` for each triangle, beyond them where it states none; without any, those of its vertices.
    pub faces: Vec<[u32; 3]>,
}

impl<T: Copy> AtCorners<T> {
    /// What is stated at the corners of triangle number `at`, whose vertices are `face`; `None` where one lacks it.
    #[must_use]
    pub(crate) fn of(&self, at: usize, face: [u32; 3]) -> Option<[T; 3]> {
        let own = self.faces.get(at).copied().unwrap_or(face);
        let [a, b, c] = own.map(|index| self.values.get(index as usize).copied());
        Some([a?, b?, c?])
    }

    /// Leaves out which triangles have which values where there are no values.
    pub(crate) fn tidy(&mut self) {
        if self.values.is_empty() {
            self.faces = Vec::new();
        }
    }
}

/// Triangles of a file, in its own coordinates.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Triangles {
    /// Points, in the file's order.
    pub vertices: Vec<DVec3>,
    /// The color of each vertex; empty where the file states none.
    pub colors: Vec<Color>,
    /// Three indices into `vertices` each, counter-clockwise seen from outside where the file keeps to that.
    pub faces: Vec<[u32; 3]>,
    /// The color of each triangle, where vertices have none; empty where the file states none.
    pub face_colors: Vec<Color>,
    /// How opaque the material of each triangle is, 0..=1; empty where all are opaque.
    pub opacities: Vec<f32>,
    /// Normals at their corners, of any length.
    pub normals: AtCorners<DVec3>,
    /// Where their corners lie in a texture: (0, 0) is its top left corner and (1, 1) its bottom right one.
    pub places: AtCorners<DVec2>,
    /// The pictures that its materials lay on triangles, times their colors.
    pub pictures: Vec<MeshPicture>,
    /// The number of the picture on each triangle, beyond them for none; empty where there are none.
    pub pictured: Vec<u32>,
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
    /// The color of triangle number `at`: the mean of its corners', in linear light, else its own; `None` where neither is stated.
    #[must_use]
    pub(crate) fn color(&self, at: usize) -> Option<Color> {
        if self.colors.is_empty() {
            return self.face_colors.get(at).copied();
        }
        let corners = self.faces.get(at)?;
        let [a, b, c] = corners.map(|at| self.colors.get(at as usize).map(|color| color.0));
        Some(Color((a? + b? + c?) / 3.0))
    }

    /// The number of the picture on triangle number `at`, if there is one.
    #[must_use]
    pub(crate) fn picture(&self, at: usize) -> Option<u32> {
        self.pictured.get(at).copied().filter(|&number| (number as usize) < self.pictures.len())
    }
}

/// A place in a texture of a file in which v runs up.
pub(crate) fn place_upward(u: f64, v: f64) -> DVec2 {
    DVec2::new(u, 1.0 - v)
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
