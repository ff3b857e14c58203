//! First hits are those of a plain walk, which asks every face of every pixel and looks at every slab.

use std::path::PathBuf;

use super::*;
use crate::renderer::Renderer;
use crate::scene::{Source, load};
use crate::volume::grid::Grid;

const BALL: &str = "[[entity]]\nname = \"ball\"\nvolume = { file = \"phantom:ball\" }\n";
const WAVES: &str = "[[entity]]\nname = \"waves\"\n\
    volume = { file = \"phantom:marschner_lobb\", center = [7, -9, 4], spacing_mm = [0.7, 0.9, -0.8] }\n";
const SURFACE: &str =
    "classify = { iso = [{ value = 0.5, thickness_voxels = 0, opacity = 0.4 }] }\n";
const AROUND: &str = "classify = { iso = [{ value = 0.45, thickness_voxels = 0, opacity = 0.6, form = \"around\" }, { value = 0.6, opacity = 0.3 }] }\n";
const THICK: &str = "classify = { iso = [{ value = 0.5, thickness_voxels = 2, opacity = 0.2 }] }\n";
const SHELL: &str = "classify = { transfer = [{ value = 0.4, opacity = 0 }, { value = 0.5, opacity = 0.6 }, { value = 0.6, opacity = 0 }] }\n";
const CLIP: &str = "clip = { planes = [[0.3, -1, 0.2, 2]] }\n";
const FACES: &str = "[[entity]]\nname = \"wall\"\n\
    polygon = { vertices = [[-30, 9, -30], [30, 12, -30], [30, 12, 30], [-30, 9, 30]] }\n\
    surface = { opacity = 0.3 }\n\
    [[entity]]\nname = \"egg\"\n\
    mesh = { ellipsoid = { center = [-6, -4, 3], radii = [20, 15, 11], subdivisions = 3 } }\n\
    surface = { opacity = 0.35 }\nsmooth = {}\n";

/// A world of some entities whose systems have run.
fn run(entities: &str, perspective: bool, sampling: &str, change: impl Fn(&mut World)) -> World {
    let folder = tempfile::tempdir().unwrap();
    let path: PathBuf = folder.path().join("s.toml");
    // The eye is so near that some faces lie behind it.
    let view = if perspective { "field_of_view = 100, height_mm = 40" } else { "height_mm = 60" };
    let view = format!(
        "[[entity]]\nname = \"eye\"\nview = {{ size = [45, 37], azimuth = 25, elevation = 15, {view} }}\n\
         sampling = {{ coarsest = 4, finest = 4, {sampling} }}\n"
    );
    std::fs::write(&path, format!("{entities}{view}")).unwrap();
    let mut world = load(&Source::read(&path).unwrap(), &[], &[], false).unwrap().world;
    change(&mut world);
    Renderer::new().unwrap().render(&mut world).unwrap();
    world
}

fn bits(hits: &FirstHits) -> Vec<(u32, [u32; 3], u32)> {
    let depths = hits.depth.iter().zip(&hits.normal).zip(&hits.entity);
    depths
        .map(|((depth, normal), entity)| (depth.to_bits(), normal.map(f32::to_bits), *entity))
        .collect()
}

/// Checks the first hits of a world; how many pixels met something.
fn check(world: &World, what: &str) -> usize {
    let found = first_hits(world).unwrap();
    let mut plain = Scene::of(world).unwrap();
    for volume in &mut plain.volumes {
        volume.room.pyramid = None;
        volume.room.ends = [DVec3::NEG_INFINITY, DVec3::INFINITY];
    }
    let everywhere = [[f64::NEG_INFINITY, f64::INFINITY]; 2];
    plain.faces = traced(world, |_| Pixels::between(everywhere, plain.camera.size));
    assert!(bits(&found) == bits(&plain.hits()), "{what}");
    found.entity.iter().filter(|entity| **entity > 0).count()
}

