//! Facts about walks: the samples that a ray meets.

use super::*;
use crate::components::View;
use crate::view::extent::Extent;

fn extent() -> Extent {
    Extent { low: DVec3::splat(-10.0), high: DVec3::splat(10.0) }
}

fn camera(azimuth: f64, elevation: f64, roll: f64) -> Camera {
    Camera::new(&View { azimuth, elevation, roll, ..View::default() }, &extent())
}

/// The index of the voxel that a ray of a tile is at, and how far outside the grid that is.
fn index(walk: &Walk, tile: &Tile, lane: usize, k: i64) -> (DVec3, f64) {
    let index = DVec3::from(std::array::from_fn(|axis| tile.place(axis, lane, k) as f64)) / UNIT;
    let last = walk.last.as_dvec3() / UNIT;
    (index, (-index).max(index - last).max_element())
}

#[test]
fn a_tile_is_where_its_rays_are() {
    let grid = Grid::axis_aligned([9, 17, 5], [2.0, 1.0, -3.0], [-8.0, -8.0, 6.0]).unwrap();
    for (azimuth, elevation) in [(0.0, 0.0), (90.0, 0.0), (45.0, 35.0), (200.0, -80.0), (0.0, 90.0)]
    {
        for field_of_view in [None, Some(40.0)] {
            let view = View { azimuth, elevation, field_of_view, ..View::default() };
            let camera = Camera::new(&view, &extent());
            let walk = Walk::new(&grid, &camera, 0.25).unwrap().unwrap();
            let mut tile = Tile::default();
            walk.enter(&TilePlaces::lattice([755, 770], 3), &mut tile);
            assert!(tile.some[0] <= tile.all[0] && tile.all[0] < tile.all[1]);
            assert!(tile.all[1] <= tile.some[1] && !tile.is_empty());
            for (lane, k) in (0..LANES).flat_map(|lane| (-90..90).map(move |k| (lane, k))) {
                let position = [755 + 3 * (lane % 4) as i64, 770 + 3 * (lane / 4) as i64];
                let world = camera.ray(Camera::window(position)).at(0.25 * (k as f64 + 0.5));
                let expected = grid.world_to_index().transform_point3(world);
                let (found, outside) = index(&walk, &tile, lane, k);
                assert!(found.distance(expected) < 1e-9, "{found} {expected}");
                assert_eq!(walk.holds(&tile, lane, k), outside <= 0.0);
                assert!(outside > 0.0 || (tile.some[0]..tile.some[1]).contains(&k));
                assert!(outside <= 0.0 || !(tile.all[0]..tile.all[1]).contains(&k));
            }
        }
    }
}

#[test]
fn a_ray_is_where_it_is_in_whatever_tile_it_lies() {
    let grid = Grid::axis_aligned([300, 170, 50], [0.2, 0.1, -0.3], [-8.0, -8.0, 6.0]).unwrap();
    let camera = camera(23.0, 41.0, 7.0);
    let walk = Walk::new(&grid, &camera, 0.25).unwrap().unwrap();
    let (mut fine, mut coarse) = (Tile::default(), Tile::default());
    walk.enter(&TilePlaces::lattice([704, 640], 8), &mut coarse);
    walk.enter(&TilePlaces::lattice([720, 656], 2), &mut fine);
    // (2, 2) of the coarse tile is (0, 0) of the fine one.
    for axis in 0..3 {
        assert_eq!(coarse.at[axis][10], fine.at[axis][0]);
        assert_eq!(coarse.step[axis][10], fine.step[axis][0]);
    }
}

#[test]
fn a_tile_beside_the_domain_meets_no_sample() {
    let grid = Grid::axis_aligned([5; 3], [1.0; 3], [-2.0; 3]).unwrap();
    let view = View { height_mm: Some(80.0), size: [80; 2], ..View::default() };
    let camera = Camera::new(&view, &extent());
    let walk = Walk::new(&grid, &camera, 1.0).unwrap().unwrap();
    let mut tile = Tile::default();
    // Pixels are as large as voxels; the grid's face is at x = 2, which is window 42, position 4 · 41.5.
    walk.enter(&TilePlaces::lattice([167, 158], 1), &mut tile);
    assert!(tile.is_empty());
    walk.enter(&TilePlaces::lattice([166, 158], 1), &mut tile);
    let held = |lane| (-9..9).filter(|&k| walk.holds(&tile, lane, k)).count();
    assert_eq!([held(0), held(1)], [4, 0]);
}

#[test]
fn a_volume_far_smaller_than_a_position_is_not_met() {
    let grid = Grid::axis_aligned([5; 3], [1e-9; 3], [0.0; 3]).unwrap();
    let distance = grid.spacing().x;
    assert_eq!(Walk::new(&grid, &camera(0.0, 0.0, 0.0), distance).unwrap(), None);
}

#[test]
fn a_step_too_small_or_too_large_is_refused_with_a_remedy() {
    let grid = Grid::axis_aligned([5; 3], [1.0; 3], [0.0; 3]).unwrap();
    for distance in [1e-14, 1e9, f64::NAN] {
        let refused = Walk::new(&grid, &camera(0.0, 0.0, 0.0), distance).unwrap_err();
        assert!(refused.contains("sampling.distance_mm"));
    }
}
