//! Which polygons the rays of each beam may meet, and which rays of it.

use super::beams::{Beams, Patch, SIDE};
use super::lanes::Lanes;
use super::projected::ProjectedFace;
use super::targets::Outlines;
use crate::view::camera::Camera;

/// Window coordinates (pixels) up to which a beam that no edge crosses is sure to be of one side of each, for all that is
/// rounded.
const SURE: f64 = 1e6;

/// A polygon that is near a beam.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Near {
    /// Its number among the faces seen.
    pub face: u32,
    /// The first and the last column and row of the beam's positions that may be in it.
    across: [u8; 2],
    down: [u8; 2],
    /// Whether all of the beam is in it.
    pub whole: bool,
}

/// For each beam the polygons near it, in the order of the scene.
pub(crate) struct Binned {
    /// For each beam: its part of `near`.
    starts: Vec<u32>,
    near: Vec<Near>,
}

/// The beams that faces are near to, each with the positions that it may be met at; the number of the first is `first`.
pub(crate) fn near(
    faces: &[ProjectedFace],
    patches: &[Patch],
    first: u32,
    beams: &Beams,
) -> Vec<(u32, Near)> {
    let mut found = Vec::with_capacity(faces.len() * 3 / 2);
    let mut marks = None;
    for (number, (face, patch)) in (first..).zip(faces.iter().zip(patches)) {
        let of = |axis: usize| patch.first[axis] as usize / SIDE..=patch.last[axis] as usize / SIDE;
        let (columns, rows) = (of(0), of(1));
        let is_wide = columns.end() - columns.start() > 1 || rows.end() - rows.start() > 1;
        let wide = is_wide.then(|| marks.get_or_insert_with(|| Wide::new(beams)));
        let mut wide = wide.and_then(|wide| wide.mark(face, beams).then_some(wide));
        for row in rows {
            for column in columns.clone() {
                let whole = wide.as_ref().and_then(|wide| wide.side(face, [column, row], beams));
                if whole != Some(false) {
                    let near = Near::new(number, patch, [column, row], whole.is_some());
                    found.push(((row * beams.counts[0] + column) as u32, near));
                }
            }
        }
        if let Some(wide) = &mut wide {
            wide.clear(patch, beams);
        }
    }
    found
}

impl Binned {
    /// Sorts what is near to beams, of which there are so many, by them, each in the order that it was found in.
    pub fn new(found: &[Vec<(u32, Near)>], beams: usize) -> Self {
        let mut starts = vec![0_u32; beams + 1];
        found.iter().flatten().for_each(|(beam, _)| starts[*beam as usize + 1] += 1);
        for beam in 1..starts.len() {
            starts[beam] += starts[beam - 1];
        }
        let Some((_, any)) = found.iter().flatten().next() else {
            return Self { starts, near: Vec::new() };
        };
        let (mut next, mut near) = (starts.clone(), vec![*any; starts[beams] as usize]);
        for (beam, found) in found.iter().flatten() {
            let at = &mut next[*beam as usize];
            near[*at as usize] = *found;
            *at += 1;
        }
        Self { starts, near }
    }

    /// Whether no polygon is near any beam.
    pub fn is_empty(&self) -> bool {
        self.near.is_empty()
    }

    /// The polygons near a beam.
    pub fn near(&self, beam: usize) -> &[Near] {
        &self.near[self.starts[beam] as usize..self.starts[beam + 1] as usize]
    }
}

impl Near {
    fn new(face: u32, patch: &Patch, beam: [usize; 2], whole: bool) -> Self {
        let within = |axis: usize| {
            let first = (beam[axis] * SIDE) as u32;
            let [from, to] = [patch.first, patch.last].map(|end| end[axis]);
            [from.max(first) - first, to.min(first + SIDE as u32 - 1) - first].map(|n| n as u8)
        };
        Self { face, across: within(0), down: within(1), whole }
    }
}

