//! Facts about rays through voxels: each sees what one alone would see there, whatever the instructions and whatever is skipped.

use glam::{DAffine3, DMat3, DVec2, DVec3, Vec4};
use proptest::array::uniform3;
use proptest::prelude::*;

use super::*;
use crate::components::View;
use crate::view::composite::{Gathered, recolor, thicken};
use crate::view::extent::Extent;
use crate::volume::field::tests::levels;

/// Gel in some voxels of a grid, seen from somewhere.
#[derive(Debug, Clone)]
struct Case {
    grid: Grid,
    view: View,
    per_voxel: f64,
    /// Δ in smallest spacings, and against the opacity unit.
    step: f64,
    ratio: f64,
    stop: f32,
    seed: u64,
    /// Of a hundred voxels so many hold gel.
    held: u64,
}

fn cases() -> impl Strategy<Value = Case> {
    let angle = || prop_oneof![(-8..=8_i32).prop_map(|n| f64::from(n) * 45.0), -360.0..360.0];
    let placed = (uniform3(2..=40_usize), uniform3(0.4..2.0), uniform3(-0.4..0.4), any::<u8>());
    let view = (angle(), angle(), angle(), 1..=24_u32);
    let ratio = prop_oneof![Just(1.0), Just(2.0), Just(0.5), 0.3..3.0];
    let stop = prop_oneof![Just(0.0_f32), Just(0.02), 0.0..0.5_f32];
    let rays = prop_oneof![Just(0.5), Just(1.0), Just(2.0), 0.5..9.0];
    let sampled = (rays, prop_oneof![Just(1.0), 0.3..2.5], ratio, stop);
    (placed, view, sampled, any::<u64>(), prop_oneof![Just(3_u64), Just(30), Just(100)]).prop_map(
        |((size, spacing, shear, flips), view, (per_voxel, step, ratio, stop), seed, held)| {
            let flip = |axis: usize| if flips >> axis & 1 == 1 { -1.0 } else { 1.0 };
            let scale = DVec3::from(std::array::from_fn(|axis| flip(axis) * spacing[axis]));
            let lean = DMat3::from_cols(
                DVec3::X,
                DVec3::new(shear[0], 1.0, 0.0),
                DVec3::new(shear[1], shear[2], 1.0),
            );
            let matrix3 = lean * DMat3::from_diagonal(scale);
            let translation = matrix3 * -DVec3::from(size.map(|n| (n - 1) as f64 / 2.0));
            let grid = Grid::new(size, DAffine3 { matrix3, translation }).unwrap();
            let (azimuth, elevation, roll, pixels) = view;
            let view = View { azimuth, elevation, roll, size: [pixels, pixels], ..View::default() };
            Case { grid, view, per_voxel, step, ratio, stop, seed, held }
        },
    )
}

