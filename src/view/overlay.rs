//! What is drawn over a picture at the picture's resolution: rectangles and letters, in linear light.

use glam::{Vec2, Vec3, Vec4};

use super::lettering::Line;
use super::picture::Picture;
use crate::schedule::Product;
use crate::shared::Shared;

/// What lies over a view's picture, of its size; made where a scene states furniture that is drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Overlay(pub Picture);

impl Product for Overlay {}

/// Something to draw on, clear at first.
pub(crate) struct Canvas {
    size: [usize; 2],
    pixels: Vec<[f32; 4]>,
    /// The color of what is behind the picture, which letters are set off by from what lies before it.
    background: Option<Vec3>,
}

impl Canvas {
    /// A clear canvas of so many pixels across and down, before a color (linear) if there is one.
    #[must_use]
    pub fn new(size: [usize; 2], background: Option<Vec3>) -> Self {
        Self { size, pixels: vec![[0.0; 4]; size[0] * size[1]], background }
    }

    /// What was drawn.
    #[must_use]
    pub fn picture(self) -> Picture {
        Picture { size: self.size, pixels: Shared::new(self.pixels) }
    }

    /// Puts a color (linear) over the part `covered` of a pixel; nothing beside the canvas.
    fn put(&mut self, [x, y]: [i64; 2], color: Vec3, covered: f32) {
        let inside = |n: i64, size: usize| usize::try_from(n).ok().filter(|n| *n < size);
        let (Some(x), Some(y)) = (inside(x, self.size[0]), inside(y, self.size[1])) else { return };
        let pixel = &mut self.pixels[y * self.size[0] + x];
        let over = (color * covered).extend(covered);
        *pixel = (over + Vec4::from_array(*pixel) * (1.0 - covered)).to_array();
    }

    /// A rectangle between two corners, pixels; its edges cover the parts of pixels that they cross.
    pub fn rectangle(&mut self, low: [f32; 2], high: [f32; 2], color: Vec3) {
        let covered = |n: i64, low: f32, high: f32| {
            (high.min(n as f32 + 1.0) - low.max(n as f32)).clamp(0.0, 1.0)
        };
        let range = |axis: usize| {
            let last = self.size[axis] as f32;
            low[axis].clamp(0.0, last).floor() as i64..high[axis].clamp(0.0, last).ceil() as i64
        };
        let (across, down) = (range(0), range(1));
        for y in down {
            for x in across.clone() {
                let part = covered(x, low[0], high[0]) * covered(y, low[1], high[1]);
                self.put([x, y], color, part);
            }
        }
    }

    /// A convex polygon, pixels; of each pixel so much is covered as of sixteen points in it lie inside.
    pub fn convex(&mut self, corners: &[Vec2], color: Vec3) {
        let low = corners.iter().copied().fold(Vec2::MAX, Vec2::min).max(Vec2::ZERO);
        let high = corners.iter().copied().fold(Vec2::MIN, Vec2::max);
        let last = self.size.map(|n| n as f32);
        let inside = |at: Vec2| {
            let edges = corners.iter().zip(corners.iter().cycle().skip(1));
            let sides = edges.map(|(p, q)| (*q - *p).perp_dot(at - *p));
            let (mut left, mut right) = (true, true);
            sides.for_each(|side| {
                left &= side >= 0.0;
                right &= side <= 0.0;
            });
            left || right
        };
        for y in low.y as i64..high.y.min(last[1]).ceil() as i64 {
            for x in low.x as i64..high.x.min(last[0]).ceil() as i64 {
                let point = |i: u8| {
                    let [dx, dy] = [i % 4, i / 4].map(|n| (f32::from(n) + 0.5) / 4.0);
                    Vec2::new(x as f32 + dx, y as f32 + dy)
                };
                let covered = (0..16).filter(|i| inside(point(*i))).count();
                self.put([x, y], color, covered as f32 / 16.0);
            }
        }
    }

    /// A line of text with its top left corner at a place, pixels; before a background its letters have a rim of that color, so
    /// that they are read before anything.
    pub fn text(&mut self, line: &Line, at: [f32; 2], color: Vec3) {
        if let Some(background) = self.background {
            self.rim(line, at, background);
        }
        self.letters(line, at, color);
    }

