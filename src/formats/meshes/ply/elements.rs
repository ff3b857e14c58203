//! The vertices and faces of a PLY: which of their properties are read, and what they become.

use glam::DVec3;

use super::super::triangles::{Triangles, add_fan, place_upward};
use super::header::Element;
use crate::components::Color;

/// Which properties of a vertex are read.
pub(super) struct Vertex {
    place: [usize; 3],
    /// Red, green and blue, and what each is at its full intensity.
    channels: Option<[(usize, f64); 3]>,
    normal: Option<[usize; 3]>,
    texture: Option<[usize; 2]>,
}

impl Vertex {
    /// Those of a kind of elements; `None` where that is none of vertices.
    pub fn of(element: &Element) -> Option<Self> {
        let all = |[a, b, c]: [&str; 3]| Some([element.at(a)?, element.at(b)?, element.at(c)?]);
        let names = [["s", "t"], ["u", "v"], ["texture_u", "texture_v"]];
        let white = |at: usize| (at, element.properties[at].kind.white());
        let is_vertex = element.name == "vertex";
        Some(Self {
            place: all(["x", "y", "z"]).filter(|_| is_vertex)?,
            channels: all(["red", "green", "blue"]).map(|three| three.map(white)),
            normal: all(["nx", "ny", "nz"]),
            texture: names.into_iter().find_map(|[u, v]| Some([element.at(u)?, element.at(v)?])),
        })
    }

    /// Adds a vertex of these values of its properties.
    pub fn add(&self, row: &[Vec<f64>], triangles: &mut Triangles) {
        let number = |at: usize| row[at].first().copied().unwrap_or(f64::NAN);
        let three = |at: [usize; 3]| DVec3::from(at.map(number));
        triangles.vertices.push(three(self.place));
        let channel = |(at, white): (usize, f64)| ((number(at) / white) as f32).clamp(0.0, 1.0);
        let color = |channels: [_; 3]| Color::from_srgb(channels.map(channel));
        triangles.colors.extend(self.channels.map(color));
        triangles.normals.values.extend(self.normal.map(three));
        let place = |[u, v]: [usize; 2]| place_upward(number(u), number(v));
        triangles.places.values.extend(self.texture.map(place));
    }
}

/// Which properties of a face are read.
pub(super) struct Polygon {
    corners: usize,
    /// Its corners' places in a texture: u and v of each.
    texture: Option<usize>,
}

impl Polygon {
    /// Those of a kind of elements; `None` where that is none of faces.
    pub fn of(element: &Element) -> Option<Self> {
        let corners = element.at("vertex_indices").or(element.at("vertex_index"));
        let corners = corners.filter(|_| element.name == "face")?;
        Some(Self { corners, texture: element.at("texcoord") })
    }

    /// Whether places in a texture are those of faces' corners, and not of vertices.
    pub fn has_places(&self) -> bool {
        self.texture.is_some()
    }

    /// Adds a face of these values of its properties, and how many corners it has.
    pub fn add(&self, row: &[Vec<f64>], triangles: &mut Triangles) -> Result<usize, String> {
        let polygon: Option<Vec<u32>> =
            row[self.corners].iter().map(|&value| index(value)).collect();
        let polygon =
            polygon.ok_or("a face names a vertex by no whole number; fetch the file again")?;
        add_fan(&mut triangles.faces, &polygon);
        if let Some(at) = self.texture {
            let places = &mut triangles.places;
            let first = places.values.len() as u32;
            let given = row[at].len() == 2 * polygon.len();
            let place = |corner: u32| if given { first + corner } else { u32::MAX };
            let corners: Vec<u32> = (0..polygon.len() as u32).map(place).collect();
            add_fan(&mut places.faces, &corners);
            if given {
                places.values.extend(row[at].chunks_exact(2).map(|uv| place_upward(uv[0], uv[1])));
            }
        }
        Ok(polygon.len())
    }
}

fn index(value: f64) -> Option<u32> {
    ((0.0..=f64::from(u32::MAX)).contains(&value) && value.fract() == 0.0).then_some(value as u32)
}
