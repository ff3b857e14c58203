//! Polygons and meshes from arrays in memory.

use std::sync::Arc;

use glam::DVec3;

use crate::error::Error;
use crate::polygon::face::{Face, Faces};

/// One planar polygon from its outline, in world units, either way round; convex or concave.
///
/// For holes, state a [`Polygon`](crate::components::Polygon) instead.
pub fn polygon(vertices: &[[f64; 3]]) -> Result<Faces, Error> {
    let outline = vertices.iter().copied().map(DVec3::from).collect();
    let face = Face::new(vec![outline]).map_err(|problem| Error::input("polygon", problem))?;
    Ok(Faces(Arc::new(vec![face])))
}

/// A mesh from vertices, in world units, and triangles, three indices from 0 each.
///
/// Triangles of no area, as tools leave them, show nothing and are left out.
pub fn triangles(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Faces, Error> {
    let wrong = |problem| Error::input("triangles", problem);
    if let Some(at) = vertices.iter().position(|vertex| !vertex.iter().all(|x| x.is_finite())) {
        return Err(wrong(format!(
            "vertex {at} is {:?}; vertices are finite, state numbers of the world's units",
            vertices[at]
        )));
    }
    let mut faces = Vec::with_capacity(triangles.len());
    for (at, triangle) in triangles.iter().enumerate() {
        if let Some(index) = triangle.iter().find(|&&index| index as usize >= vertices.len()) {
            return Err(wrong(format!(
                "triangle {at} names vertex {index}, and there are {}, counted from 0; correct the index",
                vertices.len()
            )));
        }
        let outline = triangle.map(|index| DVec3::from(vertices[index as usize])).to_vec();
        // Three finite points lie in a plane: all that is left to be wrong is that they span none.
        faces.extend(Face::new(vec![outline]));
    }
    Ok(Faces(Arc::new(faces)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 3]; 4] =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    #[test]
    fn triangles_share_vertices_and_those_without_area_are_left_out() {
        let faces = triangles(&CORNERS, &[[0, 1, 2], [0, 1, 1], [0, 1, 3]]).unwrap();
        assert_eq!(faces.0.len(), 2);
        assert_eq!(faces.0[0].normal, DVec3::Z);
    }

    #[test]
    fn indices_and_vertices_that_do_not_do_are_refused_with_a_sentence() {
        let refused = |vertices: &[[f64; 3]], indices| match triangles(vertices, indices) {
            Err(Error::Input { what: "triangles", problem }) => problem,
            other => panic!("{other:?}"),
        };
        let problem = refused(&CORNERS, &[[0, 1, 2], [0, 4, 1]]);
        assert!(problem.contains("triangle 1 names vertex 4, and there are 4"), "{problem}");
        let endless = [[0.0; 3], [f64::NAN, 0.0, 0.0]];
        assert!(refused(&endless, &[]).contains("vertex 1"));
        let line = polygon(&[[0.0; 3], [1.0; 3], [2.0; 3]]);
        assert!(matches!(line, Err(Error::Input { what: "polygon", .. })), "{line:?}");
    }
}