impl Case {
    fn voxel(&self, [x, y, z]: [usize; 3]) -> Vec4 {
        let [nx, ny, _] = self.grid.size;
        let mut bits =
            self.seed ^ (((z * ny + y) * nx + x) as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits ^= bits >> 27;
        if bits % 100 >= self.held {
            return Vec4::ZERO;
        }
        let part = |shift: u32| (bits >> shift & 0xff) as f32 / 255.0;
        let alpha = part(8);
        Vec4::new(part(16) * alpha, part(24) * alpha, part(32) * alpha, alpha)
    }

    fn texels<T: Texel>(&self) -> Texels<T> {
        let row = |first: [usize; 3], row: &mut [Vec4]| {
            for (x, voxel) in row.iter_mut().enumerate() {
                *voxel = self.voxel([first[0] + x, first[1], first[2]]);
            }
        };
        Texels::make(self.grid.size, |_| true, &row)
    }

    fn distance(&self) -> f64 {
        self.step * self.grid.spacing().min_element()
    }

    fn camera(&self) -> Camera {
        Camera::new(&self.view, &Extent::of(self.grid.corners()).unwrap())
    }

    fn sampling(&self) -> Sampling {
        Sampling { per_voxel: self.per_voxel, ..Sampling::default() }
    }

    /// Tri-linear interpolation at a voxel index; `None` outside the voxels, and where rounding decides whether it is.
    fn sample(&self, at: DVec3) -> Result<Option<Vec4>, ()> {
        let last = DVec3::from(self.grid.size.map(|n| (n - 1) as f64));
        let room = at.min(last - at).min_element();
        if room.abs() < 1e-6 {
            return Err(());
        }
        if room < 0.0 {
            return Ok(None);
        }
        let (first, part) = (at.floor(), at.fract().as_vec3());
        let corner = |n: usize| {
            let side = |axis: usize| (n >> axis) & 1;
            let weight = |axis: usize| if side(axis) == 1 { part[axis] } else { 1.0 - part[axis] };
            let voxel = std::array::from_fn(|axis| first[axis] as usize + side(axis));
            self.voxel(voxel) * (weight(0) * weight(1) * weight(2))
        };
        Ok(Some((0..8).map(corner).sum()))
    }

    /// What a ray through a window position sees, sample by sample on planes across axis `w`.
    fn alone(&self, camera: &Camera, window: DVec2, w: usize) -> Result<[f32; 4], ()> {
        let to_index = self.grid.world_to_index();
        let start = to_index.transform_point3(camera.origin(window));
        let step = to_index.transform_vector3(camera.forward * self.distance());
        let last = (self.grid.size[w] - 1) as f64;
        let near = if step[w] > 0.0 { 0.0 } else { last };
        let mut ray = Gathered::NOTHING;
        for k in 0..=(last / step[w].abs()).ceil() as usize {
            let plane = near + (k as f64 + 0.5) * step[w];
            let at = start + step * ((plane - start[w]) / step[w]);
            let outside = !(0.0..=last).contains(&plane);
            let Some(sample) = self.sample(at)?.filter(|_| !outside) else { continue };
            let opacity = f64::from(sample.w).min(1.0);
            let thick = thicken(opacity, self.ratio);
            ray.under(sample.truncate().as_dvec3() * recolor(opacity, thick, self.ratio), thick);
            if ray.through <= f64::from(self.stop) {
                break;
            }
        }
        Ok(ray.rgba(f64::from(self.stop)))
    }
}

fn seen<T: Texel>(
    case: &Case,
    (shear, texels): (&Shear, &Texels<T>),
    pyramid: Option<&Pyramid>,
    level: Level,
) -> (VoxelRays, u64) {
    let stop = if case.stop > 0.0 { case.stop } else { f32::NEG_INFINITY };
    let sought = Sought { shear, texels, pyramid, stop, ratio: case.ratio, level };
    let (rays, counts) = sought.cast(&Watch::default()).unwrap();
    (rays, counts.samples)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    #[test]
    fn each_ray_sees_what_one_alone_sees_at_its_place(case in cases()) {
        let camera = case.camera();
        let shear = Shear::new(&case.grid, &camera, case.distance(), &case.sampling()).unwrap();
        let texels = case.texels::<[f32; 4]>();
        let (rays, _) = seen(&case, (&shear, &texels), None, Level::new());
        for (at, color) in rays.colors.iter().enumerate() {
            let place = DVec2::new((at % rays.size[0]) as f64, (at / rays.size[0]) as f64);
            let Some(window) = rays.places.window(place) else { continue };
            let Ok(alone) = case.alone(&camera, window, shear.axes[2]) else { continue };
            // Where rounding decides whether a ray stops, it may go on.
            let most = 1e-4 + case.stop;
            let near = alone.iter().zip(color).all(|(a, b)| (a - b).abs() <= most);
            prop_assert!(near, "{place}: {color:?}, alone {alone:?}");
            prop_assert!(color.iter().all(|c| c.is_finite()) && (0.0..=1.0).contains(&color[3]));
        }
    }

    #[test]
    fn skipping_and_instructions_change_no_bit(case in cases()) {
        let camera = case.camera();
        let shear = Shear::new(&case.grid, &camera, case.distance(), &case.sampling()).unwrap();
        unchanged::<[f32; 4]>(&case, &shear)?;
        unchanged::<[u16; 4]>(&case, &shear)?;
        unchanged::<[u8; 4]>(&case, &shear)?;
    }
}

fn unchanged<T: Texel>(case: &Case, shear: &Shear) -> Result<(), TestCaseError> {
    let texels = case.texels::<T>();
    let pyramid = Pyramid::of(&texels);
    let (expected, _) = seen(case, (shear, &texels), None, Level::baseline());
    let (plain, _) = seen(case, (shear, &texels), None, Level::new());
    prop_assert!(plain == expected, "levels alone");
    let (skipped, _) = seen(case, (shear, &texels), Some(&pyramid), Level::baseline());
    prop_assert!(skipped == expected, "skipping alone");
    let mut samples = Vec::new();
    for level in levels() {
        let (made, taken) = seen(case, (shear, &texels), Some(&pyramid), level);
        let apart = made.colors.iter().zip(&expected.colors).position(|(a, b)| a != b);
        let both = apart.map(|at| (made.colors[at], expected.colors[at]));
        prop_assert!(made == expected, "{level:?}: {both:?}, {:?} {:?}", made.met, expected.met);
        samples.push(taken);
    }
    prop_assert!(samples.windows(2).all(|pair| pair[0] == pair[1]));
    Ok(())
}

#[test]
fn bytes_are_known_before_rays_are_cast() {
    let grid = Grid::axis_aligned([40, 30, 20], [1.0, 1.0, 2.0], [0.0; 3]);
    let grid = grid.unwrap();
    let view = View { azimuth: 30.0, elevation: 20.0, size: [64; 2], ..View::default() };
    let camera = Camera::new(&view, &Extent::of(grid.corners()).unwrap());
    let sampling = Sampling { per_voxel: 4.0, ..Sampling::default() };
    let shear = Shear::new(&grid, &camera, 1.0, &sampling).unwrap();
    let planned = bytes(&grid, &camera, 1.0, &sampling).unwrap();
    let colors = (shear.rays().iter().product::<usize>() * 16) as u64;
    assert!(planned > colors);
    assert_eq!(shear.phases.len(), shear.parts.iter().product::<usize>());
}
