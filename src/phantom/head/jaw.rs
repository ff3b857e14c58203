//! The lower jaw, two rows of teeth with a metal filling and its streaks, and the vertebrae of the neck.

use super::row::{EDGE, Row};
use crate::phantom::shapes::Piece;
use crate::phantom::solid::{Slice, Solid};

/// The lower jaw: body, chin, rising branches with their two heads.
const MANDIBLE: &[Piece] = &[
    Piece::capsule([0.0, -76.0, -91.0], [17.0, -71.0, -91.0], [6.0, 6.0]).both().soft(3.0),
    Piece::capsule([17.0, -71.0, -91.0], [46.0, -12.0, -76.0], [6.0, 5.5]).both().soft(6.0),
    Piece::capsule([0.0, -75.5, -82.0], [16.0, -70.0, -82.0], [6.0, 6.0]).both().soft(8.0),
    Piece::capsule([16.0, -70.0, -82.0], [43.0, -18.0, -69.0], [6.0, 6.0]).both().soft(6.0),
    Piece::capsule([0.0, -75.0, -73.0], [16.0, -68.0, -73.0], [5.0, 5.5]).both().soft(6.0),
    Piece::capsule([16.0, -68.0, -73.0], [38.0, -22.0, -68.0], [5.5, 5.5]).both().soft(6.0),
    Piece::ellipsoid([0.0, -81.0, -92.0], [14.0, 6.0, 6.0]).soft(8.0),
    Piece::block([48.0, -6.0, -50.0], [4.0, 16.0, 29.0], 3.0).turned(0.0, -12.0).both().soft(9.0),
    Piece::ellipsoid([51.0, 4.0, -17.0], [8.0, 4.5, 5.0]).both().soft(5.0),
    Piece::capsule([49.0, -12.0, -34.0], [48.0, -20.0, -17.0], [5.0, 2.0]).both().soft(4.0),
    Piece::ellipsoid([49.0, -6.0, -18.0], [9.0, 6.5, 10.0]).both().cut().soft(3.0),
];

/// Vertebra by vertebra: body, arch and spine; the first is a ring with wide wings.
const VERTEBRAE: &[Piece] = &[
    Piece::capsule([0.0, 14.0, -42.0], [20.0, 24.0, -42.0], [4.5, 6.0]).both().soft(4.0),
    Piece::capsule([20.0, 24.0, -42.0], [37.0, 26.0, -43.0], [6.0, 4.0]).both().soft(4.0),
    Piece::capsule([20.0, 28.0, -42.0], [0.0, 50.0, -43.0], [5.0, 4.5]).both().soft(4.0),
    Piece::capsule([0.0, 21.0, -58.0], [0.0, 22.0, -36.0], [6.5, 4.0]).soft(2.0),
    Piece::ellipsoid([0.0, 21.0, -60.0], [12.0, 9.0, 7.0]).soft(3.0),
    Piece::capsule([11.0, 24.0, -58.0], [18.0, 34.0, -59.0], [6.0, 5.5]).both().soft(3.0),
    Piece::capsule([18.0, 34.0, -59.0], [0.0, 53.0, -62.0], [5.0, 5.0]).both().soft(3.0),
    Piece::capsule([0.0, 53.0, -62.0], [5.0, 66.0, -68.0], [5.0, 4.0]).both().soft(3.0),
    Piece::block([0.0, 21.0, -78.0], [12.0, 9.0, 7.0], 4.0).soft(2.0),
    Piece::capsule([12.0, 24.0, -78.0], [18.0, 34.0, -78.0], [5.0, 6.0]).both().soft(3.0),
    Piece::capsule([18.0, 34.0, -78.0], [0.0, 51.0, -81.0], [4.5, 4.0]).both().soft(3.0),
    Piece::capsule([0.0, 51.0, -81.0], [4.0, 62.0, -86.0], [4.0, 3.0]).both().soft(3.0),
    Piece::block([0.0, 22.0, -95.0], [12.0, 9.0, 7.0], 4.0).soft(2.0),
    Piece::capsule([12.0, 25.0, -95.0], [18.0, 35.0, -95.0], [5.0, 6.0]).both().soft(3.0),
    Piece::capsule([18.0, 35.0, -95.0], [0.0, 52.0, -98.0], [4.5, 4.0]).both().soft(3.0),
    Piece::capsule([0.0, 52.0, -98.0], [4.0, 63.0, -103.0], [4.0, 3.0]).both().soft(3.0),
    Piece::block([0.0, 23.0, -112.0], [12.0, 9.0, 7.0], 4.0).soft(2.0),
    Piece::capsule([12.0, 26.0, -112.0], [18.0, 36.0, -112.0], [5.0, 6.0]).both().soft(3.0),
    Piece::capsule([18.0, 36.0, -112.0], [0.0, 53.0, -115.0], [4.5, 4.0]).both().soft(3.0),
];

const CORD: &[Piece] = &[Piece::capsule([0.0, 34.0, -20.0], [0.0, 38.0, -130.0], [6.0, 5.5])];

/// Width and depth of the teeth of one side from the middle, mm, upper then lower.
const TEETH: [[[f32; 2]; 7]; 2] = [
    [[8.0, 6.5], [6.4, 6.0], [7.0, 7.5], [6.4, 8.2], [6.4, 8.2], [9.2, 9.6], [8.6, 9.4]],
    [[5.4, 6.0], [5.8, 6.2], [6.6, 7.2], [6.6, 7.4], [6.8, 7.8], [9.8, 9.2], [9.4, 9.0]],
];

