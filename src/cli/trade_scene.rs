//! The scene that `trade` measures: its frames by one choice of settings after the other, in one world.

use std::sync::Arc;

use gelray::Renderer;
use gelray::components::{Estimate, Sampling, View};
use gelray::measure::cost::FRAME;
use gelray::measure::error::{Difference, compare};
use gelray::measure::judged::Judged;
use gelray::measure::median::median;
use gelray::measure::paired::ratio_of_pairs;
use gelray::scene::Scene;
use gelray::schedule::Watch;
use gelray::view::picture::Picture;
use gelray::view::samples::Counts;
use gelray::volume::gel::{Gel, GelBricks};
use gelray::volume::grid::smallest_spacing;
use gelray::volume::scene_volumes::visible;
use hecs::Entity;

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
        let mut seconds = vec![Vec::new(); views as usize];
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
            seconds[view as usize].push(made.seconds * 1e3);
            if round == 0 {
                counts += made.counts;
                let found = off(&made.picture, &self.references[view as usize])?;
                worst = Some(match worst {
                    Some(worst) => worse(worst, found),
                    None => found,
                });
            }
        }
        let worst = worst.ok_or_else(|| Failure::Said("nothing was measured".to_owned()))?;
        // The machine is as busy for one of a pair as for the other: ratios of pairs say more than seconds.
        let ratio = ratio_of_pairs(&pairs)
            .ok_or_else(|| Failure::Said("a frame took no time that can be measured".to_owned()))?;
        if is_base {
            self.milliseconds = seconds.iter().map(|seconds| median(seconds)).fold(0.0, f64::max);
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
            packet_steps: counts.packet_steps,
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

    /// Turns to another size of the pictures; references are of the old one.
    pub fn resize(&mut self, size: [u32; 2]) {
        self.references.clear();
        self.scene.world.query_mut::<&mut View>().into_iter().for_each(|view| view.size = size);
    }

    /// What the picture of a view is off by, from a part of its pixels that take `share` times its work.
    pub fn judged(&mut self, view: u32, share: f64) -> Result<Option<Judged>, Failure> {
        let entities: Vec<Entity> =
            self.scene.world.query_mut::<Entity>().with::<&View>().into_iter().collect();
        let mut stated = Vec::new();
        for entity in entities {
            let own = self.scene.world.get::<&Estimate>(entity).map(|own| *own).ok();
            stated.push((entity, own));
            // It was found there a line ago.
            let _ = self.scene.world.insert_one(entity, Estimate { seed: 0, share });
        }
        let base = self.base.clone();
        self.frame(view, &base)?;
        let judged = self.scene.world.query::<&Judged>().iter().next().cloned();
        for (entity, own) in stated {
            let world = &mut self.scene.world;
            // It carries one since a few lines ago.
            let _ = world.remove_one::<Estimate>(entity);
            let _ = own.map(|own| world.insert_one(entity, own));
        }
        Ok(judged)
    }

    /// The scene again, seen from where it states.
    pub fn into_scene(mut self) -> Scene {
        for view in self.scene.world.query_mut::<&mut View>() {
            view.azimuth = self.azimuth;
        }
        self.scene
    }

    /// A frame of one of the views.
    pub fn frame(&mut self, view: u32, sampling: &Sampling) -> Result<Timed, Failure> {
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
pub struct Timed {
    pub picture: Picture,
    pub counts: Counts,
    pub seconds: f64,
}

/// The worse of two views, measure by measure; where is where the worse mean is.
fn worse(a: Difference, b: Difference) -> Difference {
    let [max, ssim] = [a.linear.max.max(b.linear.max), a.linear.ssim.min(b.linear.ssim)];
    let mut worst = if b.linear.rmse > a.linear.rmse { b } else { a };
    (worst.linear.max, worst.linear.ssim) = (max, ssim);
    worst
}

/// Settings that differ in nothing that is seen.
fn nearly(base: &Sampling) -> Sampling {
    Sampling { tolerance: base.tolerance + 1e-6, ..base.clone() }
}

fn off(a: &Picture, b: &Picture) -> Result<Difference, Failure> {
    compare(a, b)
        .map_err(|problem| Failure::Said(format!("the picture and its reference: {problem}")))
}
