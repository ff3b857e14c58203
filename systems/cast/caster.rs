//! Casting the rays that refinement asks for, in packets of neighbours.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

use super::gathering::{Gathering, Hit, Shaded, geometric};
use super::lanes::{LANES, Packet, each};
use super::march::{Slabs, march};
use super::media::Media;
use super::polygons::{Met, Polygons};
use super::projection::Projections;
use super::targets::{Caster, RayColors};
use crate::view::samples::Counts;
use crate::view::walk::Tile;

/// Casts rays, a packet at a time.
pub(crate) struct BeamCaster<'a, M> {
    /// What rays may meet of polygons.
    pub polygons: Polygons<'a>,
    /// And what they show of volumes that are projected.
    pub projections: Projections<'a>,
    /// What all rays have in common.
    pub slabs: Slabs,
    /// What they may meet of volumes.
    pub media: &'a M,
    /// C_G is asked of rays that are farther apart than so many positions: others may be cast between them.
    pub edges_above: usize,
    /// The instructions that rays are cast with; no bit depends on them.
    pub level: Level,
}

/// What a thread needs for a packet, kept from one to the next.
pub(crate) struct Scratch<E> {
    entered: E,
    /// The samples `[first, end)` outside which all rays of the packets to come meet no gel.
    ahead: [i64; 2],
    /// Where the packet is in the volumes that are projected.
    tiles: Vec<Tile>,
    /// What its rays meet of polygons.
    met: Met,
    /// Those and what they meet of projections.
    hits: Vec<Hit>,
    /// What they are shown of projections.
    shown: Vec<Shaded>,
}

impl<E: Default> Default for Scratch<E> {
    fn default() -> Self {
        let ahead = [i64::MIN, i64::MAX];
        let (tiles, hits, shown) = (Vec::new(), Vec::new(), Vec::new());
        Self { entered: E::default(), ahead, tiles, met: Met::default(), hits, shown }
    }
}

impl<M: Media> BeamCaster<'_, M> {
    /// Whether there may be edges that ask for more than a ray a pixel.
    pub fn has_edges(&self) -> bool {
        !self.polygons.is_empty() || self.media.has_surfaces()
    }
}

impl<M: Media> Caster for BeamCaster<'_, M> {
    type Scratch = Scratch<M::Entered>;

    fn scout(&self, group: &Packet, scratch: &mut Self::Scratch, counts: &mut Counts) {
        scratch.ahead = self.media.scout(group, &mut scratch.entered, counts);
    }

    fn cast(
        &self,
        packet: &Packet,
        colors: &mut [RayColors; LANES],
        scratch: &mut Self::Scratch,
        counts: &mut Counts,
    ) -> bool {
        dispatch!(self.level, simd => self.cast_with(simd, packet, colors, scratch, counts))
    }
}

impl<M: Media> BeamCaster<'_, M> {
    #[inline(always)]
    fn cast_with<S: Simd>(
        &self,
        simd: S,
        packet: &Packet,
        colors: &mut [RayColors; LANES],
        scratch: &mut Scratch<M::Entered>,
        counts: &mut Counts,
    ) -> bool {
        let Scratch { entered, ahead, tiles, met, hits, shown } = scratch;
        self.polygons.meet(packet, met);
        let no_hits = met.is_empty() && self.projections.is_empty();
        let mut range = *ahead;
        if range[0] < range[1] {
            let own = self.media.enter(packet, entered);
            range = [range[0].max(own[0]), range[1].min(own[1])];
        }
        if range[0] < range[1] {
            range[0] = self.media.seek(simd, entered, (range[0], packet.wanted), counts);
        }
        if range[0] >= range[1] && no_hits {
            return false;
        }
        let mut gathered = [Gathering::new([0; 2]); LANES];
        if self.projections.is_empty() {
            each(packet.wanted).for_each(|lane| gathered[lane] = Gathering::new(met.of(lane)));
        } else {
            hits.clear();
            shown.clear();
            self.projections.enter(packet, tiles);
            for lane in each(packet.wanted) {
                let first = hits.len();
                let [from, to] = met.of(lane).map(|n| n as usize);
                hits.extend_from_slice(&met.hits()[from..to]);
                let is_opaque = |hit: &Hit| self.polygons.is_opaque(hit);
                let met = (&mut *hits, first, &mut *shown);
                self.projections.meet((packet, tiles, lane), met, is_opaque, counts);
                gathered[lane] = Gathering::new([first as u32, hits.len() as u32]);
            }
        }
        let hits = if self.projections.is_empty() { met.hits() } else { hits };
        let own = gathered.map(|ray| ray.hits());
        let projected = |hit: &Hit| shown.get(hit.shown as usize).copied();
        march(
            (simd, self.media, entered, range),
            &self.slabs,
            hits,
            |hit, lane| {
                projected(hit)
                    .unwrap_or_else(|| self.polygons.shade(hit, packet.position(lane), packet.step))
            },
            (packet.wanted, &mut gathered),
            counts,
        );
        for lane in each(packet.wanted) {
            let (ray, [from, to]) = (&gathered[lane], own[lane]);
            let hits = &hits[from as usize..to as usize];
            let color = &mut colors[lane];
            *color = RayColors { full: ray.full.rgba(self.slabs.stop), ..RayColors::default() };
            let surfaces = self.media.has_surfaces();
            if surfaces || !hits.is_empty() {
                color.attenuated = ray.attenuated();
                if packet.step > self.edges_above {
                    let plain = |hit: &Hit| match projected(hit) {
                        Some(_) => (DVec3::ZERO, 0.0),
                        None => self.polygons.plain(hit, packet.position(lane)),
                    };
                    let left = (ray.hits()[0] - from) as usize;
                    color.geometric = if surfaces {
                        ray.with_surfaces(&hits[left..], plain, self.slabs.stop)
                    } else {
                        geometric(hits, plain, self.slabs.stop)
                    };
                }
            }
        }
        true
    }
}
