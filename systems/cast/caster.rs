//! Casting the rays that refinement asks for, in packets of neighbours.

use super::lanes::{LANES, Packet, first};
use super::march::{Gathering, Hit, Slabs, geometric, march};
use super::media::Media;
use super::polygons::Polygons;
use super::targets::{Caster, RayColors, Target};
use crate::view::camera::Camera;
use crate::view::ray::Ray;
use crate::view::samples::Counts;

/// Casts rays, a packet at a time.
pub struct BeamCaster<'a, M> {
    /// The view's frame.
    pub camera: &'a Camera,
    /// What rays may meet of polygons.
    pub polygons: Polygons,
    /// What all rays have in common.
    pub slabs: Slabs,
    /// What they may meet of volumes.
    pub media: &'a M,
    /// Whether C_G is asked for.
    pub three_colors: bool,
}

/// What a thread needs for a packet, kept from one to the next.
pub struct Scratch<E> {
    entered: E,
    rays: Vec<Ray>,
    beams: Vec<usize>,
    /// What the rays meet, one after the other.
    hits: Vec<Hit>,
}

impl<E: Default> Default for Scratch<E> {
    fn default() -> Self {
        let (rays, beams, hits) = (Vec::new(), Vec::new(), Vec::new());
        Self { entered: E::default(), rays, beams, hits }
    }
}

impl<M: Media> Caster for BeamCaster<'_, M> {
    type Scratch = Scratch<M::Entered>;

    fn cast(
        &self,
        targets: &[Target],
        colors: &mut [RayColors],
        scratch: &mut Self::Scratch,
        counts: &mut Counts,
    ) {
        for (targets, colors) in targets.chunks(LANES).zip(colors.chunks_mut(LANES)) {
            self.cast_packet(targets, colors, scratch, counts);
        }
    }
}

impl<M: Media> BeamCaster<'_, M> {
    fn cast_packet(
        &self,
        targets: &[Target],
        colors: &mut [RayColors],
        scratch: &mut Scratch<M::Entered>,
        counts: &mut Counts,
    ) {
        let Scratch { entered, rays, beams, hits } = scratch;
        rays.clear();
        rays.extend(targets.iter().map(|target| self.camera.ray(target.window)));
        beams.clear();
        beams.extend(targets.iter().map(|target| target.beam));
        hits.clear();
        let mut gathered = [Gathering::new([0; 2]); LANES];
        if !self.polygons.is_empty() {
            for (target, gathered) in targets.iter().zip(&mut gathered) {
                let first = hits.len();
                self.polygons.meet(target.beam, target.window, hits);
                *gathered = Gathering::new([first as u32, hits.len() as u32]);
            }
        }
        let own = gathered.map(|ray| ray.hits());
        let range = self.media.enter(&Packet { rays: &rays[..], beams: &beams[..] }, entered);
        march(
            (self.media, entered, range),
            &self.slabs,
            hits,
            |hit, lane| self.polygons.shade(hit, targets[lane]),
            (first(targets.len()), &mut gathered),
            counts,
        );
        for ((color, ray), [from, to]) in colors.iter_mut().zip(&gathered).zip(own) {
            let hits = &hits[from as usize..to as usize];
            *color = RayColors { full: ray.full.rgba(self.slabs.stop), ..RayColors::default() };
            if !hits.is_empty() {
                color.attenuated = ray.attenuated();
                if self.three_colors {
                    let plain = |hit: &Hit| self.polygons.plain(hit);
                    color.geometric = geometric(hits, plain, self.slabs.stop);
                }
            }
        }
    }
}
