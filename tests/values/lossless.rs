//! Stepping over what cannot be seen loses nothing, byte for byte, and threads change nothing.

use gelray::components::Form;
use gelray::prelude::*;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use proptest::prelude::*;

use super::{FILTERS, bits, rendered};

/// All that a sample may depend on.
#[derive(Debug, Clone)]
struct Case {
    size: [usize; 3],
    spacing: [f64; 3],
    turn: f64,
    filter: usize,
    classify: usize,
    kind: usize,
    view: (f64, f64, Option<f64>),
    step: f64,
    seed: u64,
    extras: u8,
}

fn cases() -> impl Strategy<Value = Case> {
    let placed =
        ([2..20_usize, 2..20_usize, 2..20_usize], [0.3..2.0, 0.3..2.0, 0.3..2.0], -0.7..0.7);
    let view = (-180.0..180.0, -90.0..90.0, prop_oneof![Just(None), (10.0..70.0).prop_map(Some)]);
    let ways = (0..4_usize, 0..8_usize, 0..3_usize);
    let rest = (prop_oneof![Just(1.0), Just(0.5), 0.2..2.0], any::<u64>(), any::<u8>());
    (placed, view, ways, rest).prop_map(|(placed, view, ways, (step, seed, extras))| Case {
        size: placed.0,
        spacing: placed.1,
        turn: placed.2,
        filter: ways.0,
        classify: ways.1,
        kind: ways.2,
        view,
        step,
        seed,
        extras,
    })
}

