//! `gelray render`: one image of a scene.

use std::ffi::OsStr;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use gelray::Error;
use gelray::error::Blame;
use gelray::formats::pictures::{layers_beside, ray_map_beside};
use gelray::formats::whole::Whole;
use gelray::measure::first_hits::{FirstHits, first_hits};
use gelray::renderer::{Rendered, Renderer};
use gelray::scene::{Scene, Source};
use gelray::schedule::Ran;
use gelray::view::samples::POSITIONS;

use super::accuracy::{Accuracy, Told, note};
use super::failure::{Failure, tell};
use super::flags::Flags;
use super::interrupt::Interrupt;
use super::memory::{self, Allowed};
use super::noted::{VERSION, notes, telling_notes};
use super::progress::Progress;
use super::progressive::Progressive;
use super::results::Results;
use super::sentence::{DATA, sentence};
use super::stats::{Bytes, Counted, Seconds, Stats};
use super::trace::Trace;
use super::{bound, contact, empty, outputs, view_name};

pub const EXAMPLES: &str = "\
Examples:
  gelray render -o head.png                          the embedded scene `head`
  gelray render minimal_4 -o ball.png --size 800x600
  gelray render scan.nii.gz -o scan.png              a volume without a scene
  gelray render scan.nrrd -o bone.png --iso 300 --save-scene bone.toml
  gelray render scene.toml -o out.exr --data ~/scans --exact
  gelray render -o head.png --set head.classify.iso.0.value=1200 --set observer.view.azimuth=60
  gelray render figure_09 -o 9.png --size 2000x2000 --progressive so_far --every 500ms
  gelray render -o head.png --estimate               and how far the picture is off
  gelray render -o head.png --target psnr=45         by the cheapest settings that keep it
  gelray render -o head.png --rays rays.png --stats head.json --trace spans.json";

/// Flags that have a use here.
pub const TAKES: &[&str] = &[
    "--output",
    "--size",
    "--set",
    "--iso",
    "--preset",
    "--channel",
    "--time",
    "--save-scene",
    "--exact",
    "--stats",
    "--trace",
    "--rays",
    "--maps",
    "--max-memory",
];

/// Renders the scene and writes what was asked for.
pub fn run(
    scene: Option<&OsStr>,
    progressive: &Progressive,
    accuracy: &Accuracy,
    flags: &Flags,
) -> Result<(), Failure> {
    let start = Instant::now();
    flags.refuse_others("render", TAKES)?;
    let out = flags.output.as_deref().ok_or_else(|| {
        Failure::Misused(format!(
            "`gelray render` needs a file to write; add -o OUT, a name that ends in one of {}",
            outputs::extensions()
        ))
    })?;
    outputs::check_picture(out)?;
    let source = contact::open(scene, flags)?;
    outputs::check(flags, &source.path.as_deref().into_iter().collect::<Vec<&Path>>())?;
    progressive.check()?;
    let trace = flags.trace.as_deref().map(|path| (Trace::begin(), path));
    let interrupt = Interrupt::listen();
    let scene = load(&source, flags)?;
    let mut scene = accuracy.calibrate(scene, &interrupt, flags)?;
    accuracy.state(&mut scene.world);
    let loaded = start.elapsed().as_secs_f64();
    let telling = telling_notes(&scene.name, &scene.resolved, flags, None);
    let looking = progressive.look(&mut scene, telling)?;
    let made = rendered(&mut scene, &interrupt, flags);
    // Pictures on their way are written before anything else is said.
    let last = looking.map(|looking| looking.end(&mut scene.world)).transpose();
    let (made, last) = (made?, last?);
    let counts = Counted::of(&scene.world, made.samples.counts, made.picture.size);
    let outs = [Some(out), last.as_deref()];
    let (mut results, encode) = encoded(outs, &scene, &made, &counts, flags)?;
    if let Some(path) = &flags.save_scene {
        results.text(path, &contact::saved(path, &scene))?;
    }
    interrupt.watch.check()?;
    let total = start.elapsed().as_secs_f64();
    if let Some(path) = &flags.stats {
        results.json(
            path,
            &stats(&scene, &made, counts.clone(), [loaded, encode, total], flags.exact),
        )?;
    }
    if let Some((trace, path)) = trace {
        results.keep(trace.end(path)?);
    }
    results.appear(&interrupt)?;
    if let Some(warning) = empty::warning(&scene.world, &made.samples).filter(|_| !flags.quiet) {
        tell(format_args!("warning: {warning}"));
    }
    say_done(out, &made, &counts, total, flags);
    Ok(())
}

/// The picture and the map of its rays as their files hold them, and the seconds that took.
fn encoded(
    outs: [Option<&Path>; 2],
    scene: &Scene,
    made: &Rendered,
    counts: &Counted,
    flags: &Flags,
) -> Result<(Results, f64), Failure> {
    let _span = tracing::info_span!("encode").entered();
    let start = Instant::now();
    let mut results = Results::default();
    let mut notes = notes(scene, counts, flags, None)?;
    notes.extend(note(made.judged.as_ref())?);
    let outs: Vec<&Path> = outs.into_iter().flatten().collect();
    results.pictures(&outs, &made.picture, &notes)?;
    if let Some(path) = &flags.rays {
        let array = &made.samples;
        let size = array.layout.size.map(|n| n * POSITIONS);
        results.keep(ray_map_beside(path, size, &array.ray_map())?);
    }
    if let Some(path) = &flags.maps {
        results.keep(maps(path, &first_hits(&scene.world)?)?);
    }
    Ok((results, start.elapsed().as_secs_f64()))
}

