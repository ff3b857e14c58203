//! Facts about hulls: no place between voxels is outside of them, and they are not much wider than what is there.

use fearless_simd::Level;
use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::*;
use crate::volume::field::{Field, Sampled, Spot};
use crate::volume::grid::{Grid, Scalars};

const CUBICS: [Filter; 3] = [Filter::Cubic, Filter::CatmullRom, Filter::Interpolating];

/// A brick's hull, and all that its field is at 6³ places of a cell.
fn check(
    (size, shear): ([usize; 3], f64),
    filter: Filter,
    value: impl Fn(usize) -> f32,
    mut told: impl FnMut([f32; 2], f64, &[Sampled]),
) {
    let matrix = DMat3::from_cols(
        DVec3::new(0.5, 0.0, 0.0),
        DVec3::new(shear, 2.0, 0.0),
        DVec3::new(0.0, shear, -1.0),
    );
    let grid = Grid::new(size, DAffine3 { matrix3: matrix, translation: DVec3::ZERO }).unwrap();
    let voxels: Vec<f32> = (0..grid.voxels()).map(value).collect();
    let scalars = Scalars::from(voxels.clone());
    let field = Field::new(&scalars, &grid, filter);
    let slopes = matrix.inverse().transpose();
    let axes = Axes::new([slopes.x_axis, slopes.y_axis, slopes.z_axis]);
    let counts = size.map(|n| n.div_ceil(EDGE));
    for at in 0..counts.iter().product() {
        let brick = [at % counts[0], at / counts[0] % counts[1], at / (counts[0] * counts[1])];
        let first = brick.map(|n| n * EDGE);
        let hull = Hull::of(&voxels, (size, first), (filter, true)).unwrap();
        let [ex, ey, ez]: [usize; 3] = std::array::from_fn(|a| EDGE.min(size[a] - first[a]));
        for (z, y, x) in
            (0..ez).flat_map(|z| (0..ey).flat_map(move |y| (0..ex).map(move |x| (z, y, x))))
        {
            let part = |n: usize| n as f32 / 5.0;
            let cell = [first[0] + x, first[1] + y, first[2] + z];
            let spots: Vec<Spot> = (0..216)
                .map(|n| Spot { cell, part: [part(n % 6), part(n / 6 % 6), part(n / 36)] })
                .collect();
            let mut made = vec![Sampled::default(); spots.len()];
            field.sample(Level::new(), &spots, &mut made);
            let [low, high] = hull.values(y, z, 1e-6);
            told([low[x], high[x]], hull.gradients(y, z, 1e-6, &axes)[x], &made);
        }
    }
}

#[test]
fn no_value_and_no_gradient_leaves_the_hull_of_its_cell() {
    for (size, shear) in [([2, 9, 3], 0.0), ([12, 4, 10], 0.3), ([9, 8, 17], 0.0)] {
        for filter in CUBICS {
            let rough = |at: usize| (at * at * 7 % 101) as f32 - 40.0;
            check((size, shear), filter, rough, |[low, high], steepest, made| {
                for Sampled { value, gradient } in made {
                    assert!((low..=high).contains(value), "{filter:?}: {value} {low} {high}");
                    let length = f64::from(Vec3::from(*gradient).length());
                    assert!(length <= steepest, "{filter:?}: {length} {steepest}");
                }
            });
        }
    }
}

#[test]
fn of_a_smooth_field_the_hull_is_hardly_wider_than_what_is_there() {
    let size = [10, 10, 10];
    let smooth = |at: usize| {
        let place = DVec3::new((at % 10) as f64, (at / 10 % 10) as f64, (at / 100) as f64);
        ((place * DVec3::new(0.4, 0.3, 0.5)).to_array().map(f64::sin).iter().sum::<f64>()) as f32
    };
    for filter in CUBICS {
        let (mut hulls, mut fields, mut slopes, mut longest) = (0.0, 0.0, 0.0, 0.0);
        check((size, 0.0), filter, smooth, |[low, high], steepest, made| {
            let values = made.iter().map(|sampled| sampled.value);
            let least = values.clone().fold(f32::INFINITY, f32::min);
            fields += values.fold(f32::NEG_INFINITY, f32::max) - least;
            hulls += high - low;
            slopes += steepest;
            let lengths = made.iter().map(|s| f64::from(Vec3::from(s.gradient).length()));
            longest += lengths.fold(0.0, f64::max);
        });
        println!("{filter:?}: {} as wide, {} as steep", hulls / fields, slopes / longest);
        let spline = filter != Filter::CatmullRom;
        assert!(hulls < if spline { 1.25 } else { 1.5 } * fields, "{filter:?}");
        assert!(slopes < if spline { 1.5 } else { 3.5 } * longest, "{filter:?}");
    }
}

#[test]
fn what_is_no_number_has_no_hull() {
    let mut voxels = vec![1.0_f32; 64];
    voxels[9] = f32::INFINITY;
    assert!(Hull::of(&voxels, ([4; 3], [0; 3]), (Filter::Cubic, true)).is_none());
}
