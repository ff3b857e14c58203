//! Two profiles beside each other, stage by stage: ratios of runs in pairs, and whether a difference was found.

use gelray::measure::median::median;
use gelray::measure::paired::{Ratio, ratio_among};
use serde::Serialize;

use super::profile_saved::{Profile, Stage};
use super::table::table;

/// Stages that take less of both runs than this are not compared: nobody waits for them, and each one more that is looked
/// at makes all intervals wider.
const LEAST_SHARE: f64 = 0.01;

/// Two profiles and what is different.
#[derive(Debug, Serialize)]
pub struct Compared {
    /// Whether processor seconds were compared in place of seconds.
    pub busy: bool,
    /// Whether the runs of both were made by turns.
    pub by_turns: bool,
    /// The first.
    pub a: Profile,
    /// The second.
    pub b: Profile,
    /// Stages that take a part of the run worth telling, and the run.
    pub rows: Vec<Beside>,
}

/// A stage of both.
#[derive(Debug, Serialize)]
pub struct Beside {
    /// The stage.
    pub name: String,
    /// Median seconds of both, or processor seconds.
    pub seconds: [f64; 2],
    /// The second over the first, pair by pair; absent where one of them took no time.
    pub ratio: Option<Ratio>,
    /// Whether 1 lies outside of the interval.
    pub differs: bool,
}

impl Compared {
    /// Compares runs, the first of one with the first of the other and so on.
    pub fn new(a: Profile, b: Profile, by_turns: bool, busy: bool) -> Self {
        let none = || Stage::new(("", 0), [const { Vec::new() }; 2], 0.0, (0, Vec::new()));
        let other =
            |name: &str| b.stages.iter().find(|s| s.name == name).cloned().unwrap_or_else(none);
        let mut pairs: Vec<(Stage, Stage)> =
            a.stages.iter().map(|stage| (stage.clone(), other(&stage.name))).collect();
        pairs.retain(|(a, b)| a.share.max(b.share) >= LEAST_SHARE);
        pairs.push((a.run.clone(), b.run.clone()));
        let count = pairs.len();
        let rows = pairs.iter().map(|(a, b)| Beside::new(a, b, count, busy)).collect();
        Self { busy, by_turns, a, b, rows }
    }

    /// Whether any stage, or the run, takes another time.
    fn differs(&self) -> bool {
        self.rows.iter().any(|row| row.differs)
    }
}

impl Beside {
    /// A stage of both, one of `count` that are looked at together.
    fn new(a: &Stage, b: &Stage, count: usize, busy: bool) -> Self {
        let [a, b] =
            [a, b].map(|stage| (&stage.name, if busy { &stage.busy } else { &stage.seconds }));
        let pairs: Vec<[f64; 2]> = a.1.iter().zip(b.1).map(|(a, b)| [*a, *b]).collect();
        let ratio = ratio_among(&pairs, count);
        let differs = ratio.is_some_and(|ratio| ratio.differs());
        let seconds = [a.1, b.1].map(|seconds| median(seconds));
        Self { name: a.0.clone(), seconds, ratio, differs }
    }

    fn cells(&self) -> [String; 6] {
        let [a, b] = self.seconds.map(|seconds| format!("{seconds:.4}"));
        let [ratio, within] = match self.ratio {
            None => ["–", ""].map(str::to_owned),
            Some(Ratio { ratio, low, high }) if high.is_finite() => {
                [format!("{ratio:.3}"), format!("{low:.3}–{high:.3}")]
            }
            Some(Ratio { ratio, .. }) => [format!("{ratio:.3}"), "of too few runs".to_owned()],
        };
        let verdict = match self.ratio {
            Some(ratio) if ratio.differs() && ratio.low > 1.0 => "B takes longer",
            Some(ratio) if ratio.differs() => "B takes less",
            _ => "no difference found",
        };
        [self.name.clone(), a, b, ratio, within, verdict.to_owned()]
    }
}

/// The heading, a row a stage, and what was found.
pub fn words(compared: &Compared) -> String {
    let Compared { a, b, by_turns, busy, .. } = compared;
    let named = |letter: &str, profile: &Profile| {
        let [width, height] = profile.size;
        format!(
            "{letter}: {}, {width} × {height} pixels, {} threads, gelray {}\n",
            profile.scene, profile.threads, profile.version
        )
    };
    let runs = a.run.seconds.len().min(b.run.seconds.len());
    let how = if *by_turns {
        "by turns"
    } else {
        "not by turns: what else the machine did in between is not told apart"
    };
    let what = if *busy { "seconds of processors" } else { "seconds" };
    let mut text =
        format!("{}{}{runs} whole runs of each, {how}; {what}\n\n", named("A", a), named("B", b));
    let heading = ["stage", "A, s", "B, s", "B : A", "in 19 of 20", ""].map(str::to_owned);
    let rows: Vec<_> =
        std::iter::once(heading).chain(compared.rows.iter().map(Beside::cells)).collect();
    text.push_str(&table(&rows, &[1, 2, 3]));
    text.push_str(if compared.differs() {
        "\na difference was found\n"
    } else {
        "\nno difference found\n"
    });
    text
}

/// A line a stage and one for the run.
pub fn csv(compared: &Compared) -> String {
    let line = |row: &Beside| {
        let [a, b] = row.seconds;
        let ratio = row.ratio.map_or([f64::NAN; 3], |r| [r.ratio, r.low, r.high]);
        let [ratio, low, high] =
            ratio.map(|number| if number.is_finite() { number.to_string() } else { String::new() });
        format!("{},{a},{b},{ratio},{low},{high},{}\n", row.name, row.differs)
    };
    let heading = "stage,a_seconds,b_seconds,ratio,low,high,differs\n".to_owned();
    compared.rows.iter().fold(heading, |text, row| text + &line(row))
}
