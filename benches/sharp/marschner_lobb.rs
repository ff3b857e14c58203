//! The field of Marschner and Lobb in every filter: where its surface is found, and by how much its normals are turned.

use std::f64::consts::PI;

use fearless_simd::Level;
use gelray::components::Filter;
use gelray::formats::Voxels;
use gelray::phantom::{marschner_lobb_at, phantom};
use gelray::volume::coefficients::Coefficients;
use gelray::volume::field::{Field, Sampled, Spot};
use glam::{DVec3, Vec3};

use super::FILTERS;

fn field(p: DVec3) -> f64 {
    marschner_lobb_at(p.to_array())
}

fn slope(p: DVec3) -> DVec3 {
    let h = 1e-5;
    let along = |axis: DVec3| (field(p + axis * h) - field(p - axis * h)) / (2.0 * h);
    DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
}

/// How far off the surface ρ = 1/2 is found in each filter, and by how much its normals are turned.
pub fn measure() {
    let signal = phantom("marschner_lobb").expect("a phantom of that name");
    let (grid, Voxels::Scalars(scalars)) = (signal.grid, signal.voxels) else {
        unreachable!("it is made of scalars");
    };
    let h = 2.0 / (grid.size[0] - 1) as f64;
    let splines = Coefficients::of(&scalars, &grid, &gelray::schedule::Watch::default()).values;
    // On the surface z is a function of x and y.
    let on = (0..200 * 200).map(|n| {
        let (x, y) = (f64::from(n % 200) / 110.0 - 0.9, f64::from(n / 200) / 110.0 - 0.9);
        let ring = (2.0 * PI * 6.0 * (PI * x.hypot(y) / 2.0).cos()).cos();
        DVec3::new(x, y, (0.25 * (1.0 + ring) - 0.25).asin() * 2.0 / PI)
    });
    let on: Vec<_> = on.collect();
    println!("Marschner and Lobb, 40³: the surface ρ = 1/2 at {} places", on.len());
    println!(
        "  {:14} {:>31} {:>31}",
        "", "position, voxels, rms / worst", "normal, degrees, rms / worst"
    );
    for filter in FILTERS {
        let scalars = if filter == Filter::Interpolating { &splines } else { &scalars };
        let made = Field::new(scalars, &grid, filter);
        let errors: Vec<[f64; 2]> = on.iter().map(|&p| error(&made, p, h)).collect();
        let rms = |i: usize| {
            (errors.iter().map(|e| e[i] * e[i]).sum::<f64>() / errors.len() as f64).sqrt()
        };
        let worst = |i: usize| errors.iter().map(|e| e[i]).fold(0.0, f64::max);
        println!(
            "  {:14} {:>20.3} {:>10.3} {:>20.2} {:>10.2}",
            format!("{filter:?}"),
            rms(0),
            worst(0),
            rms(1),
            worst(1)
        );
    }
}

/// The distance in voxels to where the field takes the value that it has at `p`, to first order, and the turn of its normal.
fn error(made: &Field, p: DVec3, h: f64) -> [f64; 2] {
    let place = (p + DVec3::ONE) / h;
    let cell = place.floor();
    let spot = Spot {
        cell: cell.to_array().map(|n| n as usize),
        part: (place - cell).to_array().map(|n| n as f32),
    };
    let mut found = [Sampled::default()];
    made.sample(Level::new(), &[spot], &mut found);
    let truth = slope(p);
    let gradient = Vec3::from(found[0].gradient).as_dvec3();
    let off = (f64::from(found[0].value) - field(p)).abs() / truth.length() / h;
    [off, gradient.angle_between(truth).to_degrees()]
}
