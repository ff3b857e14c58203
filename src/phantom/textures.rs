//! Textures made by formula, 256 texels a side: to be projected through a volume (paper §5, figure 9) or put on polygons.

use glam::{Vec2, Vec3};

use super::choice::choose;
use crate::view::picture::Picture;

/// Texels on each side.
const SIDE: usize = 256;

/// Bytes that the picture of a formula takes.
pub const TEXTURE_BYTES: u64 = (SIDE * SIDE * size_of::<[f32; 4]>()) as u64;

/// The colour of a texel at its centre, in texels from the upper left corner.
type Formula = fn(Vec2) -> [f32; 4];

/// Every texture: its name and its formula.
const TEXTURES: [(&str, Formula); 4] =
    [("grid", grid), ("checker", checker), ("portrait", portrait), ("disc", disc)];

/// The texture made by the formula called `name`: 256 × 256 texels, opaque.
///
/// `grid` is a filtered rectangular grid of dark lines on white, `checker` squares of black and white (both repeat
/// without a seam), `portrait` a drawn face in colour, `disc` a soft white disc on black. The error for an unknown
/// name is a sentence that lists the names.
pub fn texture(name: &str) -> Result<Picture, String> {
    let formula = choose(&TEXTURES, name, "texture formula")?;
    let place = |i: usize| Vec2::new((i % SIDE) as f32 + 0.5, (i / SIDE) as f32 + 0.5);
    let pixels = (0..SIDE * SIDE).map(|i| formula(place(i))).collect();
    Picture::new([SIDE; 2], pixels).ok_or_else(|| format!("texture formula `{name}` has a gap"))
}

/// Passes if there is a texture formula called `name`; the error is a sentence that lists the names.
pub fn is_texture(name: &str) -> Result<(), String> {
    choose(&TEXTURES, name, "texture formula").map(|_| ())
}

fn grey(value: f32) -> [f32; 4] {
    [value, value, value, 1.0]
}

/// Lines 4 texels wide, every 32, half-covered at their edges' texels: a box filter 2 texels wide.
fn grid(at: Vec2) -> [f32; 4] {
    let line = |t: f32| (0.5 + (2.0 - (t % 32.0 - 16.0).abs()) / 2.0).clamp(0.0, 1.0);
    let open = (1.0 - line(at.x)) * (1.0 - line(at.y));
    grey(0.25 + 0.75 * open)
}

/// Squares of 32 texels, sharp to the texel.
fn checker(at: Vec2) -> [f32; 4] {
    let odd = (at.x as usize / 32 + at.y as usize / 32) % 2;
    grey(1.0 - odd as f32)
}

/// A disc of radius 104 texels at half its brightness, with an edge 32 texels wide.
fn disc(at: Vec2) -> [f32; 4] {
    let t = (0.5 + (104.0 - at.distance(Vec2::splat(128.0))) / 32.0).clamp(0.0, 1.0);
    grey(t * t * (3.0 - 2.0 * t))
}

/// One stroke of the portrait: an ellipse in texels and a linear colour; mirrored about the middle if `both`.
struct Stroke {
    center: [f32; 2],
    radii: [f32; 2],
    color: [f32; 3],
    both: bool,
}

const fn one(center: [f32; 2], radii: [f32; 2], color: [f32; 3]) -> Stroke {
    Stroke { center, radii, color, both: false }
}

const fn two(center: [f32; 2], radii: [f32; 2], color: [f32; 3]) -> Stroke {
    Stroke { center, radii, color, both: true }
}

const HAIR: [f32; 3] = [0.06, 0.03, 0.015];
const SKIN: [f32; 3] = [0.80, 0.48, 0.33];
const SHADE: [f32; 3] = [0.60, 0.31, 0.20];
const LIP: [f32; 3] = [0.52, 0.10, 0.10];