fn valued(volume: &str) -> String {
    volume.replacen(" }", ", reconstruct = \"values\" }", 1)
}

#[test]
fn gel_and_faces_are_met_where_a_plain_walk_meets_them() {
    for entities in [
        [BALL, THICK].concat(),
        [BALL, SHELL, CLIP, WAVES, THICK].concat(),
        FACES.to_owned(),
        [FACES, WAVES, THICK, CLIP].concat(),
        [FACES, &valued(WAVES), SURFACE, BALL, SHELL].concat(),
    ] {
        for perspective in [false, true] {
            for sampling in ["", "distance_mm = 0.37", "distance_mm = 11", "skip = \"none\""] {
                let world = run(&entities, perspective, sampling, |_| {});
                let met = check(&world, &format!("{perspective} {sampling} {entities}"));
                assert!(met > 30, "{met} {entities}");
            }
        }
    }
}

#[test]
fn values_are_met_where_a_plain_walk_meets_them_by_any_filter_and_step() {
    for classify in [SURFACE, AROUND, THICK, SHELL] {
        for (filter, clip) in [("linear", ""), ("cubic", CLIP), ("interpolating", "")] {
            for step in ["0.3", "0.9", "2.7", "9"] {
                let entities =
                    [&valued(WAVES), classify, clip, &valued(BALL), classify, CLIP].concat();
                let integrate = step == "2.7" || step == "0.9";
                let sampling =
                    format!("filter = \"{filter}\", distance_mm = {step}, integrate = {integrate}");
                let world = run(&entities, clip.is_empty(), &sampling, |_| {});
                let met = check(&world, &format!("{sampling} {entities}"));
                assert!(met > 30, "{met} {sampling} {entities}");
            }
        }
    }
}

#[test]
fn what_is_seen_through_values_that_are_no_numbers_is_what_a_plain_walk_sees() {
    let holes = |world: &mut World| {
        for (grid, scalars) in &mut world.query::<(&Grid, &mut Scalars)>() {
            let [nx, ny, _] = grid.size;
            // Above and below in turn, with holes between that are as wide as a long step and less.
            let voxel = |at: usize| {
                let place = [at % nx, at / nx % ny, at / (nx * ny)].map(|n| n as f32 * 0.21);
                let wave = place[0].sin() + place[1].cos() + (1.3 * place[2]).sin();
                if wave.abs() < 0.6 { f32::NAN } else { wave.signum() }
            };
            *scalars = Scalars::from((0..grid.voxels()).map(voxel).collect::<Vec<f32>>());
        }
    };
    for classify in [SURFACE, AROUND, SHELL] {
        for filter in ["linear", "cubic"] {
            for step in ["0.4", "1", "3", "6"] {
                let entities = [&valued(BALL), classify].concat();
                let sampling =
                    format!("filter = \"{filter}\", distance_mm = {step}, integrate = true");
                let world = run(&entities, false, &sampling, holes);
                check(&world, &format!("{sampling} {entities}"));
            }
        }
    }
}

#[test]
fn few_slabs_are_looked_at_of_a_ray_that_goes_through_one_surface() {
    // Of a ball that is 192 steps wide the gel within is looked at, and of values the surface and the ends of the grid.
    for (volume, classify, most) in [(BALL.to_owned(), THICK, 260), (valued(BALL), SURFACE, 40)] {
        let world = run(&[&volume, classify].concat(), false, "distance_mm = 0.25", |_| {});
        let scene = Scene::of(&world).unwrap();
        let ray = scene.camera.ray(glam::DVec2::new(22.5, 18.5));
        let mut passage = scene.volumes[0].room.passage((ray.at(-100.0), ray.along * 0.25));
        let looked_at = (0..800).filter(|slab| passage.next(*slab) == *slab).count();
        assert!((4..most).contains(&looked_at), "{classify}: {looked_at}");
    }
}
