//! What is written at axes, and the cube that tells how the world is turned.

use glam::{DVec3, Vec2, Vec3};

use super::layout::{Sheet, short};
use crate::components::{Axes, OrientationCube};
use crate::view::axes::Axis;
use crate::view::camera::Camera;
use crate::view::lettering::set;

impl Sheet {
    /// The values at the ticks of axes, and what the axes are called; `tick` is a tick's length, world units.
    pub fn axes(&mut self, stated: &Axes, axes: &[Axis; 3], camera: &Camera, tick: f64) {
        let letters = self.letters(stated.letters_pixels, 1.0 / 36.0);
        for axis in axes {
            let mut beside = |point: DVec3, text: &str, farther: f32| {
                let [at, end] = [point, point + axis.out * tick].map(|p| camera.project(p));
                if at.1 < camera.nearest() || end.1 < camera.nearest() {
                    return;
                }
                let [at, end] = [at.0.as_vec2(), end.0.as_vec2()];
                let away = (end - at).try_normalize().unwrap_or(Vec2::Y);
                let line = set(text, letters);
                let reach = away.x.abs() * line.width / 2.0 + away.y.abs() * line.height / 2.0;
                let middle = end + away * (reach + letters * (0.3 + farther));
                let size = Vec2::new(line.width, line.height);
                // At the picture's edge a value is moved inside rather than cut.
                let most = (Vec2::from(self.size) - size).max(Vec2::ZERO);
                let corner = (middle - size / 2.0).clamp(Vec2::ZERO, most);
                self.canvas.text(&line, corner.round().to_array(), stated.color.0);
            };
            let values: Vec<String> = axis.ticks.iter().map(|value| short(*value)).collect();
            for (value, text) in axis.ticks.iter().zip(&values) {
                beside(axis.at(*value), text, 0.0);
            }
            let longest = values.iter().map(|text| text.chars().count()).max().unwrap_or(0) as f32;
            let farther = if axis.name == "z" { 0.7 * longest + 0.3 } else { 1.2 };
            let name = format!("{}, {}", axis.name, stated.unit);
            beside((axis.ends[0] + axis.ends[1]) / 2.0, &name, farther);
        }
    }

    /// A cube in a corner, turned as the world is, with a letter on each side that is seen.
    pub fn cube(&mut self, stated: &OrientationCube, camera: &Camera) {
        let size = stated.size_pixels.unwrap_or(self.size[1] / 8.0);
        let [left, top] = self.place(stated.corner, [size; 2]);
        let middle = Vec2::new(left, top) + size / 2.0;
        // A cube's diagonal is the longest way across its picture.
        let half = f64::from(size) / 2.0 / 3.0_f64.sqrt();
        let drawn = |p: DVec3| {
            let across = Vec2::new(p.dot(camera.right) as f32, -p.dot(camera.up) as f32);
            middle + across * half as f32
        };
        let sides = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        for (normal, letter) in sides.into_iter().zip(["L", "R", "P", "A", "S", "I"]) {
            let facing = -normal.dot(camera.forward) as f32;
            if facing <= 0.01 {
                continue;
            }
            let (u, v) = normal.any_orthonormal_pair();
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            let corners = corners.map(|[a, b]| drawn(normal + u * a + v * b));
            let color = stated.color.0 * (0.35 + 0.65 * facing);
            self.canvas.convex(&corners, color);
            if facing > 0.3 {
                let line = set(letter, size * 0.5 * facing.sqrt());
                let corner = drawn(normal) - Vec2::new(line.width, line.height) / 2.0;
                let ink = if color.dot(Vec3::new(0.21, 0.72, 0.07)) > 0.3 { 0.0 } else { 1.0 };
                self.canvas.text(&line, corner.round().to_array(), Vec3::splat(ink));
            }
        }
    }
}