/// Depth, normal and entity of what each pixel shows first, as layers of floats.
fn maps(path: &Path, hits: &FirstHits) -> Result<Whole, Error> {
    let axis = |axis: usize| hits.normal.iter().map(|normal| normal[axis]).collect();
    let entity = hits.entity.iter().map(|number| *number as f32).collect();
    let layers = [("Z", hits.depth.clone()), ("N.X", axis(0)), ("N.Y", axis(1)), ("N.Z", axis(2))];
    layers_beside(path, hits.size, &[&layers[..], &[("entity", entity)]].concat())
}

/// Reads a scene with the changes that flags ask for, and says what was guessed or replaced.
///
/// A fault that `--set` brought in is a misuse.
pub fn load(source: &Source, flags: &Flags) -> Result<Scene, Failure> {
    let _span = tracing::info_span!("load").entered();
    memory::check(bound::text(&source.text), flags.max_memory)?;
    let changes = changes(source, flags);
    let data = flags.data_folders();
    let allowed = memory::allowed(flags.max_memory, 0);
    let most = allowed.map(Allowed::more);
    let scene = gelray::scene::load_within(source, &changes, &data, flags.exact, most).map_err(
        |error| match allowed {
            Some(allowed) if matches!(error, Error::Memory { .. }) => allowed.blame(error),
            _ => blame(error, source),
        },
    )?;
    outputs::spare(flags, &scene.files)?;
    warn(&scene, flags);
    Ok(scene)
}

/// Says what was guessed or replaced.
pub fn warn(scene: &Scene, flags: &Flags) {
    for warning in scene.warnings.iter().filter(|_| !flags.quiet) {
        let missing = |file: &String| warning.contains(&format!("`{file}`"));
        let remedy = if scene.missing.iter().any(missing) { DATA } else { "" };
        let separator = if remedy.is_empty() { "" } else { "; " };
        tell(format_args!("warning: {warning}{separator}{remedy}"));
    }
}

/// The changes of a scene that flags ask for.
pub fn changes(source: &Source, flags: &Flags) -> Vec<String> {
    let mut changes = flags.set.clone();
    if let Some([width, height]) = flags.size {
        changes
            .push(format!("{}.view.size=[{width}, {height}]", view_name::view_name(&source.text)));
    }
    changes
}

/// Whose fault an error is: that of `--set` if it stands in a line that is not the scene's own.
pub fn blame(error: Error, source: &Source) -> Failure {
    let Error::Scene(fault) = &error else { return error.into() };
    let changed = || {
        let (text, span) = (&fault.text, fault.span.as_ref()?);
        let begin = text.get(..span.start)?.rfind('\n').map_or(0, |end| end + 1);
        let line = text.get(begin..)?.lines().next()?;
        Some(!source.text.lines().any(|own| own == line))
    };
    if fault.blame == Blame::Override || changed() == Some(true) {
        return Failure::Misused(sentence(&error));
    }
    error.into()
}

/// Renders the scene's view, within the memory that is allowed.
fn rendered(scene: &mut Scene, interrupt: &Interrupt, flags: &Flags) -> Result<Rendered, Failure> {
    let renderer = Renderer::watched(Arc::clone(&interrupt.watch))?;
    bound::check_memory(renderer.schedule(), &scene.world, flags)?;
    interrupt.work_begins();
    let _progress = Progress::show(&interrupt.watch, flags);
    Ok(renderer.render(&mut scene.world)?)
}

fn stats<'a>(
    scene: &'a Scene,
    made: &'a Rendered,
    counts: Counted,
    [load, encode, total]: [f64; 3],
    exact: bool,
) -> Stats<'a> {
    Stats {
        version: VERSION,
        scene: &scene.name,
        size: made.picture.size,
        threads: rayon::current_num_threads(),
        exact,
        systems: &made.ran,
        counts,
        error: made.judged.as_ref(),
        bytes: Bytes::of(&scene.world),
        seconds: Seconds::of(&made.ran, load, encode, total),
    }
}

/// The last line: what was made; with `-v`, after a line a system.
fn say_done(out: &Path, made: &Rendered, counts: &Counted, total: f64, flags: &Flags) {
    if flags.quiet {
        return;
    }
    for Ran { name, made, reused, seconds } in made.ran.iter().filter(|_| flags.verbose) {
        tell(format_args!("{name}: {made} made, {reused} kept, {seconds:.3} s"));
    }
    let ([width, height], rays) = (made.picture.size, counts.rays_per_pixel);
    let out = if outputs::is_standard(out) {
        "standard output".into()
    } else {
        out.display().to_string()
    };
    let off = made.judged.as_ref().map_or(String::new(), |judged| format!("; {}", Told(judged)));
    tell(format_args!(
        "{out}: {width} × {height} pixels, {rays:.2} rays a pixel, {total:.3} s{off}"
    ));
}
