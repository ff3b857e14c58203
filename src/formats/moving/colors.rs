//! How far two colors are apart to the eye, roughly, and the nearest one of a few.

/// Weights of red, green and blue in squared differences of sRGB codes.
const WEIGHTS: [f32; 3] = [3.0, 4.0, 2.0];

/// A color of sRGB codes 0..=255, between codes too.
pub type Point = [f32; 3];

/// The point of a code.
pub fn point(code: [u8; 3]) -> Point {
    code.map(f32::from)
}

/// The weighed product of two differences: of one with itself, how large it is, squared.
pub fn dot(a: Point, b: Point) -> f32 {
    WEIGHTS[0] * a[0] * b[0] + WEIGHTS[1] * a[1] * b[1] + WEIGHTS[2] * a[2] * b[2]
}

/// `a − b`.
pub(crate) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The place of the nearest color, the first of equally near ones; 0 where there is none.
pub fn nearest(palette: &[Point], color: Point) -> usize {
    let (mut best, mut least) = (0, f32::INFINITY);
    for (at, entry) in palette.iter().enumerate() {
        let difference = minus(*entry, color);
        let distance = dot(difference, difference);
        if distance < least {
            (best, least) = (at, distance);
        }
    }
    best
}