/// The portrait, painted in this order.
const STROKES: [Stroke; 24] = [
    one([128.0, 112.0], [86.0, 98.0], HAIR),
    one([128.0, 274.0], [104.0, 52.0], [0.10, 0.16, 0.42]),
    one([128.0, 212.0], [28.0, 38.0], SHADE),
    two([56.0, 134.0], [12.0, 20.0], SHADE),
    one([128.0, 132.0], [70.0, 86.0], SKIN),
    two([84.0, 158.0], [17.0, 12.0], [0.84, 0.42, 0.32]),
    one([128.0, 40.0], [66.0, 32.0], HAIR),
    two([80.0, 56.0], [26.0, 25.0], HAIR),
    two([98.0, 100.0], [19.0, 5.0], HAIR),
    two([98.0, 105.0], [18.0, 5.0], SKIN),
    two([98.0, 120.0], [16.0, 9.5], HAIR),
    two([98.0, 121.5], [15.0, 8.0], [0.95, 0.95, 0.93]),
    two([98.0, 121.0], [8.0, 8.0], [0.06, 0.22, 0.30]),
    two([98.0, 121.0], [4.0, 4.0], [0.01, 0.01, 0.01]),
    two([100.0, 118.5], [1.8, 1.8], [1.0, 1.0, 1.0]),
    one([128.0, 152.0], [14.0, 11.0], SHADE),
    one([128.0, 149.0], [13.0, 10.5], SKIN),
    one([128.0, 134.0], [8.0, 22.0], [0.86, 0.54, 0.38]),
    two([121.5, 157.5], [3.0, 1.8], HAIR),
    one([128.0, 184.0], [30.0, 13.0], LIP),
    one([128.0, 182.5], [24.0, 5.5], [0.92, 0.90, 0.86]),
    one([128.0, 171.5], [36.0, 8.5], SKIN),
    one([128.0, 169.0], [4.0, 6.0], [0.72, 0.40, 0.27]),
    one([128.0, 203.0], [13.0, 3.0], [0.72, 0.40, 0.27]),
];

/// A face before a wall that darkens downwards.
fn portrait(at: Vec2) -> [f32; 4] {
    let wall = Vec3::new(0.42, 0.62, 0.66) * (1.0 - 0.4 * at.y / SIDE as f32);
    let painted = STROKES.iter().fold(wall, |below, stroke| {
        let x = if stroke.both && at.x > 128.0 { 256.0 - at.x } else { at.x };
        let cover = ellipse(Vec2::new(x, at.y), stroke);
        below.lerp(Vec3::from(stroke.color), cover)
    });
    [painted.x, painted.y, painted.z, 1.0]
}

/// The part of a texel within a stroke: a ramp 1.5 texels wide about its edge.
fn ellipse(at: Vec2, stroke: &Stroke) -> f32 {
    let from = at - Vec2::from(stroke.center);
    let scaled = from / Vec2::from(stroke.radii);
    let reach = scaled.length();
    let slope = (scaled / Vec2::from(stroke.radii)).length() + 1e-6;
    (0.5 - reach * (reach - 1.0) / slope / 1.5).clamp(0.0, 1.0)
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "these values are exact")]
mod tests {
    use super::*;

    #[test]
    fn every_texture_is_opaque_and_within_the_range_of_light() {
        for (name, _) in TEXTURES {
            let picture = texture(name).unwrap();
            assert_eq!(picture.size, [256, 256], "{name}");
            let sound = |&[r, g, b, a]: &[f32; 4]| {
                a == 1.0 && [r, g, b].iter().all(|c| (0.0..=1.0).contains(c))
            };
            assert!(picture.pixels.iter().all(sound), "{name}");
        }
    }

    #[test]
    fn the_grid_and_the_checker_repeat_without_a_seam() {
        let (grid, checker) = (texture("grid").unwrap(), texture("checker").unwrap());
        for y in 0..256 {
            for x in 0..256 {
                assert_eq!(grid.pixel(x, y), grid.pixel((x + 32) % 256, (y + 224) % 256));
                assert_eq!(
                    checker.pixel(x, y),
                    checker.pixel((x + 64) % 256, (y + 224 + 32) % 256)
                );
            }
        }
    }

    #[test]
    fn a_line_of_the_grid_takes_four_texels_of_each_period() {
        let picture = texture("grid").unwrap();
        let dark: f32 = (0..32).map(|x| (1.0 - picture.pixel(x, 0)[0]) / 0.75).sum();
        assert!((dark - 4.0).abs() < 1e-5, "{dark}");
        assert_eq!(picture.pixel(0, 0)[0], 1.0);
        assert_eq!(picture.pixel(16, 0)[0], 0.25);
    }

    #[test]
    fn an_unknown_texture_is_answered_with_the_names() {
        let sentence = texture("gird").unwrap_err();
        assert!(TEXTURES.iter().all(|(name, _)| sentence.contains(name)), "{sentence}");
    }
}
