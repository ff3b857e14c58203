//! Facts about the shear: columns run along the light, and windows hold what their slices need.

use super::*;

fn grid() -> Grid {
    Grid::axis_aligned([9, 7, 5], [1.0, -2.0, 1.5], [10.0, 20.0, 30.0]).unwrap()
}

fn shear(toward: [f64; 3]) -> Shear {
    Shear::new(&grid(), DVec3::from(toward).normalize()).unwrap()
}

#[test]
fn slices_lie_across_the_axis_nearest_to_the_light_in_index_space() {
    assert_eq!(shear([0.0, 0.0, 1.0]).axes, [0, 1, 2]);
    assert_eq!(shear([0.0, -1.0, 0.0]).axes, [0, 2, 1]);
    assert_eq!(shear([1.0, 1.0, 0.0]).axes, [1, 2, 0]);
    assert_eq!(shear([0.0, 0.0, 1.0]).distance, 1.5);
    assert_eq!(shear([0.0, 0.0, 1.0]).width(), [9, 7]);
    assert!(Shear::new(&grid(), DVec3::ZERO).is_none());
    assert!(Shear::new(&grid(), DVec3::NAN).is_none());
}

#[test]
fn points_along_the_light_stay_in_their_column_and_slices_are_their_distance_apart() {
    for toward in [[0.3, -0.8, 0.5], [-0.2, 0.1, -0.9], [1.0, 1.0, 1.0], [-0.9, 0.2, 0.3]] {
        let shear = shear(toward);
        let along = -DVec3::from(toward).normalize();
        let from = DVec3::new(12.0, 15.0, 33.0);
        let (column, slice) = shear.locate(from);
        let (same, next) = shear.locate(from + along * shear.distance);
        assert!((next - slice - 1.0).abs() < 1e-9, "{toward:?}");
        assert!((0..2).all(|axis| (same[axis] - column[axis]).abs() < 1e-8), "{toward:?}");
    }
}

#[test]
fn a_place_found_in_a_slice_is_the_voxel_it_came_from() {
    for toward in [[0.3, -0.8, 0.5], [-0.2, 0.1, -0.9], [-0.9, 0.2, 0.3]] {
        let shear = shear(toward);
        let index = shear.index([2.0, 1.0, 3.0]);
        let (column, slice) = shear.locate(grid().index_to_world.transform_point3(index));
        let expected = shear.column([2.0, 1.0], 3.0);
        assert!((slice - 3.0).abs() < 1e-12);
        assert!((0..2).all(|axis| (column[axis] - expected[axis]).abs() < 1e-9), "{toward:?}");
        assert_eq!(index[shear.axes[2]] as usize, shear.flip(3));
    }
}

#[test]
fn a_window_holds_both_neighbours_of_every_voxel_of_its_slice() {
    for toward in [[0.3, -0.8, 0.5], [-0.2, 0.1, -0.9], [1.0, -1.0, 1.0], [0.0, 0.0, 1.0]] {
        let shear = shear(toward);
        for slice in 0..shear.size[2] {
            let (window, width) = (shear.window(slice), shear.width());
            for (axis, &width) in width.iter().enumerate() {
                let last = shear.size[axis] as f64 - 1.0 + window.phase[axis];
                assert!((0.0..1.0).contains(&window.phase[axis]));
                assert!(last.ceil() < width as f64, "{toward:?} slice {slice}");
            }
        }
    }
}

#[test]
fn columns_are_read_where_they_are_and_are_fresh_before_they_enter() {
    let shear = shear([0.0, 0.5, -1.0]);
    let width = shear.width()[0];
    // Of every slice: 100 × its number + the number of the column down.
    let stored = |slice: usize| -> Vec<f64> {
        let low = shear.window(slice).low[1] as f64;
        (0..width * shear.width()[1])
            .map(|at| 100.0 * slice as f64 + (at / width) as f64 + low)
            .collect()
    };
    let slices: Vec<_> = (0..shear.size[2]).map(stored).collect();
    let at = |column: [f64; 2], along: f64| {
        let place = shear.place(column, along);
        shear.interpolate(place.as_ref(), |slice| &slices[slice][..], || -7.0)
    };
    assert!((at([3.0, 2.25], 1.5) - 152.25).abs() < 1e-9);
    assert_eq!(at([3.0, 2.0], -0.5), -7.0);
    assert_eq!(at([3.0, 2.0], 99.0), 402.0);
    // Columns enter where y is least here, and leave where it is greatest: fresh before, the border's value behind.
    let [from, to] = shear.span([3.0, -0.5]);
    assert!(0.0 < from && from < 4.0 && to == 4.0);
    assert_eq!(at([3.0, -5.0], 1.0), -7.0);
    assert_eq!(at([3.0, 50.0], 0.0), 7.0);
    assert!(shear.span([-1.0, 2.0])[0] > shear.span([-1.0, 2.0])[1]);
}