    /// The same for what stands before a volume: where there is no background, the rim is black or white, whichever the letters
    /// are set off by.
    pub fn label(&mut self, line: &Line, at: [f32; 2], color: Vec3) {
        self.rim(line, at, self.background.unwrap_or(against(color)));
        self.letters(line, at, color);
    }

    /// What is as near to a line's letters as their rim is wide.
    fn rim(&mut self, line: &Line, at: [f32; 2], color: Vec3) {
        let rim = rim_of(line);
        for step in 0..12_u8 {
            let (dy, dx) = (f32::from(step) * std::f32::consts::TAU / 12.0).sin_cos();
            let beside = [at[0] + rim * dx, at[1] + rim * dy];
            line.draw(beside, |pixel, covered| self.put(pixel, color, covered));
        }
    }

    /// The same without a rim, for what is written on something that was drawn.
    pub fn letters(&mut self, line: &Line, at: [f32; 2], color: Vec3) {
        line.draw(at, |pixel, covered| self.put(pixel, color, covered));
    }
}

/// How wide the rim of a line's letters is, pixels.
#[must_use]
pub fn rim_of(line: &Line) -> f32 {
    line.height / 12.0
}

/// Black against what is bright and white against what is dark; colors are linear.
#[must_use]
pub fn against(color: Vec3) -> Vec3 {
    Vec3::splat(if color.dot(Vec3::new(0.21, 0.72, 0.07)) > 0.3 { 0.0 } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use super::super::lettering::set;
    use super::*;

    #[test]
    fn a_label_is_set_off_by_a_rim_with_a_background_and_without_one() {
        let line = set("mandible", 24.0);
        let pixels = |background: Option<Vec3>, color: Vec3, is_label: bool| {
            let mut canvas = Canvas::new([160, 40], background);
            let at = [8.0, 6.0];
            if is_label {
                canvas.label(&line, at, color);
            } else {
                canvas.text(&line, at, color);
            }
            canvas.picture().pixels.to_vec()
        };
        let [dark, bright] = [Vec3::splat(0.1), Vec3::ONE];
        assert_eq!(pixels(Some(Vec3::X), dark, true), pixels(Some(Vec3::X), dark, false));
        for (color, rim) in [(dark, bright), (bright, Vec3::ZERO)] {
            let (plain, label) = (pixels(None, color, false), pixels(None, color, true));
            // As wide as the rim around letters nothing is seen of what is behind, and it is as far from their color as can be.
            let rimmed =
                label.iter().zip(&plain).filter(|(own, before)| before[3] == 0.0 && own[3] > 0.99);
            let rimmed: Vec<_> = rimmed.map(|(own, _)| *own).collect();
            assert!(rimmed.len() > 300, "{}", rimmed.len());
            assert!(
                rimmed
                    .iter()
                    .all(|own| Vec4::from(*own).truncate().abs_diff_eq(rim * own[3], 1e-5))
            );
            assert!(plain.iter().zip(&label).all(|(before, own)| own[3] >= before[3] - 1e-6));
        }
    }

    #[test]
    fn a_convex_polygon_covers_its_area() {
        let mut canvas = Canvas::new([20, 20], None);
        let corners = [[3.0, 2.0], [15.0, 5.0], [16.0, 14.0], [4.0, 12.0]].map(Vec2::from);
        canvas.convex(&corners, Vec3::X);
        let area: f32 = canvas.picture().pixels.iter().map(|pixel| pixel[3]).sum();
        let twice = corners.iter().zip(corners.iter().cycle().skip(1)).map(|(p, q)| p.perp_dot(*q));
        assert!((area - twice.sum::<f32>() / 2.0).abs() < 0.5, "{area}");
    }

    #[test]
    fn a_rectangle_covers_its_area_and_nothing_beside_the_canvas() {
        let mut canvas = Canvas::new([8, 6], None);
        canvas.rectangle([1.25, 2.5], [4.75, 4.0], Vec3::X);
        canvas.rectangle([7.5, -3.0], [90.0, 0.5], Vec3::Y);
        let picture = canvas.picture();
        let sum = |channel: usize| picture.pixels.iter().map(|p| p[channel]).sum::<f32>();
        assert!((sum(0) - 3.5 * 1.5).abs() < 1e-5 && (sum(1) - 0.25).abs() < 1e-5);
        assert_eq!((picture.pixel(2, 3), picture.pixel(1, 3)[3]), ([1.0, 0.0, 0.0, 1.0], 0.75));
    }
}
