//! What triangles enclose: whether they have an inside, how large it is, and which way they face.

use std::collections::HashMap;

use glam::DVec3;

use super::welded::welded;

/// What a mesh of triangles encloses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Enclosed {
    /// Points that differ.
    pub points: usize,
    /// Edges of one triangle alone: the rims of holes.
    pub open: usize,
    /// Edges of more than two triangles.
    pub shared: usize,
    /// Edges of two triangles that run the same way along it: one of them faces the wrong way.
    pub turned: usize,
    /// The area of all triangles, squared units.
    pub area: f64,
    /// The volume inside, cubed units: below 0 where the triangles face inward. It means something only where
    /// [`is_closed`](Self::is_closed).
    pub volume: f64,
}

impl Enclosed {
    /// What triangles of these vertices enclose; those that are the same point to the bit count as one.
    #[must_use]
    pub fn by(vertices: &[DVec3], faces: &[[u32; 3]]) -> Self {
        let (numbers, points) = welded(vertices.iter().copied());
        // For each edge, from its lower point: how many triangles run up it and how many down.
        let mut edges: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
        let (mut area, mut six_volumes) = (0.0, 0.0);
        let middle = vertices.iter().sum::<DVec3>() / vertices.len().max(1) as f64;
        for face in faces {
            let [a, b, c] = face.map(|at| vertices[at as usize] - middle);
            area += (b - a).cross(c - a).length() / 2.0;
            six_volumes += a.dot(b.cross(c));
            let [a, b, c] = face.map(|at| numbers[at as usize]);
            // A triangle of two points has no edges that anything hangs on.
            if a == b || b == c || c == a {
                continue;
            }
            for (from, to) in [(a, b), (b, c), (c, a)] {
                edges.entry([from.min(to), from.max(to)]).or_default()[usize::from(from > to)] += 1;
            }
        }
        let count = |of: fn(&[u32; 2]) -> bool| edges.values().filter(|ways| of(ways)).count();
        Self {
            points,
            open: count(|[up, down]| up + down == 1),
            shared: count(|[up, down]| up + down > 2),
            turned: count(|ways| matches!(ways, [2, 0] | [0, 2])),
            area,
            volume: six_volumes / 6.0,
        }
    }

    /// Whether every edge is one of two triangles that face the same side: then there is an inside and an outside.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.open == 0 && self.shared == 0 && self.turned == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box of sides 1, 2 and 3, far from the origin, every triangle with points of its own.
    fn box_of_triangles() -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let corner = |n: usize| {
            DVec3::new((n & 1) as f64, (n >> 1 & 1) as f64 * 2.0, (n >> 2 & 1) as f64 * 3.0) + 1e5
        };
        let sides =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let halves = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let vertices: Vec<_> = halves.flatten().map(corner).collect();
        let faces = (0..vertices.len() as u32 / 3).map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect();
        (vertices, faces)
    }

    #[test]
    fn a_box_is_closed_and_its_area_and_volume_are_those_of_a_box() {
        let (vertices, mut faces) = box_of_triangles();
        let whole = Enclosed::by(&vertices, &faces);
        assert!(whole.is_closed() && whole.points == 8);
        assert!((whole.area - 22.0).abs() < 1e-9 && (whole.volume - 6.0).abs() < 1e-9);
        for face in &mut faces {
            face.reverse();
        }
        let inward = Enclosed::by(&vertices, &faces);
        assert!(inward.is_closed() && (inward.volume + 6.0).abs() < 1e-9);
    }

    #[test]
    fn a_hole_a_flap_and_a_triangle_that_faces_the_wrong_way_are_counted() {
        let (vertices, faces) = box_of_triangles();
        let hole = Enclosed::by(&vertices, &faces[1..]);
        assert!(!hole.is_closed() && hole.open == 3);
        let twice = Enclosed::by(&vertices, &[&faces[..], &faces[..1]].concat());
        assert!(!twice.is_closed() && twice.shared == 3);
        let mut turned = faces.clone();
        turned[0].reverse();
        assert_eq!(
            (Enclosed::by(&vertices, &turned).turned, Enclosed::by(&vertices, &[]).points),
            (3, 8)
        );
    }
}
