//! What C_G and C_A are for: rays below a pixel are cast where a polygon's edge is seen, and nowhere else (paper §2).

use gelray::components::Sampling;
use gelray::view::samples::{Layout, POSITIONS};
use gelray::volume::grid::Grid;
use glam::{DQuat, DVec2, DVec3};

use super::support::{
    Mixture, Rendered, centred, every_position, flat, homogeneous, paint, square,
};

const SIZE: u32 = 40;
/// World units of the window.
const HEIGHT: f64 = 40.0;

/// A square polygon behind (or in front of) a block of bone 12 voxels wide, gel around it, on the default sampling.
fn scene(depth: f64, bone: f32) -> Rendered {
    let grid = centred([33, 9, 33], 1.0);
    let inside = |n: usize| (10..=22).contains(&n);
    let gel = paint(&grid, |[x, _, z]| {
        if inside(x) && inside(z) { [0.9, 0.8, 0.7, bone] } else { [0.3, 0.5, 0.9, 0.05] }
    });
    // Turned a little, so that its edges cross positions at every phase.
    let normal = DVec3::Y;
    let polygon = square(DVec3::Y * depth, normal, 3.1)
        .iter()
        .map(|v| DQuat::from_rotation_y(0.4) * *v)
        .collect();
    let scene = Mixture {
        polygons: vec![(vec![polygon], flat([1.0, 0.1, 0.1], 0.8))],
        ..Mixture::of(grid, gel)
    };
    scene.seen((0.0, 0.0), SIZE, HEIGHT).render()
}

/// Positions off the lattice of one ray a pixel at which rays were cast.
fn below_a_pixel(made: &Rendered) -> Vec<[usize; 2]> {
    let fine = made.rays().filter(|([i, j], ..)| i % POSITIONS != 0 || j % POSITIONS != 0);
    fine.map(|(at, ..)| at).collect()
}

#[test]
fn a_polygon_hidden_behind_opaque_bone_triggers_no_ray_below_a_pixel() {
    let hidden = scene(3.0, 1.0);
    assert!(hidden.array.counts.polygon_hits == 0);
    assert_eq!(below_a_pixel(&hidden), [[0; 2]; 0]);
    // The same behind bone that lets a little through, and in front of it.
    let seen = [scene(3.0, 0.3), scene(-4.6, 1.0)].map(|made| below_a_pixel(&made).len());
    println!("rays below a pixel: 0 behind bone, {} behind gel, {} before bone", seen[0], seen[1]);
    assert!(seen.iter().all(|n| *n > 300));
}

#[test]
fn the_edges_of_a_volume_trigger_no_ray_below_a_pixel() {
    let grid = Grid::axis_aligned([20; 3], [1.0; 3], [-9.5; 3]).unwrap();
    let checks = |[x, y, z]: [usize; 3]| {
        let odd = (x / 3 + y / 3 + z / 3) % 2 == 1;
        [f32::from(u8::from(odd)), 0.5, 0.2, if odd { 1.0 } else { 0.0 }]
    };
    let gel = paint(&grid, checks);
    // A large polygon lies under all of the window: its colours are constant in C_G, though not in C_A.
    let whole = vec![square(DVec3::Y * 2.0, DVec3::new(0.1, 1.0, 0.2), 300.0)];
    for polygons in [vec![], vec![(whole, flat([1.0, 0.0, 0.0], 0.5))]] {
        let scene = Mixture { polygons, ..Mixture::of(grid, gel.clone()) };
        let made = scene.seen((30.0, 20.0), SIZE, HEIGHT).render();
        assert_eq!(below_a_pixel(&made), [[0; 2]; 0]);
        assert!(made.rays_per_pixel() > 0.3, "{}", made.rays_per_pixel());
    }
}

/// Whether the border of a convex polygon passes through a square region of positions, by a margin of a hundredth.
fn crossed(layout: &Layout, outline: &[DVec2], [i, j]: [usize; 2], side: usize) -> bool {
    let holds = |x: usize, y: usize| {
        let at = DVec2::new(layout.window(x), layout.window(y));
        (0..outline.len())
            .map(|k| (outline[(k + 1) % outline.len()] - outline[k]).perp_dot(at - outline[k]))
            .map(f64::signum)
            .sum::<f64>()
            .abs() as usize
            == outline.len()
    };
    let corners = [(0, 0), (side, 0), (0, side), (side, side)].map(|(x, y)| holds(i + x, j + y));
    corners.contains(&true) && corners.contains(&false)
}

/// A turned square in thin gel, and its outline in the window.
fn turned_square(turn: f64) -> (Rendered, Vec<DVec2>) {
    let grid = centred([33, 9, 33], 1.0);
    let turned = DQuat::from_rotation_y(turn);
    let outline = square(DVec3::Y, DVec3::Y, 9.3).into_iter();
    let outline: Vec<_> = outline.map(|v| turned * v + DVec3::new(0.13, 0.0, 0.31)).collect();
    let polygons = vec![(vec![outline.clone()], flat([1.0, 0.1, 0.1], 0.8))];
    let gel = homogeneous(&grid, [0.3, 0.5, 0.9, 0.1]);
    let scene = Mixture { polygons, ..Mixture::of(grid, gel) };
    let made = scene.seen((0.0, 0.0), SIZE, HEIGHT).render();
    let outline = outline.iter().map(|v| made.camera.project(*v).0).collect();
    (made, outline)
}

