//! The scene that `trade` measures: its frames by one choice of settings after the other, in one world.

use std::sync::Arc;

use gelray::Renderer;
use gelray::components::{Sampling, View};
use gelray::measure::cost::FRAME;
use gelray::measure::error::{Difference, compare};
use gelray::measure::paired::ratio_of_pairs;
use gelray::scene::Scene;
use gelray::schedule::Watch;
use gelray::view::picture::Picture;
use gelray::view::samples::Counts;
use gelray::volume::gel::{Gel, GelBricks};
use gelray::volume::grid::smallest_spacing;
use gelray::volume::scene_volumes::visible;

use super::failure::Failure;
use super::trade_points::{Choice, Point};

/// A scene, and its view's settings and references.
pub struct TradeScene {
    pub scene: Scene,
    pub renderer: Renderer,
    /// What the scene states.
    pub base: Sampling,
    /// Δ, world units: stated, or the smallest voxel spacing.
    pub distance: f64,
    /// Views of a turn.
    pub views: u32,
    /// Milliseconds of a frame by what the scene states, the median, once they are known.
    pub milliseconds: f64,
    azimuth: f64,
    references: Vec<Picture>,
}

impl TradeScene {
    /// The scene as it was loaded; `watch` stops its frames.
    pub fn new(scene: Scene, views: u32, watch: &Arc<Watch>) -> Result<Self, Failure> {
        let missing = || Failure::Said("the scene has no view; state one".to_owned());
        let smallest = smallest_spacing(visible(&scene.world).into_iter().map(|v| v.grid));
        let (base, azimuth) = {
            let mut views = scene.world.query::<(&View, &Sampling)>();
            let (view, sampling) = views.iter().next().ok_or_else(missing)?;
            (sampling.clone(), view.azimuth)
        };
        let distance = base.distance_mm.or(smallest).unwrap_or(1.0);
        let base = Sampling { distance_mm: Some(distance), ..base };
        let (renderer, references) = (Renderer::watched(Arc::clone(watch))?, Vec::new());
        Ok(Self { scene, renderer, base, distance, views, milliseconds: 0.0, azimuth, references })
    }

    /// Pixels across and down.
    pub fn size(&self) -> [usize; 2] {
        self.references.first().map_or([0; 2], |picture| picture.size)
    }

    /// Renders the references; their root-mean-square difference to finer ones, unless it is known, the worst of all views.
    pub fn find_references(&mut self, known: Option<f64>) -> Result<f64, Failure> {
        let mut worst = known.unwrap_or(0.0);
        for view in 0..self.views {
            let [quarter, eighth] = [0.25, 0.125].map(|part| Sampling {
                distance_mm: Some(self.distance * part),
                ..self.base.exact()
            });
            let reference = self.frame(view, &quarter)?.picture;
            if known.is_none() {
                let finer = self.frame(view, &eighth)?.picture;
                worst = f64::max(worst, off(&reference, &finer)?.linear.rmse);
            }
            self.references.push(reference);
        }
        Ok(worst)
    }

    /// Measures a choice: frames in turn with those of the scene's own settings.
    pub fn measure(
        &mut self,
        (name, knobs, sampling): Choice,
        repeat: u32,
    ) -> Result<Point, Failure> {
        let is_base = sampling == self.base;
        // Frames of equal settings in a row would be kept, and take no time.
        let beside = if is_base { nearly(&self.base) } else { self.base.clone() };
        let views = self.views;
        let turns = (0..repeat).flat_map(|round| (0..views).map(move |view| (round, view)));
        let (mut pairs, mut counts) = (Vec::new(), Counts::default());
        let mut worst: Option<Difference> = None;
        for (round, view) in turns {
            // The next choice begins with the scene's own settings: they must not be the last of this one.
            let (before, made) = if is_base {
                let made = self.frame(view, &sampling)?;
                (self.frame(view, &beside)?.seconds, made)
            } else {
                (self.frame(view, &beside)?.seconds, self.frame(view, &sampling)?)
            };
            pairs.push([if is_base { made.seconds } else { before }, made.seconds]);
            if round == 0 {
                counts += made.counts;
                let found = off(&made.picture, &self.references[view as usize])?;
                if worst.as_ref().is_none_or(|worst| found.linear.rmse > worst.linear.rmse) {
                    worst = Some(found);
                }
            }
        }
        let worst = worst.ok_or_else(|| Failure::Said("nothing was measured".to_owned()))?;
        // The machine is as busy for one of a pair as for the other: ratios of pairs say more than seconds.
        let ratio = ratio_of_pairs(&pairs)
            .ok_or_else(|| Failure::Said("a frame took no time that can be measured".to_owned()))?;
        if is_base {
            self.milliseconds = median(pairs.iter().map(|pair| pair[1] * 1e3).collect());
        }
        let is_bounded = ratio.low > 0.0 && ratio.high.is_finite();
        Ok(Point {
            name,
            knobs,
            sampling,
            milliseconds: self.milliseconds * ratio.ratio,
            times: ratio.ratio,
            times_within: is_bounded.then_some([ratio.low, ratio.high]),
            rays: counts.rays,
            samples: counts.samples,
            gel_bytes: self.gel_bytes(),
            max: worst.linear.max,
            rmse: worst.linear.rmse,
            ssim: worst.linear.ssim,
            worst_at: worst.worst_at,
        })
    }

    /// The picture of the first view by some settings, and where it is off.
    pub fn pictures(&mut self, sampling: &Sampling) -> Result<[Picture; 2], Failure> {
        let picture = self.frame(0, sampling)?.picture;
        let difference = off(&picture, &self.references[0])?.worst;
        Ok([picture, difference])
    }

    fn gel_bytes(&self) -> u64 {
        let bytes = |gel: &Gel| gel.lit.bytes() + gel.ambient.as_ref().map_or(0, GelBricks::bytes);
        self.scene.world.query::<&Gel>().iter().map(bytes).sum()
    }

    /// A frame of one of the views.
    fn frame(&mut self, view: u32, sampling: &Sampling) -> Result<Timed, Failure> {
        let world = &mut self.scene.world;
        for (stated, own) in world.query_mut::<(&mut View, &mut Sampling)>() {
            stated.azimuth = self.azimuth + 360.0 * f64::from(view) / f64::from(self.views);
            *own = sampling.clone();
        }
        let made = self.renderer.render(world)?;
        let frame = made.ran.iter().filter(|ran| FRAME.contains(&ran.name));
        let seconds = frame.map(|ran| ran.seconds).sum();
        Ok(Timed { picture: made.picture, counts: made.samples.counts, seconds })
    }
}

/// A frame, and the seconds of casting and resampling.
struct Timed {
    picture: Picture,
    counts: Counts,
    seconds: f64,
}

/// The middle one of some numbers.
fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

/// Settings that differ in nothing that is seen.
fn nearly(base: &Sampling) -> Sampling {
    Sampling { tolerance: base.tolerance + 1e-6, ..base.clone() }
}

fn off(a: &Picture, b: &Picture) -> Result<Difference, Failure> {
    compare(a, b)
        .map_err(|problem| Failure::Said(format!("the picture and its reference: {problem}")))
}
