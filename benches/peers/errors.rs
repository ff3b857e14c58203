//! How far a picture is from a reference, after it was moved to where it fits best: peers place their pixels in their own way.

/// A picture's luminance in linear light, the top row first.
#[derive(Clone)]
pub struct Grey {
    pub width: usize,
    pub pixels: Vec<f32>,
}

/// The error of a picture that was moved.
#[derive(Clone, Copy)]
pub struct Registered {
    /// Peak signal-to-noise ratio against 1, decibels.
    pub decibels: f64,
    /// Pixels that it was moved by, right and down.
    pub shift: [f64; 2],
}

/// Pixels along the border that are left out, so that no shift brings in what was not drawn.
const BORDER: usize = 8;

impl Grey {
    /// Luminance of linear RGB.
    pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    /// The mean square of the differences from `reference`, of the picture moved by `shift` pixels.
    fn error(&self, reference: &Self, shift: [f64; 2]) -> f64 {
        let whole = shift.map(f64::floor);
        let [right, down] = [0, 1].map(|axis| (shift[axis] - whole[axis]) as f32);
        let (width, height) = (self.width, self.pixels.len() / self.width);
        let row = |y: usize| &self.pixels[y * width..][..width];
        let mut sum = 0.0;
        for y in BORDER..height - BORDER {
            let from = (y as f64 - whole[1]) as usize;
            let (lower, upper) = (row(from), row(from - 1));
            for x in BORDER..width - BORDER {
                let at = (x as f64 - whole[0]) as usize;
                let along = |row: &[f32]| row[at] + (row[at - 1] - row[at]) * right;
                let moved = along(lower) + (along(upper) - along(lower)) * down;
                sum += f64::from(moved - reference.pixels[y * width + x]).powi(2);
            }
        }
        sum / ((width - 2 * BORDER) * (height - 2 * BORDER)) as f64
    }

    /// The error against `reference` where the picture fits best: within four pixels, to a sixteenth of one.
    pub fn registered(&self, reference: &Self) -> Registered {
        let mut best = (self.error(reference, [0.0; 2]), [0.0; 2]);
        let mut step = 2.0;
        while step >= 1.0 / 16.0 {
            let middle = best.1;
            for (x, y) in (-2..=2).flat_map(|y| (-2..=2).map(move |x| (x, y))) {
                let shift = [middle[0] + f64::from(x) * step, middle[1] + f64::from(y) * step];
                if shift.iter().any(|pixels: &f64| pixels.abs() > 4.0) {
                    continue;
                }
                let error = self.error(reference, shift);
                if error < best.0 {
                    best = (error, shift);
                }
            }
            step /= 2.0;
        }
        Registered { decibels: -10.0 * best.0.log10(), shift: best.1 }
    }
}
