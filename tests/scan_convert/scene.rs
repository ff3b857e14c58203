//! Small scenes with polygons to scan-convert, and a tracer that does to their voxels what rays do.

use std::f64::consts::PI;
use std::sync::Arc;

use gelray::Error;
use gelray::components::{Matte, OpacityUnit, Order, Surface, Voxelize};
use gelray::polygon::face::{Face, Faces};
use gelray::schedule::{Job, Schedule, Watch};
use gelray::systems::{matte, scan_convert};
use gelray::view::composite::{Gathered, thicken};
use gelray::volume::bricks::Bricks;
use gelray::volume::grid::Grid;
use gelray::volume::layer::{Composite, Coverage};
use glam::DVec3;
use hecs::{Entity, World};

/// A world with a volume that holds nothing yet; its opacity unit is the smallest spacing.
pub fn world(grid: Grid) -> World {
    let mut world = World::new();
    world.spawn((grid, OpacityUnit(grid.spacing().min_element()), Order(0)));
    world
}

pub fn cube(voxels: usize) -> Grid {
    Grid::axis_aligned([voxels; 3], [1.0; 3], [0.0; 3]).unwrap()
}

pub fn add(world: &mut World, faces: Vec<Face>, opacity: f32, calibrated: bool) -> Entity {
    let order = Order(world.len());
    let surface = Surface { opacity, ..Surface::default() };
    let voxelize = Voxelize { matte: Matte::Over, calibrated };
    world.spawn((Faces(Arc::new(faces)), surface, voxelize, order))
}

/// Runs both systems; what was made and what was kept.
pub fn run(world: &mut World) -> Result<Vec<(u32, u32)>, Error> {
    let jobs = [Job::of::<scan_convert::ScanConvert>(), Job::of::<matte::MattePolygons>()];
    let ran = Schedule::new(&jobs)?.run(world, &Watch::default())?;
    Ok(ran.iter().map(|ran| (ran.made, ran.reused)).collect())
}

/// α_G of one entity of `faces` in `grid`.
pub fn cover(grid: Grid, faces: Vec<Face>, opacity: f32, calibrated: bool) -> Coverage {
    let mut world = world(grid);
    let entity = add(&mut world, faces, opacity, calibrated);
    run(&mut world).unwrap();
    (*world.get::<&Coverage>(entity).unwrap()).clone()
}

pub fn composite(world: &World) -> Composite {
    let mut query = world.query::<&Composite>();
    query.iter().next().unwrap().clone()
}

/// A rectangle of half-sides `half` about `center`, perpendicular to `normal`.
pub fn rectangle(center: DVec3, normal: DVec3, half: f64) -> Face {
    let (right, up) = normal.normalize().any_orthonormal_pair();
    let corner = |(x, y): (f64, f64)| center + (right * x + up * y) * half;
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(corner);
    Face::new(vec![corners.to_vec()]).unwrap()
}

/// A closed sphere of `2 n · n` planar faces.
pub fn sphere(center: DVec3, radius: f64, n: u32) -> Vec<Face> {
    let point = |i: u32, j: u32| {
        let (i, j) = (f64::from(i) / f64::from(n) * PI, f64::from(j % (2 * n)) / f64::from(n) * PI);
        center + DVec3::new(i.sin() * j.cos(), i.sin() * j.sin(), i.cos()) * radius
    };
    let quad = |(i, j): (u32, u32)| {
        let corners = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
        // At the poles two corners are one, and rounding may part them by a hair.
        let mut outline: Vec<DVec3> = Vec::new();
        for corner in corners {
            if outline.iter().all(|other| other.distance(corner) > 1e-9 * radius) {
                outline.push(corner);
            }
        }
        Face::new(vec![outline]).unwrap()
    };
    (0..n).flat_map(|i| (0..2 * n).map(move |j| (i, j))).map(quad).collect()
}

/// The outline with the corners `corners`, in the plane z = `z`.
pub fn flat(corners: &[(f64, f64)], z: f64) -> Vec<DVec3> {
    corners.iter().map(|&(x, y)| DVec3::new(x, y, z)).collect()
}

/// Sum over all voxels.
pub fn total(opacity: &Bricks<f32>) -> f64 {
    opacity.stored().flat_map(|(_, brick)| brick.iter()).map(|&alpha| f64::from(alpha)).sum()
}

/// What a ray gathers: through world point `point` in direction `along`, samples `distance` apart, one of them `phase`
/// sample distances past the point, tri-linear interpolation, opacity corrected to the opacity unit `unit`.
pub struct Tracer<'a> {
    pub grid: Grid,
    pub opacity: &'a Bricks<f32>,
    pub along: DVec3,
    pub distance: f64,
    pub unit: f64,
}

impl Tracer<'_> {
    pub fn trace(&self, point: DVec3, phase: f64) -> f64 {
        let to_index = self.grid.world_to_index();
        let (start, step) =
            (to_index.transform_point3(point), self.along.normalize() * self.distance);
        let step = to_index.transform_vector3(step);
        let steps = (self.grid.size.iter().sum::<usize>() as f64 / step.length()).ceil() as i64;
        let mut ray = Gathered::NOTHING;
        for k in -steps..=steps {
            let opacity = self.sample(start + step * (k as f64 + phase));
            ray.under(DVec3::ZERO, thicken(opacity, self.distance / self.unit));
        }
        ray.opacity()
    }

    fn sample(&self, at: DVec3) -> f64 {
        let last = DVec3::from(self.grid.size.map(|n| (n - 1) as f64));
        if at.min_element() < 0.0 || (last - at).min_element() < 0.0 {
            return 0.0;
        }
        let cell = at.floor().min(last - 1.0);
        let between = at - cell;
        let corner = |corner: usize| {
            let upper =
                DVec3::new((corner & 1) as f64, (corner >> 1 & 1) as f64, (corner >> 2) as f64);
            let weight = (DVec3::ONE - between) + upper * (2.0 * between - 1.0);
            let voxel = (cell + upper).to_array().map(|v| v as usize);
            weight.element_product() * f64::from(self.opacity.value(voxel))
        };
        // Rounded weights may sum to a hair more than 1.
        (0..8).map(corner).sum::<f64>().min(1.0)
    }
}
