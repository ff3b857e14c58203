//! Polygons that share edges are met exactly once, whatever the angle; areas are right; edge-on polygons are missed
//! (algorithm §4).

use std::sync::Arc;

use gelray::components::{Order, View};
use gelray::polygon::face::{Face, Faces};
use gelray::view::extent::Extent;
use glam::{DQuat, DVec2, DVec3};
use hecs::World;
use proptest::prelude::*;

use super::support::{Mixture, Rendered, bits, every_position, flat, rendered, run, square};

/// Cells along a side of the tiled square.
const CELLS: usize = 8;
/// Half its side.
const HALF: f64 = 4.0;
/// Moved by less than this part of a cell, four corners stay convex and their triangles tile the cell; beyond it triangles
/// may fold over each other, and a ray rightly meets three.
const CONVEX: f64 = 0.5;

/// The square in the plane z = 0 in triangles: a lattice whose inner vertices are moved by up to `jitter` of a cell,
/// each cell cut along one diagonal or as a fan about a point in it. No vertex lies inside an edge.
fn tiles(jitter: f64, random: &[f64]) -> Vec<Vec<DVec3>> {
    let number = |i: usize| random[i % random.len()];
    let side = 2.0 * HALF / CELLS as f64;
    let vertex = |x: usize, y: usize| {
        let at = y * (CELLS + 1) + x;
        let inner = |n: usize| n > 0 && n < CELLS;
        let moved = if inner(x) && inner(y) { jitter * side } else { 0.0 };
        let off = DVec2::new(number(2 * at) - 0.5, number(2 * at + 1) - 0.5) * moved;
        DVec3::new(x as f64 * side - HALF + off.x, y as f64 * side - HALF + off.y, 0.0)
    };
    let mut triangles = Vec::new();
    for (x, y) in (0..CELLS * CELLS).map(|i| (i % CELLS, i / CELLS)) {
        let corners = [vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1), vertex(x, y + 1)];
        match (number(7 * (y * CELLS + x)) * 3.0) as u32 {
            0 => triangles
                .extend([[0, 1, 2], [2, 3, 0]].map(|t| t.map(|i: usize| corners[i]).to_vec())),
            1 => triangles
                .extend([[1, 2, 3], [1, 3, 0]].map(|t| t.map(|i: usize| corners[i]).to_vec())),
            _ => {
                let middle = corners.iter().sum::<DVec3>() / 4.0;
                triangles.extend((0..4).map(|i| vec![middle, corners[i], corners[(i + 1) % 4]]));
            }
        }
    }
    triangles
}

/// Triangles as one entity of opacity 1/2, with a ray at every position.
fn cast(triangles: &[Vec<DVec3>], view: &View) -> Rendered {
    let faces: Vec<_> = triangles.iter().map(|t| Face::new(vec![t.clone()]).unwrap()).collect();
    let extent = Extent::of(triangles.iter().flatten().copied()).unwrap();
    let mut world = World::new();
    world.spawn((Order(0), Faces(Arc::new(faces)), flat([1.0; 3], 0.5)));
    let view = world.spawn((Order(1), view.clone(), every_position(), extent));
    run(&mut world);
    rendered(&world, view)
}

fn view(azimuth: f64, elevation: f64, roll: f64, size: u32, height: f64) -> View {
    let (focal_point, height_mm) = (Some([0.0; 3]), Some(height));
    let base = View { azimuth, elevation, roll, focal_point, ..View::default() };
    View { height_mm, size: [size; 2], ..base }
}

/// How many positions are in the square, all of which met exactly one triangle, or none of which, outside.
fn met_once(made: &Rendered) -> usize {
    let corners = [(-HALF, -HALF), (HALF, -HALF), (HALF, HALF), (-HALF, HALF)]
        .map(|(x, y)| made.camera.project(DVec3::new(x, y, 0.0)).0);
    let mut count = 0;
    for (at, window, color) in made.rays() {
        // Distances to the four edges, to the side of the middle: all above 0 inside.
        let sides = (0..4).map(|i| {
            let (p, q) = (corners[i], corners[(i + 1) % 4]);
            let (edge, middle) = (q - p, corners.iter().sum::<DVec2>() / 4.0);
            edge.perp_dot(window - p) * edge.perp_dot(middle - p).signum() / edge.length()
        });
        let inside = sides.fold(f64::INFINITY, f64::min);
        if inside > 1e-9 {
            assert_eq!(color, [0.5; 4], "{at:?} at {window}");
            count += 1;
        } else if inside < -1e-9 {
            assert_eq!(color, [0.0; 4], "{at:?} at {window}");
        } else {
            assert!(color == [0.5; 4] || color == [0.0; 4], "{at:?}: {color:?}");
        }
    }
    count
}

