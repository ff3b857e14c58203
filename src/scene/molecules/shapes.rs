//! Atoms, bonds and backbones as shapes of flat faces.

use glam::DVec3;

use crate::components::{Color, Ellipsoid, Prism};
use crate::formats::molecules::{Atom, Element, Structure};
use crate::polygon::shape::{ellipsoid, prism};

/// The outlines of a shape's faces, and its color.
pub type Colored = (Vec<Vec<DVec3>>, Color);

/// Sides of a stick and of a tube.
const SIDES: u32 = 8;
/// Points of the tube from one residue to the next.
const STEPS: usize = 5;
/// Backbone atoms farther apart than this are not linked, Å: a phosphorus is 7 from the next.
const LINKED: f64 = 8.5;

/// A stick for each half of a bond, rounded at atoms by a ball as thick; atoms without a bond are balls.
pub fn sticks(
    structure: &Structure,
    radius: f64,
    water: bool,
    carbon: Option<Color>,
) -> Vec<Colored> {
    let mut bonded = vec![false; structure.atoms.len()];
    let mut shapes = Vec::new();
    for pair in &structure.bonds {
        let [a, b] = pair.map(|at| &structure.atoms[at as usize]);
        for &at in pair {
            bonded[at as usize] = true;
        }
        if water || !(a.is_water || b.is_water) {
            let middle = a.place.midpoint(b.place);
            shapes
                .extend([a, b].map(|atom| (rod(atom.place, middle, radius), color(atom, carbon))));
        }
    }
    let atoms = structure.atoms.iter().zip(bonded).filter(|(atom, _)| water || !atom.is_water);
    for (atom, bonded) in atoms {
        let radius = if bonded { radius * 1.02 } else { 2.0 * radius };
        shapes.push((ball(atom.place, radius, 1), color(atom, carbon)));
    }
    shapes.retain(|(outlines, _)| !outlines.is_empty());
    shapes
}

/// A ball for each atom, `scale` times as large as its radius of van der Waals.
pub fn balls(
    structure: &Structure,
    scale: f64,
    water: bool,
    carbon: Option<Color>,
) -> Vec<Colored> {
    let atoms = structure.atoms.iter().filter(|atom| water || !atom.is_water);
    atoms
        .map(|atom| (ball(atom.place, scale * atom.element.radius(), 2), color(atom, carbon)))
        .collect()
}

/// A tube along the backbone of each chain, by the spline of Catmull and Rom through its atoms.
pub fn tube(structure: &Structure, radius: f64, carbon: Option<Color>) -> Vec<Colored> {
    let color = carbon.unwrap_or(Color::from_number(0x50_90d0));
    let backbone: Vec<&Atom> =
        structure.atoms.iter().filter(|atom| atom.backbone.is_some()).collect();
    let linked = |pair: &[&Atom]| {
        let chains = [0, 1].map(|n| pair[n].backbone.as_ref().map(|residue| &residue.chain));
        chains[0] == chains[1] && pair[0].place.distance(pair[1].place) < LINKED
    };
    let mut shapes = Vec::new();
    for chain in backbone.chunk_by(|a, b| linked(&[a, b])).filter(|chain| chain.len() > 1) {
        let places: Vec<DVec3> = chain.iter().map(|atom| atom.place).collect();
        let points = spline(&places);
        for pair in points.windows(2) {
            shapes.push((rod(pair[0], pair[1], radius), color));
        }
        shapes.extend(points.iter().map(|&point| (ball(point, radius, 1), color)));
    }
    shapes.retain(|(outlines, _)| !outlines.is_empty());
    shapes
}

/// Points of a smooth curve through some others.
fn spline(places: &[DVec3]) -> Vec<DVec3> {
    let at = |n: usize| places[n.clamp(1, places.len()) - 1];
    let mut points = Vec::new();
    for n in 1..places.len() {
        let [p, q, r, s] = [at(n - 1), at(n), at(n + 1), at(n + 2)];
        points.extend((0..STEPS).map(|step| {
            let t = step as f64 / STEPS as f64;
            let (bend, turn) = (2.0 * p - 5.0 * q + 4.0 * r - s, 3.0 * (q - r) + s - p);
            0.5 * (2.0 * q + (r - p) * t + bend * (t * t) + turn * (t * t * t))
        }));
    }
    points.push(at(places.len()));
    points
}

fn color(atom: &Atom, carbon: Option<Color>) -> Color {
    carbon
        .filter(|_| atom.element == Element::Carbon)
        .unwrap_or(Color::from_number(atom.element.color()))
}

fn rod(from: DVec3, to: DVec3, radius: f64) -> Vec<Vec<DVec3>> {
    if from.distance(to) < 1e-6 {
        return Vec::new();
    }
    let ends = [from, to].map(|end| end.to_array());
    let mut faces =
        prism(&Prism { from: ends[0], to: ends[1], radius, to_radius: None, sides: SIDES });
    // Its ends are within balls or meet another rod's.
    faces.truncate(SIDES as usize);
    faces
}

fn ball(center: DVec3, radius: f64, subdivisions: u32) -> Vec<Vec<DVec3>> {
    let center = center.to_array();
    ellipsoid(&Ellipsoid { center, radii: [radius; 3], subdivisions, lumpiness: 0.0 })
}
