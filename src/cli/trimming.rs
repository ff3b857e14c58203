//! Settings of a front, tried at the full size, and trimmed to a goal by knobs that turn continuously.

use gelray::components::Sampling;
use gelray::measure::judged::Judged;
use gelray::measure::median::median;

use super::failure::Failure;
use super::goal::Goal;
use super::trade_points::work;
use super::trade_scene::TradeScene;

/// How long the exact pixels may take, in frames.
const SHARE: f64 = 64.0;
/// Decibels above the goal that are aimed at: some thousand pixels do not tell it closer.
const MARGIN: f64 = 0.4;
/// Frames that are timed of each choice.
const TIMED: u8 = 5;
/// How often a knob's range is halved.
const HALVINGS: u32 = 5;

/// Settings that were tried.
#[derive(Clone)]
pub struct Tried {
    pub sampling: Sampling,
    /// What is expected of them, in words.
    pub told: String,
    /// By how much the goal is kept: below 0 it is not.
    kept: f64,
    cost: f64,
}

/// The scene at its full size, and what tells whether a goal is kept.
pub struct Bench<'a> {
    traded: &'a mut TradeScene,
    goal: Goal,
    /// For a goal of decibels: each view.
    judged: Vec<Judged>,
    /// The work of what the scene states, of all views.
    stated: f64,
}

/// A knob that turns continuously: by a factor above 1 it makes a frame cheaper.
type Trim = fn(&mut Sampling, f64);

const TRIMS: [Trim; 3] = [
    |sampling, by| sampling.distance_mm = sampling.distance_mm.map(|distance| distance * by),
    |sampling, by| sampling.tolerance = sampling.tolerance.max(0.002) * by as f32,
    |sampling, by| sampling.stop_at = (sampling.stop_at.max(0.001) * by as f32).min(0.5),
];

/// Settings beside some: rays that begin farther apart, and rays that stop sooner, and both.
fn neighbors(sampling: &Sampling) -> Vec<Sampling> {
    let coarsest = sampling.coarsest.max(32);
    let stop_at = (2.5 * sampling.stop_at).min(0.5);
    let all = [
        Sampling { coarsest, ..sampling.clone() },
        Sampling { stop_at, ..sampling.clone() },
        Sampling { coarsest, stop_at, ..sampling.clone() },
    ];
    all.into_iter().filter(|other| other != sampling).collect()
}

impl<'a> Bench<'a> {
    /// Casts the exact pixels, if the goal asks for an accuracy.
    pub fn new(traded: &'a mut TradeScene, goal: Goal) -> Result<Self, Failure> {
        let base = traded.base.clone();
        let (mut judged, mut stated) = (Vec::new(), 0.0);
        for view in 0..traded.views {
            if matches!(goal, Goal::Psnr(_)) {
                judged.extend(traded.judged(view, SHARE)?);
            }
            stated += work(&traded.frame(view, &base)?.counts);
        }
        Ok(Self { traded, goal, judged, stated })
    }

    /// The best settings: those of a front, cheapest first, trimmed.
    pub fn choose(&mut self, front: &[&Sampling]) -> Result<Tried, Failure> {
        match self.goal {
            Goal::Milliseconds(_) => self.most_exact(front),
            _ => self.cheapest(front),
        }
    }

    /// The cheapest settings that keep an accuracy.
    fn cheapest(&mut self, front: &[&Sampling]) -> Result<Tried, Failure> {
        let (mut low, mut high) = (0, front.len());
        let mut last = None;
        while low < high {
            let middle = usize::midpoint(low, high);
            let tried = self.tried(front[middle].clone())?;
            if tried.kept >= 0.0 {
                high = middle;
            } else {
                low = middle + 1;
            }
            last = Some(tried);
        }
        if high == front.len() {
            let reached = last.map_or_else(String::new, |tried| tried.told);
            return Err(Failure::Said(format!(
                "no settings that were tried keep the target, the most exact {reached}; ask for less, or look at what `gelray trade` finds"
            )));
        }
        let mut best: Option<Tried> = None;
        for sampling in &front[high..(high + 2).min(front.len())] {
            let start = self.tried((*sampling).clone())?;
            let turned =
                TRIMS.map(|trim| self.turned(&start.sampling, |part| 4.0_f64.powf(part), trim));
            let turned: Vec<Tried> =
                turned.into_iter().filter_map(Result::transpose).collect::<Result<_, _>>()?;
            for tried in turned.into_iter().chain([start]) {
                let cheaper = best.as_ref().is_none_or(|best| tried.cost < best.cost);
                if tried.kept >= 0.0 && cheaper {
                    best = Some(tried);
                }
            }
        }
        let mut best = best.ok_or_else(|| Failure::Said("no settings were tried".to_owned()))?;
        for sampling in neighbors(&best.sampling) {
            for trim in &TRIMS[..2] {
                // By a factor of two at most, either way.
                let tried = self.turned(&sampling, |part| 2.0_f64.powf(2.0 * part - 1.0), *trim)?;
                if let Some(tried) = tried.filter(|tried| tried.cost < best.cost) {
                    best = tried;
                }
            }
        }
        Ok(best)
    }

