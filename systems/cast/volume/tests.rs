//! Facts about samples and leaps on random rays: no leap passes a sample that is not empty, and no sample lies outside the domain.

use glam::{DAffine3, DMat3, DQuat, DVec2};
use proptest::array::uniform3;
use proptest::prelude::*;

use super::*;
use crate::components::View;
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::volume::gel::Texels;
use crate::volume::grid::Grid;
use crate::volume::pyramid::Pyramid;

/// Gel in few voxels of a grid, seen from somewhere.
#[derive(Debug, Clone)]
struct Case {
    grid: Grid,
    view: View,
    /// Δ, world units.
    distance: f64,
    seed: u64,
    /// Of a thousand bricks, and of a thousand voxels in them, so many hold gel.
    held: [u64; 2],
}

fn angles() -> impl Strategy<Value = f64> {
    prop_oneof![
        (-8..=8_i32).prop_map(|eighth| f64::from(eighth) * 45.0),
        -360.0..360.0,
        (0..4_i32, -1e-9..1e-9).prop_map(|(quarter, off)| f64::from(quarter) * 90.0 + off),
    ]
}

fn cases() -> impl Strategy<Value = Case> {
    let steps = prop_oneof![Just(1.0), Just(0.5), Just(0.125), 1e-3..0.1, 0.1..9.0];
    let placed = (uniform3(2..=90_usize), uniform3(0.3..2.0), uniform3(-0.6..0.6), any::<u8>());
    let held = prop_oneof![Just([50, 2]), Just([300, 1]), Just([1000, 20]), Just([10, 500])];
    let view = (angles(), angles(), angles());
    (placed, view, steps, any::<u64>(), held, any::<bool>()).prop_map(
        |((size, spacing, shear, flips), (azimuth, elevation, roll), step, seed, held, whole)| {
            let flip = |axis: usize| if flips >> axis & 1 == 1 { -1.0 } else { 1.0 };
            let spacing = if whole { [1.0; 3] } else { spacing };
            let scale = std::array::from_fn::<_, 3, _>(|axis| flip(axis) * spacing[axis]);
            let scale = DMat3::from_diagonal(scale.into());
            let turned = DMat3::from_quat(DQuat::from_rotation_x(shear[0]))
                * DMat3::from_cols(
                    DVec3::X,
                    DVec3::new(shear[1], 1.0, 0.0),
                    DVec3::new(0.0, shear[2], 1.0),
                );
            let matrix3 = if flips & 8 == 8 { turned * scale } else { scale };
            let translation = matrix3 * -DVec3::from(size.map(|n| (n - 1) as f64 / 2.0));
            let grid = Grid::new(size, DAffine3 { matrix3, translation }).unwrap();
            let view = View { azimuth, elevation, roll, size: [5; 2], ..View::default() };
            let distance = step * grid.spacing().min_element();
            Case { grid, view, distance, seed, held }
        },
    )
}

fn random(seed: u64, at: [usize; 3]) -> u64 {
    let mut z = at
        .iter()
        .fold(seed, |z, &n| (z ^ n as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23));
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z ^ z >> 29
}

impl Case {
    fn gel(&self) -> Texels<[f32; 4]> {
        let holds = |voxel: [usize; 3]| {
            let brick = random(!self.seed, voxel.map(|n| n / CELLS));
            brick % 1000 < self.held[0] && random(self.seed, voxel) % 1000 < self.held[1]
        };
        let fill = |[x, y, z]: [usize; 3], row: &mut [Vec4]| {
            for (i, texel) in row.iter_mut().enumerate().filter(|(i, _)| holds([x + i, y, z])) {
                *texel = Vec4::new(0.2, 0.3, 0.1, 0.1 + 0.1 * (i % 8) as f32);
            }
        };
        let size = self.grid.size;
        let stored = |brick: [usize; 3]| {
            let first = brick.map(|b| b * CELLS);
            let n: [usize; 3] = std::array::from_fn(|a| (CELLS + 1).min(size[a] - first[a]));
            let mut all =
                (0..n[0] * n[1] * n[2]).map(|i| [i % n[0], i / n[0] % n[1], i / (n[0] * n[1])]);
            all.any(|at| holds(std::array::from_fn(|axis| first[axis] + at[axis])))
        };
        Texels::make(size, stored, fill)
    }
}

