//! Facts about meshes: translucent triangles in any order come out as a brute-force sort has them, and smooth ones are lit as
//! the surface that they stand for.

use std::sync::Arc;

use gelray::components::{Ellipsoid, OpacityUnit, Order, Sampling, View};
use gelray::polygon::face::{Face, Faces};
use gelray::prelude::{Light, Mesh, Renderer, Smooth, Surface};
use gelray::view::extent::Extent;
use gelray::view::ray::Ray;
use gelray::volume::grid::{Grid, Painted};
use glam::{DVec3, Vec3};
use hecs::{Entity, World};

use super::random_scenes::Chance;
use super::support::{centred, every_pixel, flat, homogeneous, rendered, run};

/// Meshes of the soup, and triangles of each.
const MESHES: usize = 6;
const TRIANGLES: usize = 70;
/// Half the side of the box of gel around it, all of which has this opacity a unit.
const HALF: f64 = 8.0;
const GEL: f32 = 0.06;
/// Δ.
const STEP: f64 = 0.7;

/// A mesh: its triangles, its color and its opacity.
type Translucent = (Vec<[DVec3; 3]>, [f32; 3], f32);

/// Triangles that lie across each other anywhere in the box: the same ones every time.
fn soup() -> Vec<Translucent> {
    let mut chance = Chance(7);
    let mut point = |size: f64| DVec3::from([0; 3].map(|_| chance.within(-size, size)));
    let mut mesh = |number: usize| {
        let triangle = |_| {
            let middle = point(5.0);
            [0; 3].map(|_| middle + point(2.5))
        };
        let triangles = (0..TRIANGLES).map(triangle).collect();
        let part = |n: usize| (number * n % 7) as f32 / 6.0;
        (triangles, [part(1), part(2), part(4)], 0.15 + 0.8 * part(3))
    };
    (0..MESHES).map(&mut mesh).collect()
}

fn gel() -> (Grid, Painted) {
    let grid = centred([17; 3], HALF / 8.0);
    let painted = homogeneous(&grid, [0.2, 0.4, 0.9, GEL]);
    (grid, painted)
}

/// The soup in gel, or alone, from a side.
fn world(soup: &[Translucent], in_gel: bool, azimuth: f64) -> (World, Entity) {
    let mut world = World::new();
    for (order, (triangles, color, opacity)) in soup.iter().enumerate() {
        let faces = triangles.iter().map(|t| Face::new(vec![t.to_vec()]).unwrap()).collect();
        world.spawn((Order(order as u32), Faces(Arc::new(faces)), flat(*color, *opacity)));
    }
    let (grid, painted) = gel();
    let extent = Extent::of(grid.corners()).unwrap();
    if in_gel {
        world.spawn((Order(90), grid, painted, OpacityUnit(1.0)));
    }
    let view = View {
        azimuth,
        elevation: 17.0,
        focal_point: Some([0.0; 3]),
        height_mm: Some(18.0),
        size: [48; 2],
        ..View::default()
    };
    let sampling = Sampling { distance_mm: Some(STEP), ..every_pixel() };
    let view = world.spawn((Order(91), view, sampling, extent));
    (world, view)
}

/// Where a ray meets a triangle, and how near its edges that is, as a part of it.
fn meet(ray: &Ray, [a, b, c]: &[DVec3; 3]) -> Option<(f64, f64)> {
    let (u, v) = (*b - *a, *c - *a);
    let across = ray.along.cross(v);
    let scale = u.dot(across);
    let from = ray.origin - *a;
    let s = from.dot(across) / scale;
    let t = ray.along.dot(from.cross(u)) / scale;
    let within = s.min(t).min(1.0 - s - t);
    (within > -1e-9).then(|| (v.dot(from.cross(u)) / scale, within))
}

/// The slabs of a ray whose samples are in the box of gel: where they begin and end. `None` where a sample is too near its side
/// to say.
fn through(ray: &Ray) -> Option<[f64; 2]> {
    let inverse = ray.along.recip();
    let (low, high) = ((-HALF - ray.origin) * inverse, (HALF - ray.origin) * inverse);
    let (from, to) = (low.min(high).max_element(), low.max(high).min_element());
    // Sample k is at (k + ½) Δ.
    let samples = [from, to].map(|depth| depth / STEP - 0.5);
    let [first, last] = [samples[0].ceil(), samples[1].floor()];
    let clear = samples.iter().all(|k| (k - k.round()).abs() > 1e-6);
    clear.then_some([first * STEP, (last + 1.0).max(first) * STEP])
}