fn random(seed: u64, at: u64) -> u64 {
    let mut z = seed.wrapping_add(at.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z ^ z >> 29
}

/// Mostly nothing, some of it smooth, some of it rough, in bytes, shorts and floats with a few that are no numbers.
fn scalars(case: &Case) -> Scalars {
    let [nx, ny, nz] = case.size;
    let value = |at: usize| {
        let place = [at % nx, at / nx % ny, at / (nx * ny)];
        let smooth: usize = place.iter().zip([nx, ny, nz]).map(|(p, n)| p.abs_diff(n / 2)).sum();
        let rough = random(case.seed, at as u64);
        if rough.is_multiple_of(50) {
            (rough >> 8) as f32 % 256.0
        } else {
            (90.0 - 10.0 * smooth as f32).max(0.0)
        }
    };
    let all = 0..nx * ny * nz;
    match case.kind {
        0 => all.map(|at| value(at) as u8).collect::<Vec<_>>().into(),
        1 => all.map(|at| value(at) as i16 * 9 - 200).collect::<Vec<_>>().into(),
        _ => {
            let odd = |at: usize| match random(!case.seed, at as u64) % 400 {
                0 => f32::NAN,
                1 => f32::INFINITY,
                _ => value(at) / 3.0,
            };
            all.map(odd).collect::<Vec<_>>().into()
        }
    }
}

fn classification(case: &Case) -> Classify {
    let scale = [1.0, 9.0, 1.0 / 3.0][case.kind];
    let value = |v: f32| v * scale - if case.kind == 1 { 200.0 } else { 0.0 };
    let point = |v, opacity| TransferPoint { value: value(v), opacity, color: None };
    let none = Classify::default;
    let surface = |v, opacity| Contour { thickness_voxels: 0.0, opacity, ..Contour::at(value(v)) };
    match case.classify {
        0 => Classify::iso(value(45.0)),
        1 => {
            let form = Form::Around;
            let thin =
                Contour { form, thickness_voxels: 0.4, opacity: 0.5, ..Contour::at(value(30.0)) };
            let red = Some(Color::from_srgb([1.0, 0.2, 0.2]));
            Classify {
                iso: vec![thin, Contour { color: red, ..Contour::at(value(80.0)) }],
                ..none()
            }
        }
        2 => {
            let tissue = |v, opacity| Tissue { value: value(v), opacity, color: None };
            Classify {
                regions: vec![tissue(0.0, 0.0), tissue(60.0, 0.5), tissue(90.0, 1.0)],
                ..none()
            }
        }
        3 => Classify {
            transfer: vec![point(40.0, 0.0), point(41.0, 0.7), point(70.0, 0.0)],
            ..none()
        },
        4 => Classify {
            transfer: vec![point(20.0, 0.0), point(90.0, 0.9)],
            gradient: vec![[3.0 * scale, 0.0], [9.0 * scale, 1.0]],
            ..none()
        },
        5 => Classify { iso: vec![surface(45.0, 1.0)], ..none() },
        6 => {
            let thick = Contour { opacity: 0.4, ..Contour::at(value(20.0)) };
            Classify { iso: vec![surface(60.0, 0.5), thick, surface(30.0, 0.3)], ..none() }
        }
        _ => Classify { transfer: vec![point(50.0, 0.0), point(50.5, 0.3)], ..none() },
    }
}

/// The case with what is skipped, on a picture of few pixels.
fn world(case: &Case, skip: Skip) -> World {
    let matrix3 = DMat3::from_quat(DQuat::from_rotation_x(case.turn))
        * DMat3::from_diagonal(DVec3::from(case.spacing));
    let translation = matrix3 * -DVec3::from(case.size.map(|n| (n - 1) as f64 / 2.0));
    let grid = Grid::new(case.size, DAffine3 { matrix3, translation }).unwrap();
    let spacing = grid.spacing().min_element();
    let mut world = World::new();
    let volume = world.spawn((grid, scalars(case), classification(case), Reconstruct::Values));
    if case.extras & 1 == 1 {
        let clip = Clip { planes: vec![[0.6, -0.8, 0.1, 0.7]], ..Clip::default() };
        world.insert_one(volume, clip).unwrap();
    }
    let light = world.spawn((Light::from_direction([-0.4, -0.8, 0.5]),));
    if case.extras & 2 == 2 {
        world.insert_one(light, CastsShadow::default()).unwrap();
    }
    if case.extras & 4 == 4 {
        let square = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [9.0, 9.0, 2.0], [-9.0, 9.0, 2.0]];
        world.spawn((polygon(&square).unwrap(), Surface { opacity: 0.5, ..Surface::default() }));
    }
    let sampling = Sampling {
        skip,
        filter: FILTERS[case.filter],
        integrate: case.extras & 16 == 16,
        distance_mm: Some(case.step * spacing),
        ..Sampling::default()
    };
    let (azimuth, elevation, field_of_view) = case.view;
    let view = View { azimuth, elevation, field_of_view, size: [9, 7], ..View::default() };
    let view = world.spawn((view, sampling));
    if case.extras & 8 == 8 {
        world.insert_one(view, DepthCue { k1: 1.0, k2: 0.02 }).unwrap();
    }
    world
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn what_is_stepped_over_would_have_added_nothing(case in cases()) {
        let with = rendered(&mut world(&case, Skip::Pyramid));
        let without = rendered(&mut world(&case, Skip::None));
        prop_assert!(bits(&with.picture) == bits(&without.picture));
        prop_assert!(with.samples.counts.samples <= without.samples.counts.samples);
        let sound = with.picture.pixels.iter().all(|pixel| {
            (0.0..=1.0).contains(&pixel[3]) && pixel.iter().all(|channel| channel.is_finite())
        });
        prop_assert!(sound);
    }
}

#[test]
fn one_thread_and_two_and_seven_make_the_same_bytes() {
    let case = Case {
        size: [19, 17, 18],
        spacing: [1.0, 0.8, 1.3],
        turn: 0.3,
        filter: 1,
        classify: 1,
        kind: 1,
        view: (33.0, 21.0, Some(30.0)),
        step: 0.7,
        seed: 5,
        extras: 15,
    };
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| bits(&rendered(&mut world(&case, Skip::Pyramid)).picture))
    };
    let one = of(1);
    assert!(one.iter().any(|pixel| pixel[3] != 0));
    assert!(one == of(2) && one == of(7));
}