/// Half axes of the arches on which the teeth stand, mm, and the height of their crowns' middle.
const ARCHES: [[f32; 3]; 2] = [[27.0, 43.0, -50.5], [25.5, 40.5, -60.5]];

/// Where the arches' centre lies in y.
const ARCH_CENTER: f32 = -36.0;

/// The filling: in the sixth lower tooth on the left.
const FILLING: [f32; 3] = [24.0, -42.0, -57.5];

/// Streaks of the filling: direction in the slice, and how much brighter they are than what they cross.
const STREAKS: [([f32; 2], f32); 6] = [
    ([1.0, 0.1], 150.0),
    ([0.92, -0.39], -140.0),
    ([0.6, -0.8], 110.0),
    ([0.1, -0.995], -110.0),
    ([-0.5, -0.866], 120.0),
    ([0.83, 0.56], -120.0),
];

/// Jaw, teeth and neck, ready for slices.
pub struct Jaw {
    bones: Solid,
    cord: Solid,
    roots: Solid,
    crowns: Solid,
    filling: Solid,
}

impl Jaw {
    pub fn new() -> Self {
        let (crowns, roots) = teeth();
        let filling = [Piece::ellipsoid(FILLING, [3.4, 3.0, 3.0])];
        let bones: Vec<Piece> = MANDIBLE.iter().chain(VERTEBRAE).copied().collect();
        Self {
            bones: Solid::new(&bones),
            cord: Solid::new(CORD),
            roots: Solid::new(&roots),
            crowns: Solid::new(&crowns),
            filling: Solid::new(&filling),
        }
    }

    pub fn slice(&self, z: f32) -> JawSlice<'_> {
        JawSlice {
            bones: self.bones.slice(z),
            cord: self.cord.slice(z),
            roots: self.roots.slice(z),
            crowns: self.crowns.slice(z),
            filling: self.filling.slice(z),
        }
    }
}

/// Crowns and roots, tooth by tooth along the arches.
fn teeth() -> (Vec<Piece>, Vec<Piece>) {
    let (mut crowns, mut roots) = (Vec::new(), Vec::new());
    for (row, [a, b, z]) in ARCHES.into_iter().enumerate() {
        let up = if row == 0 { 1.0 } else { -1.0 };
        let mut angle = 0.0_f32;
        for [width, depth] in TEETH[row] {
            let (middle, next) = (step(angle, [a, b], width / 2.0), step(angle, [a, b], width));
            angle = next;
            let (sine, cosine) = libm::sincosf(middle);
            let [x, y] = [a * sine, ARCH_CENTER - b * cosine];
            let yaw = libm::atan2f(b * sine, a * cosine).to_degrees();
            let half = [width / 2.0 - 0.75, depth / 2.0 - 0.5, 5.0];
            let crown = Piece::block([x, y, z], half, 2.0).turned(yaw, 0.0).both();
            crowns.push(crown.soft(0.2));
            let tip = [x * 0.94, ARCH_CENTER + (y - ARCH_CENTER) * 0.9, z + up * 17.0];
            let neck = width.min(depth) / 2.0 - 0.6;
            roots.push(Piece::capsule([x, y, z + up * 3.0], tip, [neck, 1.2]).both().soft(0.2));
        }
    }
    (crowns, roots)
}

/// The angle of the point `distance` mm farther along an elliptic arch than `angle`.
fn step(mut angle: f32, [a, b]: [f32; 2], distance: f32) -> f32 {
    for _ in 0..16 {
        let (sine, cosine) = libm::sincosf(angle);
        angle += distance / 16.0 / (a * a * cosine * cosine + b * b * sine * sine).sqrt();
    }
    angle
}

/// Jaw, teeth and neck near one slice.
pub struct JawSlice<'a> {
    bones: Slice<'a>,
    cord: Slice<'a>,
    roots: Slice<'a>,
    crowns: Slice<'a>,
    filling: Slice<'a>,
}

impl JawSlice<'_> {
    /// Paints a row: bone, cord, teeth, filling and streaks.
    pub fn paint(&self, row: &mut Row) {
        let range = row.lay(&self.bones);
        row.blend(range, EDGE, |_, d| 1900.0 - 500.0 * ((-d - 1.5) / 1.5).clamp(0.0, 1.0));
        row.paint(&self.cord, 1062.0, EDGE);
        row.paint(&self.roots, 1950.0, 1.6);
        let range = row.lay(&self.crowns);
        row.blend(range, 1.6, |_, d| 2650.0 - 300.0 * ((-d - 1.0) / 1.5).clamp(0.0, 1.0));
        streak(row);
        row.paint(&self.filling, 3272.0, EDGE);
    }
}

/// Brightens and darkens the lines through the filling, as a scanner does that meets metal.
fn streak(row: &mut Row) {
    let [fx, fy, fz] = FILLING;
    let level = 1.0 - ((row.z - fz) / 5.0).abs();
    if level <= 0.0 {
        return;
    }
    let dy = row.y - fy;
    for (value, &x) in row.values.iter_mut().zip(row.x) {
        let dx = x - fx;
        let fade = level / (1.0 + (dx * dx + dy * dy) * (1.0 / 900.0));
        for ([sx, sy], strength) in STREAKS {
            let across = (dx * sy - dy * sx).abs();
            *value += strength * fade * (1.0 - across * (1.0 / 2.5)).max(0.0);
        }
        *value = value.clamp(0.0, 3272.0);
    }
}
