//! The vocabulary of phantoms: implicit shapes, and how each changes what was laid before it.
//!
//! Distances are in millimetres, negative inside, of first order at a surface (exact for capsules and boxes). Only
//! + − × ÷ √ and comparisons reach a voxel, so the bits are the same on every machine.

/// One entry of a table of anatomy: a shape, and how it changes what was laid before it.
#[derive(Debug, Clone, Copy)]
pub struct Piece {
    pub form: Shape,
    pub center: [f32; 3],
    yaw_degrees: f32,
    pitch_degrees: f32,
    pub soft: f32,
    pub cut: bool,
    pub mirrored: bool,
}

/// The shape of a piece, about its centre or from it; lengths in millimetres.
#[derive(Debug, Clone, Copy)]
pub enum Shape {
    Ellipsoid { radii: [f32; 3] },
    Block { half: [f32; 3], round: f32 },
    Capsule { to: [f32; 3], radii: [f32; 2] },
}

impl Piece {
    const fn new(center: [f32; 3], form: Shape) -> Self {
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
        Self::new(center, Shape::Ellipsoid { radii })
    }

    /// A box of half sides `half`, its edges rounded by `round` within them.
    pub const fn block(center: [f32; 3], half: [f32; 3], round: f32) -> Self {
        Self::new(center, Shape::Block { half, round })
    }

    /// A rod with round ends from `from` to `to`, of one radius at each end.
    pub const fn capsule(from: [f32; 3], to: [f32; 3], radii: [f32; 2]) -> Self {
        Self::new(from, Shape::Capsule { to, radii })
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

    /// The piece on the other side of x = 0.
    pub fn mirror(mut self) -> Self {
        self.center[0] = -self.center[0];
        self.yaw_degrees = -self.yaw_degrees;
        if let Shape::Capsule { to, .. } = &mut self.form {
            to[0] = -to[0];
        }
        self
    }

    /// The axes of the piece as rows.
    pub fn axes(&self) -> [[f32; 3]; 3] {
        let (sy, cy) = libm::sincosf(self.yaw_degrees.to_radians());
        let (sp, cp) = libm::sincosf(self.pitch_degrees.to_radians());
        [[cy, sy, 0.0], [-sy * cp, cy * cp, sp], [sy * sp, -cy * sp, cp]]
    }
}

/// The lesser of two distances, rounded where they differ by less than `soft`; `quarter` is 0.25 / soft.
pub fn smooth_union(a: f32, b: f32, soft: f32, quarter: f32) -> f32 {
    let h = (soft - (a - b).abs()).max(0.0);
    a.min(b) - h * h * quarter
}

/// The scalar product.
pub fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The Euclidean length.
pub fn length(a: [f32; 3]) -> f32 {
    dot(a, a).sqrt()
}

/// The distance to an ellipsoid about the origin, of first order at its surface; `scale` is one over its radii.
pub fn ellipsoid(p: [f32; 3], scale: [f32; 3]) -> f32 {
    let q: [f32; 3] = std::array::from_fn(|i| p[i] * scale[i]);
    // At the very centre both would be 0, and so would the distance.
    let reach = length(q).max(1e-4);
    let slope = length(std::array::from_fn(|i| q[i] * scale[i]));
    let least = 1e-4 * scale[0].max(scale[1]).max(scale[2]);
    reach * (reach - 1.0) / slope.max(least)
}

/// The distance to a box about the origin with edges rounded by `round`.
pub fn block(p: [f32; 3], half: [f32; 3], round: f32) -> f32 {
    let q: [f32; 3] = std::array::from_fn(|i| p[i].abs() - half[i] + round);
    let inside = q[0].max(q[1]).max(q[2]).min(0.0);
    length(q.map(|a| a.max(0.0))) + inside - round
}