/// Regions of 2 × 2 positions that the outline crosses. At a corner of the polygon it may cross a region whose parent's
/// corners know nothing of it: that is left out.
fn regions_on(made: &Rendered, outline: &[DVec2]) -> Vec<[usize; 2]> {
    let layout = &made.array.layout;
    let [across, down] = layout.positions().map(|n| n - 2);
    let all = (0..down).step_by(2).flat_map(|j| (0..across).step_by(2).map(move |i| [i, j]));
    let on = |at: &[usize; 2]| {
        crossed(layout, outline, *at, 2) && crossed(layout, outline, at.map(|p| p / 4 * 4), 4)
    };
    all.filter(on).collect()
}

#[test]
fn a_visible_edge_of_a_polygon_has_a_ray_at_every_position_along_it() {
    for turn in [0.0, 0.3, 0.7, 1.1] {
        let (made, outline) = turned_square(turn);
        let regions = regions_on(&made, &outline);
        for &[i, j] in &regions {
            let all = (0..3).all(|y| (0..3).all(|x| made.array.is_cast(i + x, j + y)));
            assert!(all, "turned by {turn}: region at {i} {j}");
        }
        // And nowhere else: within a pixel and a half of the edges alone.
        for [i, j] in below_a_pixel(&made) {
            let at = DVec2::new(made.array.layout.window(i), made.array.layout.window(j));
            let distances = (0..4).map(|e| {
                let (p, q) = (outline[e], outline[(e + 1) % 4]);
                let t = ((at - p).dot(q - p) / (q - p).length_squared()).clamp(0.0, 1.0);
                at.distance(p.lerp(q, t))
            });
            assert!(distances.fold(9.0, f64::min) < 1.5, "turned by {turn}: a ray at {i} {j}");
        }
        println!(
            "turned by {turn}: {} regions of half a pixel on the edge, all nine positions of each cast; {:.2} rays a pixel",
            regions.len(),
            made.rays_per_pixel()
        );
        assert!(regions.len() > 100);
    }
}

#[test]
fn a_pixel_that_edges_cross_on_all_sides_has_all_its_sixteen_rays() {
    // A star of thin triangles that meet in the middle of a pixel.
    let spokes = (0..8).map(|k| {
        let angle = f64::from(k) * std::f64::consts::FRAC_PI_4 + 0.1;
        let ray = |a: f64, r: f64| DVec3::new(r * a.cos(), 0.0, r * a.sin());
        (
            vec![vec![ray(angle, 0.02), ray(angle - 0.2, 9.0), ray(angle + 0.2, 9.0)]],
            flat([1.0; 3], 1.0),
        )
    });
    let scene = Mixture::polygons(spokes.collect()).seen((0.0, 0.0), 21, 21.0);
    let made = scene.render();
    let map = made.array.ray_map();
    let row = 21 * POSITIONS;
    let cast = (0..16).filter(|p| map[(40 + p / 4) * row + 40 + p % 4]).count();
    assert_eq!(cast, 16);
}

#[test]
fn outlines_find_polygons_that_fall_between_the_first_rays() {
    // Slivers half a pixel wide between rays that are two pixels apart.
    let polygons: Vec<_> = (0..5)
        .map(|k| {
            let x = f64::from(k) * 7.0 - 13.7;
            let sliver = [(0.0, -15.0), (0.4, -15.0), (0.4, 15.0), (0.0, 15.0)]
                .map(|(dx, z)| DVec3::new(x + dx, 0.0, z));
            (vec![sliver.to_vec()], flat([1.0; 3], 1.0))
        })
        .collect();
    let sum = |sampling: Sampling| {
        let scene = Mixture { sampling, ..Mixture::polygons(polygons.clone()) };
        let made = scene.seen((0.0, 0.0), SIZE, HEIGHT).render();
        made.picture.pixels.iter().map(|p| f64::from(p[3])).sum::<f64>()
    };
    let [found, lost] = [true, false]
        .map(|outlines| sum(Sampling { outlines, coarsest: 32, ..Sampling::default() }));
    // A ray at every position integrates tents a quarter of a pixel wide to each side: of 0.4 pixels it sees one of them.
    let (area, most) = (5.0 * 0.4 * 30.0, sum(every_position()));
    println!(
        "slivers of {area} pixels: {found:.2} with outlines, {lost:.2} without, {most:.2} at most"
    );
    assert!((most - 5.0 * 0.25 * 30.0).abs() < 0.6, "{most}");
    assert!((found - most).abs() < 0.01 * most, "{found} {most}");
    assert!(lost < 0.01 * most, "{lost}");
}
