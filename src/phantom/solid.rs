//! Solids of phantoms: shapes laid one after another, evaluated a row of voxels at a time.

use std::ops::Range;

use super::shapes::{Piece, Shape, block, dot, ellipsoid, length, smooth_union};

/// Farther than anything: the distance before any piece is laid.
pub const FAR: f32 = 1e3;

/// Depth under a cut's surface to which distances stay continuous, mm: no layer of tissue lies deeper.
const REACH: f32 = 9.0;

/// A piece with its bounds, ready for rows.
#[derive(Debug, Clone)]
struct Placed {
    piece: Piece,
    axes: [[f32; 3]; 3],
    low: [f32; 3],
    high: [f32; 3],
}

impl Placed {
    /// Bounds the piece; beyond them its distance is above `softest`, the widest blend from it on, and changes nothing.
    fn new(piece: Piece, softest: f32) -> Self {
        let axes = piece.axes();
        let center = piece.center;
        let margin = softest + if piece.cut { REACH } else { 3.0 };
        let (mut low, mut high) = (center, center);
        for axis in 0..3 {
            let across = |sides: [f32; 3]| -> f32 {
                (0..3).map(|row| axes[row][axis].abs() * sides[row]).sum::<f32>() + margin
            };
            let (below, above) = match piece.form {
                Shape::Ellipsoid { radii } => (-across(radii), across(radii)),
                Shape::Block { half, .. } => (-across(half), across(half)),
                Shape::Capsule { to, radii } => {
                    let step = to[axis] - center[axis];
                    let around = margin + radii[0].max(radii[1]);
                    (step.min(0.0) - around, step.max(0.0) + around)
                }
            };
            low[axis] += below;
            high[axis] += above;
        }
        Self { piece, axes, low, high }
    }

    fn meets(&self, axis: usize, at: f32) -> bool {
        self.low[axis] <= at && at <= self.high[axis]
    }

    /// Lays the piece over the distances `out` at the places `xs` of the row (y, z).
    fn lay(&self, xs: &[f32], y: f32, z: f32, out: &mut [f32]) {
        let Piece { center, form, .. } = self.piece;
        let [cx, cy, cz] = center;
        let start = self.axes.map(|row| row[1] * (y - cy) + row[2] * (z - cz) - row[0] * cx);
        let step = self.axes.map(|row| row[0]);
        let local = |x: f32| -> [f32; 3] { std::array::from_fn(|i| start[i] + x * step[i]) };
        match form {
            Shape::Ellipsoid { radii } => {
                let scale = radii.map(|r| 1.0 / r);
                self.fold(xs, out, |x| ellipsoid(local(x), scale));
            }
            Shape::Block { half, round } => self.fold(xs, out, |x| block(local(x), half, round)),
            Shape::Capsule { to, radii } => {
                let along = [to[0] - cx, to[1] - cy, to[2] - cz];
                let scale = 1.0 / dot(along, along);
                self.fold(xs, out, |x| {
                    let p = [x - cx, y - cy, z - cz];
                    let h = (dot(p, along) * scale).clamp(0.0, 1.0);
                    let q = std::array::from_fn(|i| p[i] - h * along[i]);
                    length(q) - radii[0] - h * (radii[1] - radii[0])
                });
            }
        }
    }

    fn fold(&self, xs: &[f32], out: &mut [f32], distance: impl Fn(f32) -> f32) {
        let (soft, quarter) = (self.piece.soft, 0.25 / self.piece.soft);
        if self.piece.cut {
            for (d, &x) in out.iter_mut().zip(xs) {
                *d = -smooth_union(-*d, distance(x), soft, quarter);
            }
        } else {
            for (d, &x) in out.iter_mut().zip(xs) {
                *d = smooth_union(*d, distance(x), soft, quarter);
            }
        }
    }
}

/// Pieces laid one after another.
#[derive(Debug, Clone)]
pub struct Solid(Vec<Placed>);

impl Solid {
    /// The solid of a table, mirrored pieces laid twice.
    pub fn new(pieces: &[Piece]) -> Self {
        let mut placed = Vec::new();
        let mut softest = 0.0_f32;
        for piece in pieces.iter().rev() {
            softest = softest.max(piece.soft);
            placed.extend(piece.mirrored.then(|| Placed::new(piece.mirror(), softest)));
            placed.push(Placed::new(*piece, softest));
        }
        placed.reverse();
        Self(placed)
    }

    /// What of the solid comes near the plane z.
    pub fn slice(&self, z: f32) -> Slice<'_> {
        Slice { pieces: self.0.iter().filter(|p| p.meets(2, z)).collect(), z }
    }
}

