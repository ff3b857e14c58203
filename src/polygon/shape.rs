//! Shapes made of flat faces by formula: a lumpy ellipsoid (a tumour) and a prism (a beam of radiation).

use std::collections::BTreeMap;

use glam::DVec3;

use crate::components::{Ellipsoid, Prism};

/// The triangles of an ellipsoid, `20 · 4^subdivisions`, counter-clockwise seen from outside; shared edges share their bits.
pub fn ellipsoid(shape: &Ellipsoid) -> Vec<Vec<DVec3>> {
    let (mut directions, mut triangles) = icosahedron();
    for _ in 0..shape.subdivisions {
        triangles = subdivide(&mut directions, &triangles);
    }
    let (center, radii) = (DVec3::from(shape.center), DVec3::from(shape.radii));
    let points: Vec<_> = directions
        .iter()
        .map(|&d| center + radii * d * (1.0 + shape.lumpiness * lump(d)))
        .collect();
    triangles.iter().map(|t| t.map(|i| points[i]).to_vec()).collect()
}

/// A smooth function on the unit sphere, within −1..=1, that repeats nowhere on it: waves of two to three lumps a radius.
fn lump(d: DVec3) -> f64 {
    let first = libm::sin(4.1 * d.x + 0.6) * libm::cos(3.3 * d.y - 1.1);
    let second = libm::sin(3.7 * d.z - 0.4) * libm::cos(2.9 * d.x + 2.3);
    f64::midpoint(first, second)
}

/// The twelve directions and twenty triangles of an icosahedron.
fn icosahedron() -> (Vec<DVec3>, Vec<[usize; 3]>) {
    let long = f64::midpoint(1.0, libm::sqrt(5.0));
    let corner = |i: usize| {
        let (a, b) = (if i & 1 == 0 { 1.0 } else { -1.0 }, if i & 2 == 0 { long } else { -long });
        let v = [DVec3::new(0.0, a, b), DVec3::new(a, b, 0.0), DVec3::new(b, 0.0, a)][i / 4];
        v.normalize()
    };
    let directions: Vec<_> = (0..12).map(corner).collect();
    // Neighbours are the closest pairs; a triangle is three mutual neighbours, turned to face outwards.
    let near = |i: usize, j: usize| directions[i].dot(directions[j]) > 0.4;
    let mut triangles = Vec::new();
    for i in 0..12 {
        for j in (i + 1..12).filter(|&j| near(i, j)) {
            for k in (j + 1..12).filter(|&k| near(i, k) && near(j, k)) {
                let [a, b, c] = [i, j, k].map(|v| directions[v]);
                triangles.push(if (b - a).cross(c - a).dot(a) > 0.0 {
                    [i, j, k]
                } else {
                    [i, k, j]
                });
            }
        }
    }
    (directions, triangles)
}

/// Four triangles for each, the middles of edges pushed out to the sphere.
fn subdivide(directions: &mut Vec<DVec3>, triangles: &[[usize; 3]]) -> Vec<[usize; 3]> {
    let mut middles: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    let mut middle = |a: usize, b: usize| {
        *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let between = (directions[a.min(b)] + directions[a.max(b)]).normalize();
            directions.push(between);
            directions.len() - 1
        })
    };
    let split = |&[a, b, c]: &[usize; 3]| {
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    triangles.iter().flat_map(split).collect()
}

