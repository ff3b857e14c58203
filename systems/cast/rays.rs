//! What the rays of a view meet, made of the inputs; and the errands that they are sent on.

use fearless_simd::Level;

use super::beams::Beams;
use super::caster::BeamCaster;
use super::cue::Cue;
use super::inputs::{Inputs, Placed, Sampled};
use super::kernel;
use super::looks::Look;
use super::march::Slabs;
use super::media::{Media, Nothing};
use super::medium::{Medium, Source};
use super::polygons::Polygons;
use super::projection::Projections;
use super::seen::SeenFaces;
use super::several::{AnyMedium, Several};
use super::shaft::Dust;
use super::targets::looks_for_edges;
use super::values::Values;
use crate::components::{Sampling, Skip};
use crate::error::Error;
use crate::view::camera::Camera;
use crate::view::samples::Layout;
use crate::view::walk::Walk;
use crate::volume::gel::{Gel, GelBricks, Texel, Texels};
use crate::volume::grid::smallest_spacing;
use crate::volume::pyramid::{Pyramid, PyramidSlices};

/// What is to be done with the rays of a view, whatever they meet.
pub trait Errand {
    /// What they bring back.
    type Done;
    /// Does it.
    fn run<M: Media>(self, caster: BeamCaster<'_, M>) -> Result<Self::Done, Error>;
}

/// Δ: as stated, else the smallest spacing of any volume; without a volume it makes no difference.
pub fn distance(inputs: &Inputs) -> f64 {
    let grids = inputs.volumes.iter().map(|volume| volume.grid);
    let smallest = smallest_spacing(grids.chain(inputs.projections.iter().map(|v| v.grid)));
    inputs.sampling.distance_mm.or(smallest).unwrap_or(inputs.extent.radius())
}

/// ε_T of a view's rays: what comes through is never under 0, so a ray that is not to stop goes on behind what is opaque.
pub fn stop(sampling: &Sampling) -> f64 {
    let stop_at = f64::from(sampling.stop_at);
    if stop_at > 0.0 { stop_at } else { f64::NEG_INFINITY }
}

/// Sends rays on an errand; `layout` holds every position that they are cast at, no closer than `finest` of them.
pub fn send<E: Errand>(
    inputs: &Inputs,
    camera: &Camera,
    (layout, finest): (Layout, usize),
    errand: E,
) -> Result<E::Done, Error> {
    let beams = Beams::new(layout, finest);
    let cue = inputs.cue.map(|cue| {
        let near = camera.depth(inputs.extent.center()) - inputs.extent.radius();
        Cue { k1: cue.k1, k2: cue.k2, near }
    });
    let polygons = polygons(inputs, camera, beams, cue);
    let eye = camera.eye.map_or(f64::NEG_INFINITY, |eye| -eye);
    let slabs = Slabs { distance: distance(inputs), stop: stop(&inputs.sampling), eye };
    let dust = Dust::new(&inputs.shafts, camera).map_err(|p| Error::entity("shaft", p))?;
    let dust = dust.as_ref();
    let mut media = Vec::new();
    // Where dust is, nothing is stepped over; several volumes have one dust.
    let alone = dust.filter(|_| inputs.volumes.len() == 1);
    let view = SharedView { camera, slabs, cue, skips: dust.is_none() };
    for placed in &inputs.volumes {
        media.extend(view.medium(placed, alone)?);
    }
    let skips = inputs.sampling.skip != Skip::None;
    let projections = Projections::new(&inputs.projections, camera, slabs.distance, skips);
    let projections = projections.map_err(|problem| Error::entity("view", problem))?;
    let sampling = &inputs.sampling;
    let edges_above = if looks_for_edges(sampling) { sampling.finest as usize } else { usize::MAX };
    let rays = Rays { polygons, projections, slabs, edges_above };
    match media.len() {
        0 => rays.go(&Nothing, errand),
        1 => match media.swap_remove(0) {
            AnyMedium::F32(medium) => rays.go(&medium, errand),
            AnyMedium::U16(medium) => rays.go(&medium, errand),
            AnyMedium::U8(medium) => rays.go(&medium, errand),
            AnyMedium::Values(medium) => rays.go(&*medium, errand),
        },
        _ => {
            let several = Several { media, dust };
            rays.go(&several, errand)
        }
    }
}

/// The polygons of a scene that rays of a view may meet.
fn polygons<'a>(
    inputs: &'a Inputs,
    camera: &'a Camera,
    beams: Beams,
    cue: Option<Cue>,
) -> Polygons<'a> {
    let faces = SeenFaces::new(&inputs.polygons, camera, &beams);
    let looks = inputs.polygons.iter().map(|traced| Look::new(traced, inputs, camera)).collect();
    // What rounding may do to the depth of a plane, in a scene of that size so far from the world's origin.
    let slack = 1e-9 * inputs.extent.radius() + 1e-14 * inputs.extent.center().abs().max_element();
    Polygons::new(faces, looks, beams, slack, (camera, cue), &inputs.strengths)
}

