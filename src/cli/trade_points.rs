//! What `trade` measures: settings of a view, each with its time, its counts and its error.

use gelray::components::{KNOBS, Sampling};
use gelray::measure::front::front;
use gelray::view::samples::Counts;
use serde::{Deserialize, Serialize};

use super::goal::Goal;

/// One choice of settings, and what it costs and buys. Errors are in linear light, peak 1, the worst of all views.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// What is turned, in words.
    pub name: String,
    /// The knobs that are turned away from what the scene states.
    pub knobs: Vec<String>,
    /// All settings.
    pub sampling: Sampling,
    /// Milliseconds of casting and resampling: the median of the scene's own settings, times `times`.
    pub milliseconds: f64,
    /// How many times longer than the settings of the scene, in runs in turn.
    pub times: f64,
    /// Between which bounds that lies in 19 of 20 cases; of fewer than six runs nobody can say.
    pub times_within: Option<[f64; 2]>,
    /// Rays of all views.
    pub rays: u64,
    /// Samples of all views.
    pub samples: u64,
    /// Samples that packets of sixteen rays looked at together.
    #[serde(default)]
    pub packet_steps: u64,
    /// Bytes of the gel.
    pub gel_bytes: u64,
    /// The greatest difference of a channel.
    pub max: f64,
    /// The root of the mean squared difference.
    pub rmse: f64,
    /// Structural similarity.
    pub ssim: f64,
    /// Column and row of the greatest difference.
    pub worst_at: [usize; 2],
}

/// What was measured: `trade.json`.
#[derive(Debug, Serialize, Deserialize)]
pub struct Trade {
    /// The version that measured.
    pub version: String,
    /// The scene's name.
    pub scene: String,
    /// The scene after its overrides.
    pub settings: String,
    /// Pixels across and down.
    pub size: [usize; 2],
    /// Threads that computed.
    pub threads: usize,
    /// Views of a turn.
    pub views: u32,
    /// Root-mean-square difference of the reference, `--exact` at a quarter of the sample distance, to one at an eighth.
    pub reference_rmse: f64,
    /// What was measured; first the settings of the scene.
    pub points: Vec<Point>,
}

impl Point {
    /// Decibels; infinite where nothing differs.
    pub fn psnr_db(&self) -> f64 {
        psnr_db(self.rmse)
    }

    /// What its frames took, counted: see [`work`].
    pub fn work(&self) -> f64 {
        let Self { rays, samples, packet_steps, .. } = *self;
        work(&Counts { rays, samples, packet_steps, ..Counts::default() })
    }

    /// Whether it keeps a goal.
    pub fn keeps(&self, goal: Goal) -> bool {
        match goal {
            Goal::Psnr(least) => self.psnr_db() >= least,
            Goal::Max(most) => self.max <= most,
            Goal::Ssim(least) => self.ssim >= least,
            Goal::Milliseconds(most) => self.milliseconds <= most,
        }
    }
}

/// What rays take, in parts of about equal time: a sample, what a packet looks at together, and a ray that is made.
pub fn work(counts: &Counts) -> f64 {
    counts.samples as f64 + 8.0 * counts.packet_steps as f64 + 32.0 * counts.rays as f64
}

/// Decibels of a root-mean-square error.
pub fn psnr_db(rmse: f64) -> f64 {
    if rmse == 0.0 { f64::INFINITY } else { -20.0 * rmse.log10() }
}

/// The places of those that no other beats in both time and error, cheapest first.
pub fn on_front(points: &[Point]) -> Vec<usize> {
    front(&points.iter().map(|point| [point.milliseconds, point.rmse]).collect::<Vec<_>>())
}

/// The point that keeps a goal best: the fastest of those that keep an accuracy, the most exact of those that keep a time.
pub fn best(points: &[Point], goal: Goal) -> Option<&Point> {
    let order = |point: &&Point| match goal {
        Goal::Milliseconds(_) => point.rmse,
        _ => point.milliseconds,
    };
    let kept = points.iter().filter(|point| point.keeps(goal));
    kept.min_by(|a, b| order(a).total_cmp(&order(b)))
}

/// The settings as a scene states them.
pub fn stated(sampling: &Sampling) -> String {
    let lines = toml::to_string(sampling).unwrap_or_default();
    format!("sampling = {{ {} }}", lines.lines().collect::<Vec<_>>().join(", "))
}

/// Settings to be measured: a name, the knobs that are turned, and all of them.
pub type Choice = (String, Vec<String>, Sampling);

/// One knob turned at a time, wherever that changes anything; first the settings of the scene.
pub fn singles(base: &Sampling, distance: f64) -> Vec<Choice> {
    let mut choices = vec![("as stated".to_owned(), Vec::new(), base.clone())];
    for knob in KNOBS {
        for &setting in knob.range {
            let mut sampling = base.clone();
            knob.turn(&mut sampling, setting, distance);
            if choices.iter().all(|(_, _, known)| *known != sampling) {
                let name = format!("{} = {setting}", knob.key);
                choices.push((name, vec![knob.key.to_owned()], sampling));
            }
        }
    }
    // Gel is made anew where its texel changes: seldom, that way.
    choices[1..].sort_by_key(|(_, _, sampling)| sampling.texel as u8);
    choices
}

