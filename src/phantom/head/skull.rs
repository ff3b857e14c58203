//! The skull: braincase with its sutures, face, cavities and eyes.

use std::ops::Range;

use super::brain::BrainSlice;
use super::row::{AIR, EDGE, Row};
use crate::phantom::shapes::Piece;
use crate::phantom::solid::{FAR, Slice, Solid, coverage};

/// The outside of the braincase; its inside is the same surface, deeper by the thickness.
const CASE: &[Piece] = &[
    Piece::ellipsoid([0.0, 8.0, 38.0], [65.0, 86.0, 61.0]),
    Piece::ellipsoid([0.0, -36.0, 38.0], [50.0, 44.0, 42.0]).soft(16.0),
    Piece::ellipsoid([0.0, 58.0, 14.0], [48.0, 37.0, 32.0]).soft(16.0),
    Piece::ellipsoid([42.0, 10.0, 12.0], [23.0, 36.0, 30.0]).both().soft(10.0),
    Piece::ellipsoid([0.0, 8.0, -6.0], [42.0, 50.0, 16.0]).soft(12.0),
    // It recedes above and behind the orbits and the nose.
    Piece::ellipsoid([29.0, -62.0, 2.0], [25.0, 34.0, 22.0]).both().cut().soft(8.0),
    Piece::ellipsoid([0.0, -62.0, -4.0], [22.0, 40.0, 26.0]).cut().soft(8.0),
];

/// The bones of the face and the base, then the openings.
const FACE: &[Piece] = &[
    // Brows, outer and lower rims of the orbits.
    Piece::capsule([4.0, -77.0, 24.0], [25.0, -75.0, 27.0], [5.0, 4.5]).both().soft(7.0),
    Piece::capsule([25.0, -75.0, 27.0], [45.0, -62.0, 20.0], [4.5, 4.5]).both().soft(7.0),
    Piece::capsule([45.0, -62.0, 20.0], [49.0, -56.0, -2.0], [4.5, 5.0]).both().soft(5.0),
    Piece::capsule([48.0, -57.0, -6.0], [14.0, -73.0, -9.0], [6.0, 5.0]).both().soft(5.0),
    // Walls between orbits, nose and temples.
    Piece::block([0.0, -46.0, 2.0], [16.0, 28.0, 22.0], 8.0).soft(6.0),
    Piece::ellipsoid([37.0, -42.0, 4.0], [9.0, 20.0, 22.0]).turned(-28.0, 0.0).both().soft(6.0),
    // Upper jaw and its tooth-bearing rim.
    Piece::ellipsoid([0.0, -46.0, -24.0], [37.0, 32.0, 23.0]).soft(6.0),
    Piece::ellipsoid([0.0, -42.0, -41.0], [30.5, 40.5, 9.0]).soft(6.0),
    Piece::ellipsoid([0.0, -30.0, -47.0], [20.0, 36.0, 9.0]).cut().soft(3.0),
    Piece::capsule([0.0, -78.0, -31.0], [0.0, -83.0, -33.0], [3.5, 2.0]).soft(6.0),
    // Bridge of the nose.
    Piece::capsule([0.0, -77.0, 22.0], [0.0, -91.0, 1.0], [5.0, 3.2]).soft(5.0),
    Piece::capsule([5.0, -76.0, 20.0], [5.0, -87.0, -1.0], [4.0, 2.6]).both().soft(4.0),
    Piece::capsule([8.0, -76.0, 16.0], [14.0, -76.0, -12.0], [4.0, 5.0]).both().soft(4.0),
    // Cheekbones and arches.
    Piece::ellipsoid([46.0, -54.0, -13.0], [12.0, 11.0, 11.0]).both().soft(6.0),
    Piece::ellipsoid([36.0, -58.0, -18.0], [12.0, 12.0, 10.0]).both().soft(6.0),
    Piece::capsule([51.0, -48.0, -12.0], [62.0, -22.0, -10.0], [7.0, 4.5]).both().soft(5.0),
    Piece::capsule([62.0, -22.0, -10.0], [61.0, 8.0, -5.0], [4.5, 5.5]).both().soft(5.0),
    // Behind the ears, under the ears, and before the neck.
    Piece::capsule([53.0, 28.0, -4.0], [50.0, 23.0, -32.0], [13.0, 6.0]).both().soft(8.0),
    Piece::capsule([40.0, 12.0, -22.0], [38.0, 6.0, -40.0], [2.8, 1.4]).both().soft(2.0),
    Piece::ellipsoid([0.0, -18.0, -12.0], [22.0, 16.0, 15.0]).soft(6.0),
    Piece::capsule([16.0, -22.0, -18.0], [15.0, -22.0, -40.0], [4.0, 2.5]).both().soft(4.0),
    // Orbits.
    Piece::ellipsoid([30.5, -70.0, 8.5], [17.5, 18.0, 15.0]).both().cut().soft(3.0),
    Piece::capsule([29.5, -62.0, 8.0], [15.0, -30.0, 8.0], [15.5, 5.0]).both().cut().soft(3.0),
    // The pear-shaped opening and cavity of the nose.
    Piece::capsule([0.0, -90.0, -4.0], [0.0, -84.0, -20.0], [4.0, 10.0]).cut().soft(3.0),
    Piece::block([0.0, -54.0, -15.0], [12.0, 32.0, 15.0], 8.0).cut().soft(3.0),
    // The way of the spinal cord, and the ear canals.
    Piece::capsule([0.0, 30.0, -6.0], [0.0, 34.0, -50.0], [14.0, 15.0]).cut().soft(3.0),
    Piece::capsule([78.0, 13.0, -7.0], [46.0, 8.0, -7.0], [3.6, 3.0]).both().cut(),
];

