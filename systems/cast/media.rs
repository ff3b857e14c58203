//! What the rays of a view meet of volumes: none, one, or several whose gels overlap.

use fearless_simd::Simd;
use glam::{DVec3, Vec4};

use super::crossing::Sheet;
use super::lanes::{Lanes, Packet};
use crate::view::composite::{recolor, thicken};
use crate::view::samples::Counts;

/// Gel as a packet of rays meets it, sample by sample. All rays of a view have their samples at the same depths.
///
/// Compiled anew for each set of instructions, on which no bit depends.
pub(crate) trait Media: Sync {
    /// Where the rays of a packet are in it; taken from packet to packet, so that nothing is allocated for one.
    type Entered: Default + Send;

    /// Lets a packet enter; the sample numbers `[first, end)` outside which none of its rays meets gel.
    fn enter(&self, packet: &Packet, entered: &mut Self::Entered) -> [i64; 2];

    /// The samples `[first, end)` outside which no ray meets gel that lies within the outline of a packet `group`.
    fn scout(&self, group: &Packet, entered: &mut Self::Entered, counts: &mut Counts) -> [i64; 2];

    /// The first sample from number `k` on that some of `lanes` may meet gel at; all before it are empty for all of them.
    fn seek<S: Simd>(
        &self,
        simd: S,
        entered: &mut Self::Entered,
        sample: (i64, Lanes),
        counts: &mut Counts,
    ) -> i64;

    /// Which of `lanes` meet gel at sample `k`, which no other sample is asked for until [`slab`](Media::slab) was.
    fn meet<S: Simd>(
        &self,
        simd: S,
        entered: &mut Self::Entered,
        sample: (i64, Lanes),
        counts: &mut Counts,
    ) -> Lanes;

    /// The gel of the slab around sample `k` for a ray that meets it there: associated colour and opacity.
    fn slab(&self, entered: &mut Self::Entered, k: i64, lane: usize) -> (DVec3, f64);

    /// The gel of that slab without the surfaces in it.
    fn bare(&self, entered: &mut Self::Entered, k: i64, lane: usize) -> (DVec3, f64) {
        self.slab(entered, k, lane)
    }

    /// Whether there are surfaces in it, whose edges are sought as those of polygons are.
    #[inline]
    fn has_surfaces(&self) -> bool {
        false
    }

    /// The surfaces within the slab that a ray met last.
    #[inline]
    fn sheet(&self, _: &Self::Entered, _: usize) -> Sheet {
        Sheet::default()
    }
}

/// A scene without a volume.
pub struct Nothing;

impl Media for Nothing {
    type Entered = ();

    fn enter(&self, _: &Packet, (): &mut ()) -> [i64; 2] {
        [i64::MAX; 2]
    }

    fn scout(&self, _: &Packet, (): &mut (), _: &mut Counts) -> [i64; 2] {
        [i64::MAX; 2]
    }

    fn seek<S: Simd>(&self, _: S, (): &mut (), _: (i64, Lanes), _: &mut Counts) -> i64 {
        i64::MAX
    }

    fn meet<S: Simd>(&self, _: S, (): &mut (), _: (i64, Lanes), _: &mut Counts) -> Lanes {
        0
    }

    fn slab(&self, (): &mut (), _: i64, _: usize) -> (DVec3, f64) {
        (DVec3::ZERO, 0.0)
    }
}

/// A sample of associated colour and opacity per opacity unit, as a slab `ratio` units thick.
#[inline]
pub fn slab(sample: Vec4, ratio: f64) -> (DVec3, f64) {
    let (color, opacity) = (sample.truncate().as_dvec3(), f64::from(sample.w).min(1.0));
    if ratio == 1.0 {
        return (color, opacity);
    }
    let thick = thicken(opacity, ratio);
    (color * recolor(opacity, thick, ratio), thick)
}
