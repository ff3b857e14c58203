//! Whole runs of a scene, from its file to the bytes of its picture, with nothing kept between them.

use std::sync::Arc;

use gelray::components::Voxelize;
use gelray::formats::pictures::png_bytes;
use gelray::measure::cost::FRAME;
use gelray::measure::cost_table::Row;
use gelray::measure::held::{Held, held};
use gelray::measure::spans::spanned;
use gelray::measure::variants::has_polygons;
use gelray::scene::{Scene, Source};
use gelray::schedule::Watch;
use gelray::{Rendered, Renderer};
use hecs::World;

use super::failure::Failure;
use super::flags::Flags;
use super::noted::{VERSION, notes};
use super::profile_saved::{Profile, Stage};
use super::stats::Counted;
use super::{bound, memory, render};

/// A scene and its settings, to be run again and again.
pub struct Subject {
    source: Source,
    flags: Flags,
    watch: Arc<Watch>,
}

/// What one run left: the sums of its spans, and what was held when it was done; the world itself is gone.
pub struct Run {
    rows: Vec<Row>,
    held: Vec<Held>,
    paper_frame: &'static str,
    scene: String,
    settings: String,
    missing: Vec<String>,
    size: [usize; 2],
}

impl Subject {
    /// The scene with the changes of flags and some more; it is loaded once to say what is guessed or replaced.
    pub fn new(
        source: Source,
        flags: &Flags,
        more: &[String],
        watch: &Arc<Watch>,
    ) -> Result<Self, Failure> {
        let mut flags = flags.clone();
        flags.set.extend_from_slice(more);
        let scene = render::load(&source, &flags)?;
        let renderer = Renderer::watched(Arc::clone(watch))?;
        bound::check_memory(renderer.schedule(), &scene.world, &flags)?;
        // What was said once is not said for every run.
        flags.quiet = true;
        Ok(Self { source, flags, watch: Arc::clone(watch) })
    }

    /// The scene, read anew.
    pub fn load(&self) -> Result<Scene, Failure> {
        render::load(&self.source, &self.flags)
    }

    /// A renderer that the same watch stops.
    pub fn renderer(&self) -> Result<Renderer, Failure> {
        Ok(Renderer::watched(Arc::clone(&self.watch))?)
    }

    /// Runs all of it.
    pub fn run(&self) -> Result<Run, Failure> {
        self.run_and_look().map(|(run, _)| run)
    }

    /// Runs all of it; with what was rendered.
    pub fn run_and_look(&self) -> Result<(Run, Rendered), Failure> {
        let (ran, rows) = spanned(|| self.whole());
        let (Scene { world, name, resolved, missing, .. }, made) = ran?;
        let held = rows.iter().map(|row| held(&world, &row.name).unwrap_or_default()).collect();
        let (scene, settings, size) = (name, resolved, made.picture.size);
        let paper_frame = paper_frame(&world);
        Ok((Run { rows, held, paper_frame, scene, settings, missing, size }, made))
    }

    /// From the file of the scene to the bytes of the picture's.
    fn whole(&self) -> Result<(Scene, Rendered), Failure> {
        let _run = tracing::info_span!("run").entered();
        let mut scene = self.load()?;
        let made = self.renderer()?.render(&mut scene.world)?;
        let _encode = tracing::info_span!("encode").entered();
        let counts = Counted::of(&scene.world, made.samples.counts, made.picture.size);
        let notes = notes(&scene, &counts, &self.flags, None)?;
        png_bytes(&made.picture, &notes)
            .map_err(|problem| Failure::Said(format!("the picture {problem}")))?;
        Ok((scene, made))
    }
}

impl Run {
    /// Seconds and processor seconds of the spans of some names at a depth.
    fn spent(&self, depth: usize, names: &[&str]) -> [f64; 2] {
        let named = |row: &&Row| row.depth == depth && names.contains(&row.name.as_str());
        let rows = self.rows.iter().filter(named);
        rows.fold([0.0; 2], |[seconds, busy], row| [seconds + row.seconds, busy + row.busy])
    }

    fn stage(&self, at: usize, runs: &[Self], wall: f64) -> Stage {
        let (row, Held { bytes, counts }) = (&self.rows[at], self.held[at].clone());
        let made = row.made.map_or(row.count, |made| made);
        Stage::new((&row.name, made), spent(runs, 1, &[&row.name]), wall, (bytes, counts))
    }
}

/// Which of the paper's frames this one is most like.
fn paper_frame(world: &World) -> &'static str {
    let voxelized = world.query::<&Voxelize>().iter().next().is_some();
    match has_polygons(world) {
        false => "volume alone",
        true if voxelized => "polygons scan-converted",
        true => "polygons traced",
    }
}

/// Seconds and processor seconds of each run, of the spans of some names at a depth.
fn spent(runs: &[Run], depth: usize, names: &[&str]) -> [Vec<f64>; 2] {
    runs.iter().map(|run| run.spent(depth, names).into()).unzip::<f64, f64, _, _>().into()
}

/// The profile of some runs of one subject, without the paper's numbers; there is at least one.
pub fn profile(runs: &[Run]) -> Option<Profile> {
    let last = runs.last()?;
    let total = Stage::new(("run", 1), spent(runs, 0, &["run"]), 0.0, (0, Vec::new()));
    let rows = (0..last.rows.len()).filter(|&at| last.rows[at].depth == 1);
    let stages: Vec<Stage> = rows.map(|at| last.stage(at, runs, total.median)).collect();
    let mut frame = Stage::new(("frame", 1), spent(runs, 1, &FRAME), total.median, (0, vec![]));
    frame.is_like(last.paper_frame);
    Some(Profile {
        version: VERSION.to_owned(),
        scene: last.scene.clone(),
        settings: last.settings.clone(),
        missing: last.missing.clone(),
        size: last.size,
        threads: rayon::current_num_threads(),
        peak_bytes: memory::of_status("VmHWM:"),
        stages,
        frame,
        run: total,
        numbers: Vec::new(),
    })
}