#[test]
fn edges_that_fall_exactly_on_rays_are_met_once() {
    // From above the lattice's edges and diagonals run along the positions of the rays, and its vertices lie on them.
    for (roll, size) in [(0.0, 16), (90.0, 16), (0.0, 8), (45.0, 16), (180.0, 32), (30.0, 24)] {
        let triangles = tiles(0.0, &[0.1, 0.5, 0.9, 0.2, 0.7]);
        let made = cast(&triangles, &view(0.0, 90.0, roll, size, 10.0 * f64::from(size) / 20.0));
        let count = met_once(&made);
        assert!(count > 400, "{count}");
    }
    // A window as large as the square: the borders too lie on rays, two of them in and two out.
    let made = cast(&tiles(0.0, &[0.1, 0.9]), &view(0.0, 90.0, 0.0, 8, 8.0));
    let inside = made.rays().filter(|(.., color)| color[3] == 0.5).count();
    assert_eq!(inside, 32 * 32);
    assert!(made.picture.pixels.iter().all(|pixel| (0.38..=0.5).contains(&pixel[3])));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 120, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_square_of_random_triangles_has_no_gap_and_no_overlap_at_any_angle(
        random in proptest::collection::vec(0.0..1.0, 200),
        jitter in prop_oneof![Just(0.0), 0.0..CONVEX],
        (azimuth, elevation, roll) in (
            prop_oneof![Just(0.0), Just(90.0), Just(45.0), -180.0..180.0],
            prop_oneof![Just(90.0), Just(-90.0), Just(30.0), 5.0..90.0, 0.1..1.0],
            prop_oneof![Just(0.0), Just(45.0), -180.0..180.0],
        ),
    ) {
        let made = cast(&tiles(jitter, &random), &view(azimuth, elevation, roll, 16, 10.0));
        prop_assert!(met_once(&made) > 0);
    }
}

/// Twice the signed area of an outline in the plane z = 0.
fn doubled_area(outline: &[DVec3]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(p, q)| p.x * q.y - q.x * p.y).sum()
}

#[test]
fn a_concave_polygon_with_a_hole_covers_its_area() {
    let at = |(x, y): (f64, f64)| DVec3::new(x, y, 0.0);
    let outline =
        [(-4.0, -3.0), (4.1, -3.3), (3.0, 3.7), (0.2, -1.1), (-3.1, 3.9)].map(at).to_vec();
    let hole = [(-2.7, -2.1), (-1.5, -1.3), (-2.4, -0.2)].map(at).to_vec();
    let area = (doubled_area(&outline).abs() - doubled_area(&hole).abs()) / 2.0;
    for tilt in [0.0, 0.5, 1.2] {
        let turned = DQuat::from_rotation_x(tilt);
        let outlines = [&outline, &hole].map(|o| o.iter().map(|v| turned * *v).collect());
        let scene = Mixture {
            sampling: every_position(),
            ..Mixture::polygons(vec![(outlines.to_vec(), flat([1.0; 3], 1.0))])
        };
        let made = scene.seen((0.0, 90.0), 100, 10.0).render();
        let seen: f64 = made.picture.pixels.iter().map(|p| f64::from(p[3])).sum::<f64>() * 0.01;
        let expected = area * tilt.cos();
        println!("concave polygon with a hole, tilted by {tilt}: area {seen:.4} for {expected:.4}");
        assert!((seen - expected).abs() < 0.001 * expected);
    }
}

#[test]
fn polygons_seen_edge_on_are_missed_and_leave_no_trace() {
    let gel_free = |polygons| Mixture { sampling: every_position(), ..Mixture::polygons(polygons) };
    let backdrop = (vec![square(DVec3::Y * 3.0, DVec3::Y, 9.0)], flat([0.2, 0.4, 0.6], 0.7));
    for (azimuth, elevation) in [(0.0, 0.0), (90.0, 0.0), (0.0, 90.0), (30.0, 0.0), (33.0, -21.0)] {
        let camera = gel_free(vec![backdrop.clone()]).seen((azimuth, elevation), 20, 12.0);
        let expected = camera.render();
        let forward = expected.camera.forward;
        for turn in 0..12 {
            let normal =
                DQuat::from_axis_angle(forward, f64::from(turn) * 0.5) * expected.camera.up;
            let on_edge = (vec![square(DVec3::ZERO, normal, 3.0)], flat([1.0; 3], 1.0));
            let mut scene = camera.clone();
            scene.polygons.insert(0, on_edge);
            assert_eq!(bits(&scene.render().picture), bits(&expected.picture), "{azimuth} {turn}");
            // A thousandth of a degree off it is a line thinner than a position: at most few rays, each of its colour.
            let nearly = DQuat::from_axis_angle(expected.camera.right, 2e-5) * normal;
            scene.polygons[0].0 = vec![square(DVec3::ZERO, nearly, 3.0)];
            let off = scene.render().rays().filter(|(.., c)| c[3] == 1.0).count();
            assert!(off <= 250, "{off}");
        }
    }
}
