//! Small scenes at random, in plain numbers: for the engine as a world, and for the reference in 64 bits as they are.

use gelray::components::{
    Classify, Color, Contour, Form, Light, Material, OpacityUnit, Sampling, Surface, Toward,
    TransferPoint, View,
};
use gelray::polygon::arrays::polygon;
use gelray::shared::Shared;
use gelray::volume::grid::{Grid, Scalars};
use glam::DVec3;
use hecs::World;

use super::support::every_pixel;

/// Numbers from 0 up to 1, the same ones for a seed.
pub struct Chance(pub u64);

impl Chance {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ bits >> 31) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// How opacity follows from a value.
#[derive(Clone, Copy)]
pub enum Classified {
    /// α_v at f_v, r voxels thick, on both sides (Levoy 1988).
    Around { value: f64, opacity: f64, thickness: f64 },
    /// Linear from the opacity of value 0 to that of value 100.
    Ramp([f64; 2]),
}

pub struct Scene {
    pub size: [usize; 3],
    pub spacing: DVec3,
    pub values: Vec<f32>,
    pub classified: Classified,
    /// u and Δ.
    pub unit: f64,
    pub distance: f64,
    /// k_a, k_d, k_s and n.
    pub material: [f64; 4],
    pub color: DVec3,
    pub toward: DVec3,
    pub strength: f64,
    pub azimuth: f64,
    pub elevation: f64,
    pub height: f64,
    /// A square that reaches beyond all else: a point of it, its normal, color and opacity.
    pub plane: (DVec3, DVec3, DVec3, f64),
}

impl Scene {
    pub fn random(seed: u64) -> Self {
        let mut chance = Chance(seed);
        let size = [0; 3].map(|_| 3 + (5.0 * chance.next()) as usize);
        // One in four scenes is up to a hundred times finer along an axis.
        let fine =
            if seed.is_multiple_of(4) { 10.0_f64.powf(chance.within(-2.0, 0.0)) } else { 1.0 };
        let axis = (3.0 * chance.next()) as usize;
        let mut spacing = DVec3::from([0; 3].map(|_| chance.within(0.6, 1.6)));
        spacing[axis] *= fine;
        let count = size.iter().product::<usize>();
        let values = (0..count).map(|_| chance.within(0.0, 100.0) as f32).collect();
        let classified = if chance.next() < 0.5 {
            let [value, opacity] = [chance.within(20.0, 80.0), chance.within(0.1, 1.0)];
            Classified::Around { value, opacity, thickness: chance.within(0.5, 3.0) }
        } else {
            Classified::Ramp([chance.within(0.0, 1.0).powi(3), chance.within(0.0, 1.0)])
        };
        let least = spacing.min_element();
        let direction =
            |chance: &mut Chance| DVec3::from([0; 3].map(|_| chance.within(-1.0, 1.0))).normalize();
        let through = spacing * DVec3::from(size.map(|n| (n - 1) as f64)) * 0.5;
        let mut scene = Self {
            size,
            spacing,
            values,
            classified,
            unit: least * chance.within(0.5, 2.0),
            distance: least * chance.within(0.2, 2.5),
            material: [0.2, 0.5, 0.3, 7.0],
            color: DVec3::from([0; 3].map(|_| chance.next())),
            toward: direction(&mut chance),
            strength: chance.within(0.3, 1.0),
            azimuth: chance.within(-180.0, 180.0),
            elevation: chance.within(-85.0, 85.0),
            height: 2.2 * through.length(),
            plane: (
                through * chance.within(-0.6, 0.6),
                direction(&mut chance),
                DVec3::from([0; 3].map(|_| chance.next())),
                chance.within(0.1, 0.9),
            ),
        };
        // Seen so much aslant, a square would not reach beyond all else.
        while scene.plane.1.dot(scene.forward()).abs() < 0.2 {
            scene.plane.1 = direction(&mut chance);
        }
        scene
    }

    /// Along the line of sight.
    pub fn forward(&self) -> DVec3 {
        let (a, e) = (self.azimuth.to_radians(), self.elevation.to_radians());
        -DVec3::new(a.sin() * e.cos(), -a.cos() * e.cos(), e.sin())
    }

    /// The same scene, stated.
    pub fn world(&self) -> World {
        let mut world = World::new();
        let last = DVec3::from(self.size.map(|n| (n - 1) as f64));
        let corner = (self.spacing * last * -0.5).to_array();
        let grid = Grid::axis_aligned(self.size, self.spacing.to_array(), corner).unwrap();
        let classify = match self.classified {
            Classified::Around { value, opacity, thickness } => {
                let contour = Contour {
                    opacity: opacity as f32,
                    thickness_voxels: thickness as f32,
                    form: Form::Around,
                    ..Contour::at(value as f32)
                };
                Classify { iso: vec![contour], ..Classify::default() }
            }
            Classified::Ramp(opacities) => {
                let point = |value: f32, opacity: f64| TransferPoint {
                    value,
                    opacity: opacity as f32,
                    color: None,
                };
                let transfer = vec![point(0.0, opacities[0]), point(100.0, opacities[1])];
                Classify { transfer, ..Classify::default() }
            }
        };
        let [ambient, diffuse, specular, shininess] = self.material.map(|k| k as f32);
        let color = Color(self.color.as_vec3());
        let material = Material { color, ambient, diffuse, specular, shininess, two_sided: true };
        let scalars = Scalars::F32(Shared::new(self.values.clone()));
        world.spawn((grid, scalars, classify, material, OpacityUnit(self.unit)));
        let toward = Toward::Direction(self.toward.to_array());
        let strength = self.strength as f32;
        world.spawn((Light { toward, strength, color: Color::WHITE },));
        let (point, normal, plain, cover) = self.plane;
        let (a, b) = normal.any_orthonormal_pair();
        let far = 40.0 * self.height;
        let square = [(-far, -far), (far, -far), (far, far), (-far, far)];
        let square = square.map(|(x, y)| (point + a * x + b * y).to_array());
        let surface = Surface {
            color: Color(plain.as_vec3()),
            opacity: cover as f32,
            ambient: 0.4,
            diffuse: 0.6,
            specular: 0.0,
            ..Surface::default()
        };
        world.spawn((polygon(&square).unwrap(), surface));
        let view = View {
            azimuth: self.azimuth,
            elevation: self.elevation,
            focal_point: Some([0.0; 3]),
            height_mm: Some(self.height),
            size: [9, 9],
            ..View::default()
        };
        let distance_mm = Some(self.distance);
        world.spawn((view, Sampling { distance_mm, ..every_pixel() }));
        world
    }
}