/// The faces of a prism, counter-clockwise seen from outside: its sides, then the first and the last end.
///
/// `from` and `to` must differ, and `sides` be at least 3.
pub fn prism(shape: &Prism) -> Vec<Vec<DVec3>> {
    let (from, to) = (DVec3::from(shape.from), DVec3::from(shape.to));
    let axis = (to - from).normalize();
    // Across from the world's axis that the prism least follows: a prism along x has its first edge over +y.
    let (across, _) = [DVec3::X, DVec3::Y, DVec3::Z]
        .into_iter()
        .map(|e| (e, axis.dot(e).abs()))
        .fold((DVec3::X, f64::INFINITY), |best, next| if next.1 < best.1 { next } else { best });
    let u = (across - axis * axis.dot(across)).normalize();
    let v = axis.cross(u);
    let ring = |center: DVec3, radius: f64| -> Vec<DVec3> {
        let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(shape.sides);
        (0..shape.sides)
            .map(|i| center + radius * (u * libm::cos(angle(i)) + v * libm::sin(angle(i))))
            .collect()
    };
    let (first, last) =
        (ring(from, shape.radius), ring(to, shape.to_radius.unwrap_or(shape.radius)));
    let side = |i: usize| {
        let next = (i + 1) % first.len();
        vec![first[i], first[next], last[next], last[i]]
    };
    let mut faces: Vec<_> = (0..first.len()).map(side).collect();
    faces.push(first.iter().rev().copied().collect());
    faces.push(last);
    faces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::face::Face;

    fn egg(lumpiness: f64) -> Ellipsoid {
        Ellipsoid { center: [1.0, 2.0, 3.0], radii: [3.0, 2.0, 1.0], subdivisions: 3, lumpiness }
    }

    /// Six times the volume that closed, outward faces enclose: the divergence theorem over fans of triangles.
    fn volume(faces: &[Vec<DVec3>]) -> f64 {
        let fan =
            |f: &Vec<DVec3>| (2..f.len()).map(|i| f[0].dot(f[i - 1].cross(f[i]))).sum::<f64>();
        faces.iter().map(fan).sum::<f64>() / 6.0
    }

    /// Every edge is walked once each way.
    fn closed(faces: &[Vec<DVec3>]) -> bool {
        let bits = |p: DVec3| p.to_array().map(f64::to_bits);
        let mut edges: Vec<_> = faces
            .iter()
            .flat_map(|f| (0..f.len()).map(|i| (bits(f[i]), bits(f[(i + 1) % f.len()]))))
            .collect();
        let mut back: Vec<_> = edges.iter().map(|&(a, b)| (b, a)).collect();
        edges.sort_unstable();
        back.sort_unstable();
        edges == back && edges.windows(2).all(|pair| pair[0] != pair[1])
    }

    #[test]
    fn an_ellipsoid_is_closed_and_inscribed_and_nearly_fills_its_volume() {
        let faces = ellipsoid(&egg(0.0));
        assert_eq!(faces.len(), 20 * 64);
        assert!(closed(&faces));
        let exact = 4.0 / 3.0 * std::f64::consts::PI * 6.0;
        let part = volume(&faces) / exact;
        assert!((0.97..1.0).contains(&part), "{part}");
    }

    #[test]
    fn lumps_keep_it_closed_and_the_same_bits_come_again() {
        let faces = ellipsoid(&egg(0.5));
        assert!(closed(&faces) && faces == ellipsoid(&egg(0.5)) && faces != ellipsoid(&egg(0.0)));
        assert!(faces.into_iter().all(|f| Face::new(vec![f]).is_ok()));
    }

    #[test]
    fn a_square_prism_encloses_its_base_times_its_length() {
        let beam = Prism {
            from: [0.0, 0.0, 0.0],
            to: [0.0, 0.0, 5.0],
            radius: 1.0,
            to_radius: None,
            sides: 4,
        };
        let faces = prism(&beam);
        assert_eq!(faces.len(), 6);
        assert!(closed(&faces) && (volume(&faces) - 10.0).abs() < 1e-12);
    }

    #[test]
    fn a_diverging_beam_has_flat_faces_that_look_outwards() {
        let beam = Prism {
            from: [1.0, 2.0, 3.0],
            to: [-7.0, 5.0, 4.0],
            radius: 1.0,
            to_radius: Some(3.0),
            sides: 7,
        };
        let faces = prism(&beam);
        let middle = f64::midpoint(1.0, -7.0);
        let inside = DVec3::new(middle, 3.5, 3.5);
        for face in faces.into_iter().map(|f| Face::new(vec![f]).unwrap()) {
            assert!(face.normal.dot(face.center - inside) > 0.0);
        }
    }
}
