//! Volumes of different kinds side by side: a shadow from one on another, RGBA beside scalars, a grid that is turned.

use gelray::components::{
    CastsShadow, Classify, Color, Light, Material, Sampling, TransferPoint, View,
};
use gelray::light::strength::LightStrength;
use gelray::polygon::face::Faces;
use gelray::prelude::{Renderer, polygon};
use gelray::view::picture::Picture;
use gelray::volume::grid::{Grid, Painted, Scalars};
use glam::{DAffine3, DQuat, DVec3};
use hecs::World;

use super::support::{Mixture, bits, centred, every_pixel, homogeneous, paint, worst};

/// Scalars that fall upwards, so that all normals point up, of one opacity a world unit and one color.
fn scalars(grid: &Grid, opacity: f32, material: Material) -> (Grid, Scalars, Classify, Material) {
    let [nx, ny, _] = grid.size;
    let values: Vec<f32> = (0..grid.voxels()).map(|at| -((at / (nx * ny)) as f32)).collect();
    let point = |value| TransferPoint { value, opacity, color: None };
    let transfer = vec![point(-1e6), point(1e6)];
    (*grid, values.into(), Classify { transfer, ..Classify::default() }, material)
}

fn seen_from_the_side(height: f64) -> (View, Sampling) {
    let (focal_point, height_mm) = (Some([0.0; 3]), Some(height));
    (View { focal_point, height_mm, size: [24; 2], ..View::default() }, every_pixel())
}

fn rendered(world: &mut World) -> Picture {
    Renderer::new().unwrap().render(world).unwrap().picture
}

#[test]
fn the_shadow_of_one_volume_on_another_is_what_the_first_lets_through() {
    let (below, opacity) = (centred([17, 9, 13], 1.0), 0.05_f32);
    let above = Grid::axis_aligned([33, 25, 6], [1.0, 1.0, 2.0], [-16.0, -12.0, 20.0]).unwrap();
    let material = Material { ambient: 0.0, diffuse: 1.0, ..Material::default() };
    let made = |veil: Option<f32>| {
        let mut world = World::new();
        let below = world.spawn(scalars(&below, opacity, material.clone()));
        if let Some(alpha) = veil {
            world.spawn((above, homogeneous(&above, [0.1, 0.2, 0.9, alpha])));
        }
        let shadow = CastsShadow { bias_voxels: 0.0, ..CastsShadow::default() };
        let light = world.spawn((Light::from_direction([0.0, 0.0, 1.0]), shadow));
        world.spawn(seen_from_the_side(10.0));
        let picture = rendered(&mut world);
        let strength = (*world.get::<&LightStrength>(light).unwrap()).clone();
        (picture, strength.of(below).unwrap().clone())
    };
    let (bare, _) = made(None);
    for alpha in [0.1_f32, 0.4, 0.8] {
        let (veiled, strength) = made(Some(alpha));
        // Ten world units of gel whose opacity is stated for its smallest spacing, 1.
        let through = (1.0 - f64::from(alpha)).powi(10);
        for z in [0, 5, 11] {
            let own = (1.0 - f64::from(opacity)).powi(12 - z as i32);
            let found =
                f64::from(strength.voxels.value([8, 4, z])) / 65535.0 * f64::from(strength.full);
            let off = (found - own * through).abs();
            assert!(off < 2e-5, "{alpha} at {z}: {found} {}", own * through);
        }
        // Seen from the side, through the lower volume alone: its color is dimmed, its opacity is not.
        for (lit, dim) in bare.pixels.iter().zip(veiled.pixels.iter()) {
            assert_eq!(lit[3].to_bits(), dim[3].to_bits());
            let off = f64::from(dim[0]) - f64::from(lit[0]) * through;
            assert!(off.abs() < 2e-5 && lit[0] > 0.02, "{alpha}: {off} of {}", lit[0]);
        }
    }
}

