//! Mixtures of volumes and polygons through the whole program: both methods, shadows, textures, shafts, and all at once.

mod agreement;
mod composing;
mod cues;
mod emitting;
mod furnished;
mod judged;
mod labeled;
mod maps;
mod operators;
mod projecting;
mod removing;
mod seen_through;
mod shadows;
mod shafts;
mod speckle;
mod textures;
mod thrift;

use std::path::PathBuf;

use gelray::components::{Name, View};
use gelray::light::strength::LightStrength;
use gelray::scene::{Source, load};
use gelray::schedule::{Ran, Schedule, Watch};
use gelray::systems::JOBS;
use gelray::view::camera::Camera;
use gelray::view::extent::Extent;
use gelray::view::picture::Frame;
use gelray::view::picture::Picture;
use gelray::view::samples::{SampleArray, Samples};
use glam::DVec3;
use hecs::{Entity, World};

/// A ray at the middle of every pixel, and none that stops early: what a pixel shows depends on it and its neighbours alone.
const EVERY_PIXEL: &str = "coarsest = 4, finest = 4, tolerance = 0, stop_at = 0, texel = \"f32\"";
/// A light from above that casts shadows.
const KEY: &str = "[[entity]]\nname = \"key\"\nlight = { toward = [0, 0, 1] }\ncasts_shadow = {}\n";

/// The world that the TOML of some entities states; `data` are the folders for its files.
fn stated(parts: &[&str], data: &[PathBuf]) -> World {
    let text = parts.join("\n");
    let scene = load(&Source::inline("mixture", text.as_str()), &[], data, false);
    scene.unwrap_or_else(|error| panic!("{error}\n{text}")).world
}

fn run(world: &mut World) -> Vec<Ran> {
    Schedule::new(JOBS).unwrap().run(world, &Watch::default()).unwrap()
}

/// A world with everything made.
fn made(parts: &[&str]) -> World {
    let mut world = stated(parts, &[]);
    run(&mut world);
    world
}

fn frame(world: &World) -> Picture {
    world.query::<&Frame>().iter().next().unwrap().0.clone()
}

fn rendered(parts: &[&str]) -> Picture {
    frame(&made(parts))
}

fn samples(world: &World) -> std::sync::Arc<SampleArray> {
    world.query::<&Samples>().iter().next().unwrap().0.clone()
}

fn strength(world: &World) -> Option<LightStrength> {
    world.query::<&LightStrength>().iter().next().cloned()
}

fn entity(world: &World, name: &str) -> Entity {
    world.query::<(Entity, &Name)>().iter().find(|(_, found)| found.0 == name).unwrap().0
}

fn camera(world: &World) -> Camera {
    let mut views = world.query::<(&View, &Extent)>();
    let (view, extent) = views.iter().next().unwrap();
    Camera::new(view, extent)
}

/// What a picture shows of a world point.
fn at(world: &World, point: [f64; 3]) -> [f32; 4] {
    let (window, _) = camera(world).project(DVec3::from(point));
    frame(world).pixel(window.x as usize, window.y as usize)
}

/// A phantom whose gel has opacity `opacity[0]` at value 0 and `opacity[1]` at 1, linear between.
fn gel(phantom: &str, opacity: [f64; 2], keys: &str) -> String {
    let [low, high] = opacity;
    format!(
        "[[entity]]\nname = \"gel\"\nvolume = {{ file = \"phantom:{phantom}\" }}\n\
         classify = {{ transfer = [{{ value = 0, opacity = {low} }}, {{ value = 1, opacity = {high} }}] }}\n{keys}\n"
    )
}

/// A volume of 64³ voxels without any gel.
fn nothing() -> String {
    gel("ball", [0.0, 0.0], "")
}

/// A polygon; `keys` are further lines, as `surface` and `voxelize`.
fn polygon(name: &str, vertices: &[[f64; 3]], keys: &str) -> String {
    format!("[[entity]]\nname = \"{name}\"\npolygon = {{ vertices = {vertices:?} }}\n{keys}\n")
}

/// A square across z.
fn level(name: &str, z: f64, half: f64, keys: &str) -> String {
    polygon(name, &[[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]], keys)
}

/// An observer with a window `height` world units high.
fn view(azimuth: f64, elevation: f64, size: u32, height: f64, sampling: &str) -> String {
    format!(
        "[[entity]]\nname = \"observer\"\nview = {{ azimuth = {azimuth}, elevation = {elevation}, focal_point = [0, 0, 0], \
         height_mm = {height}, size = [{size}, {size}] }}\nsampling = {{ {sampling} }}\n"
    )
}

/// The greatest difference of a channel.
fn difference(a: [f32; 4], b: [f32; 4]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Columns and rows of a picture.
fn pixels(picture: &Picture) -> impl Iterator<Item = [usize; 2]> + use<> {
    let [width, height] = picture.size;
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}

/// Whether `holds` is true of a pixel within `reach` of another.
fn near(
    picture: &Picture,
    [x, y]: [usize; 2],
    reach: usize,
    holds: impl Fn([f32; 4]) -> bool,
) -> bool {
    let around = |p: usize, n: usize| p.saturating_sub(reach)..(p + reach + 1).min(n);
    around(y, picture.size[1])
        .any(|y| around(x, picture.size[0]).any(|x| holds(picture.pixel(x, y))))
}
