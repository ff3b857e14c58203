//! Stepping over empty gel loses nothing, and any number of threads makes the same bytes (paper §6; algorithm §6, §10).

use gelray::components::{DepthCue, Sampling, Skip, TexelKind, View};
use gelray::shared::Shared;
use gelray::view::extent::Extent;
use gelray::volume::grid::{Grid, Painted};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use proptest::array::{uniform2, uniform3, uniform4};
use proptest::prelude::*;

use super::support::{Mixture, Shown, bits, data, flat, head, run, sampling_of_the_head, square};

const TEXELS: [TexelKind; 3] = [TexelKind::F32, TexelKind::U16, TexelKind::U8];

/// Everything that a ray's walk depends on.
#[derive(Debug, Clone)]
struct Case {
    grid: Grid,
    view: View,
    sampling: Sampling,
    seed: u64,
    /// The part of the voxels that hold gel.
    part: f64,
    blocky: bool,
    cued: bool,
    polygons: usize,
}

impl Case {
    fn mixture(&self) -> Mixture {
        let extent = Extent::of(self.grid.corners()).unwrap();
        let (center, radius) = (extent.center(), extent.radius());
        let planes = (0..self.polygons).map(|i| {
            let turn = DQuat::from_rotation_x(i as f64 + self.view.azimuth);
            let normal = turn * DVec3::new(0.3, 1.0, 0.2);
            let place = center + normal * (radius * 0.2 * i as f64);
            (vec![square(place, normal, radius * 0.7)], flat([0.2, 0.5, 1.0], 0.3))
        });
        Mixture {
            polygons: planes.collect(),
            view: self.view.clone(),
            sampling: self.sampling.clone(),
            cue: self.cued.then_some(DepthCue { k1: 1.0, k2: 0.3 / radius }),
            ..Mixture::of(self.grid, sparse(&self.grid, self.seed, self.part, self.blocky))
        }
    }
}

/// Angles in degrees: quarter and eighth turns, any, and all but quarter turns.
fn angles() -> impl Strategy<Value = f64> {
    prop_oneof![
        2 => (-8..=8_i32).prop_map(|eighth| f64::from(eighth) * 45.0),
        3 => -360.0..360.0,
        1 => (0..4_i32, -1e-6..1e-6).prop_map(|(quarter, off)| f64::from(quarter) * 90.0 + off),
    ]
}

fn placings() -> impl Strategy<Value = Placing> {
    let (spacing, shear) = (uniform3(0.2..3.0), uniform3(-0.8..0.8));
    (spacing, 0..8_u32, any::<bool>(), shear, uniform4(-1.0..1.0))
}

fn samplings() -> impl Strategy<Value = Sampling> {
    let steps = prop_oneof![Just(1.0), Just(0.5), 0.03..0.3, 0.3..4.0];
    (steps, 0..3_usize, 0..3_usize, any::<bool>()).prop_map(|(step, texel, coarsest, stops)| {
        Sampling {
            distance_mm: Some(step),
            texel: TEXELS[texel],
            coarsest: [1, 4, 8][coarsest],
            stop_at: if stops { 0.05 } else { 0.0 },
            ..Sampling::default()
        }
    })
}

fn any_case(most: usize) -> impl Strategy<Value = Case> {
    let view = (angles(), angles(), angles(), uniform2(1..=9_u32), 0.05..1.2);
    let part = prop_oneof![Just(0.0), 0.0005..0.01, 0.01..0.5];
    let gel = (any::<u64>(), part, any::<bool>(), any::<bool>(), 0..3_usize);
    let placed = (uniform3(2..=most), placings());
    (placed, view, samplings(), gel).prop_map(|(placed, view, mut sampling, gel)| {
        let grid = grid(placed.0, placed.1);
        let (azimuth, elevation, roll, size, zoom) = view;
        let height = 2.0 * zoom * Extent::of(grid.corners()).unwrap().radius();
        let view =
            View { azimuth, elevation, roll, height_mm: Some(height), size, ..View::default() };
        let steps = sampling.distance_mm.unwrap_or(1.0);
        sampling.distance_mm = Some(steps * grid.spacing().min_element());
        let (seed, part, blocky, cued, polygons) = gel;
        Case { grid, view, sampling, seed, part, blocky, cued, polygons }
    })
}

type Placing = ([f64; 3], u32, bool, [f64; 3], [f64; 4]);

/// Anisotropic, flipped, turned and sheared.
fn grid(size: [usize; 3], (spacing, flips, sheared, shear, turn): Placing) -> Grid {
    let flip = |axis: usize| if flips >> axis & 1 == 1 { -1.0 } else { 1.0 };
    let scale =
        DMat3::from_diagonal(DVec3::from_array(std::array::from_fn(|a| flip(a) * spacing[a])));
    let matrix3 = if sheared {
        let [a, b, c] = shear;
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(a, 1.0, 0.0), DVec3::new(b, c, 1.0));
        DMat3::from_quat(DQuat::from_array(turn).normalize()) * shear * scale
    } else {
        scale
    };
    let last = DVec3::from(size.map(|n| (n - 1) as f64 / 2.0));
    Grid::new(size, DAffine3 { matrix3, translation: -(matrix3 * last) }).unwrap()
}

