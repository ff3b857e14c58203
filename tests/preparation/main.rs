//! Preparation, from scalars to gel and pyramid: what the stages make together, and what they need not make again.

mod buried;
mod extremes;
mod sparse;
mod stages;
mod thrift;

use gelray::components::{
    Classify, Color, Contour, Form, Light, Material, Matte, Name, OpacityUnit, Order, Sampling,
    Surface, TexelKind, Toward, View, Voxelize,
};
use gelray::polygon::face::{Face, Faces};
use gelray::schedule::{Job, Ran, Schedule, Watch};
use gelray::shared::Shared;
use gelray::systems::JOBS;
use gelray::view::extent::Extent;
use gelray::volume::gel::{CELLS, GelBricks};
use gelray::volume::grid::{Grid, Scalars};
use gelray::volume::layer::{Composite, LitColors};
use gelray::with_texels;
use glam::{DVec3, Vec3, Vec4};
use hecs::{Entity, World};

/// The stages of preparation, in the order that the schedule gives them.
const STAGES: [&str; 4] = ["ranges", "classify", "relight", "pyramid"];

/// The schedule of preparation alone.
fn schedule() -> Schedule {
    let jobs: Vec<_> = JOBS.iter().filter(|job| STAGES.contains(&job.name)).copied().collect();
    assert_eq!(jobs.len(), STAGES.len());
    Schedule::new(&jobs).unwrap()
}

fn prepare(world: &mut World) -> Vec<Ran> {
    schedule().run(world, &Watch::default()).unwrap()
}

/// A contour at `value` of thickness 2.
fn contour(value: f32) -> Classify {
    let contour =
        Contour { value, opacity: 0.9, thickness_voxels: 2.0, form: Form::Around, color: None };
    Classify { iso: vec![contour], ..Classify::default() }
}

/// Samples a field of world points on a grid.
fn sampled(grid: &Grid, field: impl Fn(DVec3) -> f32) -> Vec<f32> {
    let [nx, ny, _] = grid.size;
    let index = |at: usize| [at % nx, at / nx % ny, at / (nx * ny)].map(|n| n as f64);
    let point = |at: usize| grid.index_to_world.transform_point3(index(at).into());
    (0..grid.voxels()).map(|at| field(point(at))).collect()
}

fn spawn_volume(world: &mut World, grid: Grid, values: Vec<f32>, classify: Classify) -> Entity {
    world.spawn((
        Name("volume".into()),
        Order(0),
        grid,
        Scalars::F32(Shared::new(values)),
        classify,
        Material::default(),
        OpacityUnit(grid.spacing().min_element()),
    ))
}

fn spawn_light(world: &mut World, order: u32, toward: Toward) -> Entity {
    let light = Light { toward, strength: 0.5, color: Color::WHITE };
    world.spawn((Name(format!("light {order}")), Order(order), light))
}

fn spawn_view(world: &mut World, grid: &Grid) -> Entity {
    let extent = Extent::of(grid.corners()).unwrap();
    let view = View { size: [16, 16], ..View::default() };
    let sampling = Sampling { texel: TexelKind::F32, ..Sampling::default() };
    world.spawn((Name("view".into()), Order(9), view, sampling, extent))
}

/// What the voxels of a volume send, light by light: they are matted with a polygon that is far from all of them.
fn colors(world: &mut World, volume: Entity) -> LitColors {
    let far = spawn_far(world, Matte::Over);
    let is_asked = |job: &&Job| ["scan_convert", "matte"].contains(&job.name);
    let jobs: Vec<_> = JOBS.iter().filter(is_asked).copied().collect();
    Schedule::new(&jobs).unwrap().run(world, &Watch::default()).unwrap();
    let colors = world.remove_one::<Composite>(volume).unwrap().0.colors;
    world.despawn(far).unwrap();
    colors
}

fn spawn_far(world: &mut World, matte: Matte) -> Entity {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 1e4));
    let faces = Faces(vec![Face::new(vec![corners.to_vec()]).unwrap()].into());
    let voxelize = Voxelize { matte, calibrated: true };
    world.spawn((Name("far".into()), Order(8), faces, Surface::default(), voxelize))
}

/// The texel of a voxel; zero where nothing is stored.
fn texel(gel: &GelBricks, voxel: [usize; 3]) -> Vec4 {
    with_texels!(gel, texels => {
        let brick = texels.slices().stored(texels.entry(voxel));
        texels.slices().sample(brick, voxel.map(|n| n % CELLS), Vec3::ZERO)
    })
}

/// Every voxel of a grid and where it is in the world.
fn voxels(grid: &Grid) -> impl Iterator<Item = ([usize; 3], DVec3)> + use<> {
    let (grid, [nx, ny, _]) = (*grid, grid.size);
    (0..grid.voxels()).map(move |at| {
        let voxel = [at % nx, at / nx % ny, at / (nx * ny)];
        let index = DVec3::from(voxel.map(|n| n as f64));
        (voxel, grid.index_to_world.transform_point3(index))
    })
}

const RADIUS: f64 = 12.0;

/// A ball whose scalar falls by 1 per world unit from its middle, a contour at [`RADIUS`], a fixed light and a view.
struct Ball {
    world: World,
    volume: Entity,
    light: Entity,
    view: Entity,
    grid: Grid,
}

fn ball() -> Ball {
    let mut world = World::new();
    let grid = Grid::axis_aligned([31, 31, 16], [1.0, -1.0, 2.0], [-15.0, 15.0, -15.0]).unwrap();
    let values = sampled(&grid, |p| 100.0 - p.length() as f32);
    let volume = spawn_volume(&mut world, grid, values, contour(100.0 - RADIUS as f32));
    let light = spawn_light(&mut world, 1, Toward::Direction([0.0, 0.0, 1.0]));
    let view = spawn_view(&mut world, &grid);
    Ball { world, volume, light, view, grid }
}
