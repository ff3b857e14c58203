//! The vocabulary of phantoms: implicit shapes, joined and cut smoothly, evaluated a row of voxels at a time.
//!
//! Distances are in millimetres, negative inside, of first order at a surface (exact for capsules and boxes). Only
//! + − × ÷ √ and comparisons reach a voxel, so the bits are the same on every machine.

/// Farther than anything: the distance before any piece is laid.
pub const FAR: f32 = 1e3;

/// Depth under a cut's surface to which distances stay continuous, mm: no layer of tissue lies deeper.
const REACH: f32 = 9.0;

/// One entry of a table of anatomy: a shape, and how it changes what was laid before it.
#[derive(Debug, Clone, Copy)]
pub struct Piece {
    form: Form,
    center: [f32; 3],
    yaw_degrees: f32,
    pitch_degrees: f32,
    soft: f32,
    cut: bool,
    mirrored: bool,
}

#[derive(Debug, Clone, Copy)]
enum Form {
    Ellipsoid { radii: [f32; 3] },
    Block { half: [f32; 3], round: f32 },
    Capsule { to: [f32; 3], radii: [f32; 2] },
}

impl Piece {
    const fn new(center: [f32; 3], form: Form) -> Self {
        Self {
            form,
            center,
            yaw_degrees: 0.0,
            pitch_degrees: 0.0,
            soft: 1.0,
            cut: false,
            mirrored: false,
        }
    }

    /// An ellipsoid.
    pub const fn ellipsoid(center: [f32; 3], radii: [f32; 3]) -> Self {
        Self::new(center, Form::Ellipsoid { radii })
    }

    /// A box of half sides `half`, its edges rounded by `round` within them.
    pub const fn block(center: [f32; 3], half: [f32; 3], round: f32) -> Self {
        Self::new(center, Form::Block { half, round })
    }

    /// A rod with round ends from `from` to `to`, of one radius at each end.
    pub const fn capsule(from: [f32; 3], to: [f32; 3], radii: [f32; 2]) -> Self {
        Self::new(from, Form::Capsule { to, radii })
    }

    /// Blended into what was laid before over `soft` mm.
    pub const fn soft(mut self, soft: f32) -> Self {
        self.soft = soft;
        self
    }

    /// Taken away from what was laid before.
    pub const fn cut(mut self) -> Self {
        self.cut = true;
        self
    }

    /// Laid a second time on the other side of x = 0.
    pub const fn both(mut self) -> Self {
        self.mirrored = true;
        self
    }

    /// Turned about its centre: first by `pitch` about x (+y towards +z), then by `yaw` about z (+x towards +y).
    pub const fn turned(mut self, yaw_degrees: f32, pitch_degrees: f32) -> Self {
        self.yaw_degrees = yaw_degrees;
        self.pitch_degrees = pitch_degrees;
        self
    }

    fn mirror(mut self) -> Self {
        self.center[0] = -self.center[0];
        self.yaw_degrees = -self.yaw_degrees;
        if let Form::Capsule { to, .. } = &mut self.form {
            to[0] = -to[0];
        }
        self
    }

    /// The axes of the piece as rows.
    fn axes(&self) -> [[f32; 3]; 3] {
        let (sy, cy) = libm::sincosf(self.yaw_degrees.to_radians());
        let (sp, cp) = libm::sincosf(self.pitch_degrees.to_radians());
        [[cy, sy, 0.0], [-sy * cp, cy * cp, sp], [sy * sp, -cy * sp, cp]]
    }
}

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
                Form::Ellipsoid { radii } => (-across(radii), across(radii)),
                Form::Block { half, .. } => (-across(half), across(half)),
                Form::Capsule { to, radii } => {
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
            Form::Ellipsoid { radii } => {
                let scale = radii.map(|r| 1.0 / r);
                self.fold(xs, out, |x| ellipsoid(local(x), scale));
            }
            Form::Block { half, round } => self.fold(xs, out, |x| block(local(x), half, round)),
            Form::Capsule { to, radii } => {
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

/// The lesser of two distances, rounded where they differ by less than `soft`; `quarter` is 0.25 / soft.
fn smooth_union(a: f32, b: f32, soft: f32, quarter: f32) -> f32 {
    let h = (soft - (a - b).abs()).max(0.0);
    a.min(b) - h * h * quarter
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: [f32; 3]) -> f32 {
    dot(a, a).sqrt()
}

fn ellipsoid(p: [f32; 3], scale: [f32; 3]) -> f32 {
    let q: [f32; 3] = std::array::from_fn(|i| p[i] * scale[i]);
    let reach = length(q);
    let slope = length(std::array::from_fn(|i| q[i] * scale[i]));
    // The tiny term stands for the slope at the very centre, where it is 0.
    reach * (reach - 1.0) / (slope + 1e-6)
}

fn block(p: [f32; 3], half: [f32; 3], round: f32) -> f32 {
    let q: [f32; 3] = std::array::from_fn(|i| p[i].abs() - half[i] + round);
    let inside = q[0].max(q[1]).max(q[2]).min(0.0);
    length(q.map(|a| a.max(0.0))) + inside - round
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
    pub fn lay(&self, xs: &[f32], y: f32, out: &mut [f32]) -> std::ops::Range<usize> {
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