/// Gel in a random part of the voxels: single ones, or blocks; some of it brighter than white, some hardly there.
fn sparse(grid: &Grid, seed: u64, part: f64, blocky: bool) -> Painted {
    let random = |at: u64, salt: u64| {
        // SplitMix64.
        let mut z = (seed ^ salt).wrapping_add(at.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let [nx, ny, _] = grid.size;
    let voxel = |at: usize| {
        let [x, y, z] = [at % nx, at / nx % ny, at / (nx * ny)];
        let place = if blocky { (z / 5 * 1000 + y / 7) * 1000 + x / 3 } else { at } as u64;
        if random(place, 1) >= part {
            return [1.0, 1.0, 1.0, 0.0];
        }
        let at = at as u64;
        let alpha = random(at, 2) * if random(at, 3) < 0.3 { 0.003 } else { 1.0 };
        let bright = if random(at, 4) < 0.2 { 4.0 } else { 1.0 };
        [(random(at, 5) * bright) as f32, (random(at, 6) * bright) as f32, 1.0, alpha as f32]
    };
    Painted::F32(Shared::new((0..grid.voxels()).map(voxel).collect()))
}

fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases: more(cases), failure_persistence: None, ..ProptestConfig::default() }
}

/// As many cases as stated, or as PROPTEST_CASES asks for beyond.
fn more(cases: u32) -> u32 {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok());
    asked.unwrap_or(cases)
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn any_gel_seen_from_anywhere_is_the_same_with_and_without_the_pyramid(case in any_case(40)) {
        let scene = case.mixture();
        let with = scene.render();
        let sampling = Sampling { skip: Skip::None, ..scene.sampling.clone() };
        let without = Mixture { sampling, ..scene.clone() }.render();
        prop_assert_eq!(bits(&with.picture), bits(&without.picture));
        prop_assert_eq!(with.array.counts.rays, without.array.counts.rays);
        prop_assert!(with.array.counts.samples <= without.array.counts.samples);
        prop_assert_eq!(with.array.counts.polygon_hits, without.array.counts.polygon_hits);
        prop_assert_eq!(without.array.counts.cells_skipped, 0);
    }
}

proptest! {
    #![proptest_config(cases(20))]

    #[test]
    fn any_gel_is_the_same_on_1_2_and_7_threads(case in any_case(30)) {
        let scene = case.mixture();
        let made = [1, 2, 7].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let made = pool.install(|| scene.render());
            (bits(&made.picture), made.array.counts)
        });
        prop_assert!(made[0] == made[1] && made[0] == made[2]);
    }
}

/// Renders a scene with every texel, with and without the pyramid; says what it saved.
fn compare_with_and_without(name: &str, shown: &mut Shown, size: u32) {
    for texel in TEXELS {
        let sampling = |skip| Sampling { skip, texel, ..sampling_of_the_head() };
        let resize = |view: &mut View| view.size = [size; 2];
        let with = shown.render(resize, sampling(Skip::Pyramid));
        let without = shown.render(resize, sampling(Skip::None));
        assert!(bits(&with.picture) == bits(&without.picture), "{name} {texel:?}");
        let (some, all) = (with.array.counts, without.array.counts);
        println!(
            "{name} {size}² {texel:?}: the same bytes from {} samples and {} steps over empty cells instead of {} samples",
            some.samples, some.cells_skipped, all.samples
        );
        assert!(some.samples * 5 < all.samples);
    }
}

#[test]
fn the_phantom_of_a_head_is_the_same_with_and_without_the_pyramid_in_every_texel() {
    compare_with_and_without("phantom", &mut head(), 72);
}

#[test]
fn the_real_head_is_the_same_with_and_without_the_pyramid_in_every_texel() {
    let Some(folder) = data("the real head with and without the pyramid") else { return };
    compare_with_and_without("CThead", &mut Shown::embedded("figure_06a", &[folder]), 72);
}

#[test]
fn the_phantom_of_a_head_is_the_same_on_1_2_and_7_threads() {
    let mut held = head();
    let shown: &mut Shown = &mut held;
    let made = [1, 2, 7].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        // A view of its own each time, so that nothing is kept from the time before.
        let small = |size| move |view: &mut View| view.size = [size; 2];
        pool.install(|| shown.render(small(8), sampling_of_the_head()));
        let made = pool.install(|| shown.render(small(90), sampling_of_the_head()));
        run(&mut shown.world);
        (bits(&made.picture), made.array.counts)
    });
    assert!(made[0] == made[1] && made[0] == made[2]);
}
