//! What the bias is for: no self-shadow speckle on surfaces that are lit, and how much light it lets into what is not.

use std::io::Write;
use std::path::PathBuf;

use gelray::components::CastsShadow;
use gelray::view::picture::Picture;
use gelray::volume::gradients::Gradients;
use gelray::volume::grid::{Grid, Scalars};
use gelray::volume::layer::Opacity;
use glam::Vec3;
use hecs::World;

use crate::{EVERY_PIXEL, entity, frame, pixels, run, stated, strength, view};

const TOWARD: [f32; 3] = [-0.4, -0.8, 0.5];
/// Side of the square that a pixel's neighbours are in, less one half.
const AROUND: usize = 2;

/// What shadows do to something that reflects light diffusely and nothing else.
#[derive(Debug, Clone, Copy)]
struct Shadowed {
    /// The part of the light that falls on lit pixels.
    mean: f32,
    /// The standard deviation of that part among neighbouring pixels, relative to their mean.
    speckle: f32,
    /// The mean strength at voxels of surfaces that face away from the light.
    leak: f32,
}

/// The part of the light that reaches each pixel, where it is opaque and the light would fall on it.
fn parts(plain: &Picture, shadowed: &Picture) -> Vec<Option<f32>> {
    let part = |(plain, shadowed): (&[f32; 4], &[f32; 4])| {
        (plain[3] > 0.98 && plain[0] > 0.35).then(|| shadowed[0] / plain[0])
    };
    plain.pixels.iter().zip(shadowed.pixels.iter()).map(part).collect()
}

/// Mean and speckle over the pixels that are lit and have only such neighbours.
fn mean_and_speckle(picture: &Picture, parts: &[Option<f32>], lit: &[bool]) -> [f32; 2] {
    let (mut count, mut sum, mut variance) = (0.0, 0.0, 0.0);
    let [width, height] = picture.size;
    for [x, y] in pixels(picture) {
        if x < AROUND || y < AROUND || x + AROUND >= width || y + AROUND >= height {
            continue;
        }
        let rows = y - AROUND..=y + AROUND;
        let near = rows.flat_map(|y| (x - AROUND..=x + AROUND).map(move |x| y * width + x));
        let near: Option<Vec<f32>> = near.map(|at| parts[at].filter(|_| lit[at])).collect();
        if let Some(near) = near {
            let mean = near.iter().sum::<f32>() / near.len() as f32;
            let squares = near.iter().map(|part| (part / mean - 1.0).powi(2));
            variance += squares.sum::<f32>() / near.len() as f32;
            sum += mean;
            count += 1.0;
        }
    }
    assert!(count > 300.0, "{count} pixels are lit");
    [sum / count, f32::sqrt(variance / count)]
}

/// The mean strength at opaque voxels whose surface faces away from the light by more than 60 degrees past its edge.
fn leak(world: &World) -> f32 {
    let strength = strength(world).unwrap();
    let mut volumes = world.query::<(&Opacity, &Scalars, &Grid)>();
    let (opacity, scalars, grid) = volumes.iter().next().unwrap();
    let gradients = Gradients::new(grid);
    let toward = Vec3::from(TOWARD).normalize();
    let (mut sum, mut count) = (0.0, 0.0);
    for (place, brick) in opacity.voxels.stored() {
        for (_, voxel) in place.voxels().filter(|(within, _)| brick[*within] > 0.5) {
            let outward = -Vec3::from(gradients.of(scalars, voxel)).normalize_or_zero();
            if outward.dot(toward) < -0.5 {
                sum += f32::from(strength.volumes[0].1.voxels.value(voxel)) / 65535.0
                    * strength.volumes[0].1.full;
                count += 1.0;
            }
        }
    }
    sum / count
}

/// A volume under shadows of a bias of 0, 1, 2, 3 and 6 voxels.
fn table(volume: &str, azimuth: f64, height: f64, data: &[PathBuf]) -> [Shadowed; 5] {
    let light = format!("[[entity]]\nname = \"key\"\nlight = {{ toward = {TOWARD:?} }}\n");
    let seen = view(azimuth, 20.0, 128, height, EVERY_PIXEL);
    let mut world = stated(&[volume, &light, &seen], data);
    run(&mut world);
    let plain = frame(&world);
    let key = entity(&world, "key");
    let shadowed = [0.0, 1.0, 2.0, 3.0, 6.0].map(|bias_voxels| {
        world.insert_one(key, CastsShadow { bias_voxels, ..CastsShadow::default() }).unwrap();
        run(&mut world);
        (bias_voxels, parts(&plain, &frame(&world)), leak(&world))
    });
    // What is dark six voxels nearer to the light is in the shadow of something else than its own surface.
    let lit: Vec<bool> = shadowed[4].1.iter().map(|far| far.is_some_and(|far| far > 0.9)).collect();
    println!("bias  lit part where lit  speckle  strength where turned away");
    shadowed.map(|(bias, parts, leak)| {
        let [mean, speckle] = mean_and_speckle(&plain, &parts, &lit);
        println!("{bias:<5} {mean:<18.4} {speckle:<8.4} {leak:.4}");
        Shadowed { mean, speckle, leak }
    })
}

#[test]
fn on_the_lit_side_of_a_ball_the_default_bias_leaves_no_speckle() {
    let ball = "[[entity]]\nname = \"ball\"\nvolume = { file = \"phantom:ball\" }\n\
        classify = { iso = [{ value = 0.5 }] }\nmaterial = { ambient = 0, diffuse = 1 }\n";
    let [none, _, two, ..] = table(ball, -10.0, 60.0, &[]);
    assert!(two.speckle < 0.025 && two.speckle < none.speckle / 3.0, "{none:?} {two:?}");
    assert!(two.mean > 2.0 * none.mean && two.mean > 0.85 && two.leak < 0.06, "{two:?}");
}

#[test]
fn on_the_skull_of_a_study_the_default_bias_takes_much_of_the_speckle_and_lets_little_light_in() {
    let Some(data) = std::env::var_os("GELRAY_DATA").map(PathBuf::from) else {
        // Past the harness, which keeps what passing tests print to itself.
        let _ = writeln!(std::io::stderr(), "skipped: GELRAY_DATA names no folder of data");
        return;
    };
    let skull = "[[entity]]\nname = \"head\"\nvolume = { file = \"cthead_small.nrrd\" }\n\
        classify = { iso = [{ value = 1300, form = \"around\" }] }\nmaterial = { ambient = 0, diffuse = 1 }\n";
    let [none, _, two, three, _] = table(skull, -10.0, 260.0, &[data]);
    assert!(two.speckle < none.speckle / 1.4 && three.speckle < two.speckle, "{none:?} {two:?}");
    assert!(two.leak < 0.1 && none.leak < two.leak && two.leak < three.leak, "{two:?}");
}