#[test]
fn a_volume_of_colors_beside_one_of_scalars_looks_as_each_alone_and_before_it_covers_it() {
    let small = [9, 9, 9];
    let ambient = Material { ambient: 1.0, diffuse: 0.0, ..Material::default() };
    let green = Material { color: Color::from_srgb([0.0, 1.0, 0.0]), ..ambient };
    let at = |x: f64, y: f64| Grid::axis_aligned(small, [1.0; 3], [x, y, -4.0]).unwrap();
    let picture = |painted: Option<Grid>, measured: Option<Grid>| {
        let mut world = World::new();
        if let Some(grid) = painted {
            world.spawn((grid, homogeneous(&grid, [1.0, 0.0, 0.0, 0.07])));
        }
        if let Some(grid) = measured {
            world.spawn(scalars(&grid, 0.04, green.clone()));
        }
        world.spawn(seen_from_the_side(24.0));
        rendered(&mut world)
    };
    // Side by side: no ray meets both.
    let (left, right) = (at(-10.0, -4.0), at(2.0, -4.0));
    let both = picture(Some(left), Some(right));
    let (paint, tissue) = (picture(Some(left), None), picture(None, Some(right)));
    let sum: Vec<_> = paint
        .pixels
        .iter()
        .zip(tissue.pixels.iter())
        .map(|(p, t)| std::array::from_fn(|channel| p[channel] + t[channel]))
        .collect();
    assert_eq!(bits(&both), bits(&Picture::new(both.size, sum).unwrap()));
    // One behind the other: eight slabs of red gel, then eight of green.
    let both = picture(Some(at(-4.0, -10.0)), Some(at(-4.0, 2.0)));
    let red = 1.0 - (1.0_f64 - f64::from(0.07_f32)).powi(8);
    let behind = (1.0 - red) * (1.0 - (1.0_f64 - f64::from(0.04_f32)).powi(8));
    let [r, g, b, alpha] = both.pixel(12, 12).map(f64::from);
    for (found, expected) in [(r, red), (g, behind), (b, 0.0), (alpha, red + behind)] {
        assert!((found - expected).abs() < 2e-5, "{found} {expected}");
    }
}

/// Three soft lumps of gel in a ball about the origin.
fn lumps(p: DVec3) -> [f32; 4] {
    let lump = |at: [f64; 3], width: f64| (-p.distance_squared(at.into()) / (width * width)).exp();
    let [a, b, c] =
        [lump([3.0, 1.0, -2.0], 3.0), lump([-2.0, 3.0, 2.0], 2.5), lump([0.0, -3.0, 3.0], 3.5)];
    let sum = a + b + c + 1e-9;
    let alpha = 0.3 * (a + 0.7 * b + 0.5 * c).min(1.0);
    [(a / sum) as f32, (b / sum) as f32, 0.4, alpha as f32]
}

#[test]
fn a_turned_grid_shows_what_a_straight_one_of_the_same_field_shows_to_second_order() {
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, 0.8, 0.5).normalize(), 0.7);
    let errors = [1.0, 0.5].map(|h| {
        let half = (13.0 / h) as usize;
        let straight = centred([2 * half + 1; 3], h);
        let turned = DAffine3::from_quat(turn) * straight.index_to_world;
        let turned = Grid::new(straight.size, turned).unwrap();
        let picture = |grid: Grid| {
            let gel: Painted = paint(&grid, |voxel| {
                let index = DVec3::from(voxel.map(|v| v as f64));
                lumps(grid.index_to_world.transform_point3(index))
            });
            let sampling = Sampling { distance_mm: Some(h), ..every_pixel() };
            let mixture = Mixture { unit: 1.0, sampling, ..Mixture::of(grid, gel) };
            mixture.seen((25.0, 10.0), 32, 16.0).render().picture
        };
        worst(&picture(straight), &picture(turned))
    });
    println!("turned against straight: off by {errors:.5?} at voxels of 1 and 1/2");
    assert!(errors[0] / errors[1] > 3.0 && errors[1] < 4e-3, "{errors:?}");
}

#[test]
fn a_polygon_is_shadowed_by_every_volume_on_its_way_to_the_light() {
    // Two veils over a floor: what reaches it is the product of what they let through, in either order.
    let veil = |z: f64| Grid::axis_aligned([25, 25, 5], [1.0; 3], [-12.0, -12.0, z]).unwrap();
    let floor = [[-9.0, -9.0, -6.0], [9.0, -9.0, -6.0], [9.0, 9.0, -6.0], [-9.0, 9.0, -6.0]];
    let lit = |alphas: [f32; 2]| {
        let mut world = World::new();
        for (z, alpha) in [4.0, 12.0].into_iter().zip(alphas) {
            let grid = veil(z);
            world.spawn((grid, homogeneous(&grid, [0.0, 0.0, 0.0, alpha])));
        }
        let surface = gelray::components::Surface {
            ambient: 0.0,
            diffuse: 1.0,
            ..gelray::components::Surface::default()
        };
        let floor: Faces = polygon(&floor).unwrap();
        world.spawn((floor, surface));
        world.spawn((Light::from_direction([0.0, 0.0, 1.0]), CastsShadow::default()));
        let view = View { elevation: 20.0, ..seen_from_the_side(14.0).0 };
        let focal_point = Some([0.0, 0.0, -6.0]);
        world.spawn((View { focal_point, height_mm: Some(4.0), ..view }, every_pixel()));
        rendered(&mut world).pixel(12, 12)[0]
    };
    let clear = lit([0.0, 0.0]);
    for alphas in [[0.2_f32, 0.0], [0.0, 0.2], [0.2, 0.3], [0.3, 0.2]] {
        let through: f64 = alphas.iter().map(|a| (1.0 - f64::from(*a)).powi(4)).product();
        let found = f64::from(lit(alphas)) / f64::from(clear);
        assert!((found - through).abs() < 2e-3, "{alphas:?}: {found} {through}");
    }
}
