//! Casting the rays that refinement asks for, in packets of neighbours.

use glam::DVec3;

use super::lanes::{LANES, Packet, each};
use super::march::{Gathering, Hit, Slabs, geometric, march};
use super::media::Media;
use super::polygons::Polygons;
use super::projection::Projections;
use super::targets::{Caster, RayColors};
use crate::view::samples::Counts;
use crate::view::walk::Tile;

/// Casts rays, a packet at a time.
pub(crate) struct BeamCaster<'a, M> {
    /// What rays may meet of polygons.
    pub polygons: Polygons,
    /// And what they show of volumes that are projected.
    pub projections: Projections<'a>,
    /// What all rays have in common.
    pub slabs: Slabs,
    /// What they may meet of volumes.
    pub media: &'a M,
    /// Whether C_G is asked for.
    pub three_colors: bool,
}

/// What a thread needs for a packet, kept from one to the next.
pub(crate) struct Scratch<E> {
    entered: E,
    /// Where the packet is in the volumes that are projected.
    tiles: Vec<Tile>,
    /// What the rays meet, one after the other.
    hits: Vec<Hit>,
}

impl<E: Default> Default for Scratch<E> {
    fn default() -> Self {
        Self { entered: E::default(), tiles: Vec::new(), hits: Vec::new() }
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

    fn cast(
        &self,
        packet: &Packet,
        colors: &mut [RayColors; LANES],
        scratch: &mut Self::Scratch,
        counts: &mut Counts,
    ) {
        let Scratch { entered, tiles, hits } = scratch;
        let mut range = self.media.enter(packet, entered);
        if range[0] < range[1] {
            range[0] = self.media.seek(entered, range[0], counts);
        }
        let no_hits = self.polygons.is_empty() && self.projections.is_empty();
        if range[0] >= range[1] && no_hits {
            colors.fill(RayColors::default());
            return;
        }
        let mut gathered = [Gathering::new([0; 2]); LANES];
        hits.clear();
        if !no_hits {
            self.projections.enter(packet, tiles);
            for lane in each(packet.wanted) {
                let first = hits.len();
                self.polygons.meet(packet.position(lane), hits);
                if !self.projections.is_empty() {
                    let is_opaque = |hit: &Hit| self.polygons.is_opaque(hit);
                    self.projections.meet((packet, tiles, lane), (hits, first), is_opaque, counts);
                }
                gathered[lane] = Gathering::new([first as u32, hits.len() as u32]);
            }
        }
        let own = gathered.map(|ray| ray.hits());
        march(
            (self.media, entered, range),
            &self.slabs,
            hits,
            |hit, lane| {
                let projected = self.projections.shade(hit);
                projected
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
                if self.three_colors {
                    let plain = |hit: &Hit| match self.projections.shade(hit) {
                        Some(_) => (DVec3::ZERO, 0.0),
                        None => self.polygons.plain(hit),
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
    }
}