/// Where in their beam some rays of a packet are: for every column and row, those of them to one side of it.
pub(crate) struct Spread {
    /// For each axis and each number: the rays from that column or row on, and those up to it.
    from: [[Lanes; SIDE]; 2],
    to: [[Lanes; SIDE]; 2],
}

impl Spread {
    /// Where the rays `lanes` are, by their places in the array.
    pub fn of(lanes: impl Iterator<Item = usize>, place: impl Fn(usize) -> [usize; 2]) -> Self {
        let mut from: [[Lanes; SIDE]; 2] = [[0; SIDE]; 2];
        for lane in lanes {
            let [x, y] = place(lane).map(|n| n % SIDE);
            from[0][x] |= 1 << lane;
            from[1][y] |= 1 << lane;
        }
        let mut to = from;
        for axis in 0..2 {
            for n in 1..SIDE {
                to[axis][n] |= to[axis][n - 1];
                from[axis][SIDE - 1 - n] |= from[axis][SIDE - n];
            }
        }
        Self { from, to }
    }

    /// Those of the rays that may meet a polygon near their beam.
    #[inline]
    pub fn met(&self, near: &Near) -> Lanes {
        let within = |axis: usize, [first, last]: [u8; 2]| {
            self.from[axis][usize::from(first) % SIDE] & self.to[axis][usize::from(last) % SIDE]
        };
        within(0, near.across) & within(1, near.down)
    }
}

/// Which beams the edges of a wide polygon cross.
struct Wide(Outlines);

impl Wide {
    fn new(beams: &Beams) -> Self {
        let [across, down] = beams.counts;
        Self(Outlines { side: SIDE, across, crossed: vec![false; across * down] })
    }

    /// Marks the beams that edges of a face cross; whether the others are sure to be of one side.
    fn mark(&mut self, face: &ProjectedFace, beams: &Beams) -> bool {
        if face.outlines().vertices().any(|v| !v.is_finite() || v.abs().max_element() >= SURE) {
            return false;
        }
        for (p, q) in face.outlines().edges() {
            let [p, q] = [p, q].map(|window| self.0.square(&beams.layout, window));
            self.0.mark(p, q);
        }
        true
    }

    /// Whether a beam lies in a face, all of it; `None` where edges cross it.
    fn side(&self, face: &ProjectedFace, [x, y]: [usize; 2], beams: &Beams) -> Option<bool> {
        let margin = beams.layout.margin as i64;
        let first = [x, y].map(|n| (n * SIDE) as i64 - margin);
        let crossed = self.0.crossed[y * self.0.across + x];
        (!crossed).then(|| face.holds(Camera::window(first)))
    }

