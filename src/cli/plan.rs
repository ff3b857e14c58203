//! `gelray plan`: which systems run, which do not and why, sizes in bytes before anything is allocated.

use std::ffi::OsStr;
use std::path::Path;

use gelray::components::{Name, Sampling, View};
use gelray::renderer::Renderer;
use gelray::scene::Scene;
use gelray::schedule::{Job, Plan, Schedule};
use gelray::view::extent::Extent;
use gelray::volume::grid::smallest_spacing;
use gelray::volume::scene_volumes::visible;
use hecs::World;

use super::bound::{self, check_memory, jobs};
use super::bytes::human;
use super::failure::Failure;
use super::flags::Flags;
use super::table::table;
use super::{contact, outputs, render, stats};

/// Flags that have a use here.
pub const TAKES: &[&str] = &[
    "--output",
    "--size",
    "--set",
    "--iso",
    "--preset",
    "--channel",
    "--time",
    "--exact",
    "--max-memory",
];

/// Prints the plan of a scene.
pub fn run(scene: Option<&OsStr>, flags: &Flags) -> Result<(), Failure> {
    flags.refuse_others("plan", TAKES)?;
    let source = contact::open(scene, flags)?;
    outputs::check(flags, &source.path.as_deref().into_iter().collect::<Vec<&Path>>())?;
    let scene = render::load(&source, flags)?;
    let renderer = Renderer::new()?;
    let schedule = renderer.schedule();
    outputs::print_or_write(&words(schedule, &scene), flags)?;
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

fn words(schedule: &Schedule, scene: &Scene) -> String {
    let world = &scene.world;
    let heading =
        ["system", "", "at most", "bytes", "expected", "makes", "for", "why"].map(str::to_owned);
    let voxels = stats::voxels(world);
    let plans: Vec<_> = jobs(schedule).map(|job| (job, (job.plan)(world))).collect();
    let beside = [
        (bound::program(), "the program and its threads"),
        (bound::text(&scene.resolved), "the scene's text, while it is read"),
        (bound::polygons(world), "polygons, as they were read and as rays look for them"),
        (bound::textures(world), "textures, as they were read and at their coarser levels"),
        (bound::encoding(world), "the file of the picture, while it is made"),
    ];
    let known = beside.iter().map(|(bytes, _)| bytes).sum::<u64>().saturating_add(voxels);
    let sum = |bytes: fn(&Plan) -> u64| {
        plans.iter().fold(known, |sum, (_, plan)| sum.saturating_add(bytes(plan)))
    };
    let (most, expected) = (sum(Plan::bytes), sum(Plan::expected));
    let weighed = |name: &str, [most, expected]: [u64; 2], [makes, why]: [&str; 2]| {
        let bytes = most.to_string();
        [name, "", &human(most), &bytes, &human(expected), makes, "", why].map(str::to_owned)
    };
    let mut rows = vec![heading, weighed("", [voxels; 2], ["voxels", "as they were read"])];
    rows.extend(plans.iter().map(|(job, plan)| row(job, plan, world)));
    let beside = beside.into_iter().filter(|(bytes, _)| *bytes > 0);
    rows.extend(beside.map(|(bytes, what)| weighed("", [bytes; 2], ["", what])));
    rows.push(weighed("total", [most, expected], ["", ""]));
    table(&rows, &[2, 3, 4]) + &samples(world).unwrap_or_default()
}

fn row(job: &Job, plan: &Plan, world: &World) -> [String; 8] {
    let runs = !plan.makes.is_empty();
    let name = |entity| world.get::<&Name>(entity).map(|name| name.0.clone()).unwrap_or_default();
    let entities: Vec<_> = plan.makes.iter().map(|(entity, _)| name(*entity)).collect();
    let bytes = plan.bytes();
    [
        job.name.to_owned(),
        (if runs { "runs" } else { "does not run" }).to_owned(),
        if runs { human(bytes) } else { String::new() },
        if runs { bytes.to_string() } else { String::new() },
        if runs { human(plan.expected()) } else { String::new() },
        format!("{:?}", job.makes),
        entities.join(", "),
        plan.why.to_owned(),
    ]
}