/// What is seen along a ray, every triangle asked and all sorted; `None` where it passes too near an edge to say.
fn sorted(soup: &[Translucent], ray: &Ray, in_gel: bool) -> Option<[f64; 4]> {
    let mut hits = Vec::new();
    for (triangles, color, opacity) in soup {
        for (depth, within) in triangles.iter().filter_map(|triangle| meet(ray, triangle)) {
            if within < 1e-9 {
                return None;
            }
            hits.push((depth, *color, f64::from(*opacity)));
        }
    }
    hits.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut seen, mut clear) = ([0.0; 4], 1.0);
    let mut add = |color: [f32; 3], opacity: f64| {
        for (channel, value) in color.iter().chain(&[1.0]).enumerate() {
            seen[channel] += clear * opacity * f64::from(*value);
        }
        clear *= 1.0 - opacity;
    };
    let own = if in_gel { Some(through(ray)?) } else { None };
    let mut at = f64::NEG_INFINITY;
    let mut fill = |to: f64, add: &mut dyn FnMut([f32; 3], f64)| {
        if let Some([from, end]) = own {
            let long = (to.min(end) - at.max(from)).max(0.0);
            add([0.2, 0.4, 0.9], 1.0 - (1.0 - f64::from(GEL)).powf(long));
            at = to;
        }
    };
    for (depth, color, opacity) in hits {
        fill(depth, &mut add);
        add(color, opacity);
    }
    fill(f64::INFINITY, &mut add);
    Some(seen)
}

#[test]
fn translucent_triangles_come_out_as_a_brute_force_sort_has_them_from_eight_sides() {
    let soup = soup();
    for (in_gel, bound) in [(false, 1e-6), (true, 1e-5)] {
        let (mut compared, mut most, mut worst) = (0, 0, 0.0_f64);
        for side in 0..8 {
            let (mut world, view) = world(&soup, in_gel, f64::from(side) * 45.0 + 3.0);
            run(&mut world);
            let made = rendered(&world, view);
            for (_, window, color) in made.rays() {
                let ray = made.camera.ray(window);
                let Some(expected) = sorted(&soup, &ray, in_gel) else { continue };
                let met =
                    soup.iter().flat_map(|mesh| &mesh.0).filter_map(|t| meet(&ray, t)).count();
                (compared, most) = (compared + 1, most.max(met));
                for (found, expected) in color.iter().zip(expected) {
                    worst = worst.max((f64::from(*found) - expected).abs());
                }
            }
        }
        assert!(compared > 17_000 && most > 15, "{compared} {most}");
        assert!(worst < bound, "{in_gel} {worst}");
    }
}

#[test]
fn a_smooth_ball_of_triangles_is_lit_as_a_sphere() {
    let toward = [0.3, -0.8, 0.5];
    let off = |smooth: bool| {
        let mut world = World::new();
        let shape =
            Ellipsoid { center: [0.0; 3], radii: [8.0; 3], subdivisions: 3, lumpiness: 0.0 };
        let mesh = Mesh { ellipsoid: Some(shape), ..Mesh::default() };
        let surface =
            Surface { ambient: 0.1, diffuse: 0.8, two_sided: false, ..Surface::default() };
        let ball = world.spawn((mesh, surface));
        if smooth {
            world.insert_one(ball, Smooth::default()).unwrap();
        }
        world.spawn((Light::from_direction(toward),));
        let view = View {
            focal_point: Some([0.0; 3]),
            height_mm: Some(18.0),
            size: [72; 2],
            ..View::default()
        };
        let view = world.spawn((view, every_pixel()));
        let light = world.query::<&Light>().iter().next().map(|l| l.color.0 * l.strength).unwrap();
        Renderer::new().unwrap().render(&mut world).unwrap();
        let made = rendered(&world, view);
        let mut worst = 0.0_f64;
        for (_, window, color) in made.rays() {
            let ray = made.camera.ray(window);
            let toward_middle = -ray.origin.dot(ray.along);
            let near = (ray.origin + ray.along * toward_middle).length();
            if near > 7.0 {
                continue;
            }
            let normal = ray.at(toward_middle - (64.0 - near * near).sqrt()) / 8.0;
            let facing = normal.dot(DVec3::from(toward).normalize()).max(0.0);
            let expected = Vec3::splat(0.1) + light * 0.8 * facing as f32;
            worst = worst.max(f64::from((expected - Vec3::from_slice(&color)).abs().max_element()));
        }
        worst
    };
    let (smooth, flat) = (off(true), off(false));
    assert!(smooth < 0.012 && flat > 0.06, "{smooth} {flat}");
}
