//! What one resampling of strengths buys over the paper's three, and what the bias costs.

use gelray::components::CastsShadow;
use glam::DVec3;

use crate::setup::{NO_BIAS, Scene, beta, bricks, cubes, noise, point, voxels};

const SIZE: [usize; 3] = [72, 24, 64];

/// The paper's form: illumination rays sampled at equal distances with tri-linear opacities, their strengths kept in a
/// 3D buffer aligned with the light, and read from it tri-linearly. One voxel is the distance of rays and of samples.
struct ThreeSteps {
    axes: [DVec3; 3],
    side: usize,
    strengths: Vec<f64>,
}

impl ThreeSteps {
    fn new(toward: DVec3, opacity: &dyn Fn(DVec3) -> f64) -> Self {
        let along = -toward.normalize();
        let across = along.any_orthonormal_vector();
        let axes = [across, along.cross(across), along];
        let side = 104;
        let mut steps = Self { axes, side, strengths: vec![1.0; side * side * side] };
        for ray in 0..side * side {
            let mut through = 1.0;
            for k in 0..side {
                let p = steps.world([(ray % side) as f64, (ray / side) as f64, k as f64]);
                through *= 1.0 - opacity(p);
                steps.strengths[k * side * side + ray] = through;
            }
        }
        steps
    }

    fn middle() -> DVec3 {
        DVec3::from(SIZE.map(|n| n as f64 / 2.0))
    }

    fn world(&self, at: [f64; 3]) -> DVec3 {
        let half = self.side as f64 / 2.0;
        Self::middle() + (0..3).map(|i| self.axes[i] * (at[i] - half)).sum::<DVec3>()
    }

    fn at(&self, world: DVec3) -> f64 {
        let half = self.side as f64 / 2.0;
        let at = self.axes.map(|axis| axis.dot(world - Self::middle()) + half);
        let read = |[x, y, z]: [usize; 3]| self.strengths[(z * self.side + y) * self.side + x];
        trilinear(at, [self.side; 3], &read).unwrap_or(1.0)
    }
}

fn trilinear(at: [f64; 3], size: [usize; 3], read: &dyn Fn([usize; 3]) -> f64) -> Option<f64> {
    let inside = at.iter().zip(size).all(|(&p, n)| p >= 0.0 && p < (n - 1) as f64);
    inside.then(|| {
        let corner = |corner: usize| {
            let mut weight = 1.0;
            let voxel = std::array::from_fn(|axis| {
                let (low, up) = (at[axis].floor(), corner >> axis & 1);
                let part = at[axis] - low;
                weight *= if up == 1 { part } else { 1.0 - part };
                low as usize + up
            });
            weight * read(voxel)
        };
        (0..8).map(corner).sum()
    })
}

/// Mean distance over which β rises from 10 to 90 % of its range along rows of x.
fn width(beta: &dyn Fn([usize; 3]) -> f64, z: usize) -> f64 {
    let crossing = |row: &[f64], level: f64| {
        let x = row.windows(2).position(|w| (w[0] - level) * (w[1] - level) <= 0.0 && w[0] != w[1]);
        x.map(|x| x as f64 + (level - row[x]) / (row[x + 1] - row[x])).unwrap()
    };
    let widths = (6..18).map(|y| {
        let row: Vec<f64> = (2..SIZE[0] - 2).map(|x| beta([x, y, z])).collect();
        let low = row.iter().copied().fold(f64::INFINITY, f64::min);
        let high = row.iter().copied().fold(0.0, f64::max);
        let level = |part: f64| low + part * (high - low);
        (crossing(&row, level(0.1)) - crossing(&row, level(0.9))).abs()
    });
    widths.sum::<f64>() / 12.0
}

