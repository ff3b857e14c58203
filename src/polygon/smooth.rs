//! Normals at the corners of triangles: those of the curved surface that the triangles stand for.

use glam::{DAffine3, DMat3, DVec3};

use super::face::Face;
use super::welded::welded;
use crate::shared::Shared;

/// Triangles around one point of which each is held against each: a point with more is the tip of something, not of a surface.
const MOST_AROUND: usize = 64;

/// Unit normals at the corners of each face of one entity, in the order of its faces; three alike on a face that stays flat.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CornerNormals(pub Shared<[DVec3; 3]>);

/// Unit normals at the corners of each face of one entity that its file states; no numbers on a face of which it states none.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StatedNormals(pub Shared<[DVec3; 3]>);

impl CornerNormals {
    /// The normals that a file states, and where it states none those [`of`](Self::of) the triangles.
    #[must_use]
    pub fn stated(stated: &StatedNormals, faces: &[Face], crease: f64) -> Self {
        let is_whole = |three: &&[DVec3; 3]| three.iter().all(|normal| normal.is_finite());
        if stated.0.len() == faces.len() && stated.0.iter().all(|three| is_whole(&three)) {
            return Self(stated.0.clone());
        }
        let made = Self::of(faces, crease);
        let own = |at: usize| stated.0.get(at).filter(is_whole).unwrap_or(&made.0[at]);
        Self(Shared::new((0..faces.len()).map(|at| *own(at)).collect()))
    }

    /// The normals of triangles that meet at angles of at most `crease` (radians) are joined, each weighed by its angle at the
    /// corner. Faces that are no triangles stay flat, and so does one whose neighbors run the other way around.
    #[must_use]
    pub fn of(faces: &[Face], crease: f64) -> Self {
        let corners: Vec<_> = faces.iter().map(Face::triangle).collect();
        let own = |at: usize| corners[at].unwrap_or([faces[at].center; 3]);
        let (numbers, count) = welded((0..faces.len()).flat_map(own));
        let mut around = vec![Vec::new(); count];
        for (corner, &number) in numbers.iter().enumerate() {
            around[number as usize].push((corner / 3) as u32);
        }
        let least = libm::cos(crease) - 1e-12;
        let joined = |at: usize, corner: usize| {
            let flat = faces[at].normal;
            let point = own(at)[corner];
            let around = &around[numbers[3 * at + corner] as usize];
            if corners[at].is_none() || around.len() > MOST_AROUND {
                return flat;
            }
            let near = around.iter().map(|&other| other as usize).filter(|&other| {
                corners[other].is_some() && faces[other].normal.dot(flat) >= least
            });
            let sum: DVec3 = near.map(|other| faces[other].normal * angle(own(other), point)).sum();
            sum.try_normalize().unwrap_or(flat)
        };
        let normals = (0..faces.len()).map(|at| [0, 1, 2].map(|corner| joined(at, corner)));
        Self(Shared::new(normals.collect()))
    }

    /// Where on face number `at` which way its normal points: an affine map of world points of the face to vectors along the
    /// normal. `None` where the face is flat.
    #[must_use]
    pub fn over(&self, at: usize, face: &Face) -> Option<DAffine3> {
        let normals = self.0.get(at)?;
        if normals.iter().all(|normal| normal == &face.normal) {
            return None;
        }
        let [a, b, c] = face.triangle()?;
        // The point a + s (b − a) + t (c − a) has the normal n_a + s (n_b − n_a) + t (n_c − n_a).
        let from = DMat3::from_cols(b - a, c - a, face.normal);
        if from.determinant() == 0.0 {
            return None;
        }
        let to = DMat3::from_cols(normals[1] - normals[0], normals[2] - normals[0], DVec3::ZERO);
        let matrix3 = to * from.inverse();
        Some(DAffine3 { matrix3, translation: normals[0] - matrix3 * a })
    }
}

