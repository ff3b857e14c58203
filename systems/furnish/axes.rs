//! What is written at axes, and the cube that tells how the world is turned.

use glam::{DVec3, Vec2, Vec3};

use super::layout::{Sheet, short};
use crate::components::{Axes, OrientationCube};
use crate::view::axes::Axis;
use crate::view::camera::Camera;
use crate::view::lettering::{Line, set};
use crate::view::overlay::against;

impl Sheet {
    /// The values at the ticks of axes, and what the axes are called; `tick` is a tick's length, world units. A value that
    /// would stand on something else is left out, and a name stands where there is room for it.
    pub fn axes(&mut self, stated: &Axes, axes: &[Axis; 3], camera: &Camera, tick: f64) {
        let letters = self.letters(stated.letters_pixels, 1.0 / 36.0);
        let color = stated.color.0;
        let mut widest = [0.0_f32; 3];
        for (axis, widest) in axes.iter().zip(&mut widest) {
            for &value in &axis.ticks {
                let line = set(&short(value), letters);
                let Some(corner) =
                    beside(axis.at(value), (axis, tick), camera, (&line, 0.3 * letters))
                else {
                    continue;
                };
                *widest = widest.max(line.width);
                if self.is_free(corner, Vec2::new(line.width, line.height)) {
                    self.write(&line, corner, color);
                }
            }
        }
        for (axis, widest) in axes.iter().zip(widest) {
            let line = set(&format!("{}, {}", axis.name, stated.unit), letters);
            let size = Vec2::new(line.width, line.height);
            let across = if axis.name == "z" { widest + 0.6 * letters } else { 1.3 * letters };
            let mut places = places(axis).flat_map(|point| {
                let at = |gap: f32| beside(point, (axis, tick), camera, (&line, gap));
                [at(0.3 * letters + across), at(0.3 * letters)]
            });
            if let Some(corner) = places.find_map(|at| at.filter(|at| self.is_free(*at, size))) {
                self.write(&line, corner, color);
            }
        }
    }

    fn write(&mut self, line: &Line, corner: Vec2, color: Vec3) {
        self.canvas.text(line, corner.to_array(), color);
        self.take(corner, Vec2::new(line.width, line.height));
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
                self.canvas.letters(&line, corner.round().to_array(), against(color));
            }
        }
    }
}

/// The top left of a line of text beside a point of an axis, `gap` pixels farther out than the end of a tick there; `None`
/// behind the eye.
fn beside(
    point: DVec3,
    (axis, tick): (&Axis, f64),
    camera: &Camera,
    (line, gap): (&Line, f32),
) -> Option<Vec2> {
    let [at, end] = [point, point + axis.out * tick].map(|p| camera.project(p));
    if at.1 < camera.nearest() || end.1 < camera.nearest() {
        return None;
    }
    let [at, end] = [at.0.as_vec2(), end.0.as_vec2()];
    let away = (end - at).try_normalize().unwrap_or(Vec2::Y);
    let size = Vec2::new(line.width, line.height);
    let reach = (away.abs() * size).element_sum() / 2.0;
    Some((end + away * (reach + gap) - size / 2.0).round())
}

/// The points of an axis that its name may stand beside: its middle, then between its ticks from there outward.
fn places(axis: &Axis) -> impl Iterator<Item = DVec3> {
    let middle = (axis.ends[0] + axis.ends[1]) / 2.0;
    let mut between: Vec<_> =
        axis.ticks.windows(2).map(|pair| axis.at(f64::midpoint(pair[0], pair[1]))).collect();
    between.sort_by(|a, b| a.distance(middle).total_cmp(&b.distance(middle)));
    std::iter::once(middle).chain(between)
}
