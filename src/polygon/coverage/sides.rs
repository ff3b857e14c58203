//! The sides of a mesh: faces that share an edge are turned alike, whichever way round each was stated.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::polygon::face::Face;

/// For each face, whether its normal has to be turned so that faces which share an edge look to the same side.
///
/// Of each connected part of the mesh the first face stays as it is. On a surface with one side only (a Möbius strip),
/// or where more than two faces meet at an edge, the first way found stands.
#[must_use]
pub fn turned(faces: &[Face]) -> Vec<bool> {
    let mut edges: BTreeMap<[[u64; 3]; 2], Vec<(usize, bool)>> = BTreeMap::new();
    let mut of_face: Vec<Vec<([[u64; 3]; 2], bool)>> = Vec::with_capacity(faces.len());
    for (number, face) in faces.iter().enumerate() {
        let of = face.outlines.edges();
        let of: Vec<_> = of.map(|(a, b)| key(a, b)).collect();
        for &(edge, forward) in &of {
            edges.entry(edge).or_default().push((number, forward));
        }
        of_face.push(of);
    }
    let mut turned: Vec<Option<bool>> = vec![None; faces.len()];
    for first in 0..faces.len() {
        let mut open = if turned[first].is_none() { vec![first] } else { Vec::new() };
        turned[first].get_or_insert(false);
        while let Some(face) = open.pop() {
            let own = turned[face] == Some(true);
            for (edge, forward) in &of_face[face] {
                for &(other, runs) in &edges[edge] {
                    // Neighbours that look to one side run along their edge in opposite ways.
                    if turned[other].is_none() {
                        turned[other] = Some(own != (runs == *forward));
                        open.push(other);
                    }
                }
            }
        }
    }
    turned.into_iter().map(|turned| turned == Some(true)).collect()
}

/// An edge without its direction, and the direction. −0 and 0 are one place.
fn key(a: DVec3, b: DVec3) -> ([[u64; 3]; 2], bool) {
    let [a, b] = [a, b].map(|v| (v + 0.0).to_array().map(f64::to_bits));
    if a <= b { ([a, b], true) } else { ([b, a], false) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_of_a_strip_stated_either_way_round_are_turned_alike() {
        let v = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let quad = |x: f64, turn: bool| {
            let mut outline = vec![v(x, 0.0), v(x + 1.0, 0.0), v(x + 1.0, 1.0), v(x, 1.0)];
            if turn {
                outline.reverse();
            }
            Face::new(vec![outline]).unwrap()
        };
        let stated = [true, false, false, true, false];
        let faces: Vec<_> =
            stated.iter().enumerate().map(|(x, &turn)| quad(x as f64, turn)).collect();
        let expected: Vec<bool> = stated.iter().map(|&turn| turn != stated[0]).collect();
        assert_eq!(turned(&faces), expected);
    }
}
