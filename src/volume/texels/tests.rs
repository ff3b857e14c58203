//! Facts about gel: what is stored, sampled and called interesting.

use super::*;

const SIZE: [usize; 3] = [17, 9, 12];

/// Linear in each coordinate, so that interpolation must be exact up to rounding.
fn linear(at: Vec3) -> Vec4 {
    let alpha = 0.1 + at.dot(Vec3::new(0.02, 0.03, 0.01));
    Vec4::new(0.5 * alpha, 0.25 * alpha, alpha, alpha)
}

fn gel<T: Texel>() -> Texels<T> {
    let fill = |[x, y, z]: [usize; 3], row: &mut [Vec4]| {
        for (i, texel) in row.iter_mut().enumerate() {
            *texel = linear(Vec3::new((x + i) as f32, y as f32, z as f32));
        }
    };
    Texels::make(SIZE, |_| true, &fill)
}

fn error<T: Texel>() -> f32 {
    let gel = gel::<T>();
    let mut worst = 0.0_f32;
    for step in 0..400 {
        let at = Vec3::new(
            (step * 7 % 160) as f32 / 10.0,
            (step * 3 % 80) as f32 / 10.0,
            (step % 110) as f32 / 10.0,
        );
        let cell = at.to_array().map(|c| c as usize);
        let brick = cell.map(|c| c / CELLS);
        let entry = gel.table()[(brick[2] * 2 + brick[1]) * 3 + brick[0]];
        if entry != EMPTY {
            let sample = gel.slices().sample(entry, cell.map(|c| c % CELLS), at.fract());
            worst = worst.max((sample - linear(at)).abs().max_element());
        }
    }
    worst
}

#[test]
fn a_sample_interpolates_linearly_across_brick_borders() {
    assert!(error::<[f32; 4]>() < 1e-6);
    assert!(error::<[u16; 4]>() < 1.0 / 65535.0);
    assert!(error::<[u8; 4]>() < 1.0 / 255.0);
}

#[test]
fn beyond_the_last_voxel_is_nothing() {
    let gel = gel::<[f32; 4]>();
    let last = gel.table()[gel.table().len() - 1];
    assert_eq!(gel.slices().sample(last, [1, 1, 4], Vec3::ONE), Vec4::ZERO);
    assert_eq!(
        gel.slices().sample(last, [0, 0, 3], Vec3::ZERO),
        linear(Vec3::new(16.0, 8.0, 11.0))
    );
}

#[test]
fn a_cell_is_interesting_if_one_of_its_eight_texels_is() {
    let fill = |[x, y, z]: [usize; 3], row: &mut [Vec4]| {
        for (i, texel) in row.iter_mut().enumerate() {
            if [x + i, y, z] == [8, 3, 5] {
                *texel = Vec4::ONE;
            }
        }
    };
    let gel = Texels::<[f32; 4]>::make([16; 3], |_| true, &fill);
    let mut cells = Vec::new();
    for (at, &brick) in gel.table().iter().enumerate() {
        for (z, word) in gel.interesting_cells(brick).into_iter().enumerate() {
            cells.extend(
                (0..64)
                    .filter(|bit| word >> bit & 1 == 1)
                    .map(|bit| (at % 2 * 8 + bit % 8, at / 2 % 2 * 8 + bit / 8, at / 4 * 8 + z)),
            );
        }
    }
    cells.sort_unstable();
    let expected: Vec<_> = [7, 8]
        .iter()
        .flat_map(|&x| [2, 3].iter().flat_map(move |&y| [4, 5].map(|z| (x, y, z))))
        .collect();
    assert_eq!(cells, expected);
}
