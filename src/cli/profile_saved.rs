//! A profile as it is saved (`--json`) and read again: seconds of each stage in each run, counts, bytes, the paper's numbers.

use std::collections::BTreeMap;
use std::path::Path;

use gelray::measure::cost::paper_costs;
use gelray::measure::median::median;
use serde::{Deserialize, Serialize};

use super::failure::Failure;

/// What whole runs of a scene took.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Profile {
    /// The version that measured.
    pub version: String,
    /// The scene's name.
    pub scene: String,
    /// The scene after its overrides.
    pub settings: String,
    /// Files that were not found, in whose place something made by formula was rendered.
    #[serde(default)]
    pub missing: Vec<String>,
    /// Pixels across and down.
    pub size: [usize; 2],
    /// Threads that computed.
    pub threads: usize,
    /// The most memory that the program took until then, other runs included; absent where the system does not tell.
    pub peak_bytes: Option<u64>,
    /// All stages, in the order in which they ran; they follow each other and make up the run.
    pub stages: Vec<Stage>,
    /// Casting and resampling: a frame of a turn.
    pub frame: Stage,
    /// The whole run, from the scene's file to the bytes of the picture's.
    pub run: Stage,
    /// The paper's numbers beside ours.
    pub numbers: Vec<Number>,
}

/// What a stage took.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Stage {
    /// The span's name.
    pub name: String,
    /// Products that it made in a run.
    pub made: u64,
    /// Seconds of each run, in their order.
    pub seconds: Vec<f64>,
    /// Seconds of each run that processors were busy with it, all threads together; 0 where the system does not tell.
    pub busy: Vec<f64>,
    /// The middle one of `seconds`.
    pub median: f64,
    /// The least.
    pub least: f64,
    /// The most.
    pub most: f64,
    /// Part of the run, by medians.
    pub share: f64,
    /// What its products count.
    pub counts: BTreeMap<String, u64>,
    /// Bytes of its products.
    pub bytes: u64,
    /// Seconds on a Sun 4/280, where the paper states them.
    pub paper_seconds: Option<f64>,
    /// Of what.
    pub paper_what: Option<String>,
}

/// A number of the paper, and ours.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Number {
    /// A word for it.
    pub key: String,
    /// What it is of.
    pub what: String,
    /// The paper's, in words: `about 1.6`.
    pub paper: String,
    /// Ours, if the scene has what it takes.
    pub ours: Option<f64>,
    /// Between which bounds ours lies in 19 of 20 cases, where that was measured.
    pub within: Option<[f64; 2]>,
    /// Its unit, or why there is none of ours.
    pub note: String,
}

impl Stage {
    /// A stage by its name and products, its seconds and processor seconds, the seconds of the run, and what its products are.
    pub fn new(
        (name, made): (&str, u64),
        [seconds, busy]: [Vec<f64>; 2],
        run: f64,
        (bytes, counts): (u64, Vec<(&str, u64)>),
    ) -> Self {
        let paper = paper_costs(name).next().filter(|_| made > 0 && name != "frame");
        let counts = counts.into_iter().filter(|(_, count)| *count > 0);
        let mut stage = Self {
            name: name.to_owned(),
            made,
            seconds,
            busy,
            median: 0.0,
            least: 0.0,
            most: 0.0,
            share: 0.0,
            counts: counts.map(|(what, count)| (what.to_owned(), count)).collect(),
            bytes,
            paper_seconds: paper.map(|paper| paper.seconds),
            paper_what: paper.map(|paper| paper.what.to_owned()),
        };
        stage.sum_up(run);
        stage
    }

    /// What follows from the seconds of its runs, where the run's own median is `run` seconds; 0 for the run itself.
    fn sum_up(&mut self, run: f64) {
        let seconds = || self.seconds.iter().copied();
        let (least, most) = (seconds().reduce(f64::min), seconds().reduce(f64::max));
        self.median = median(&self.seconds);
        [self.least, self.most] = [least, most].map(|end| end.unwrap_or(0.0));
        self.share = if run > 0.0 { self.median / run } else { 1.0 };
    }

    /// The runs of `before` and then these; `run` as in [`Stage::sum_up`].
    fn after(mut self, before: Option<&Self>, run: f64) -> Self {
        if let Some(before) = before {
            self.seconds.splice(0..0, before.seconds.iter().copied());
            self.busy.splice(0..0, before.busy.iter().copied());
        }
        self.sum_up(run);
        self
    }

    /// The paper's seconds of a frame of that kind stand beside this one's.
    pub fn is_like(&mut self, what: &str) {
        let paper = paper_costs(&self.name).find(|paper| paper.what == what);
        self.paper_seconds = paper.map(|paper| paper.seconds);
        self.paper_what = paper.map(|paper| paper.what.to_owned());
    }
}

impl Profile {
    /// The sum of all stages as a part of the run, the median of runs: 1 where spans leave nothing out.
    pub fn accounted(&self) -> f64 {
        let of_run = |at: usize| {
            let sum: f64 = self.stages.iter().filter_map(|stage| stage.seconds.get(at)).sum();
            sum / self.run.seconds[at]
        };
        median(&(0..self.run.seconds.len()).map(of_run).collect::<Vec<f64>>())
    }

    /// The runs of `before`, of the same scene and settings, and then these; with its numbers of the paper.
    pub fn after(self, before: Self) -> Self {
        let run = self.run.after(Some(&before.run), 0.0);
        let named = |name: &str| before.stages.iter().find(|stage| stage.name == name);
        let stages = self.stages.into_iter().map(|stage| {
            let known = named(&stage.name);
            stage.after(known, run.median)
        });
        let stages = stages.collect();
        let frame = self.frame.after(Some(&before.frame), run.median);
        Self { stages, frame, run, numbers: before.numbers, ..self }
    }

    /// Reads a saved one.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let name = path.display();
        let text = std::fs::read_to_string(path).map_err(|error| {
            Failure::Said(format!(
                "{name}: cannot be read ({error}); name a file of `gelray profile --json`"
            ))
        })?;
        serde_json::from_str(&text).map_err(|error| {
            Failure::Said(format!(
                "{name}: is no profile ({error}); write one with `gelray profile --json -o {name}`"
            ))
        })
    }
}
