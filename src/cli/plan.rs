//! `gelray plan`: which systems run, which do not and why, sizes in bytes before anything is allocated.

use std::ffi::OsStr;
use std::path::Path;

use gelray::components::{Name, Sampling, View};
use gelray::renderer::Renderer;
use gelray::schedule::{Job, Plan, Schedule};
use gelray::view::extent::Extent;
use gelray::volume::grid::smallest_spacing;
use gelray::volume::scene_volumes::visible;
use hecs::World;

use super::bound::{self, check_memory, jobs, most_bytes};
use super::bytes::human;
use super::failure::Failure;
use super::flags::Flags;
use super::table::table;
use super::{contact, outputs, render, stats};

/// Flags that have a use here.
pub const TAKES: &[&str] =
    &["--output", "--size", "--set", "--iso", "--preset", "--exact", "--max-memory"];

/// Prints the plan of a scene.
pub fn run(scene: Option<&OsStr>, flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("plan", TAKES)?;
    let source = contact::open(scene, flags)?;
    outputs::check(flags, &source.path.as_deref().into_iter().collect::<Vec<&Path>>())?;
    let scene = render::load(&source, flags)?;
    let renderer = Renderer::new()?;
    let schedule = renderer.schedule();
    outputs::print_or_write(&words(schedule, &scene.world), flags)?;
    check_memory(schedule, &scene.world, flags)
}

/// How many samples the view's rays can take, were nothing empty: a scene without a volume takes none.
fn samples(world: &World) -> Option<String> {
    let smallest = smallest_spacing(visible(world).iter().map(|volume| volume.grid))?;
    let mut views = world.query::<(&View, &Sampling, &Extent)>();
    let (view, sampling, extent) = views.iter().next()?;
    let distance = sampling.distance_mm.unwrap_or(smallest);
    let a_ray = extent.samples(distance);
    let all = a_ray * view.size.iter().map(|&n| f64::from(n)).product::<f64>();
    Some(format!(
        "A ray has up to {a_ray} samples, {distance} apart; at a ray a pixel up to {all:.3e} in all, less what is empty or hidden.\n"
    ))
}

fn words(schedule: &Schedule, world: &World) -> String {
    let heading = ["system", "", "bytes at most", "", "makes", "for", "why"].map(str::to_owned);
    let voxels = stats::voxels(world);
    let read = ["", "", &human(voxels), &voxels.to_string(), "voxels", "", "as they were read"];
    let total = most_bytes(schedule, world);
    let sum = ["total", "", &human(total), &total.to_string(), "", "", ""];
    let beside = [
        (bound::program(), "the program and its threads"),
        (bound::polygons(world), "polygons, as they were read and as rays look for them"),
        (bound::encoding(world), "the file of the picture, while it is made"),
    ];
    let mut rows = vec![heading, read.map(str::to_owned)];
    rows.extend(jobs(schedule).map(|job| row(job, &(job.plan)(world), world)));
    rows.extend(beside.into_iter().filter(|(bytes, _)| *bytes > 0).map(|(bytes, what)| {
        ["", "", &human(bytes), &bytes.to_string(), "", "", what].map(str::to_owned)
    }));
    rows.push(sum.map(str::to_owned));
    table(&rows, &[2, 3]) + &samples(world).unwrap_or_default()
}

fn row(job: &Job, plan: &Plan, world: &World) -> [String; 7] {
    let runs = !plan.makes.is_empty();
    let name = |entity| world.get::<&Name>(entity).map(|name| name.0.clone()).unwrap_or_default();
    let entities: Vec<_> = plan.makes.iter().map(|(entity, _)| name(*entity)).collect();
    let bytes = plan.bytes();
    [
        job.name.to_owned(),
        (if runs { "runs" } else { "does not run" }).to_owned(),
        if runs { human(bytes) } else { String::new() },
        if runs { bytes.to_string() } else { String::new() },
        format!("{:?}", job.makes),
        entities.join(", "),
        plan.why.to_owned(),
    ]
}