    /// Takes the marks away of a face that has rays at a patch: its edges are no farther from them than the next rays are.
    fn clear(&mut self, patch: &Patch, beams: &Beams) {
        let reach = beams.finest.div_ceil(SIDE);
        let of = |axis: usize| {
            let first = (patch.first[axis] as usize / SIDE).saturating_sub(reach);
            first..(patch.last[axis] as usize / SIDE + reach + 1).min(beams.counts[axis])
        };
        for row in of(1) {
            let row = row * self.0.across;
            self.0.crossed[row + of(0).start..row + of(0).end].fill(false);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::super::lanes::each;
    use super::*;
    use crate::polygon::face::Face;
    use crate::view::samples::Layout;

    const SIZE: [usize; 2] = [40, 24];

    /// A camera that sees the plane z = 0 upright, a pixel a unit: window (x, y) is (x, −y).
    fn camera() -> Camera {
        let focal = DVec3::new(SIZE[0] as f64 / 2.0, SIZE[1] as f64 / -2.0, 0.0);
        let (right, up, forward) = (DVec3::X, DVec3::Y, DVec3::NEG_Z);
        Camera { right, up, forward, focal, pixel: 1.0, size: SIZE, eye: None }
    }

    /// Triangles from far smaller than a pixel to far larger than the picture, and a square with a hole.
    fn outlines() -> Vec<Vec<Vec<DVec3>>> {
        let mut state = 1_u64;
        let mut random = move || {
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            (state >> 40) as f64 / (1_u64 << 24) as f64
        };
        let mut all: Vec<_> = (0..400)
            .map(|n| {
                let middle = DVec2::new(random() * 50.0 - 5.0, random() * 34.0 - 5.0);
                let reach = [0.1, 0.7, 3.0, 20.0, 1e3][n % 5];
                let mut corner = || {
                    let off = DVec2::new(random() - 0.5, random() - 0.5) * reach;
                    let at = middle + if n % 3 == 0 { (off * 4.0).round() / 4.0 } else { off };
                    DVec3::new(at.x, -at.y, 0.0)
                };
                vec![vec![corner(), corner(), corner()]]
            })
            .collect();
        let square = |low: f64, high: f64| {
            let corners = [(low, low), (high, low), (high, high), (low, high)];
            corners.map(|(x, y)| DVec3::new(x, -y, 0.0)).to_vec()
        };
        all.push(vec![square(-1e3, 1e3), square(9.0, 19.3)]);
        all
    }

    #[test]
    fn rays_find_every_face_that_holds_them_and_no_other() {
        let camera = camera();
        let faces: Vec<Face> =
            outlines().into_iter().filter_map(|outlines| Face::new(outlines).ok()).collect();
        assert!(faces.len() > 300, "{}", faces.len());
        let everywhere = Patch { first: [0; 2], last: [u32::MAX; 2] };
        let of = |face, patch: &dyn Fn([DVec2; 2]) -> Option<Patch>| {
            ProjectedFace::new(face, [0; 2], &camera, patch)
        };
        let all: Vec<_> = faces.iter().filter_map(|face| of(face, &|_| Some(everywhere))).collect();
        let layout = Layout::new(SIZE, 8, 6);
        let (mut whole, [across, down]) = (0, layout.positions());
        for finest in [1, 2, 4] {
            let beams = Beams::new(layout, finest);
            let seen = faces.iter().filter_map(|face| of(face, &|bounds| beams.patch(bounds)));
            let (patches, seen): (Vec<_>, Vec<_>) = seen.unzip();
            assert!(seen.len() < faces.len() - 40 || finest < 4, "some are between all rays");
            let found = near(&seen, &patches, 0, &beams);
            let binned = Binned::new(&[found], beams.counts[0] * beams.counts[1]);
            // The rays of a beam in one row of positions.
            for (y, x) in (0..down)
                .step_by(finest)
                .flat_map(|y| (0..beams.counts[0]).map(move |x| (y, x * SIDE)))
            {
                let place = |lane: usize| [x + lane, y];
                let window = |lane: usize| {
                    Camera::window(place(lane).map(|n| n as i64 - layout.margin as i64))
                };
                let lanes = (0..SIDE.min(across - x)).step_by(finest);
                let spread = Spread::of(lanes.clone(), place);
                let mut found = vec![Vec::new(); SIDE];
                for near in binned.near(beams.around([x, y])) {
                    whole += usize::from(near.whole);
                    let face = &seen[near.face as usize];
                    for lane in
                        each(spread.met(near)).filter(|n| near.whole || face.holds(window(*n)))
                    {
                        found[lane].push(near.face);
                    }
                }
                for lane in lanes {
                    let numbers = (0_u32..).zip(&seen).filter(|(_, face)| face.holds(window(lane)));
                    let held: Vec<u32> = numbers.map(|(number, _)| number).collect();
                    assert_eq!(found[lane], held, "{finest} {x} {y}");
                    let any = all.iter().filter(|(_, face)| face.holds(window(lane)));
                    assert_eq!(held.len(), any.count(), "{finest} {x} {y}");
                }
            }
        }
        assert!(whole > 1000, "{whole}");
    }
}