type Taken = Vec<(i64, [u32; 4])>;

/// Every sample of a ray that is not empty: its number, and the bits of what was sampled.
fn taken(volume: &Volume<'_, [f32; 4]>, mut cursor: Cursor, until: i64) -> Taken {
    let (mut taken, mut counts) = (Vec::new(), Counts::default());
    for until in [until, i64::MAX] {
        loop {
            let mut sample = None;
            volume.visit(&mut cursor, until, &mut counts, |seen| {
                sample = Some(seen);
                false
            });
            let Some(sample) = sample else { break };
            if sample != Vec4::ZERO {
                taken.push((cursor.k - 1, sample.to_array().map(f32::to_bits)));
            }
        }
    }
    taken
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_leap_passes_no_sample_that_is_not_empty(case in cases(), places in proptest::collection::vec((0.0..1.0, 0.0..1.0, any::<i8>()), 12)) {
        let gel = case.gel();
        let pyramid = Pyramid::of(&gel);
        let camera = Camera::new(&case.view, &Extent::of(case.grid.corners()).unwrap());
        let walk = Walk::new(&case.grid, &camera, case.distance).unwrap();
        let volume = |pyramid| Volume {
            walk, gel: gel.slices(), ambient: None, pyramid, ratio: 1.0, distance: case.distance, cue: None, dust: None,
        };
        for (x, y, until) in places {
            // Some rays through the very middle, where views along an axis run in planes of voxels.
            let window = if until == 0 { DVec2::splat(2.5) } else { DVec2::new(x, y) * 5.0 };
            let Some(samples) = walk.enter(camera.origin(window)) else { continue };
            let cursor = Cursor::new(&walk, samples, [i64::MIN, i64::MAX], DVec3::ZERO);
            let all = taken(&volume(None), cursor, i64::MAX);
            prop_assert!(all.iter().all(|(k, _)| (samples.first..samples.end).contains(k)));
            // Wherever a polygon interrupts the walk.
            let until = samples.first + i64::from(until);
            prop_assert_eq!(&taken(&volume(Some(pyramid.slices())), cursor, until), &all);
        }
    }

    #[test]
    fn the_samples_of_any_ray_are_exactly_those_within_the_domain(case in cases(), x in -0.2..1.2, y in -0.2..1.2, moved in -1e6..1e6) {
        let mut grid = case.grid;
        grid.index_to_world.translation += DVec3::splat(moved);
        let camera = Camera::new(&case.view, &Extent::of(grid.corners()).unwrap());
        let walk = Walk::new(&grid, &camera, case.distance).unwrap();
        let origin = camera.origin(DVec2::new(x, y) * 5.0);
        let inside = |k: i64, slack: f64| {
            let world = origin + camera.forward * ((k as f64 + 0.5) * case.distance);
            let index = grid.world_to_index().transform_point3(world);
            let last = DVec3::from(grid.size.map(|n| (n - 1) as f64));
            index.min(last - index).min_element() > slack
        };
        let reach = (case.grid.corners()[0].length() / case.distance) as i64 + 2;
        // A ray has few thousand samples; of more, some stretches.
        let numbers = (-reach..=reach).step_by(1 + reach as usize / 20_000);
        let entered = walk.enter(origin);
        for k in numbers {
            let taken = entered.is_some_and(|samples| (samples.first..samples.end).contains(&k));
            prop_assert!(taken || !inside(k, 1e-6), "sample {} is left out", k);
            prop_assert!(!taken || inside(k, -1e-6), "sample {} is outside", k);
        }
    }
}
