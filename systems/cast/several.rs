//! Several volumes, each on a grid of its own: where their gels overlap, optical depths add.
#![allow(clippy::inline_always, reason = "compiled anew within each set of instructions")]

use fearless_simd::Simd;
use glam::{DVec3, Vec4};

use super::crossing::Sheet;
use super::kernel::GelSlices;
use super::lanes::{Lanes, Packet};
use super::media::{Media, slab};
use super::medium::{Entered, Medium};
use super::shaft::Dust;
use super::values::Values;
use crate::view::composite::overlap;
use crate::view::samples::Counts;

/// A volume in whatever numbers its gel is kept, or without.
pub(crate) enum AnyMedium<'a> {
    /// 32-bit floats.
    F32(Medium<'a, GelSlices<'a, [f32; 4]>>),
    /// 16-bit fixed point.
    U16(Medium<'a, GelSlices<'a, [u16; 4]>>),
    /// 8-bit fixed point.
    U8(Medium<'a, GelSlices<'a, [u8; 4]>>),
    /// No gel: values, classified at samples.
    Values(Box<Medium<'a, Values<'a>>>),
}

/// The volumes of a scene.
pub struct Several<'a> {
    /// In the order of the scene, which no picture depends on.
    pub media: Vec<AnyMedium<'a>>,
    /// Dust in shafts of light, wherever some volume is: as thick as for the first that is there.
    pub dust: Option<&'a Dust>,
}

/// Where the rays of a packet are in several volumes.
#[derive(Default)]
pub(crate) struct EnteredAll {
    each: Vec<Within>,
    /// The slabs that overlap, of the ray that was asked for last.
    parts: Vec<(DVec3, f64)>,
}

/// Where they are in one of them.
#[derive(Default)]
struct Within {
    entered: Entered,
    range: [i64; 2],
    /// The next sample at which a ray may meet its gel.
    next: i64,
    /// Who meets its gel at the last sample asked for.
    met: Lanes,
}

macro_rules! with_medium {
    ($medium:expr, $inner:ident => $body:expr) => {
        match $medium {
            AnyMedium::F32($inner) => $body,
            AnyMedium::U16($inner) => $body,
            AnyMedium::U8($inner) => $body,
            AnyMedium::Values($inner) => $body,
        }
    };
}

impl Several<'_> {
    /// The gel of all volumes in a slab, with the surfaces in it or without.
    fn joined(
        &self,
        entered: &mut EnteredAll,
        (k, lane): (i64, usize),
        bare: bool,
    ) -> (DVec3, f64) {
        let EnteredAll { each, parts } = entered;
        parts.clear();
        let there = self.media.iter().zip(each).filter(|(_, within)| within.met >> lane & 1 == 1);
        for (medium, within) in there {
            if let Some(dust) = self.dust.filter(|_| parts.is_empty()) {
                let (world, ratio) =
                    with_medium!(medium, inner => inner.place(&within.entered, lane, k));
                parts.push(slab(dust.join(Vec4::ZERO, world), ratio));
            }
            let within = &mut within.entered;
            parts.push(with_medium!(medium, inner => if bare {
                inner.bare(within, k, lane)
            } else {
                inner.slab(within, k, lane)
            }));
        }
        overlap(parts)
    }
}

impl Media for Several<'_> {
    type Entered = EnteredAll;

    #[inline(always)]
    fn enter(&self, packet: &Packet, entered: &mut EnteredAll) -> [i64; 2] {
        entered.each.resize_with(self.media.len(), Within::default);
        let mut all = [i64::MAX, i64::MIN];
        for (medium, within) in self.media.iter().zip(&mut entered.each) {
            within.range = with_medium!(medium, inner => inner.enter(packet, &mut within.entered));
            within.next = i64::MIN;
            all = [all[0].min(within.range[0]), all[1].max(within.range[1])];
        }
        all
    }

    fn scout(&self, group: &Packet, entered: &mut EnteredAll, counts: &mut Counts) -> [i64; 2] {
        entered.each.resize_with(self.media.len(), Within::default);
        let mut all = [i64::MAX, i64::MIN];
        for (medium, within) in self.media.iter().zip(&mut entered.each) {
            let [first, end] =
                with_medium!(medium, inner => inner.scout(group, &mut within.entered, counts));
            all = [all[0].min(first), all[1].max(end)];
        }
        all
    }

    #[inline(always)]
    fn seek<S: Simd>(
        &self,
        simd: S,
        entered: &mut EnteredAll,
        (k, lanes): (i64, Lanes),
        counts: &mut Counts,
    ) -> i64 {
        let mut least = i64::MAX;
        for (medium, within) in self.media.iter().zip(&mut entered.each) {
            if within.next < k {
                let from = k.max(within.range[0]);
                let found = with_medium!(medium, inner => inner.seek(simd, &mut within.entered, (from, lanes), counts));
                within.next = if found < within.range[1] { found } else { i64::MAX };
            }
            least = least.min(within.next);
        }
        least
    }

    #[inline(always)]
    fn meet<S: Simd>(
        &self,
        simd: S,
        entered: &mut EnteredAll,
        (k, lanes): (i64, Lanes),
        counts: &mut Counts,
    ) -> Lanes {
        let mut met = 0;
        for (medium, within) in self.media.iter().zip(&mut entered.each) {
            within.met = 0;
            if within.next == k {
                within.met = with_medium!(medium, inner => inner.meet(simd, &mut within.entered, (k, lanes), counts));
            }
            met |= within.met;
        }
        met
    }

    fn slab(&self, entered: &mut EnteredAll, k: i64, lane: usize) -> (DVec3, f64) {
        self.joined(entered, (k, lane), false)
    }

    fn bare(&self, entered: &mut EnteredAll, k: i64, lane: usize) -> (DVec3, f64) {
        self.joined(entered, (k, lane), true)
    }

    fn has_surfaces(&self) -> bool {
        self.media.iter().any(|medium| with_medium!(medium, inner => inner.has_surfaces()))
    }

    fn sheet(&self, entered: &EnteredAll, lane: usize) -> Sheet {
        let there = self.media.iter().zip(&entered.each);
        let there = there.filter(|(medium, within)| {
            within.met >> lane & 1 == 1 && with_medium!(medium, inner => inner.has_surfaces())
        });
        let sheets = there.map(
            |(medium, within)| with_medium!(medium, inner => inner.sheet(&within.entered, lane)),
        );
        sheets.fold(Sheet::default(), |sum, sheet| sum.beside(&sheet))
    }
}