/// The angle of a triangle at the corner that is there, radians.
fn angle(corners: [DVec3; 3], point: DVec3) -> f64 {
    let at = corners.iter().position(|&corner| corner == point).unwrap_or(0);
    let (b, c) = (corners[(at + 1) % 3] - point, corners[(at + 2) % 3] - point);
    libm::atan2(b.cross(c).length(), b.dot(c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::components::Ellipsoid;
    use crate::polygon::shape::ellipsoid;

    fn ball() -> Vec<Face> {
        let shape =
            Ellipsoid { center: [5.0, 0.0, 0.0], radii: [2.0; 3], subdivisions: 3, lumpiness: 0.0 };
        ellipsoid(&shape).into_iter().map(|outline| Face::new(vec![outline]).unwrap()).collect()
    }

    #[test]
    fn the_normals_of_a_ball_are_those_of_a_sphere_at_corners_and_between() {
        let faces = ball();
        let smooth = CornerNormals::of(&faces, 1.0);
        let (mut worst, mut flat) = (0.0_f64, 0.0_f64);
        for (at, face) in faces.iter().enumerate() {
            let normal = smooth.over(at, face).unwrap();
            let [a, b, c] = face.triangle().unwrap();
            for point in [a, b, (a + b) / 2.0, (a + b + c) / 3.0] {
                let true_normal = (point - DVec3::new(5.0, 0.0, 0.0)).normalize();
                let found = normal.transform_point3(point).normalize();
                worst = worst.max(found.angle_between(true_normal).to_degrees());
                flat = flat.max(face.normal.angle_between(true_normal).to_degrees());
            }
        }
        assert!(worst < 0.4 && flat > 4.0, "{worst} {flat}");
    }

    #[test]
    fn normals_that_are_stated_take_the_place_of_those_of_triangles_where_they_are_numbers() {
        let faces = ball();
        let mut stated = vec![[DVec3::X, DVec3::Y, DVec3::Z]; faces.len()];
        let normals = |stated: &[[DVec3; 3]]| {
            CornerNormals::stated(&StatedNormals(Shared::new(stated.to_vec())), &faces, 1.0).0
        };
        assert_eq!(normals(&stated)[7], stated[7]);
        stated[7][1] = DVec3::NAN;
        let made = CornerNormals::of(&faces, 1.0).0;
        let mixed = normals(&stated);
        assert_eq!((mixed[7], mixed[8]), (made[7], stated[8]));
    }

    #[test]
    fn edges_sharper_than_the_crease_stay_and_the_rest_is_joined() {
        let o = DVec3::ZERO;
        let triangle = |a, b, c| Face::new(vec![vec![a, b, c]]).unwrap();
        let faces = [triangle(o, DVec3::X, DVec3::Y), triangle(o, DVec3::Z, DVec3::X)];
        let sharp = CornerNormals::of(&faces, 1.5);
        assert!(sharp.over(0, &faces[0]).is_none());
        let round = CornerNormals::of(&faces, 1.6);
        let normal = round.over(0, &faces[0]).unwrap();
        let edge = normal.transform_point3(DVec3::X / 2.0);
        assert!(edge.abs_diff_eq(DVec3::new(0.0, 0.5, 0.5).normalize() * edge.length(), 1e-12));
        assert!(normal.transform_point3(DVec3::Y).abs_diff_eq(DVec3::Z, 1e-12));
    }

    #[test]
    fn a_point_with_very_many_triangles_takes_no_time_that_grows_with_their_square() {
        let rim =
            |n: u32| DVec3::new(libm::cos(f64::from(n) / 1e4), libm::sin(f64::from(n) / 1e4), 1.0);
        let fan: Vec<_> = (0..50_000)
            .filter_map(|n| Face::new(vec![vec![DVec3::ZERO, rim(n), rim(n + 1)]]).ok())
            .collect();
        let normals = CornerNormals::of(&fan, 1.0);
        assert_eq!(normals.0.len(), fan.len());
    }
}
