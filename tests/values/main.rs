//! Volumes whose values are interpolated: what is skipped is empty, what is asked again is made again, what is seen is there.

mod agreement;
mod closed;
mod convergence;
mod integrated;
mod lossless;
mod silhouettes;
mod surfaces;
mod thrift;

use gelray::prelude::*;
use gelray::schedule::Ran;
use glam::DVec3;

const FILTERS: [Filter; 4] =
    [Filter::Linear, Filter::Cubic, Filter::CatmullRom, Filter::Interpolating];

/// A world of one volume of values by formula of the voxel, a light, and a view.
fn world(
    (grid, scalars): (Grid, Scalars),
    classify: Classify,
    (view, sampling): (View, Sampling),
) -> World {
    let mut world = World::new();
    world.spawn((grid, scalars, classify, Reconstruct::Values));
    world.spawn((Light::from_direction([-0.4, -0.8, 0.5]),));
    world.spawn((view, sampling));
    world
}

/// The entity that carries a component.
fn carrier<T: hecs::Component>(world: &World) -> Entity {
    world.query::<Entity>().with::<&T>().iter().next().unwrap()
}

fn rendered(world: &mut World) -> Rendered {
    Renderer::new().unwrap().render(world).unwrap()
}

fn bits(picture: &Picture) -> Vec<[u32; 4]> {
    picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

/// What was made, by name.
fn made(ran: &[Ran]) -> Vec<&'static str> {
    ran.iter().filter(|ran| ran.made > 0).map(|ran| ran.name).collect()
}

/// Scalars in floats, by the place from the middle in voxels.
fn floats(size: [usize; 3], field: impl Fn(DVec3) -> f32) -> (Grid, Scalars) {
    let middle = DVec3::from(size.map(|n| (n - 1) as f64 / 2.0));
    let place = |at: usize| {
        let index = [at % size[0], at / size[0] % size[1], at / (size[0] * size[1])];
        DVec3::from(index.map(|n| n as f64)) - middle
    };
    let voxels: Vec<f32> = (0..size.iter().product()).map(|at| field(place(at))).collect();
    let [nx, ny, nz] = size;
    gelray::prelude::volume(voxels, [nz, ny, nx], [1.0; 3]).unwrap()
}