/// Hollows full of air: sinuses, nose, ear canals, throat and mouth.
const HOLLOWS: &[Piece] = &[
    Piece::ellipsoid([9.0, -77.0, 29.0], [8.0, 3.6, 8.0]).both(),
    Piece::ellipsoid([28.0, -50.0, -18.0], [10.0, 14.0, 11.0]).both(),
    Piece::ellipsoid([7.0, -22.0, -6.0], [6.0, 9.0, 7.0]).both(),
    Piece::ellipsoid([7.5, -48.0, 7.0], [5.5, 19.0, 10.0]).both(),
    Piece::block([0.0, -52.0, -14.0], [10.0, 32.0, 14.0], 7.0),
    Piece::capsule([6.0, -103.0, -38.0], [6.0, -80.0, -22.0], [3.6, 5.0]).both().soft(2.0),
    Piece::capsule([0.0, -22.0, -16.0], [0.0, -6.0, -44.0], [8.0, 7.0]).soft(4.0),
    Piece::capsule([0.0, -6.0, -44.0], [0.0, -4.0, -130.0], [7.0, 8.0]).soft(4.0),
    Piece::ellipsoid([0.0, -42.0, -44.0], [17.0, 30.0, 2.6]).soft(3.0),
    Piece::capsule([80.0, 14.0, -7.0], [46.0, 8.0, -7.0], [2.6, 2.2]).both(),
];

/// The septum between the halves of the nose, a little to one side, and the shelves in each half.
const SEPTUM: &[Piece] = &[
    Piece::block([0.8, -54.0, -13.0], [1.3, 30.0, 16.0], 1.0).turned(1.0, 0.0),
    Piece::capsule([9.0, -72.0, -24.0], [8.0, -32.0, -22.0], [2.8, 2.6]).both(),
    Piece::capsule([8.5, -66.0, -12.0], [7.5, -34.0, -11.0], [2.4, 2.2]).both(),
];

const EYES: &[Piece] = &[Piece::ellipsoid([30.0, -69.0, 8.0], [11.5, 11.5, 11.5]).both()];
const LENSES: &[Piece] = &[Piece::ellipsoid([30.0, -76.5, 8.0], [4.5, 2.2, 4.5]).both()];
const NERVES: &[Piece] =
    &[Piece::capsule([29.0, -58.0, 8.0], [13.0, -26.0, 8.0], [2.2, 2.2]).both()];

/// The skull with what it holds, ready for slices.
pub struct Skull {
    solids: [Solid; 7],
}

impl Skull {
    pub fn new() -> Self {
        Self { solids: [CASE, FACE, HOLLOWS, SEPTUM, EYES, LENSES, NERVES].map(Solid::new) }
    }

    pub fn slice(&self, z: f32) -> SkullSlice<'_> {
        SkullSlice { solids: self.solids.each_ref().map(|solid| solid.slice(z)) }
    }
}

/// The skull near one slice.
pub struct SkullSlice<'a> {
    solids: [Slice<'a>; 7],
}

