//! What a world leaves out, filled in: the one function that scene files and callers of the library share.
//!
//! Stated is what the caller put on an entity; the rest is made of it here, before any system runs: orders, grids' opacity
//! units, a classification, materials and surfaces, faces of polygons and meshes, textures by name, the extent, a head
//! light, a view and its sampling. What was filled in follows what it was made of, and gives way to what is stated later.

mod carriers;
mod fault;
mod fill;
mod furniture;
mod lights;
mod order;
mod polygons;
mod slides;
mod textures;
mod values;
mod view;
mod volumes;

use hecs::World;

pub use fault::{Fault, Notice};

/// Fills in what the entities of a world leave out, and checks what no entity can be checked for alone.
///
/// Gives what was guessed, a sentence each. Called again, it makes anew only what hangs on what was changed in between.
/// The error is the first thing found that cannot be rendered; what was filled in until then stays.
pub fn resolve(world: &mut World) -> Result<Vec<Notice>, Fault> {
    let mut notices = Vec::new();
    volumes::fill_in(world, &mut notices)?;
    furniture::fill_in(world)?;
    polygons::fill_in(world)?;
    let extent = view::extent(world)?;
    textures::fill_in(world, &mut notices)?;
    slides::fill_in(world, extent)?;
    order::fill_in(world);
    lights::fill_in(world, extent, &mut notices)?;
    view::fill_in(world, extent, &mut notices)?;
    values::check(world, &mut notices)?;
    Ok(notices)
}
