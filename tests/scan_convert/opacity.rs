//! Facts about opacity: what a ray gathers of a plane, against angle, phase, sample distance and direction in the grid.

use gelray::volume::grid::Grid;
use glam::DVec3;

use crate::scene::{Tracer, cover, cube, rectangle};

/// Mean and least and most of the opacity over 64 phases: 8 of the plane between voxels, 8 of the samples.
struct Seen {
    mean: f64,
    least: f64,
    most: f64,
}

impl Seen {
    fn of(opacities: &[f64]) -> Self {
        let mean = opacities.iter().sum::<f64>() / opacities.len() as f64;
        let least = opacities.iter().copied().fold(f64::INFINITY, f64::min);
        let most = opacities.iter().copied().fold(0.0, f64::max);
        Self { mean, least, most }
    }

    /// The largest difference between phases as a part of the stated opacity.
    fn spread(&self, stated: f64) -> f64 {
        (self.most - self.least) / stated
    }
}

/// A plane through `center`, moved by eighths of a voxel along `normal`, seen in direction `along`.
fn phases(grid: Grid, normal: DVec3, along: DVec3, form: (f32, bool), distance: f64) -> Seen {
    let [low, .., high] = grid.corners();
    let center = low.midpoint(high);
    // A voxel along the normal, in the world.
    let layer = (grid.index_to_world.matrix3.transpose() * normal.normalize()).length();
    let mut opacities = Vec::new();
    for plane in 0..8 {
        let center = center + normal.normalize() * (layer * f64::from(plane) / 8.0);
        let face = rectangle(center, normal, 1000.0 * layer);
        let opacity = cover(grid, vec![face], form.0, form.1).0.opacity;
        let unit = grid.spacing().min_element();
        let tracer = Tracer { grid, opacity: &opacity, along, distance, unit };
        opacities.extend((0..8).map(|n| {
            // Each ray elsewhere in its cell, too.
            let aside = along.any_orthonormal_vector() * (f64::from(n * 3 % 8) / 8.0);
            tracer.trace(center + aside, (f64::from(n) + 0.5) / 8.0)
        }));
    }
    Seen::of(&opacities)
}

#[test]
fn a_plane_seen_aslant_is_a_slab_of_gel_and_face_on_it_is_as_opaque_as_stated_only_if_calibrated() {
    let grid = Grid::axis_aligned([96, 8, 16], [1.0; 3], [0.0; 3]).unwrap();
    println!("form        alpha  distance  degrees    mean   slab   least    most");
    for (calibrated, stated) in
        [false, true].into_iter().flat_map(|c| [0.1, 0.5, 0.9, 1.0].map(|o| (c, o)))
    {
        for distance in [1.0, 0.5, 0.25] {
            for degrees in [0_u32, 30, 45, 60, 75, 85] {
                let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
                let along = DVec3::new(sin, 0.0, cos);
                let seen = phases(grid, DVec3::Z, along, (stated, calibrated), distance);
                let slab = 1.0 - (1.0 - f64::from(stated)).powf(1.0 / cos);
                let form = if calibrated { "calibrated" } else { "printed   " };
                let Seen { mean, least, most } = seen;
                println!(
                    "{form}  {stated:4}  {distance:8}  {degrees:7}  {mean:.4} {slab:.4}  {least:.4}  {most:.4}"
                );
                if calibrated {
                    assert!(
                        (mean / slab - 1.0).abs() <= 0.02,
                        "{stated} {distance} {degrees}: {mean}"
                    );
                    assert!(
                        seen.spread(slab) <= 0.05,
                        "{stated} {distance} {degrees}: {least} {most}"
                    );
                    assert!(stated < 1.0 || least > 0.99);
                }
            }
        }
    }
}

#[test]
fn the_printed_ball_leaks_between_samples_as_the_algorithm_page_says() {
    let through = |plane: f64, distance: f64, phase: f64| {
        let center = DVec3::new(6.0, 6.0, 6.0 + plane);
        let opacity = cover(cube(13), vec![rectangle(center, DVec3::Z, 1e3)], 1.0, false).0.opacity;
        let tracer =
            Tracer { grid: cube(13), opacity: &opacity, along: DVec3::Z, distance, unit: 1.0 };
        1.0 - tracer.trace(center, phase)
    };
    assert!((through(0.0, 1.0, 0.5) - 0.25).abs() < 1e-6);
    assert!((through(0.0, 1.0 / 256.0, 0.5) - 0.135).abs() < 0.002);
    let half_way: Vec<f64> =
        (0..16).map(|n| through(0.5, 1.0, (f64::from(n) + 0.5) / 16.0)).collect();
    assert!(half_way.iter().all(|t| (0.055..=0.105).contains(t)), "{half_way:?}");
}

#[test]
fn planes_of_every_direction_in_the_grid_are_as_opaque_as_stated_face_on() {
    println!("normal     alpha  distance    mean   least    most");
    for normal in
        [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [1.0, 2.0, 3.0], [5.0, 0.3, 0.1]]
            .map(DVec3::from)
    {
        for (stated, distance) in
            [0.1, 0.5, 0.9, 1.0].into_iter().flat_map(|o| [1.0, 0.5].map(|d| (o, d)))
        {
            let seen = phases(cube(24), normal, normal, (stated, true), distance);
            let Seen { mean, least, most } = seen;
            println!("{normal}  {stated:4}  {distance:8}  {mean:.4}  {least:.4}  {most:.4}");
            let stated = f64::from(stated);
            // Tri-linear interpolation leaves a ripple on planes aslant in the grid: the fainter, the more.
            assert!((mean / stated - 1.0).abs() <= 0.02, "{normal} {stated}: {mean}");
            assert!(seen.spread(stated) <= 0.125, "{normal} {stated}: {least} {most}");
            assert!(stated < 1.0 || least > 0.99, "{normal}: {least}");
        }
    }
}

#[test]
fn planes_in_voxels_of_unequal_sides_are_as_opaque_as_stated_face_on() {
    println!("spacing      normal     alpha    mean   least    most");
    for spacing in [[1.0, 1.0, 2.0], [0.5, 1.0, -2.0], [1.0, 1.0, 5.0]] {
        let grid = Grid::axis_aligned([20, 20, 16], spacing, [7.0, -3.0, 0.0]).unwrap();
        for normal in
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 1.0]].map(DVec3::from)
        {
            for stated in [0.1, 0.5, 0.9, 1.0] {
                let distance = grid.spacing().min_element();
                let seen = phases(grid, normal, normal, (stated, true), distance);
                let Seen { mean, least, most } = seen;
                println!("{spacing:?}  {normal}  {stated:4}  {mean:.4}  {least:.4}  {most:.4}");
                let stated = f64::from(stated);
                assert!(
                    (mean / stated - 1.0).abs() <= 0.02,
                    "{spacing:?} {normal} {stated}: {mean}"
                );
                assert!(
                    seen.spread(stated) <= 0.05,
                    "{spacing:?} {normal} {stated}: {least} {most}"
                );
                assert!(stated < 1.0 || least > 0.99);
            }
        }
    }
}
