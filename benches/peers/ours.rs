//! gelray at a task: its scene, opened once for each way of casting, and its frames.

use std::path::{Path, PathBuf};

use gelray::components::Sampling;
use gelray::measure::cost::FRAME;
use gelray::scene::Source;
use gelray::view::picture::Frame;
use gelray::view::samples::{Counts, Samples};

use crate::errors::Grey;
use crate::timed::{Setting, on_threads};

/// A scene in one way of casting.
pub struct Ours(Setting);

/// A frame of it.
pub struct Framed {
    /// The whole, and casting and resampling alone.
    pub milliseconds: [f64; 2],
    pub picture: Grey,
    pub counts: Counts,
}

impl Ours {
    /// Reads a scene whose files may lie in `folder`.
    pub fn open(text: &str, folder: &Path, change: impl Fn(&mut Sampling)) -> Self {
        let folders: Vec<PathBuf> = vec![folder.to_owned()];
        let source = Source::inline("task", text);
        let mut setting = Setting::with(&source, &folders).expect("the task is a scene");
        setting.sample(change);
        Self(setting)
    }

    /// What it says where its data is not there.
    pub fn warnings(&self) -> &[String] {
        &self.0.warnings
    }

    /// The frame from an azimuth in degrees, on so many threads.
    pub fn frame(&mut self, azimuth: f64, threads: usize) -> Framed {
        let Self(setting) = self;
        setting.turn(azimuth);
        let (ran, seconds) = on_threads(threads, || setting.run());
        let cast = ran.iter().filter(|ran| FRAME.contains(&ran.name)).map(|ran| ran.seconds);
        let milliseconds = [seconds * 1e3, cast.sum::<f64>() * 1e3];
        let mut made = setting.world.query_mut::<(&Frame, &Samples)>().into_iter();
        let (Frame(picture), Samples(samples)) = made.next().expect("a view has its frame");
        let luminance = |[r, g, b, _]: &[f32; 4]| Grey::luminance([*r, *g, *b]);
        let pixels = picture.pixels.iter().map(luminance).collect();
        let picture = Grey { width: picture.size[0], pixels };
        Framed { milliseconds, picture, counts: samples.counts }
    }
}