/// What the volumes of a view have in common.
struct SharedView<'a> {
    camera: &'a Camera,
    slabs: Slabs,
    cue: Option<Cue>,
    /// Whether empty gel is stepped over.
    skips: bool,
}

impl<'a> SharedView<'a> {
    /// A volume as the rays of the view meet it, whatever it is made of; `None` where it is too small to be met.
    fn medium(
        &self,
        placed: &'a Placed,
        dust: Option<&'a Dust>,
    ) -> Result<Option<AnyMedium<'a>>, Error> {
        let Gel { lit, ambient, .. } = match &placed.content {
            Sampled::Gel(gel) => gel,
            Sampled::Values(stated) => {
                let values = Values::new(stated, (&placed.grid, placed.unit), self.steps(placed));
                let medium = self.of(placed, values, dust)?;
                return Ok(medium.map(|medium| AnyMedium::Values(Box::new(medium))));
            }
        };
        Ok(match (lit, ambient) {
            (GelBricks::F32(lit), None) => self.gel(placed, lit, None, dust)?.map(AnyMedium::F32),
            (GelBricks::F32(lit), Some(GelBricks::F32(ambient))) => {
                self.gel(placed, lit, Some(ambient), dust)?.map(AnyMedium::F32)
            }
            (GelBricks::U16(lit), None) => self.gel(placed, lit, None, dust)?.map(AnyMedium::U16),
            (GelBricks::U16(lit), Some(GelBricks::U16(ambient))) => {
                self.gel(placed, lit, Some(ambient), dust)?.map(AnyMedium::U16)
            }
            (GelBricks::U8(lit), None) => self.gel(placed, lit, None, dust)?.map(AnyMedium::U8),
            (GelBricks::U8(lit), Some(GelBricks::U8(ambient))) => {
                self.gel(placed, lit, Some(ambient), dust)?.map(AnyMedium::U8)
            }
            _ => {
                let problem = "the two parts of the gel are of different texels";
                return Err(Error::Schedule(problem.to_owned()));
            }
        })
    }

    fn gel<T: Texel>(
        &self,
        placed: &'a Placed,
        lit: &'a Texels<T>,
        ambient: Option<&'a Texels<T>>,
        dust: Option<&'a Dust>,
    ) -> Result<Option<Medium<'a, kernel::GelSlices<'a, T>>>, Error> {
        let (texels, ambient) = (lit.slices(), ambient.map(Texels::slices));
        let pyramid = self.steps(placed);
        self.of(placed, kernel::GelSlices { texels, ambient, pyramid }, dust)
    }

    /// What steps over empty parts of a volume.
    fn steps(&self, placed: &'a Placed) -> Option<PyramidSlices<'a>> {
        placed.pyramid.as_ref().filter(|_| self.skips).map(Pyramid::slices)
    }

    fn of<S: Source>(
        &self,
        placed: &'a Placed,
        source: S,
        dust: Option<&'a Dust>,
    ) -> Result<Option<Medium<'a, S>>, Error> {
        let distance = self.slabs.distance;
        let walk = Walk::new(&placed.grid, self.camera, distance)
            .map_err(|problem| Error::entity("view", problem))?;
        let pyramid = self.steps(placed);
        Ok(walk.map(|walk| Medium {
            walk,
            camera: self.camera,
            source,
            pyramid,
            ratio: distance / placed.unit,
            distance,
            cue: self.cue,
            dust,
        }))
    }
}

/// What the rays of a view share, whatever they meet.
struct Rays<'a> {
    polygons: Polygons<'a>,
    projections: Projections<'a>,
    slabs: Slabs,
    edges_above: usize,
}

impl Rays<'_> {
    fn go<M: Media, E: Errand>(self, media: &M, errand: E) -> Result<E::Done, Error> {
        let Self { polygons, projections, slabs, edges_above } = self;
        let level = Level::new();
        errand.run(BeamCaster { polygons, projections, slabs, media, edges_above, level })
    }
}