/// The pieces of a solid near one slice of voxels.
#[derive(Debug)]
pub struct Slice<'a> {
    pieces: Vec<&'a Placed>,
    z: f32,
}

impl Slice<'_> {
    /// Lays the pieces over the distances `out` at the rising places `xs` of row y; the range of them that any came near.
    pub fn lay(&self, xs: &[f32], y: f32, out: &mut [f32]) -> Range<usize> {
        let mut touched = xs.len()..0;
        for placed in self.pieces.iter().filter(|p| p.meets(1, y)) {
            let first = xs.partition_point(|&x| x < placed.low[0]);
            let last = xs.partition_point(|&x| x <= placed.high[0]);
            if first < last {
                placed.lay(&xs[first..last], y, self.z, &mut out[first..last]);
                touched = touched.start.min(first)..touched.end.max(last);
            }
        }
        touched.start.min(touched.end)..touched.end
    }
}

/// The part of a voxel that a solid fills, from the distance at its centre: a linear ramp `width` mm wide.
pub fn coverage(distance: f32, width: f32) -> f32 {
    (0.5 - distance / width).clamp(0.0, 1.0)
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "these values are exact")]
mod tests {
    use super::*;

    fn at(pieces: &[Piece], [x, y, z]: [f32; 3]) -> f32 {
        let mut distance = [FAR];
        Solid::new(pieces).slice(z).lay(&[x], y, &mut distance);
        distance[0]
    }

    #[test]
    fn distances_are_exact_at_boxes_and_capsules_and_on_the_axes_of_ellipsoids() {
        let near = |a: f32, b: f32| assert!((a - b).abs() < 1e-4, "{a} for {b}");
        near(at(&[Piece::block([1.0, 2.0, 3.0], [4.0, 5.0, 6.0], 1.0)], [6.5, 2.0, 3.0]), 1.5);
        let rod = [Piece::capsule([0.0; 3], [0.0, 10.0, 0.0], [2.0, 4.0])];
        near(at(&rod, [3.0, 5.0, 1.0]), 10.0_f32.sqrt() - 3.0);
        near(at(&[Piece::ellipsoid([0.0; 3], [3.0, 6.0, 9.0])], [0.0, 0.0, 11.0]), 2.0);
        let turned = [Piece::ellipsoid([0.0; 3], [3.0, 6.0, 9.0]).turned(90.0, 0.0)];
        near(at(&turned, [7.0, 0.0, 0.0]), 1.0);
    }

    #[test]
    fn what_is_cut_is_gone_and_what_is_mirrored_is_on_both_sides() {
        let ear = Piece::ellipsoid([8.0, 0.0, 0.0], [2.0; 3]).both();
        let head = [Piece::ellipsoid([0.0; 3], [9.0; 3]), ear.cut()];
        assert!(at(&head, [0.0; 3]) < 0.0);
        assert!(at(&head, [8.0, 0.0, 0.0]) > 1.0 && at(&head, [-8.0, 0.0, 0.0]) > 1.0);
        assert_eq!(at(&[ear], [-8.0, 1.0, 0.0]), at(&[ear], [8.0, 1.0, 0.0]));
    }

    #[test]
    fn bounds_change_no_distance_near_a_surface() {
        let pieces = [
            Piece::ellipsoid([0.0; 3], [20.0, 6.0, 9.0]).turned(30.0, 20.0),
            Piece::block([9.0, 1.0, 2.0], [8.0, 5.0, 6.0], 1.0).turned(-40.0, 10.0).soft(6.0),
            Piece::capsule([-20.0, 0.0, 0.0], [5.0, 9.0, 9.0], [3.0, 1.0]).cut().soft(12.0),
        ];
        let whole = Solid(Solid::new(&pieces).0.iter().map(unbounded).collect());
        for i in 0..40_000_u16 {
            let [x, y, z] = [i % 40, i / 40 % 40, i / 1600].map(|n| 1.3 * f32::from(n) - 26.0);
            let mut free = [FAR];
            whole.slice(z).lay(&[x], y, &mut free);
            let bounded = at(&pieces, [x, y, z]);
            if free[0].abs() < 3.0 || bounded.abs() < 3.0 {
                assert_eq!(bounded, free[0], "at {x}, {y}, {z}");
            }
        }
    }

    fn unbounded(placed: &Placed) -> Placed {
        Placed { low: [-FAR; 3], high: [FAR; 3], ..placed.clone() }
    }
}