    /// The most exact settings that keep a time.
    fn most_exact(&mut self, front: &[&Sampling]) -> Result<Tried, Failure> {
        let (mut low, mut high) = (0, front.len());
        let mut best = None;
        let mut least = String::new();
        while low < high {
            let middle = usize::midpoint(low, high);
            let tried = self.tried(front[middle].clone())?;
            if tried.kept >= 0.0 {
                low = middle + 1;
                best = Some(tried);
            } else {
                high = middle;
                least = tried.told;
            }
        }
        let Some(start) = best else {
            return Err(Failure::Said(format!(
                "no settings that were tried keep the target, the fastest {least}; allow for more time, or a smaller --size"
            )));
        };
        let turned = self.turned(&start.sampling, |part| 1.0 / 4.0_f64.powf(part), TRIMS[0])?;
        Ok(turned.unwrap_or(start))
    }

    /// Settings turned by a knob as far as the goal is kept, from a factor of part 0 to that of part 1; `None` where no factor that
    /// was tried keeps it.
    fn turned(
        &mut self,
        start: &Sampling,
        factor: fn(f64) -> f64,
        trim: Trim,
    ) -> Result<Option<Tried>, Failure> {
        let mut best = None;
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(low, high);
            let mut sampling = start.clone();
            trim(&mut sampling, factor(middle));
            let tried = self.tried(sampling)?;
            if tried.kept >= 0.0 {
                low = middle;
                best = Some(tried);
            } else {
                high = middle;
            }
        }
        Ok(best)
    }

    fn tried(&mut self, sampling: Sampling) -> Result<Tried, Failure> {
        match self.goal {
            Goal::Psnr(least) => self.accuracy(sampling, least),
            Goal::Milliseconds(most) => {
                let milliseconds = self.milliseconds(&sampling)?;
                let told = format!("expected: {milliseconds:.1} ms for a frame{}", self.of_views());
                Ok(Tried { sampling, told, kept: most - milliseconds, cost: milliseconds })
            }
            Goal::Max(_) | Goal::Ssim(_) => {
                Err(Failure::Said("the picture cannot be judged".to_owned()))
            }
        }
    }

    /// What the worst view is off by, and what all take.
    fn accuracy(&mut self, sampling: Sampling, least: f64) -> Result<Tried, Failure> {
        let (mut worst, mut cost): (Option<Judged>, f64) = (None, 0.0);
        for (view, judged) in (0..).zip(&self.judged) {
            let made = self.traded.frame(view, &sampling)?;
            cost += work(&made.counts);
            let judged = judged.of_another(&made.picture);
            if worst.as_ref().is_none_or(|worst| judged.psnr_db < worst.psnr_db) {
                worst = Some(judged);
            }
        }
        let Some(Judged { psnr_db, low, high, .. }) = worst else {
            return Err(Failure::Said("the picture cannot be judged".to_owned()));
        };
        let told = format!(
            "expected: {psnr_db:.1} dB ({low:.1} to {high:.1}){}, {:.2} times the work of what the scene states",
            self.of_views(),
            cost / self.stated
        );
        Ok(Tried { sampling, told, kept: psnr_db - least - MARGIN, cost })
    }

    /// Of which view the numbers are, in words.
    fn of_views(&self) -> String {
        match self.traded.views {
            1 => String::new(),
            views => format!(" at the worst of {views} views"),
        }
    }

    /// The median of some frames, of the slowest view.
    fn milliseconds(&mut self, sampling: &Sampling) -> Result<f64, Failure> {
        let mut slowest: f64 = 0.0;
        for view in 0..self.traded.views {
            let mut seconds = Vec::new();
            for time in 0..TIMED {
                // Frames of equal settings in a row would be kept, and take no time.
                let tolerance = sampling.tolerance + 1e-6 * f32::from(time + 1);
                let frame = self.traded.frame(view, &Sampling { tolerance, ..sampling.clone() })?;
                seconds.push(frame.seconds * 1e3);
            }
            slowest = slowest.max(median(&seconds));
        }
        Ok(slowest)
    }
}
