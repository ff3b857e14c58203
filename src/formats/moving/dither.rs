//! Ordered dithering between the two colors of a palette that a pixel lies between: a pattern that stays where it is from
//! frame to frame, and whose mean is the color that was meant.

use std::collections::HashMap;

use super::colors::{Point, dot, minus, nearest, point};

/// Two colors that are farther apart than this, squared and weighed, are not mixed: dots would be seen.
const FARTHEST: f32 = 9.0 * 40.0 * 40.0;

/// What dots count for, squared, against what is left over.
const DOTS: f32 = 0.02;

/// How a color is made of a palette.
#[derive(Clone, Copy)]
struct Blend {
    near: usize,
    far: usize,
    /// How much of `far` there is, in 64ths.
    share: u32,
}

/// The places in the palette that show the pixels of a frame `width` pixels across.
pub(crate) fn dithered(pixels: &[[u8; 3]], width: usize, palette: &[Point]) -> Vec<usize> {
    let mut known: HashMap<[u8; 3], Blend> = HashMap::new();
    let place = |(at, pixel): (usize, &[u8; 3])| {
        let mixture = known.entry(*pixel).or_insert_with(|| mixture(palette, point(*pixel)));
        let threshold = threshold(at % width.max(1), at / width.max(1));
        if mixture.share > threshold { mixture.far } else { mixture.near }
    };
    pixels.iter().enumerate().map(place).collect()
}

/// The color nearest to one, and the other that it is best mixed with: what is left over is small, and so are the dots.
fn mixture(palette: &[Point], color: Point) -> Blend {
    let near = nearest(palette, color);
    let alone = Blend { near, far: near, share: 0 };
    let Some(&first) = palette.get(near) else { return alone };
    let left = minus(color, first);
    let (mut best, mut least) = (alone, dot(left, left));
    for (far, entry) in palette.iter().enumerate() {
        let way = minus(*entry, first);
        let (length, along) = (dot(way, way), dot(left, way));
        if length > FARTHEST || along <= 0.0 {
            continue;
        }
        let share = (along / length).min(0.5);
        let over = minus(left, way.map(|channel| share * channel));
        let fault = dot(over, over) + DOTS * share * (1.0 - share) * length;
        if fault < least {
            (best, least) = (Blend { near, far, share: (share * 64.0).round() as u32 }, fault);
        }
    }
    best
}

/// Bayer's matrix of 8 × 8 (1973): each of 0..64 once, neighbors far apart.
fn threshold(x: usize, y: usize) -> u32 {
    let mut threshold = 0;
    for bit in 0..3 {
        let (x, y) = (x >> bit & 1, y >> bit & 1);
        threshold = threshold << 2 | ((x ^ y) << 1 | y) as u32;
    }
    threshold
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_dots_is_the_color_that_was_meant() {
        let palette = [[100.0; 3], [116.0; 3]];
        for gray in 100..=116_u8 {
            let places = dithered(&[[gray; 3]; 64], 8, &palette);
            let mean: f32 = places.iter().map(|place| palette[*place][0]).sum::<f32>() / 64.0;
            assert!((mean - f32::from(gray)).abs() <= 0.13, "{gray}: {mean}");
        }
    }

    #[test]
    fn every_threshold_stands_once_and_colors_far_apart_are_not_mixed() {
        let mut seen: Vec<_> = (0..64).map(|n| threshold(n % 8, n / 8)).collect();
        seen.sort_unstable();
        assert!(seen.iter().copied().eq(0..64));
        let places = dithered(&[[60; 3]; 64], 8, &[[0.0; 3], [200.0; 3]]);
        assert!(places.iter().all(|place| *place == 0));
    }
}