#[test]
fn the_edge_of_a_shadow_is_sharper_than_after_the_papers_three_resamplings() {
    // A sheet two voxels thick with an edge that runs aslant over the voxels, and a faint receiver far behind; the mean
    // over places of both, so that no phase between columns and voxels is favoured.
    println!("toward the light     10-90 % width in voxels: one resampling, three");
    let mut gain = 0.0;
    for toward in
        [[0.0, 0.0, 1.0], [0.2, 0.1, 1.0], [0.35, -0.05, 1.0], [-0.4, 0.15, 1.0], [0.6, 0.0, 1.0]]
    {
        let (mut ours, mut theirs) = (0.0, 0.0);
        for top in [52, 54, 55, 57] {
            let sheet = move |[x, y, z]: [usize; 3]| {
                let there = (top..top + 2).contains(&z) && (x as f64) < 30.0 + 0.37 * y as f64;
                if there { 0.99 } else { 1e-6 }
            };
            let opacity = bricks(SIZE, sheet);
            let read = |voxel: [usize; 3]| f64::from(opacity.value(voxel));
            let field = |p: DVec3| trilinear(p.to_array(), SIZE, &read).unwrap_or(0.0);
            let strength = Scene::new(cubes(SIZE), toward, NO_BIAS, sheet).sweep();
            let three = ThreeSteps::new(DVec3::from(toward), &field);
            for z in 24..32 {
                ours += width(&|voxel| beta(&strength, voxel), z) / 32.0;
                theirs += width(&|voxel| three.at(point(voxel)), z) / 32.0;
            }
        }
        println!("{:<20} {ours:.3}  {theirs:.3}", format!("{toward:?}"));
        // Along an axis the paper's rays and its buffer can lie on the voxels, and nothing is blurred.
        let straight = toward[0] == 0.0;
        assert!(ours < if straight { 1.01 } else { 0.99 } * theirs, "{toward:?}: {ours} {theirs}");
        gain += (1.0 - ours / theirs) / 5.0;
    }
    println!("{:.0} % sharper on the average", 100.0 * gain);
    assert!(gain > 0.03, "{gain}");
}

#[test]
fn a_bias_of_two_voxels_takes_the_speckle_off_a_noisy_surface() {
    // A ball whose surface is measured with noise, classified into a band of opacity 2 to 3 voxels thick.
    let (side, radius) = (64, 22.0);
    let center = DVec3::splat(31.5);
    let surface = |v: [usize; 3]| {
        let seed = (v[2] * side + v[1]) * side + v[0];
        let measured = point(v).distance(center) + 0.6 * (noise(seed as u64) - 0.5);
        (1.0 - (measured - radius).abs() / 1.25).max(0.0) as f32
    };
    let opacity = bricks([side; 3], surface);
    let toward = DVec3::new(0.25, 0.35, 0.9).normalize();
    println!("bias  mean of lit side  spread  leak 2, 3, 4, 6 voxels under the surface");
    let mut spreads = Vec::new();
    for bias in [0.0, 0.5, 1.0, 2.0, 3.0, 4.0] {
        let shadow = CastsShadow { bias_voxels: bias, ..NO_BIAS };
        let mut scene = Scene::new(cubes([side; 3]), toward.to_array(), shadow, surface).buffered();
        let strength = scene.sweep();
        // What an observer above sees of the strength: weighted as voxels are composited, on the side that faces both.
        let seen = |x: usize, y: usize| {
            let (mut through, mut sum) = (1.0, 0.0);
            for z in (32..side).rev() {
                let alpha = f64::from(opacity.value([x, y, z]));
                sum += through * alpha * beta(&strength, [x, y, z]);
                through *= 1.0 - alpha;
            }
            sum / (1.0 - through)
        };
        let lit: Vec<f64> = voxels([side, side, 1])
            .filter(|v| (point([v[0], v[1], 31]) - center).length() < 0.6 * radius)
            .map(|v| seen(v[0], v[1]))
            .collect();
        let mean = lit.iter().sum::<f64>() / lit.len() as f64;
        let spread = lit.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / lit.len() as f64;
        let under = |depth: f64| {
            let buffer = &strength.buffers[0];
            let leak = |seed: u64| {
                let aside = DVec3::from([0, 1, 2].map(|i| noise(3 * seed + i) - 0.5)) * 0.8;
                let normal = (toward + aside).normalize();
                f64::from(buffer.at(center + normal * (radius - depth) + buffer.bias()))
            };
            (0..500).map(leak).sum::<f64>() / 500.0
        };
        let leak = [2.0, 3.0, 4.0, 6.0].map(under);
        println!("{bias:<5} {mean:<17.3} {:<7.3} {leak:.3?}", spread.sqrt());
        spreads.push(spread.sqrt());
    }
    assert!(spreads[3] < 0.03 && spreads[3] < spreads[0] / 2.5, "{spreads:?}");
}
