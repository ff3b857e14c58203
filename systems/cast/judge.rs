//! Judging a picture by itself: a few of its pixels are cast exactly, and tell how far all of it is off.

use glam::Vec4;
use hecs::{Entity, World};
use rayon::prelude::*;

use super::caster::BeamCaster;
use super::exact_pixel::exact_pixel;
use super::inputs::{self, Inputs};
use super::media::Media;
use super::rays::{self, Errand};
use super::targets::Caster;
use crate::components::{DepthCue, Estimate, Sampling, View};
use crate::error::Error;
use crate::measure::judged::{ANYWHERE, ExactPixel, Judged, ROUND};
use crate::measure::survey::{Drawn, Survey};
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::shared::Shared;
use crate::view::camera::Camera;
use crate::view::extent::Extent;
use crate::view::overlay::Overlay;
use crate::view::picture::{Frame, Picture};
use crate::view::samples::{Counts, Layout, Samples};

/// Samples lie so many times closer where a pixel is cast exactly.
const FINER: f64 = 4.0;
/// Where exact rays stop: what is behind adds no more than this, far less than the errors that are told of; rays that never
/// stop take up to forty times as many samples.
const STOP_AT: f32 = 1e-4;
/// The first rounds, which tell what a round costs.
const FIRST: usize = 5;
/// How much longer the same work takes where pixels lie apart: what one touches of the gel is in no cache for the next.
const APART: f64 = 3.0;
/// Pixels across and down of the blocks that are drawn as one: what is drawn often is known of a block, and one of its pixels
/// is cast.
const BLOCK: usize = 2;
/// The ends of no range.
const NOTHING: [Vec4; 2] = [Vec4::INFINITY, Vec4::NEG_INFINITY];
/// The most rounds: more would know the error to less than 0.3 dB.
const MOST: usize = 1024;

/// Estimates the error of the picture of every view that states [`Estimate`].
pub struct Judge;

/// What a judgement is made from.
#[derive(PartialEq)]
struct Case {
    /// What rays meet, and the settings of exact ones.
    inputs: Inputs,
    frame: Frame,
    overlay: Option<Overlay>,
    estimate: Estimate,
    /// What the picture took.
    counts: Counts,
}

impl System for Judge {
    type Product = Judged;
    const NAME: &'static str = "judge";
    const READS: &'static [ProductKey] = &{
        let [gel, coefficients, pyramid, strength, ranges] = inputs::READS;
        let (samples, overlay) = (ProductKey::of::<Samples>(), ProductKey::of::<Overlay>());
        let frame = ProductKey::of::<Frame>();
        [gel, coefficients, pyramid, strength, ranges, samples, overlay, frame]
    };

    fn run(world: &World, out: &mut Outbox<'_, Judged>) -> Result<(), Error> {
        type Seen<'a> = (&'a View, &'a Sampling, &'a Extent, Option<&'a DepthCue>);
        type Shown<'a> = (&'a Samples, &'a Frame, Option<&'a Overlay>);
        let watch = out.watch();
        let mut views = world.query::<(Entity, &Estimate, Seen<'_>, Shown<'_>)>();
        for (entity, estimate, (view, sampling, extent, cue), (samples, frame, overlay)) in
            &mut views
        {
            let camera = Camera::new(view, extent);
            let mut inputs = Inputs::of(world, (view, sampling, *extent, cue.copied()), &camera);
            let distance = rays::distance(&inputs);
            inputs.sampling = Sampling {
                distance_mm: Some(distance / FINER),
                stop_at: sampling.stop_at.min(STOP_AT),
                ..sampling.exact()
            };
            let case = Case {
                inputs,
                frame: frame.clone(),
                overlay: overlay.cloned(),
                estimate: *estimate,
                counts: samples.0.counts,
            };
            out.derive(entity, case, |case| case.judge(&camera, watch))?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let mut views = world.query::<(Entity, &View)>().with::<&Estimate>();
        let bytes = |(entity, view): (Entity, &View)| {
            let pixels: u64 = view.size.iter().map(|&n| u64::from(n)).product();
            (entity, pixels * 3 * size_of::<f64>() as u64 / (BLOCK * BLOCK) as u64)
        };
        let makes: Vec<_> = views.iter().map(bytes).collect();
        if makes.is_empty() {
            return Plan::absent("no view states `estimate`");
        }
        Plan::of_most(makes, "a view states `estimate`")
    }
}

impl Case {
    fn judge(&self, camera: &Camera, watch: &Watch) -> Result<Judged, Error> {
        let Inputs { view, sampling, .. } = &self.inputs;
        let layout = Layout::new(view.size.map(|n| n as usize), 1, sampling.pixel_filter.reach());
        rays::send(&self.inputs, camera, (layout, 1), Judging { case: self, watch })
    }
}

/// The errand of a judgement.
struct Judging<'a> {
    case: &'a Case,
    watch: &'a Watch,
}

impl Errand for Judging<'_> {
    type Done = Judged;

    fn run<M: Media>(self, caster: BeamCaster<'_, M>) -> Result<Judged, Error> {
        let sizes = sizes(&self.case.frame.0);
        let missing = || Error::Schedule("a picture has no pixel to be judged by".to_owned());
        let survey = Survey::new(sizes).ok_or_else(missing)?;
        let mut counts = Counts::default();
        let mut exact = self.rounds(&caster, &survey, 0..FIRST, &mut counts)?;
        let allowed = self.case.estimate.share * work(&self.case.counts) as f64 / APART;
        let more = (allowed * FIRST as f64 / work(&counts).max(1) as f64) as usize;
        let more = FIRST..more.clamp(FIRST, MOST);
        exact.extend(self.rounds(&caster, &survey, more, &mut counts)?);
        let counts = [counts.rays, counts.samples];
        Ok(Judged::new(&self.case.frame.0, Shared::new(exact), counts))
    }
}

