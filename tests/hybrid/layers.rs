//! Faint layers: what 4096 of them add up to in texels of 32, 16 and 8 bits, and what the last bits of an opacity do.

use gelray::components::{Sampling, TexelKind};
use gelray::volume::grid::Grid;

use super::support::{Mixture, every_pixel, homogeneous};

/// α of a ray through 4096 layers of opacity `opacity`, and what it should be.
fn layered(opacity: f32, texel: TexelKind) -> [f64; 2] {
    let grid = Grid::axis_aligned([2, 4096, 2], [1.0; 3], [-0.5, -2047.5, -0.5]).unwrap();
    let sampling = Sampling { texel, distance_mm: Some(1.0), ..every_pixel() };
    let gel = homogeneous(&grid, [0.5, 0.5, 0.5, opacity]);
    let scene = Mixture { sampling, ..Mixture::of(grid, gel) }.seen((0.0, 0.0), 1, 0.25);
    let expected = -(4096.0 * (-f64::from(opacity)).ln_1p()).exp_m1();
    [f64::from(scene.render().picture.pixels[0][3]), expected]
}

#[test]
fn layers_of_32_bits_keep_every_digit_however_faint() {
    for opacity in [1e-12, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 0.01, 1.0 - f32::EPSILON / 2.0] {
        let [seen, expected] = layered(opacity, TexelKind::F32);
        println!("4096 layers of {opacity:.1e} in 32 bits: {seen:.9} for {expected:.9}");
        // A transparency of 64 bits knows an opacity to 1.1e-16 and no closer.
        let known = 2e-7 + 1.2e-16 / f64::from(opacity);
        assert!((seen / expected - 1.0).abs() < known, "{}", seen / expected - 1.0);
    }
}

#[test]
fn the_error_of_a_ray_grows_with_its_layers_by_the_last_bit_of_a_transparency_alone() {
    // A voxel's width of even gel, cut into as many layers as a ray may have samples.
    let grid = Grid::axis_aligned([2; 3], [1.0; 3], [-0.5; 3]).unwrap();
    println!("opacity, then what a ray is off by after 2, 10, … 1,000,000 layers");
    for opacity in [1e-9_f32, 1e-6, 1e-3, 0.5, 0.999, 1.0 - f32::EPSILON / 2.0] {
        let gel = homogeneous(&grid, [0.5, 0.5, 0.5, opacity]);
        let off = [2, 10, 100, 1_000, 10_000, 100_000, 1_000_000].map(|layers| {
            let distance_mm = Some(1.0 / f64::from(layers));
            let sampling = Sampling { texel: TexelKind::F32, distance_mm, ..every_pixel() };
            let scene = Mixture { sampling, ..Mixture::of(grid, gel.clone()) };
            let seen = scene.seen((0.0, 0.0), 1, 0.25).render().picture.pixels[0][3];
            let off = f64::from(seen) - f64::from(opacity);
            assert!(
                off.abs() < 2e-7 * f64::from(opacity) + 1.2e-16 * f64::from(layers),
                "{layers} layers of {opacity:e} together: off by {off:e}"
            );
            off
        });
        println!("{opacity:.3e}: {}", off.map(|off| format!("{off:9.1e}")).join(" "));
    }
}

#[test]
fn layers_of_fixed_point_are_those_of_the_nearest_stored_opacity_and_vanish_under_half_a_step() {
    for (texel, steps, bits) in [(TexelKind::U16, 65535.0, 16), (TexelKind::U8, 255.0, 8)] {
        for opacity in [0.2 / 65535.0, 0.49 / 255.0, 1e-4, 1e-3, 0.51 / 255.0, 2e-3, 0.01_f32] {
            let [seen, expected] = layered(opacity, texel);
            let stored = (f64::from(opacity) * steps + 0.5).floor() / steps;
            let of_stored = -(4096.0 * (-stored).ln_1p()).exp_m1();
            println!("4096 layers of {opacity:.2e} in {bits} bits: {seen:.6} for {expected:.6}");
            assert!((seen - of_stored).abs() <= 1e-5 * of_stored, "{seen} {of_stored}");
            assert!(stored > 0.0 || seen == 0.0);
        }
    }
}

#[test]
fn a_ray_through_fixed_point_gel_is_off_by_no_more_than_half_a_step_a_layer() {
    // What is stated of the kinds: an error of 2⁻¹⁷ and 2⁻⁹ a channel, here of 64 layers seen through what lies before.
    for (texel, half) in [(TexelKind::U16, 1.0 / 131_072.0), (TexelKind::U8, 1.0 / 512.0)] {
        let grid = Grid::axis_aligned([2, 64, 2], [1.0; 3], [-0.5, -31.5, -0.5]).unwrap();
        for i in 0..50 {
            let opacity = 0.0007 * (i * i) as f32 / 10.0;
            let gel = homogeneous(&grid, [0.9, 0.5, 0.2, opacity]);
            let pixel = |texel| {
                let sampling = Sampling { texel, ..every_pixel() };
                let scene = Mixture { sampling, ..Mixture::of(grid, gel.clone()) };
                scene.seen((0.0, 0.0), 1, 0.25).render().picture.pixels[0]
            };
            let (exact, made) = (pixel(TexelKind::F32), pixel(texel));
            let through: f64 =
                (0..64).map(|k| (1.0 - f64::from(opacity) + half).powi(k).min(1.0)).sum();
            for (a, b) in exact.iter().zip(made) {
                // Half a step of the colour, and half a step of opacity that veils what lies behind.
                assert!(
                    f64::from((a - b).abs()) <= 2.01 * half * through + 1e-6,
                    "{opacity} {exact:?} {made:?}"
                );
            }
        }
    }
}
