//! A reference in 64 bits, written from the formulas alone, for the whole way: classify, shade, interpolate, composite.
//!
//! It shares no code with the engine: voxels in plain arrays, one ray after the other, every slab of it. Scenes are small and
//! random: any spacing to 1:100, any view, any step, a polygon that splits slabs.

use gelray::renderer::Renderer;
use glam::{DVec2, DVec3};

use super::random_scenes::{Classified, Scene};
use super::support::rendered;

impl Scene {
    fn value(&self, [x, y, z]: [usize; 3]) -> f64 {
        f64::from(self.values[(z * self.size[1] + y) * self.size[0] + x])
    }

    /// Central differences, one-sided at borders, in world units.
    fn gradient(&self, at: [usize; 3]) -> DVec3 {
        DVec3::from([0, 1, 2].map(|axis| {
            let (mut before, mut after) = (at, at);
            before[axis] = at[axis].saturating_sub(1);
            after[axis] = (at[axis] + 1).min(self.size[axis] - 1);
            let apart = (after[axis] - before[axis]) as f64 * self.spacing[axis];
            (self.value(after) - self.value(before)) / apart
        }))
    }

    fn opacity(&self, at: [usize; 3]) -> f64 {
        let f = self.value(at);
        match self.classified {
            Classified::Ramp([low, high]) => low + (high - low) * f / 100.0,
            Classified::Around { value, opacity, thickness } => {
                let reach = thickness * self.unit * self.gradient(at).length();
                if (value - f).abs() <= reach && reach > 0.0 {
                    opacity * (1.0 - (value - f).abs() / reach)
                } else {
                    0.0
                }
            }
        }
    }

    /// Levoy's model, the normal turned to the light.
    fn lit(
        &self,
        color: DVec3,
        normal: DVec3,
        [ambient, diffuse, specular, shine]: [f64; 4],
    ) -> DVec3 {
        let facing = normal.dot(self.toward);
        let side = if facing < 0.0 { -1.0 } else { 1.0 };
        let half = (self.toward - self.forward()).normalize();
        let glint = (side * normal.dot(half)).max(0.0).powf(shine);
        let reflected = diffuse * (side * facing).max(0.0) + specular * glint;
        color * (ambient + self.strength * reflected)
    }

    /// Associated color and opacity of a voxel.
    fn voxel(&self, at: [usize; 3]) -> (DVec3, f64) {
        let gradient = self.gradient(at);
        let material =
            if gradient == DVec3::ZERO { [self.material[0], 0.0, 0.0, 1.0] } else { self.material };
        let alpha = self.opacity(at);
        (self.lit(self.color, -gradient.normalize_or_zero(), material) * alpha, alpha)
    }

    /// Where a ray passes the plane of depth 0.
    fn origin(&self, window: DVec2, size: f64) -> DVec3 {
        let forward = self.forward();
        let right = forward.cross(DVec3::Z).normalize();
        let up = right.cross(forward);
        let pixel = self.height / size;
        right * ((window.x - size / 2.0) * pixel) + up * ((size / 2.0 - window.y) * pixel)
    }

    /// Tri-linear, of associated colors; nothing outside the domain.
    fn sample(&self, point: DVec3, voxels: &[(DVec3, f64)]) -> (DVec3, f64) {
        let last = DVec3::from(self.size.map(|n| (n - 1) as f64));
        let index = point / self.spacing + last * 0.5;
        if index.cmplt(DVec3::ZERO).any() || index.cmpgt(last).any() {
            return (DVec3::ZERO, 0.0);
        }
        let first: [usize; 3] =
            [0, 1, 2].map(|axis| (index[axis] as usize).min(self.size[axis] - 2));
        let (mut color, mut alpha) = (DVec3::ZERO, 0.0);
        for corner in 0..8_usize {
            let (mut weight, mut at) = (1.0, first);
            for axis in 0..3 {
                let part = index[axis] - first[axis] as f64;
                let far = corner >> axis & 1;
                weight *= if far == 1 { part } else { 1.0 - part };
                at[axis] += far;
            }
            let (c, a) = voxels[(at[2] * self.size[1] + at[1]) * self.size[0] + at[0]];
            color += c * weight;
            alpha += a * weight;
        }
        (color, alpha)
    }

    /// What a ray sees: slab after slab, the one that the plane is met in cut in two.
    fn ray(&self, origin: DVec3, voxels: &[(DVec3, f64)]) -> [f64; 4] {
        let (forward, (point, normal, plain, cover)) = (self.forward(), self.plane);
        let depth = (point - origin).dot(normal) / forward.dot(normal);
        let surface = self.lit(plain, normal, [0.4, 0.6, 0.0, 1.0]);
        let reach = (self.height / self.distance) as i64 + 2;
        let (mut color, mut through) = (DVec3::ZERO, 1.0);
        let mut met = depth < -reach as f64 * self.distance;
        if met {
            color += surface * cover;
            through *= 1.0 - cover;
        }
        for k in -reach..=reach {
            let (near, far) = (k as f64 * self.distance, (k + 1) as f64 * self.distance);
            let (c, alpha) = self.sample(origin + forward * f64::midpoint(near, far), voxels);
            let pass = |thickness: f64, color: &mut DVec3, through: &mut f64| {
                if alpha > 0.0 && thickness > 0.0 {
                    let opacity = 1.0 - (1.0 - alpha).powf(thickness / self.unit);
                    *color += c * (*through * opacity / alpha);
                    *through *= 1.0 - opacity;
                }
            };
            if !met && depth < far {
                met = true;
                pass(depth - near, &mut color, &mut through);
                color += surface * (through * cover);
                through *= 1.0 - cover;
                pass(far - depth, &mut color, &mut through);
            } else {
                pass(self.distance, &mut color, &mut through);
            }
        }
        if !met {
            color += surface * (through * cover);
            through *= 1.0 - cover;
        }
        [color.x, color.y, color.z, 1.0 - through]
    }
}

#[test]
fn random_scenes_are_what_a_reference_in_64_bits_makes_of_them() {
    let (mut worst, mut rays) = (0.0_f64, 0);
    for seed in 0..48 {
        let scene = Scene::random(seed);
        let voxels: Vec<_> = (0..scene.values.len())
            .map(|at| {
                let [nx, ny, _] = scene.size;
                scene.voxel([at % nx, at / nx % ny, at / (nx * ny)])
            })
            .collect();
        let mut world = scene.world();
        let view = Renderer::new().unwrap().render(&mut world).unwrap().view;
        let (mut off, mut seen) = (0.0_f64, 0.0_f32);
        for (_, window, color) in rendered(&world, view).rays() {
            let expected = scene.ray(scene.origin(window, 9.0), &voxels);
            for (made, expected) in color.iter().zip(expected) {
                off = off.max((f64::from(*made) - expected).abs());
            }
            seen = seen.max(color[3]);
            rays += 1;
        }
        assert!(seen > 0.05, "{seed}: there is something to see");
        assert!(off < 1e-6, "seed {seed}: off by {off:e}");
        worst = worst.max(off);
    }
    println!("48 random scenes, {rays} rays: off from 64 bits by {worst:.1e} at most");
    assert!(rays > 48 * 81);
}
