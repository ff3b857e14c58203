//! `gelray animate`: a sequence of frames, or one animation of them.

use std::ffi::OsStr;
use std::path::Path;
use std::time::Instant;

use gelray::Error;
use gelray::Renderer;
use gelray::formats::moving::Movie;
use gelray::scene::{Loads, Source};
use gelray::sequence::film::Film;
use gelray::sequence::manifest::Manifest;
use gelray::sequence::pipeline::{self, Feed, RenderFault, Shot, Stopped};

use super::animate_stats::{FrameStats, SequenceStats};
use super::failure::{Failure, tell};
use super::flags::Flags;
use super::frame_progress::FrameProgress;
use super::interrupt::Interrupt;
use super::memory::{self, Allowed};
use super::motion::Motion;
use super::noted::notes;
use super::results::Results;
use super::stats::Counted;
use super::target::Target;
use super::trace::Trace;
use super::{bound, contact, listing, outputs, render};

pub const EXAMPLES: &str = "\
Examples:
  gelray animate -o turn.gif                         a full turn of the embedded scene `head`
  gelray animate -o frames/turn.####.png --frames 0..90x5 --axis elevation
  gelray animate keyframes -o keyframes.mp4 --frames 240   a scene with `animate`; MP4 and WebM by way of ffmpeg
  gelray animate scene.toml -o DIR --resume          only what is missing or has changed
  gelray animate scene.toml -o DIR --shard 2/8       a machine's part; then `gelray assemble DIR -o turn.mp4`
  gelray animate -o - | mpv -                        YUV4MPEG2 to a pipe";

/// Flags that have a use here.
pub const TAKES: &[&str] =
    &["--output", "--size", "--set", "--exact", "--stats", "--trace", "--max-memory"];

/// Renders the frames that are asked for and writes what was asked for.
pub fn run(scene: Option<&OsStr>, motion: &Motion, flags: &Flags) -> Result<(), Failure> {
    let start = Instant::now();
    flags.refuse_others("animate", TAKES)?;
    let target = Target::of(flags, motion)?;
    let source = contact::open(scene, flags)?;
    let others = Flags { output: None, ..flags.clone() };
    outputs::check(&others, &source.path.as_deref().into_iter().collect::<Vec<&Path>>())?;
    let trace = flags.trace.as_deref().map(|path| (Trace::begin(), path));
    let interrupt = Interrupt::listen();
    let mut film = open(&source, motion, flags)?;
    target.spare(&film)?;
    film.check()?;
    let mut work = Work { film, target, motion, flags, interrupt, frames: Vec::new(), done: 0 };
    work.render(start)?;
    if let Some((trace, path)) = trace {
        trace.end(path)?.appear()?;
    }
    Ok(())
}

/// Loads the scene; a fault that `--set` brought in is a misuse.
fn open(source: &Source, motion: &Motion, flags: &Flags) -> Result<Film, Failure> {
    let _span = tracing::info_span!("load").entered();
    let loads = Loads {
        data: flags.data_folders(),
        exact: flags.exact,
        most_bytes: memory::allowed(flags.max_memory, 0).map(Allowed::more),
        source: source.clone(),
    };
    let film = Film::open(loads, render::changes(source, flags), motion.frames, motion.axis())
        .map_err(|error| render::blame(error, source))?;
    let others = Flags { output: None, ..flags.clone() };
    outputs::spare(&others, &film.scene.files)?;
    render::warn(&film.scene, flags);
    Ok(film)
}

/// A sequence at work.
struct Work<'a> {
    film: Film,
    target: Target<'a>,
    motion: &'a Motion,
    flags: &'a Flags,
    interrupt: Interrupt,
    /// What each frame took, in the order in which they were rendered.
    frames: Vec<FrameStats>,
    /// Frames that were there before.
    done: usize,
}

