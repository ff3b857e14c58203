//! Facts about fields: what is straight is exact, what is no number is told, and no bit depends on instructions.

use super::*;

const ALL: [Filter; 4] = [Filter::Linear, Filter::Cubic, Filter::CatmullRom, Filter::Interpolating];

/// Every set of instructions that this machine has.
pub(crate) fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = vec![best, Level::baseline()];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_avx2().map(Level::Avx2));
        levels.extend(best.as_sse4_2().map(Level::Sse4_2));
    }
    levels
}

/// Spots all over a grid, on its borders and on voxels too.
fn spots(size: [usize; 3]) -> Vec<Spot> {
    let all = 0..4 * size.iter().product::<usize>();
    let part = |n: usize| (n % 5) as f32 / 4.0;
    let spot = |at: usize| {
        let cell = [at % size[0], at / size[0] % size[1], at / (size[0] * size[1]) % size[2]];
        Spot { cell, part: [part(at), part(at / 3), part(at * 7 / 5)] }
    };
    all.map(spot).collect()
}

fn sampled(field: &Field, level: Level, spots: &[Spot]) -> Vec<Sampled> {
    let mut made = vec![Sampled::default(); spots.len()];
    field.sample(level, spots, &mut made);
    made
}

#[test]
fn a_linear_field_and_its_gradient_are_exact_in_every_filter_up_to_the_borders() {
    let grid = Grid::axis_aligned([5, 2, 3], [0.5, 2.0, -1.0], [0.0; 3]).unwrap();
    let value = |x: usize, y: usize, z: usize| (3 * x + 8 * y + 5 * z) as u16;
    let voxels: Vec<u16> = (0..30).map(|at| value(at % 5, at / 5 % 2, at / 10)).collect();
    let scalars = Scalars::from(voxels);
    for filter in ALL {
        let field = Field::new(&scalars, &grid, filter);
        for spot in spots(grid.size) {
            let inside = (0..3).all(|axis| spot.cell[axis] + 1 < grid.size[axis]);
            let place: [f32; 3] =
                std::array::from_fn(|axis| spot.cell[axis] as f32 + spot.part[axis]);
            let Sampled { value, gradient } = sampled(&field, Level::new(), &[spot])[0];
            let expected = 3.0 * place[0] + 8.0 * place[1] + 5.0 * place[2];
            assert!(!inside || (value - expected).abs() < 1e-4, "{filter:?} {spot:?} {value}");
            let [x, y, z] = gradient;
            let slope = (x - 6.0).abs().max((y - 4.0).abs()).max((z + 5.0).abs());
            assert!(slope < 1e-4, "{filter:?} {spot:?} {gradient:?}");
        }
    }
}

#[test]
fn no_bit_depends_on_the_set_of_instructions() {
    let grid = Grid::axis_aligned([7, 6, 5], [0.7, 1.1, 0.9], [0.0; 3]).unwrap();
    let voxels: Vec<f32> = (0..210).map(|at| (at * at % 97) as f32 / 7.0).collect();
    let scalars = Scalars::from(voxels);
    for filter in ALL {
        let field = Field::new(&scalars, &grid, filter);
        let spots = spots(grid.size);
        let best = sampled(&field, Level::new(), &spots);
        let values: Vec<f32> = best.iter().map(|sampled| sampled.value).collect();
        for level in levels() {
            assert_eq!(sampled(&field, level, &spots), best, "{filter:?} {level:?}");
            let mut alone = vec![0.0; spots.len()];
            field.values(level, &spots, &mut alone);
            assert_eq!(alone, values, "{filter:?} {level:?}");
        }
    }
}

#[test]
fn what_is_no_number_is_told_and_where_nothing_changes_there_is_no_gradient() {
    let grid = Grid::axis_aligned([6; 3], [0.7, 1.1, 0.9], [0.0; 3]).unwrap();
    let mut voxels = vec![0.3_f32; 216];
    let constant = Scalars::from(&voxels);
    voxels[0] = f32::NAN;
    let holed = Scalars::from(voxels);
    for filter in ALL {
        let same = sampled(&Field::new(&constant, &grid, filter), Level::new(), &spots([6; 3]));
        assert!(same.iter().all(|s| *s == Sampled { value: 0.3, gradient: [0.0; 3] }));
        let field = Field::new(&holed, &grid, filter);
        let near = Spot { cell: [0; 3], part: [0.5; 3] };
        let far = Spot { cell: [3; 3], part: [0.5; 3] };
        let made = sampled(&field, Level::new(), &[near, far]);
        assert!(made[0].value.is_nan() && made[0].gradient == [0.0; 3]);
        assert_eq!(made[1], Sampled { value: 0.3, gradient: [0.0; 3] });
    }
}
