//! What rays count for a pixel: the mean over it of the cubics of Catmull and Rom (Keys 1981) through the rays around.
//!
//! A pixel spreads along each axis of the lattice by as much as its sides do; the mean over so wide a part of the cubics is a
//! function of how far the pixel's middle is behind a ray, in pieces of the fourth power that reach over six rays. Here it is
//! cubic in each distance between rays, equal at four places of it, and of four rays: what the outermost two count goes to
//! their neighbours so that straight lines stay straight, and the picture is continuous. Up to [`WIDEST`] rays that is as near
//! as the mean itself (within .1 dB), and takes what the cubics alone take.

use glam::DVec2;

use crate::view::voxel_rays::LatticePlaces;

/// Most rays across a pixel.
const WIDEST: f64 = 2.0;
/// Bounds what a width is divided by.
const NARROWEST: f64 = 1e-4;

/// By powers of how far a place is behind a ray, 0..1: what the ray before that one, it, the next and the one beyond count.
pub(super) type Powers = [[f32; 4]; 4];

/// The weights of rays along both axes of their lattice.
pub(super) struct Cubics {
    pub across: Powers,
    pub down: Powers,
}

impl Cubics {
    /// For pixels of a picture; `None` where a pixel is wider than [`WIDEST`].
    pub fn of(places: &LatticePlaces) -> Option<Self> {
        let [right, down] = [places.right, places.down];
        let width = DVec2::new(right.x.hypot(down.x), right.y.hypot(down.y));
        // A hair more, for what is rounded.
        let fits = width.max_element() <= WIDEST * (1.0 + 1e-9);
        fits.then(|| Self { across: powers(width.x), down: powers(width.y) })
    }
}

/// The weights for a mean over so many rays.
fn powers(width: f64) -> Powers {
    let parts = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
    let [first, second, third, last] = parts.map(|part| weights(part, width.max(NARROWEST)));
    // At a ray only three count, so that what is before it and what is behind it end alike.
    let first = [first[0], first[1] - first[3], first[2] + 2.0 * first[3], 0.0];
    let last = [0.0, last[1] + 2.0 * last[0], last[2] - last[0], last[3]];
    let four = [first, second, third, last];
    let mut powers = [[0.0; 4]; 4];
    for ray in 0..4 {
        let [a, b, c, d] = four.map(|weights| weights[ray]);
        let of = [
            a,
            -5.5 * a + 9.0 * b - 4.5 * c + d,
            9.0 * a - 22.5 * b + 18.0 * c - 4.5 * d,
            4.5 * (d - a) + 13.5 * (b - c),
        ];
        for (power, of) in powers.iter_mut().zip(of) {
            power[ray] = of as f32;
        }
    }
    powers
}

/// What four rays count for a mean over `width` whose middle is so far behind the second, 0..=1.
fn weights(part: f64, width: f64) -> [f64; 4] {
    let mean = |ray: i32| {
        let from = f64::from(ray) - part - 0.5 * width;
        (area(from + width) - area(from)) / width
    };
    let [first, a, b, c, d, last] = [-2, -1, 0, 1, 2, 3].map(mean);
    [a + 2.0 * first, b - first, c - last, d + 2.0 * last]
}

/// Of the kernel of Catmull and Rom, from its middle to `x` rays behind.
fn area(x: f64) -> f64 {
    let t = x.abs().min(2.0);
    let area = if t < 1.0 {
        ((0.375 * t - 2.5 / 3.0) * t * t + 1.0) * t
    } else {
        let t = 2.0 - t;
        0.5 + (0.5 / 3.0 - 0.125 * t) * t * t * t
    };
    area.copysign(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::components::Filter;
    use crate::volume::filter::Taps;

    fn at(powers: &Powers, part: f32) -> [f32; 4] {
        let [none, first, second, third] = *powers;
        std::array::from_fn(|n| ((third[n] * part + second[n]) * part + first[n]) * part + none[n])
    }

    fn parts() -> impl Iterator<Item = f32> {
        (0..=64).map(|n| n as f32 / 64.0)
    }

    #[test]
    fn what_is_narrow_is_the_cubic_at_its_place() {
        let powers = powers(0.0);
        for part in parts() {
            let expected = Taps::new(Filter::CatmullRom, part).weights;
            for (made, expected) in at(&powers, part).into_iter().zip(expected) {
                assert!((made - expected).abs() < 1e-6, "{part} {made} {expected}");
            }
        }
    }

    #[test]
    fn what_is_wide_is_the_mean_over_so_many_cubics() {
        for width in [0.3, 0.7, 1.0, 1.5, 2.0] {
            let powers = powers(width);
            for part in parts() {
                let mut mean = [0.0; 8];
                for n in 0..4096 {
                    let place = f64::from(part) + width * ((f64::from(n) + 0.5) / 4096.0 - 0.5);
                    let taps = Taps::new(Filter::CatmullRom, (place - place.floor()) as f32);
                    for (ray, weight) in taps.weights.into_iter().enumerate() {
                        mean[(place.floor() + 2.0) as usize + ray] += f64::from(weight) / 4096.0;
                    }
                }
                let [_, first, a, b, c, d, last, _] = mean;
                let expected = [a + 2.0 * first, b - first, c - last, d + 2.0 * last];
                for (made, expected) in at(&powers, part).into_iter().zip(expected) {
                    let off = (f64::from(made) - expected).abs();
                    assert!(off < 0.042, "{width} {part} {made} {expected}");
                }
            }
        }
    }

    #[test]
    fn it_is_the_mean_itself_between_rays_and_continuous_at_them() {
        for width in [0.3, 1.0, 2.0] {
            let powers = powers(width);
            for part in [1.0 / 3.0, 2.0 / 3.0] {
                let expected = weights(part, width);
                for (made, expected) in at(&powers, part as f32).into_iter().zip(expected) {
                    assert!((f64::from(made) - expected).abs() < 2e-6, "{width} {part}");
                }
            }
            let ([a, b, c, none], [still, d, e, f]) = (at(&powers, 0.0), at(&powers, 1.0));
            let off = [none, still, a - d, b - e, c - f]
                .into_iter()
                .fold(0.0, |n: f32, off| n.max(off.abs()));
            assert!(off < 2e-6, "{width} {off}");
        }
    }

    #[test]
    fn what_is_even_stays_even_and_straight_lines_straight() {
        for width in [0.0, 0.4, 1.0, 1.7, 2.0] {
            let powers = powers(width);
            for part in parts() {
                let weights = at(&powers, part);
                let moment = 2.0 * weights[3] + weights[2] - weights[0];
                assert!((weights.iter().sum::<f32>() - 1.0).abs() < 2e-6, "{width} {part}");
                assert!((moment - part).abs() < 4e-6, "{width} {part} {moment}");
            }
        }
    }
}
