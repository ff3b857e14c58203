//! The sampling limit of this machine: what a trilinear RGBA sample and its compositing take at perfect coherence.
//!
//! Four rays side by side walk through texels that the cache holds, nothing is skipped and none stops. A cell's two rows
//! of a plane are loaded as pairs of texels, eight channels in a register: eight loads become four, and seven
//! interpolations four. No caster that samples this way can take less than the samples that it needs times this.

use std::hint::black_box;
use std::time::Instant;

use fearless_simd::{Level, Simd, SimdBase, SimdFloat, dispatch, f32x4, f32x8};
use glam::Vec4;

/// Texels of the little volume, 8³, and room for the last cell's corners.
const TEXELS: usize = 1024;
const RAYS: usize = 4;
const STEPS: usize = 4096;

/// A number that a channel is kept in.
trait Channel: Copy + Default + Into<f32> + 'static {
    const ONE: f32;
    fn of(value: f32) -> Self;
}

impl Channel for f32 {
    const ONE: f32 = 1.0;
    fn of(value: f32) -> Self {
        value
    }
}

impl Channel for u16 {
    const ONE: f32 = 65535.0;
    fn of(value: f32) -> Self {
        (value * Self::ONE) as Self
    }
}

impl Channel for u8 {
    const ONE: f32 = 255.0;
    fn of(value: f32) -> Self {
        (value * Self::ONE) as Self
    }
}

/// A place: three bits of cell and 29 of the way through it, on each axis.
type Place = [u32; 4];

/// One sample, not scaled: two texels a load, the axes y and z first.
#[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
#[inline(always)]
fn sample<S: Simd, T: Channel>(simd: S, texels: &[T; 4 * TEXELS], place: Place) -> f32x4<S> {
    let [x, y, z, _] = place.map(|p| (p >> 29) as usize);
    let [fx, fy, fz, _] = place.map(|p| ((p << 3) >> 8) as i32 as f32 * (1.0 / 16_777_216.0));
    let first = 4 * (x + 8 * y + 64 * z);
    let pair = |offset: usize| {
        let pair: &[T] = &texels[first + 4 * offset..][..8];
        let channels: [f32; 8] = std::array::from_fn(|i| pair[i].into());
        f32x8::from_slice(simd, &channels)
    };
    let mix = |low: f32x8<S>, high: f32x8<S>, part: f32| {
        (high - low).mul_add(f32x8::splat(simd, part), low)
    };
    let low = mix(pair(0), pair(8), fy);
    let high = mix(pair(64), pair(72), fy);
    let (low, high) = simd.split_f32x8(mix(low, high, fz));
    (high - low).mul_add(f32x4::splat(simd, fx), low)
}

/// Takes the rays from `places` on by `way` a step and composites what they meet.
#[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
#[inline(always)]
fn march<S: Simd, T: Channel>(
    simd: S,
    texels: &[T; 4 * TEXELS],
    mut places: [Place; RAYS],
    way: Place,
) -> [[f32; 4]; RAYS] {
    let scale = f32x4::splat(simd, 1.0 / T::ONE);
    let mut composited = [f32x4::splat(simd, 0.0); RAYS];
    for _ in 0..STEPS {
        for (place, color) in places.iter_mut().zip(&mut composited) {
            let through = f32x4::splat(simd, 1.0 - color.as_slice()[3]) * scale;
            *color = sample(simd, texels, *place).mul_add(through, *color);
            *place = std::array::from_fn(|axis| place[axis].wrapping_add(way[axis]));
        }
    }
    composited.map(|color| std::array::from_fn(|channel| color.as_slice()[channel]))
}

/// Nanoseconds a sample in this number type: the least of many runs.
fn nanoseconds<T: Channel>() -> f64 {
    let mut texels = [T::default(); 4 * TEXELS];
    for (at, channel) in texels.iter_mut().enumerate() {
        *channel = T::of((at * 7919 % 101) as f32 / 1.0e4);
    }
    // Neighbouring rays, oblique, a voxel a step.
    let way = [0.62, 0.49, 0.61, 0.0].map(|part: f64| (part * f64::from(1_u32 << 29)) as u32);
    let places = std::array::from_fn(|ray| [ray as u32 * 97_000_000, 0, 5, 0]);
    let level = Level::new();
    let mut least = f64::INFINITY;
    for _ in 0..200 {
        let start = Instant::now();
        let (texels, places) = (black_box(&texels), black_box(places));
        let made = dispatch!(level, simd => march(simd, texels, places, way));
        assert!(black_box(made)[0][3] > 0.9, "what is sampled is composited");
        least = least.min(start.elapsed().as_secs_f64());
    }
    least * 1e9 / (STEPS * RAYS) as f64
}

/// Refuses a kernel that does not interpolate: against eight corners, one by one.
fn check() {
    let mut texels = [0.0_f32; 4 * TEXELS];
    for (at, channel) in texels.iter_mut().enumerate() {
        *channel = (at * 7919 % 101) as f32;
    }
    let corner =
        |x: usize, y: usize, z: usize| Vec4::from_slice(&texels[4 * (x + 8 * y + 64 * z)..]);
    let place = [(3 << 29) + (1 << 28), (2 << 29) + (1 << 27), (6 << 29) + (3 << 27), 0];
    let row = |y, z| corner(3, y, z).lerp(corner(4, y, z), 0.5);
    let plane = |z| row(2, z).lerp(row(3, z), 0.25);
    let expected: Vec4 = plane(6).lerp(plane(7), 0.75);
    let made: Vec<f32> =
        dispatch!(Level::new(), simd => sample(simd, &texels, place).as_slice().to_vec());
    assert!(Vec4::from_slice(&made).abs_diff_eq(expected, 1e-4), "{made:?} {expected}");
}

/// Nanoseconds a sample in 32-bit floats, 16 and 8 bits, in this order.
pub fn per_sample() -> [f64; 3] {
    check();
    [nanoseconds::<f32>(), nanoseconds::<u16>(), nanoseconds::<u8>()]
}

/// The instructions that the kernel ran with.
pub fn instructions() -> String {
    format!("{:?}", Level::new()).split('(').next().unwrap_or_default().to_owned()
}
