//! `--stats` of a sequence: what each frame took, and what the first one took that the others did not.

use gelray::schedule::Ran;
use gelray::sequence::film::Film;
use gelray::sequence::pipeline::Times;
use serde::Serialize;

use super::noted::VERSION;
use super::stats::Bytes;

/// What a frame took.
#[derive(Debug, Clone, Serialize)]
pub struct FrameStats {
    /// Its place in the sequence, from 0.
    #[serde(rename = "frame")]
    pub number: usize,
    /// Every system: how many products it made and kept, and its seconds.
    pub systems: Vec<Ran>,
    /// From the values that it sets to its picture.
    pub seconds: f64,
}

impl FrameStats {
    /// The systems that made anything.
    pub fn made(&self) -> Vec<&'static str> {
        self.systems.iter().filter(|ran| ran.made > 0).map(|ran| ran.name).collect()
    }

    /// The seconds of all systems.
    fn systems_seconds(&self) -> f64 {
        self.systems.iter().map(|ran| ran.seconds).sum()
    }
}

/// All that `--stats` writes of a sequence.
#[derive(Debug, Serialize)]
pub struct SequenceStats<'a> {
    version: &'static str,
    scene: &'a str,
    size: [usize; 2],
    threads: usize,
    frames: &'a [FrameStats],
    bytes: Bytes,
    seconds: Seconds,
}

#[derive(Debug, Serialize)]
struct Seconds {
    load: f64,
    /// The first frame that was rendered.
    first: f64,
    /// The mean of all others.
    others: f64,
    /// The sum of what systems took, over all frames.
    systems: f64,
    #[serde(flatten)]
    encoder: Times,
    total: f64,
}

impl<'a> SequenceStats<'a> {
    /// What was measured of the frames, beside what was timed around them.
    pub fn of(
        film: &'a Film,
        size: [usize; 2],
        frames: &'a [FrameStats],
        encoder: Times,
        [load, total]: [f64; 2],
    ) -> Self {
        let others = frames.get(1..).unwrap_or_default();
        let sum: f64 = others.iter().map(|frame| frame.seconds).sum();
        Self {
            version: VERSION,
            scene: &film.scene.name,
            size,
            threads: rayon::current_num_threads(),
            frames,
            bytes: Bytes::of(&film.scene.world),
            seconds: Seconds {
                load,
                first: frames.first().map_or(0.0, |frame| frame.seconds),
                others: if others.is_empty() { 0.0 } else { sum / others.len() as f64 },
                systems: frames.iter().map(FrameStats::systems_seconds).sum(),
                encoder,
                total,
            },
        }
    }

    /// The last line: how many frames, and where the time went.
    pub fn sentence(&self, before: usize) -> String {
        let Seconds { first, others, encoder, total, .. } = &self.seconds;
        let plural = if self.frames.len() == 1 { "" } else { "s" };
        let before = match before {
            0 => String::new(),
            count => format!(" ({count} more were there)"),
        };
        format!(
            "{} frame{plural}{before}, the first {first:.3} s, others {others:.3} s each, encoding {:.3} s beside, {:.3} s waited for it, {total:.3} s",
            self.frames.len(),
            encoder.encoding,
            encoder.waited
        )
    }
}