/// A combination as single sweeps predict it: time factor, squared error beyond the scene's settings, and what is turned.
#[derive(Clone)]
struct Predicted {
    factor: f64,
    squared: f64,
    turned: Vec<usize>,
}

/// The combinations that can lie on the front, `most` of them at the most.
///
/// Single sweeps teach: a setting that is beaten by another of its knob is in no combination; factors of time multiply and
/// squared errors add, where knobs have nothing to do with each other; knob after knob only what is then on the front
/// goes on.
pub fn combinations(points: &[Point], most: usize) -> Vec<Choice> {
    let Some(base) = points.first() else { return Vec::new() };
    let mut kept = vec![Predicted { factor: 1.0, squared: 0.0, turned: Vec::new() }];
    for knob in KNOBS {
        let own: Vec<usize> =
            (1..points.len()).filter(|&at| points[at].knobs == [knob.key]).collect();
        let mut next = kept.clone();
        for before in &kept {
            next.extend(own.iter().map(|&at| {
                let point = &points[at];
                let mut turned = before.turned.clone();
                turned.push(at);
                let squared = before.squared + point.rmse.powi(2) - base.rmse.powi(2);
                Predicted { factor: before.factor * point.times, squared, turned }
            }));
        }
        let places = front(&next.iter().map(|p| [p.factor, p.squared]).collect::<Vec<_>>());
        kept = places.into_iter().map(|at| next[at].clone()).collect();
    }
    let fresh: Vec<_> = kept.iter().filter(|p| p.turned.len() > 1).collect();
    let step = fresh.len().div_ceil(most.max(1)).max(1);
    fresh.into_iter().step_by(step).map(|p| combined(points, &p.turned)).collect()
}

/// Several points' knobs turned together.
fn combined(points: &[Point], turned: &[usize]) -> Choice {
    let names: Vec<_> = turned.iter().map(|&at| points[at].name.clone()).collect();
    let knobs: Vec<String> = turned.iter().flat_map(|&at| points[at].knobs.clone()).collect();
    let mut table = toml::Table::try_from(&points[0].sampling).unwrap_or_default();
    for &at in turned {
        let own = toml::Table::try_from(&points[at].sampling).unwrap_or_default();
        table.extend(own.into_iter().filter(|(key, _)| points[at].knobs.contains(key)));
    }
    let mut sampling: Sampling = table.try_into().unwrap_or_else(|_| points[0].sampling.clone());
    sampling.finest = sampling.finest.min(sampling.coarsest);
    (names.join(", "), knobs, sampling)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(name: &str, knob: &str, sampling: Sampling, time: f64, rmse: f64) -> Point {
        let knobs = if knob.is_empty() { Vec::new() } else { vec![knob.to_owned()] };
        Point {
            name: name.to_owned(),
            knobs,
            sampling,
            milliseconds: 10.0 * time,
            times: time,
            times_within: None,
            rays: 0,
            samples: 0,
            packet_steps: 0,
            gel_bytes: 0,
            max: rmse * 5.0,
            rmse,
            ssim: 1.0,
            worst_at: [0; 2],
        }
    }

    fn swept() -> Vec<Point> {
        let base = Sampling::default();
        let stop = |stop_at| Sampling { stop_at, ..Sampling::default() };
        let split = |tolerance| Sampling { tolerance, ..Sampling::default() };
        vec![
            point("as stated", "", base, 1.0, 0.01),
            point("stop_at = 0.1", "stop_at", stop(0.1), 0.8, 0.012),
            point("stop_at = 0.2", "stop_at", stop(0.2), 0.9, 0.02),
            point("tolerance = 0.1", "tolerance", split(0.1), 0.7, 0.015),
            point("tolerance = 0", "tolerance", split(0.0), 3.0, 0.005),
        ]
    }

    #[test]
    fn combinations_are_made_of_settings_that_are_not_beaten() {
        let made = combinations(&swept(), 10);
        assert!(!made.is_empty());
        for (name, knobs, sampling) in &made {
            assert!(!name.contains("0.2"), "{name}");
            assert_eq!(knobs, &["stop_at", "tolerance"]);
            assert_eq!(sampling.stop_at, 0.1);
        }
    }

    #[test]
    fn the_best_point_keeps_the_goal_at_the_least_cost() {
        let points = swept();
        assert_eq!(best(&points, Goal::Psnr(40.0)).map(|p| &p.name[..]), Some("as stated"));
        assert_eq!(best(&points, Goal::Psnr(36.0)).map(|p| &p.name[..]), Some("tolerance = 0.1"));
        assert_eq!(
            best(&points, Goal::Milliseconds(9.0)).map(|p| &p.name[..]),
            Some("stop_at = 0.1")
        );
        assert_eq!(best(&points, Goal::Psnr(90.0)), None);
    }

    #[test]
    fn singles_begin_with_what_is_stated_and_repeat_nothing() {
        let base = Sampling { distance_mm: Some(1.0), ..Sampling::default() };
        let choices = singles(&base, 1.0);
        assert_eq!(choices[0].2, base);
        for (at, (name, _, sampling)) in choices.iter().enumerate() {
            assert!(choices[..at].iter().all(|(_, _, known)| known != sampling), "{name}");
        }
        assert!(
            stated(&base)
                .starts_with("sampling = { distance_mm = 1.0, skip = \"pyramid\", stop_at = 0.02,")
        );
    }
}
