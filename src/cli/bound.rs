//! The most bytes that a scene takes, before any is taken.

use std::collections::HashMap;

use gelray::components::{Sampling, View};
use gelray::light::strength::ProjectedBy;
use gelray::polygon::face::Faces;
use gelray::polygon::texture;
use gelray::schedule::{Job, Schedule};
use gelray::systems::cast::keeps_edges;
use gelray::view::picture::Picture;
use hecs::World;

use super::failure::Failure;
use super::flags::Flags;
use super::{memory, stats};

/// What the program takes before anything is read, with what is free between arrays.
const PROGRAM: u64 = 15 << 20;

/// What a thread takes beside: its stack, as far as it is used, and its share of what is free.
const THREAD: u64 = 512 << 10;

/// Bytes for a pixel of the picture's file, while it is made.
const ENCODED: u64 = 16;

/// What each byte of a scene's text takes while it is read, and each entity that it states.
const LETTER: u64 = 72;
const ENTITY: u64 = 5 << 9;

/// What the text of a scene takes while it is read.
pub fn text(scene: &str) -> u64 {
    LETTER * scene.len() as u64 + ENTITY * scene.matches("[[entity]]").count() as u64
}

/// Refuses a scene whose voxels and products could take more memory than `--max-memory` allows.
pub fn check_memory(schedule: &Schedule, world: &World, flags: &Flags) -> Result<(), Failure> {
    let taken = stats::voxels(world) + textures(world);
    let Some(allowed) = memory::allowed(flags.max_memory, taken) else { return Ok(()) };
    allowed.check(most_bytes(schedule, world) - taken, taken)
}

/// The jobs of a schedule, in the order in which they run.
pub fn jobs(schedule: &Schedule) -> impl Iterator<Item = &Job> {
    schedule.waves().iter().flatten()
}

/// What the program, voxels, textures and polygons that were read take, and the most that is made of them.
pub fn most_bytes(schedule: &Schedule, world: &World) -> u64 {
    let plans = jobs(schedule).map(|job| (job.plan)(world).bytes());
    let beside = program() + encoding(world) + polygons(world) + textures(world);
    plans.fold(stats::voxels(world).saturating_add(beside), u64::saturating_add)
}

/// The program itself, and its threads.
pub fn program() -> u64 {
    PROGRAM + THREAD * rayon::current_num_threads() as u64
}

/// The file of the picture, while it is made; nothing where casting its rays took as much for edges, which is free by then.
pub fn encoding(world: &World) -> u64 {
    let bytes = |(view, sampling): (&View, Option<&Sampling>)| {
        let pixels = view.size.iter().map(|n| u64::from(*n)).product::<u64>();
        let free = sampling.is_some_and(|sampling| keeps_edges(world, sampling));
        if free { 0 } else { pixels * ENCODED }
    };
    world.query::<(&View, Option<&Sampling>)>().iter().map(bytes).sum()
}

/// Pictures of textures as they were read, each once, and their coarser levels.
pub fn textures(world: &World) -> u64 {
    let counted = |picture: &Picture| (picture.pixels.as_ptr(), picture.pixels.bytes());
    let mut each_once: HashMap<_, _> = world.query::<&Picture>().iter().map(counted).collect();
    each_once.extend(world.query::<&ProjectedBy>().iter().map(|slide| counted(&slide.picture)));
    each_once.values().sum::<u64>() + texture::bytes_of(world)
}

/// Polygons as they were read, and as rays look for them.
pub fn polygons(world: &World) -> u64 {
    world.query::<&Faces>().iter().map(Faces::bytes).sum::<u64>() * 2
}
