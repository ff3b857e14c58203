//! Ways of casting rays, timed side by side: view after view of a turn that casts rays and does nothing else.

use gelray::components::{Material, Sampling, Surface};
use gelray::measure::cost::FRAME;
use gelray::scene::Source;
use gelray::view::samples::Samples;

use crate::timed::{Setting, Spread, is_quick};

const PIXELS: f64 = 380.0 * 380.0;

/// Reads a scene, takes its highlights off, so that no view changes the colours of its voxels, and puts its samples as far
/// apart as voxels.
pub fn open(source: &Source) -> Setting {
    let mut setting = Setting::open(source).expect("an embedded scene is read");
    setting.world.query_mut::<&mut Material>().into_iter().for_each(|m| m.specular = 0.0);
    setting.world.query_mut::<&mut Surface>().into_iter().for_each(|s| s.specular = 0.0);
    setting.sample(|sampling| sampling.distance_mm = None);
    setting
}

/// One way of casting: its scene, what was measured view by view.
pub struct Way {
    name: &'static str,
    pub setting: Setting,
    pub seconds: Vec<f64>,
    rays: Vec<f64>,
}

impl Way {
    /// Its first frame is made, so that the next ones cast rays alone.
    pub fn new(name: &'static str, source: &Source, sampling: impl Fn(&mut Sampling)) -> Self {
        let mut setting = open(source);
        setting.sample(sampling);
        setting.run();
        Self { name, setting, seconds: Vec::new(), rays: Vec::new() }
    }

    /// Turns the view and keeps the best of some frames.
    pub fn view(&mut self, azimuth: f64, repeat: usize) {
        let mut best = f64::INFINITY;
        for again in 0..repeat {
            // A view a hair off is another view: its rays are cast again.
            self.setting.turn(azimuth + 1e-7 * again as f64);
            let (ran, seconds) = self.setting.run();
            let made: u32 = ran.iter().map(|ran| ran.made).sum();
            assert_eq!(made as usize, FRAME.len(), "a turn of the view casts and resamples alone");
            best = best.min(seconds);
        }
        self.seconds.push(best);
        let mut samples = self.setting.world.query_mut::<&Samples>().into_iter();
        let rays = samples.next().map_or(0, |samples| samples.0.counts.rays);
        self.rays.push(rays as f64 / PIXELS);
    }

    /// The median of the ratio to another way's frames of the same views.
    pub fn ratio(&self, other: &Self) -> f64 {
        let ratios = self.seconds.iter().zip(&other.seconds).map(|(a, b)| a / b);
        Spread::of(&ratios.collect::<Vec<_>>()).median
    }

    pub fn print(&self, adaptive: &Self) {
        let rays = Spread::of(&self.rays).median;
        println!(
            "  {:46} {:>26}  {rays:>6.2}  {:>7.2}",
            self.name,
            Spread::of(&self.seconds).milliseconds(),
            self.ratio(adaptive)
        );
    }
}

/// Frames of two ways over some views, and the ratio of the first to the second.
pub fn compare(ways: &mut [Way; 2], told: &str) {
    for view in 0..if is_quick() { 3 } else { 9 } {
        for way in ways.iter_mut() {
            way.view(f64::from(view) * 40.0 + 5.0, 3);
        }
    }
    for way in ways.iter() {
        way.print(&ways[1]);
    }
    println!("  {told:46} {:>9.2}", ways[0].ratio(&ways[1]));
}
