//! What the benches share: a scene that is made ready, turned, and timed frame by frame; medians; the most memory.

use std::path::PathBuf;
use std::time::Instant;

use gelray::Error;
use gelray::components::{Sampling, View};
use gelray::scene::{Source, load};
use gelray::schedule::{Ran, Schedule, Watch};
use gelray::systems::JOBS;
use hecs::World;

/// Whether `--quick` was asked for: fewer views and repetitions, the same tables.
pub fn is_quick() -> bool {
    std::env::args().any(|argument| argument == "--quick")
}

/// Where real data is, if the environment says so.
fn data() -> Vec<PathBuf> {
    std::env::var_os("GELRAY_DATA").into_iter().map(PathBuf::from).collect()
}

/// A scene in memory and the schedule that makes its pictures.
pub struct Setting {
    pub world: World,
    /// Why it is not the data that the scene names, if so.
    pub warnings: Vec<String>,
    schedule: Schedule,
}

impl Setting {
    /// Reads a scene; nothing is made of it yet.
    pub fn open(source: &Source) -> Result<Self, Error> {
        Self::with(source, &[])
    }

    /// Reads a scene whose files may also lie in `folders`.
    pub fn with(source: &Source, folders: &[PathBuf]) -> Result<Self, Error> {
        let scene = load(source, &[], &[folders, &data()].concat(), false)?;
        let schedule = Schedule::new(JOBS)?;
        Ok(Self { world: scene.world, warnings: scene.warnings, schedule })
    }

    /// Turns the view about the scene, degrees.
    pub fn turn(&mut self, azimuth: f64) {
        for view in self.world.query_mut::<&mut View>() {
            view.azimuth = azimuth;
        }
    }

    /// Changes how the view samples.
    pub fn sample(&mut self, change: impl Fn(&mut Sampling)) {
        self.world.query_mut::<&mut Sampling>().into_iter().for_each(change);
    }

    /// Runs the schedule: what each system did, and the seconds of the whole.
    pub fn run(&mut self) -> (Vec<Ran>, f64) {
        let start = Instant::now();
        let ran = self.schedule.run(&mut self.world, &Watch::default());
        let seconds = start.elapsed().as_secs_f64();
        (ran.expect("an embedded scene renders"), seconds)
    }
}

/// Runs `act` on a pool of so many threads.
pub fn on_threads<R: Send>(threads: usize, act: impl FnOnce() -> R + Send) -> R {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads can be started").install(act)
}

/// The most memory in MB that this program took until now; NaN where the system tells none.
pub fn peak_megabytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kibibytes.map_or(f64::NAN, |kibibytes| kibibytes * 1024.0 / 1e6)
}

/// Seconds that processors were busy with this program until now, all threads together; NaN where the system tells none.
pub fn busy_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // After the name, which ends in the last parenthesis: the twelfth and thirteenth fields, in hundredths.
    let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace().skip(11).take(2);
    let ticks: Vec<f64> = fields.filter_map(|field| field.parse().ok()).collect();
    if ticks.len() == 2 { (ticks[0] + ticks[1]) / 100.0 } else { f64::NAN }
}

/// The middle one of some numbers, the least and the greatest; NaN of none.
#[derive(Clone, Copy)]
pub struct Spread {
    pub median: f64,
    pub least: f64,
    pub most: f64,
}

impl Spread {
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |place: usize| sorted.get(place).copied().unwrap_or(f64::NAN);
        Self { median: at(sorted.len() / 2), least: at(0), most: at(sorted.len().max(1) - 1) }
    }

    /// `median [least–most]` in milliseconds, of seconds.
    pub fn milliseconds(&self) -> String {
        let [median, least, most] = [self.median, self.least, self.most].map(|s| s * 1e3);
        format!("{median:.1} [{least:.1}–{most:.1}]")
    }
}
