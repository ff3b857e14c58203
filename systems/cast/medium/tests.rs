//! Facts about samples and leaps on random rays: no leap passes a sample that is not empty, and no sample lies outside the domain.

use glam::{DAffine3, DMat3, DQuat};
use proptest::array::uniform3;
use proptest::prelude::*;

use super::super::lanes::each;
use fearless_simd::{Level, dispatch};

use super::*;
use crate::components::View;
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::view::walk::TilePlaces;
use crate::volume::field::tests::levels;
use crate::volume::gel::{CELLS, Texels};
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
    let view = (angles(), angles(), angles(), prop_oneof![Just(None), (0.1..150.0).prop_map(Some)]);
    (placed, view, steps, any::<u64>(), held, any::<bool>()).prop_map(
        |(
            (size, spacing, shear, flips),
            (azimuth, elevation, roll, field_of_view),
            step,
            seed,
            held,
            whole,
        )| {
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
            let view =
                View { azimuth, elevation, roll, field_of_view, size: [5; 2], ..View::default() };
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
        Texels::make(size, stored, &fill)
    }
}

type Taken = Vec<(i64, [u64; 4])>;

/// Every slab of every wanted ray that is not empty: its number, and the bits of what is in it. From a number on where the
/// rays are asked to seek anew, as where a polygon interrupts them.
fn taken(
    medium: &Medium<'_, kernel::GelSlices<'_, [f32; 4]>>,
    packet: &Packet,
    anew: i64,
    level: Level,
) -> [Taken; LANES] {
    dispatch!(level, simd => taken_with(simd, medium, packet, anew))
}

#[inline(always)]
fn taken_with<I: Simd>(
    simd: I,
    medium: &Medium<'_, kernel::GelSlices<'_, [f32; 4]>>,
    packet: &Packet,
    anew: i64,
) -> [Taken; LANES] {
    let (mut counts, mut entered) = (Counts::default(), Entered::default());
    let mut taken: [Taken; LANES] = Default::default();
    let [mut k, end] = medium.enter(packet, &mut entered);
    while k < end {
        let sought = medium.seek(simd, &mut entered, (k, packet.wanted), &mut counts);
        if k < anew && anew < sought {
            k = anew;
            continue;
        }
        k = sought;
        if k < end {
            for lane in each(medium.meet(simd, &mut entered, (k, packet.wanted), &mut counts)) {
                let (color, opacity) = medium.slab(&mut entered, k, lane);
                if (color, opacity) != (DVec3::ZERO, 0.0) {
                    taken[lane].push((k, color.extend(opacity).to_array().map(f64::to_bits)));
                }
            }
        }
        k += 1;
    }
    taken
}

/// A packet somewhere in a picture of 5 × 5 pixels; some through its very middle, where views along an axis run in planes of
/// voxels.
fn packets() -> impl Strategy<Value = Packet> {
    let anywhere = (-8..20_i64, -8..20_i64).prop_map(|(i, j)| [i, j]);
    let first = prop_oneof![4 => anywhere, 1 => Just([8, 8])];
    let step = (0..4_u32).prop_map(|shift| 1_usize << shift);
    let off = proptest::array::uniform16([0..24_u16, 0..24_u16]);
    let off = prop_oneof![off.clone().prop_map(Some), off.prop_map(|_| None)];
    (first, step, any::<u16>(), off).prop_map(|(first, step, some, off)| {
        let packet = Packet::new(first, step, some | 1);
        let scattered = off.map(|off| TilePlaces::scattered(first, off));
        Packet { places: scattered.unwrap_or(packet.places), ..packet }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_leap_passes_no_sample_that_is_not_empty(case in cases(), packet in packets(), until in any::<i8>()) {
        let gel = case.gel();
        let pyramid = Pyramid::of(&gel);
        let camera = Camera::new(&case.view, &Extent::of(case.grid.corners()).unwrap());
        let walk = Walk::new(&case.grid, &camera, case.distance).unwrap().unwrap();
        let medium = |pyramid| Medium {
            walk, camera: &camera, source: kernel::GelSlices { texels: gel.slices(), ambient: None, pyramid }, pyramid, ratio: 1.0, distance: case.distance, cue: None,
            dust: None,
        };
        let mut tile = Tile::default();
        walk.enter(&packet.places, &mut tile);
        walk.scatter(&packet.places, &mut tile);
        let anew = tile.some[0].saturating_add(i64::from(until));
        let expected = taken(&medium(None), &packet, i64::MIN, Level::baseline());
        for level in levels() {
            prop_assert_eq!(&taken(&medium(Some(pyramid.slices())), &packet, anew, level), &expected);
        }
        // Alone, or in another tile, a ray takes what it takes among others.
        let lane = packet.wanted.trailing_zeros() as usize;
        let alone = Packet::new(packet.position(lane), 1, 1);
        let some = medium(Some(pyramid.slices()));
        prop_assert_eq!(&taken(&some, &alone, anew, Level::new())[0], &expected[lane]);
    }

    #[test]
    fn the_samples_of_any_ray_are_exactly_those_within_the_domain(case in cases(), packet in packets(), moved in -1e6..1e6) {
        let mut grid = case.grid;
        grid.index_to_world.translation += DVec3::splat(moved);
        let camera = Camera::new(&case.view, &Extent::of(grid.corners()).unwrap());
        let walk = Walk::new(&grid, &camera, case.distance).unwrap().unwrap();
        let mut tile = Tile::default();
        walk.enter(&packet.places, &mut tile);
        walk.scatter(&packet.places, &mut tile);
        let ray = camera.ray(Camera::window(packet.position(0)));
        let inside = |k: i64, slack: f64| {
            let world = ray.at((k as f64 + 0.5) * case.distance);
            let index = grid.world_to_index().transform_point3(world);
            let last = DVec3::from(grid.size.map(|n| (n - 1) as f64));
            index.min(last - index).min_element() > slack
        };
        let reach = (case.grid.corners()[0].length() / case.distance) as i64 + 2;
        // A ray has few thousand samples; of more, some stretches.
        let numbers = (-reach..=reach).step_by(1 + reach as usize / 20_000);
        for k in numbers {
            let all = (tile.all[0]..tile.all[1]).contains(&k);
            let taken = (tile.some[0]..tile.some[1]).contains(&k) && (all || walk.holds(&tile, 0, k));
            prop_assert!(!all || walk.holds(&tile, 0, k), "sample {} is not held", k);
            let seen = camera.eye.is_none_or(|eye| (k as f64 + 1.0) * case.distance > 1e-9 - eye);
            prop_assert!(taken || !seen || !inside(k, 1e-6), "sample {} is left out", k);
            prop_assert!(!taken || inside(k, -1e-6), "sample {} is outside", k);
        }
    }
}
