//! Flat polygons in the world, checked: a plane, an outline and holes (algorithm §4).

use std::sync::Arc;

use glam::DVec3;

use super::outline::{Rings, edges};
use super::simple;
use crate::components::Color;
use crate::shared::Shared;
use crate::view::extent::Extent;

/// How far a vertex may lie from the plane of its polygon, as a part of the polygon's extent.
const OUT_OF_PLANE: f64 = 1e-4;

/// A planar polygon, simple, convex or concave, with any number of holes. World coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Face {
    /// Unit normal, to the side from which the outline runs counter-clockwise.
    pub normal: DVec3,
    /// The mean of the outline's vertices: a point of the plane.
    pub center: DVec3,
    /// The outline first, then the holes; each at least three vertices.
    pub outlines: Rings<DVec3>,
}

/// The faces of one entity, in the order stated; shared by pointer, equality is identity.
#[derive(Debug, Clone)]
pub struct Faces(pub Arc<Vec<Face>>);

impl PartialEq for Faces {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// A color for each of the faces of one entity, in place of their surface's.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FaceColors(pub Shared<Color>);

impl FaceColors {
    /// The color of face number `at`, if it has one.
    #[must_use]
    pub fn of(colors: Option<&Self>, at: usize) -> Option<Color> {
        colors.and_then(|colors| colors.0.get(at).copied())
    }

    /// What no channel of any of them is above; at least 0.
    #[must_use]
    pub fn brightest(&self) -> f32 {
        self.0.iter().fold(0.0, |most, color| most.max(color.0.max_element()))
    }
}

/// For each of the faces of one entity the part of their surface's opacity that it has, 0..=1.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FaceOpacities(pub Shared<f32>);

impl FaceOpacities {
    /// The part that face number `at` has: all of it where none is stated.
    #[must_use]
    #[inline]
    pub fn of(opacities: Option<&Self>, at: usize) -> f32 {
        opacities.and_then(|opacities| opacities.0.get(at).copied()).unwrap_or(1.0)
    }
}

impl Faces {
    /// Bytes that the polygons take.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.0.iter().map(Face::bytes).sum::<usize>() as u64
    }

    /// The middle of the bounding box of all vertices; `None` for no faces.
    #[must_use]
    pub fn middle(&self) -> Option<DVec3> {
        Extent::of(self.0.iter().flat_map(|face| face.outlines.vertices()))
            .map(|extent| extent.center())
    }
}

impl Face {
    /// Bytes that it takes, with its outlines.
    fn bytes(&self) -> usize {
        size_of::<Self>() + self.outlines.bytes_beside()
    }

    /// A polygon with its holes, checked: at least three vertices an outline, finite, of some area, in one plane, and simple.
    ///
    /// The error is a sentence without a subject, for the caller to put the entity's name before it.
    pub fn new(outlines: Vec<Vec<DVec3>>) -> Result<Self, String> {
        let Some(outline) = outlines.first() else {
            return Err("a polygon without an outline; state at least 3 vertices".to_owned());
        };
        if let Some(short) = outlines.iter().find(|o| o.len() < 3) {
            return Err(format!(
                "an outline of {} vertices encloses nothing; a polygon needs at least 3",
                short.len()
            ));
        }
        if outlines.iter().flatten().any(|v| !v.is_finite()) {
            return Err("a vertex is not finite; state numbers of the world's units".to_owned());
        }
        let center = outline.iter().sum::<DVec3>() / outline.len() as f64;
        let extent = outlines.iter().flatten().map(|v| v.distance(center)).fold(0.0, f64::max);
        let normal = doubled_area(outline, center);
        if normal.length() <= 1e-12 * extent * extent || extent == 0.0 {
            let problem = if on_one_line(outline, center) {
                "its vertices lie on one line; a polygon needs an area"
            } else {
                "its outline crosses itself, and what it encloses cancels out; split it where it crosses"
            };
            return Err(problem.to_owned());
        }
        let normal = normal.normalize();
        let out = |v: &&DVec3| normal.dot(**v - center).abs() > OUT_OF_PLANE * extent;
        if let Some(vertex) = outlines.iter().flatten().find(out) {
            return Err(format!(
                "vertex [{}, {}, {}] is {:.3e} out of the polygon's plane, more than 1e-4 of its extent; split it into triangles",
                vertex.x,
                vertex.y,
                vertex.z,
                normal.dot(*vertex - center).abs()
            ));
        }
        simple::check(&outlines, normal)?;
        Ok(Self { normal, center, outlines: outlines.into() })
    }

    /// The corners of a triangle without holes, in the order stated; `None` of any other polygon.
    #[must_use]
    pub(crate) fn triangle(&self) -> Option<[DVec3; 3]> {
        match &self.outlines {
            Rings::Triangle(corners) => Some(*corners),
            Rings::Many(_) => None,
        }
    }
}

/// Whether all vertices lie on the line through their mean and the vertex farthest from it.
fn on_one_line(outline: &[DVec3], center: DVec3) -> bool {
    let far = |a: &DVec3, b: &DVec3| a.length_squared().total_cmp(&b.length_squared());
    let from = || outline.iter().map(|vertex| *vertex - center);
    let along = from().max_by(far).unwrap_or_default();
    from().all(|v| along.cross(v).length() <= 1e-12 * along.length_squared())
}

/// Newell's sum: a vector along the normal, as long as twice the area of the outline.
fn doubled_area(outline: &[DVec3], center: DVec3) -> DVec3 {
    edges(outline).map(|(p, q)| (p - center).cross(q - center)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(z: f64) -> Vec<DVec3> {
        [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(x, y)| DVec3::new(x, y, z)).to_vec()
    }

    #[test]
    fn a_normal_points_to_the_side_that_sees_the_outline_run_counter_clockwise() {
        assert_eq!(Face::new(vec![square(3.0)]).unwrap().normal, DVec3::Z);
    }

    #[test]
    fn two_vertices_a_line_and_a_bent_square_are_refused_with_a_remedy() {
        let line = (0..4).map(|i| DVec3::splat(f64::from(i))).collect();
        let mut bent = square(0.0);
        bent[2].z = 0.1;
        assert!(Face::new(vec![square(0.0)[..2].to_vec()]).unwrap_err().contains("at least 3"));
        assert!(Face::new(vec![line]).unwrap_err().contains("area"));
        assert!(Face::new(vec![bent]).unwrap_err().contains("triangles"));
        let mut bow = square(0.0);
        bow.swap(1, 2);
        assert!(Face::new(vec![bow]).unwrap_err().contains("crosses itself"));
    }
}