impl SkullSlice<'_> {
    /// Paints row j: bone, brain, eyes, air.
    pub fn paint(&self, row: &mut Row, brain: &BrainSlice, j: usize) {
        let [case, face, hollows, septum, eyes, lenses, nerves] = &self.solids;
        let mut depths = vec![-FAR; row.x.len()];
        let cavity = hollow_case(row, case, &mut depths);
        let bones = face.lay(row.x, row.y, row.distances);
        let range = join(&cavity, &bones);
        row.blend(range, EDGE, |_, distance| bone(distance));
        if !cavity.is_empty() {
            fill(row, brain, j, cavity, &depths);
        }
        row.paint(eyes, 1050.0, EDGE);
        row.paint(lenses, 1110.0, EDGE);
        row.paint(nerves, 1065.0, EDGE);
        row.paint(hollows, AIR, EDGE);
        row.paint(septum, 1750.0, EDGE);
    }
}

/// The least range that holds both.
fn join(a: &Range<usize>, b: &Range<usize>) -> Range<usize> {
    match (a.is_empty(), b.is_empty()) {
        (true, _) => b.clone(),
        (_, true) => a.clone(),
        _ => a.start.min(b.start)..a.end.max(b.end),
    }
}

/// Hard bone around spongy bone, by the distance to its surface.
fn bone(distance: f32) -> f32 {
    1900.0 - 450.0 * ((-distance - 1.5) / 1.5).clamp(0.0, 1.0)
}

/// Leaves the distance to the shell of the braincase in the row, and its depth under the inside in `depths`.
fn hollow_case(row: &mut Row, case: &Slice, depths: &mut [f32]) -> Range<usize> {
    let range = row.lay(case);
    let (y, z) = (row.y, row.z);
    for i in range.clone() {
        let (x, distance) = (row.x[i], row.distances[i]);
        depths[i] = -distance - thickness(x, y, z);
        let outside = if distance.abs() < 6.0 { distance + groove(x, y, z) } else { distance };
        row.distances[i] = outside.max(depths[i]);
    }
    range
}

/// The thickness of the braincase, mm: least at the temples, most at the back of the head and the brows.
fn thickness(x: f32, y: f32, z: f32) -> f32 {
    let side = (x * x) * (1.6 / 4225.0);
    let back = ((y - 40.0) * 0.05).clamp(0.0, 2.0);
    let front = ((-50.0 - y) * 0.08).clamp(0.0, 2.0);
    let low = ((10.0 - z) * 0.06).clamp(0.0, 1.5);
    6.0 - side + back + front + low
}

/// How deep a suture cuts into the outside of the braincase, mm.
fn groove(x: f32, y: f32, z: f32) -> f32 {
    let side = x.abs();
    let coronal = y + 26.0 - (99.0 - z) * 0.12 - 1.6 * zigzag(side / 9.0);
    let lambdoid = (z - 66.0 + 0.85 * side) * 0.72 - 1.6 * zigzag(side / 8.0);
    let above = if y > 30.0 { lambdoid } else { 1.0 };
    let mut near = FAR;
    if z > 18.0 && y < 20.0 {
        near = near.min(coronal.abs());
    }
    if y > 40.0 && z > -6.0 {
        near = near.min(lambdoid.abs());
    }
    if z > 40.0 && coronal > 0.0 && above > 0.0 {
        near = near.min((x - 1.6 * zigzag(y / 9.0)).abs());
    }
    if side > 40.0 && z > 8.0 {
        let temple = ((y - 8.0) * (y - 8.0) + (z - 2.0) * (z - 2.0)).sqrt();
        near = near.min((temple - 38.0).abs());
    }
    2.2 * coverage(near - 1.2, 1.6)
}

/// A wave of straight lines between −1 and 1, of period 1.
fn zigzag(at: f32) -> f32 {
    4.0 * (at - (at + 0.5).floor()).abs() - 1.0
}

/// Fills the braincase with brain.
fn fill(row: &mut Row, brain: &BrainSlice, j: usize, range: Range<usize>, depths: &[f32]) {
    let mut tissue = vec![0.0; row.x.len()];
    brain.row(row.x, (j, row.y), depths, &mut tissue);
    for i in range {
        row.values[i] += (tissue[i] - row.values[i]) * coverage(-depths[i], EDGE);
    }
}