impl Judging<'_> {
    /// The exact pixels of some rounds, one round after the other.
    fn rounds<M: Media>(
        &self,
        caster: &BeamCaster<'_, M>,
        survey: &Survey,
        numbers: std::ops::Range<usize>,
        counts: &mut Counts,
    ) -> Result<Vec<ExactPixel>, Error> {
        self.watch.expect(numbers.len() as u64);
        let seed = u64::from(self.case.estimate.seed) << 32;
        let one = |number: usize| {
            self.watch.check()?;
            let round = self.round(caster, &survey.round(ROUND, seed + number as u64));
            self.watch.advance();
            Ok(round)
        };
        let rounds: Vec<_> = numbers.into_par_iter().map(one).collect::<Result<_, Error>>()?;
        for round in &rounds {
            *counts += round.1;
        }
        Ok(rounds.into_iter().flat_map(|round| round.0).collect())
    }

    fn round<M: Media>(
        &self,
        caster: &BeamCaster<'_, M>,
        drawn: &[Drawn],
    ) -> (Vec<ExactPixel>, Counts) {
        let Case { inputs, frame: Frame(picture), overlay, .. } = self.case;
        let looks = (inputs.sampling.pixel_filter, inputs.view.background);
        let mut scratch = <BeamCaster<'_, M> as Caster>::Scratch::default();
        let mut counts = Counts::default();
        let exact = |drawn: &Drawn| {
            let (at, weight) = pixel_of(drawn, picture.size);
            let item = at[1] * picture.size[0] + at[0];
            let mut exact = exact_pixel(caster, at, looks, &mut scratch, &mut counts);
            if let Some(Overlay(over)) = overlay {
                let over = Picture::new([1, 1], vec![over.pixels[item]]);
                exact = over.map_or(exact.clone(), |over| exact.under(&over));
            }
            ExactPixel { item, weight, color: exact.pixels[0] }
        };
        (drawn.iter().map(exact).collect(), counts)
    }
}

/// What rays take, in parts of about equal time: a packet's step with its samples, and a ray that is made.
fn work(counts: &Counts) -> u64 {
    counts.samples + 8 * counts.packet_steps + 32 * counts.rays
}

/// The pixel that was drawn of a block, and what it counts in the mean over all pixels.
fn pixel_of(&Drawn { item, weight, within }: &Drawn, size: [usize; 2]) -> ([usize; 2], f64) {
    let blocks = size.map(|n| n.div_ceil(BLOCK));
    let first = [item % blocks[0], item / blocks[0]].map(|n| n * BLOCK);
    // Blocks at the right and the lower end may have fewer pixels.
    let [across, down] = [0, 1].map(|axis| BLOCK.min(size[axis] - first[axis]));
    let pixels = across * down;
    let one = (within * pixels as f64) as usize;
    let of_all = (blocks[0] * blocks[1] * pixels) as f64 / (size[0] * size[1]) as f64;
    ([first[0] + one % across, first[1] + one / across], weight * of_all)
}

/// How often each block of pixels is to be drawn: as the root of the range of its pixels and those around it, for edges are
/// off by more, and all of them now and then.
fn sizes(picture: &Picture) -> Vec<f64> {
    let [width, height] = picture.size;
    let across = width.div_ceil(BLOCK);
    let mut roots = vec![0.0; across * height.div_ceil(BLOCK)];
    let rows = roots.par_chunks_mut(across).enumerate();
    rows.for_each_init(Vec::new, |ends, (row, roots)| {
        // Of the rows first, and then of columns.
        ends.clear();
        ends.resize(width, NOTHING);
        for y in (row * BLOCK).saturating_sub(1)..(row * BLOCK + BLOCK + 1).min(height) {
            for ([low, high], &color) in ends.iter_mut().zip(&picture.pixels[y * width..]) {
                (*low, *high) = (low.min(color.into()), high.max(color.into()));
            }
        }
        for (column, root) in roots.iter_mut().enumerate() {
            let first = column * BLOCK;
            let near = &ends[first.saturating_sub(1)..(first + BLOCK + 1).min(width)];
            let join = |a: [Vec4; 2], b: &[Vec4; 2]| [a[0].min(b[0]), a[1].max(b[1])];
            let [low, high] = near.iter().fold(NOTHING, join);
            let range = f64::from((high - low).max_element());
            *root = if range.is_finite() { range.sqrt() } else { 0.0 };
        }
    });
    let mean = roots.iter().sum::<f64>() / roots.len() as f64;
    let scale = if mean > 0.0 { (1.0 - ANYWHERE) / mean } else { 0.0 };
    for root in &mut roots {
        *root = scale * *root + ANYWHERE;
    }
    roots
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_counts_as_often_as_any_other() {
        // Of blocks of unlike sizes, some of them cut at the ends: what is drawn makes the mean of all pixels in the long run.
        let size = [7, 5];
        let sizes = (0..12).map(|block| 1.0 + f64::from(block % 5));
        let survey = Survey::new(sizes).unwrap();
        let mut counted = [0.0; 35];
        let rounds = 20_000;
        for seed in 0..rounds {
            for drawn in survey.round(ROUND, seed) {
                let ([x, y], weight) = pixel_of(&drawn, size);
                counted[y * size[0] + x] += weight / rounds as f64;
            }
        }
        for (pixel, counted) in counted.iter().enumerate() {
            assert!((counted * 35.0 - 1.0).abs() < 0.05, "{pixel}: {}", counted * 35.0);
        }
    }
}