impl Work<'_> {
    fn render(&mut self, start: Instant) -> Result<(), Failure> {
        let renderer = Renderer::watched(self.interrupt.watch.clone())?;
        bound::check_memory(renderer.schedule(), &self.film.scene.world, self.flags)?;
        let (todo, data) = self.prepare()?;
        let loaded = start.elapsed().as_secs_f64();
        self.interrupt.work_begins();
        let clip = Movie {
            size: self.film.size(),
            count: self.film.range().count(),
            rate: self.motion.fps,
        };
        let target = self.target.clone();
        let times = pipeline::run(
            |feed| self.shoot(&renderer, &todo, data.as_deref(), feed),
            |shots| target.encode(&clip, shots),
        );
        let times = times.map_err(|stopped| self.stopped(stopped))?;
        let total = start.elapsed().as_secs_f64();
        let stats = SequenceStats::of(&self.film, clip.size, &self.frames, times, [loaded, total]);
        if let Some(path) = &self.flags.stats {
            let mut results = Results::default();
            results.json(path, &stats)?;
            results.appear(&self.interrupt)?;
        }
        if !self.flags.quiet {
            tell(format_args!("{}: {}", self.target, stats.sentence(self.done)));
        }
        Ok(())
    }

    /// Which frames are to be rendered, after the list of all was written; and the digest of the data.
    fn prepare(&mut self) -> Result<(Vec<usize>, Option<String>), Failure> {
        let numbers = 0..self.film.range().count();
        let Target::Frames(numbered) = &self.target else { return Ok((numbers.collect(), None)) };
        let listing = listing::of(&self.film, numbered, self.motion.fps, self.flags)?;
        make_folder(numbered.folder())?;
        let path = numbered.manifest();
        if Manifest::read(&path).ok().as_ref() != Some(&listing) {
            listing.write(&path)?;
        }
        let own = |number: &usize| self.motion.shard.is_none_or(|shard| shard.has(*number));
        let own: Vec<_> = numbers.filter(own).collect();
        let is_done = |number: usize| listing.is_done(numbered.folder(), number);
        let todo: Vec<_> =
            own.iter().copied().filter(|n| !(self.motion.resume && is_done(*n))).collect();
        self.done = own.len() - todo.len();
        Ok((todo, listing.data_digest))
    }

    /// Renders frames one by one and hands them to the encoder.
    fn shoot(
        &mut self,
        renderer: &Renderer,
        todo: &[usize],
        data: Option<&str>,
        feed: &mut Feed,
    ) -> Result<(), RenderFault> {
        let progress = FrameProgress::show(todo.len(), self.flags);
        for &number in todo {
            let start = Instant::now();
            self.film.show(number)?;
            let rendered = renderer.render(&mut self.film.scene.world)?;
            let (scene, counts) = (&self.film.scene, rendered.samples.counts);
            let counts = Counted::of(&scene.world, counts, rendered.picture.size);
            let notes = notes(scene, &counts, self.flags, data).map_err(unsaid)?;
            let seconds = start.elapsed().as_secs_f64();
            feed.send(Shot { number, picture: rendered.picture, notes })?;
            let frame = FrameStats { number, systems: rendered.ran, seconds };
            progress.frame(&frame, self.film.range().count());
            self.frames.push(frame);
        }
        Ok(())
    }

    /// Why a sequence came to its end too early, and how far it got.
    fn stopped(&self, Stopped { error, done }: Stopped) -> Failure {
        let all = self.frames.len().max(done) + self.done;
        let count = match (&self.target, self.motion.shard) {
            (Target::Frames(_), _) => {
                format!("{} frames are finished, --resume goes on after them", done + self.done)
            }
            _ => format!("{all} of {} frames were rendered", self.film.range().count()),
        };
        if let Error::Interrupted = error {
            tell(format_args!("{}: {count}", self.target));
            return error.into();
        }
        Failure::Said(format!("{error}; {count}"))
    }
}

fn unsaid(failure: Failure) -> Error {
    match failure {
        Failure::Failed(error) => error,
        _ => Error::Schedule("the counts of a frame cannot be noted".to_owned()),
    }
}

/// Makes the folder of the frames, if it is not there; not the folders above it.
pub fn make_folder(folder: &Path) -> Result<(), Error> {
    if folder.is_dir() {
        return Ok(());
    }
    std::fs::create_dir(folder).map_err(|error| {
        let problem = format!("cannot be made for the frames ({error}); choose another folder");
        Error::file(folder, problem)
    })
}
