//! What a ray meets of polygons, and what it has gathered of those and of gel: C, and C_A and C_G beside it (paper §2 and §6).

use glam::DVec3;

use super::crossing::Sheet;
use crate::view::composite::Gathered;
use crate::view::samples::Counts;

/// A polygon that a ray meets, shaded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shaded {
    /// Associated colour: textured, shadowed, cued.
    pub color: DVec3,
    /// α_P, textured.
    pub opacity: f64,
    /// The associated colour that C_A and C_G see: neither textured nor shadowed.
    pub plain_color: DVec3,
    /// The opacity that C_A and C_G see.
    pub plain_opacity: f64,
}

/// A polygon on a ray: where, and which.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hit {
    /// Depth along the ray, world units.
    pub depth: f64,
    /// Its number among the faces seen, in the order of the scene.
    pub face: u32,
    /// The number of what a projection shows among all that the packet is shown; beyond them of a face.
    pub shown: u32,
}

/// The state of C and C_A of one ray (paper §2).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gathering {
    /// C: volume and polygons.
    pub full: Gathered,
    /// C_A: polygons attenuated by the volume.
    attenuated: Gathered,
    /// How much of the ray polygons cover in C_A.
    covered: f64,
    /// C_G as far as the ray goes, where volumes have surfaces.
    geometric: Gathered,
    /// Those of the packet's hits that the ray has not come to yet.
    left: [u32; 2],
}

impl Gathering {
    /// Nothing gathered yet by a ray that is to meet the hits numbered `[first, end)`.
    pub fn new(hits: [u32; 2]) -> Self {
        let nothing = Gathered::NOTHING;
        Self { full: nothing, attenuated: nothing, covered: 0.0, geometric: nothing, left: hits }
    }

    /// Those of the packet's hits that the ray has not come to yet, `[first, end)`.
    pub fn hits(&self) -> [u32; 2] {
        self.left
    }

    /// C_A; what polygons cover is kept beside, as associated RGBA.
    pub fn attenuated(&self) -> [f32; 4] {
        let [r, g, b] = self.attenuated.color.to_array();
        [r as f32, g as f32, b as f32, self.covered as f32]
    }

    /// C_G of a ray that meets surfaces of volumes: as far as it went, and then the polygons that it did not come to.
    pub fn with_surfaces(
        &self,
        hits: &[Hit],
        plain: impl Fn(&Hit) -> (DVec3, f64),
        stop: f64,
    ) -> [f32; 4] {
        under(self.geometric, hits, plain, stop)
    }

    /// The next of the packet's hits that the ray comes to.
    #[inline]
    pub fn next<'h>(&self, hits: &'h [Hit]) -> Option<&'h Hit> {
        self.has_hits().then(|| &hits[self.left[0] as usize])
    }

    /// Whether polygons are still to come: only then does C_A go on.
    fn has_hits(&self) -> bool {
        self.left[0] < self.left[1]
    }

    /// Whether more than `stop` comes through of what is still to be seen.
    pub fn is_open(&self, stop: f64) -> bool {
        self.full.through > stop || (self.has_hits() && self.attenuated.through > stop)
    }

    /// Comes through gel of an associated colour and an opacity, with the surfaces in it.
    #[inline]
    pub fn gel(&mut self, color: DVec3, opacity: f64, sheet: Option<Sheet>, stop: f64) {
        if self.full.through > stop {
            self.full.under(color, opacity);
        }
        if let Some(sheet) = sheet {
            self.covered += self.attenuated.through * sheet.opacity;
            self.attenuated.under(sheet.color, opacity);
            self.geometric.under(sheet.turn, sheet.opacity);
        } else if self.has_hits() {
            self.attenuated.under(DVec3::ZERO, opacity);
        }
    }

    /// Those of the packet's hits that are left, with nothing between them.
    pub fn polygons(
        &mut self,
        hits: &[Hit],
        shade: impl Fn(&Hit) -> Shaded,
        stop: f64,
        counts: &mut Counts,
    ) {
        while let Some(hit) = self.next(hits).filter(|_| self.is_open(stop)) {
            self.polygon(&shade(hit), stop, counts);
        }
    }

    /// Comes through the polygon at its next hit, shaded.
    pub fn polygon(&mut self, met: &Shaded, stop: f64, counts: &mut Counts) {
        if self.full.through > stop {
            counts.polygon_hits += 1;
            self.full.under(met.color, met.opacity);
        }
        self.covered += self.attenuated.through * met.plain_opacity;
        self.attenuated.under(met.plain_color, met.plain_opacity);
        self.geometric.under(met.plain_color, met.plain_opacity);
        self.left[0] += 1;
    }
}

/// C_G of a ray: the polygons alone, as associated RGBA; stops on its own (paper §6). `plain` shades a hit: associated
/// colour and opacity.
pub fn geometric(hits: &[Hit], plain: impl Fn(&Hit) -> (DVec3, f64), stop: f64) -> [f32; 4] {
    under(Gathered::NOTHING, hits, plain, stop)
}

/// The polygons at `hits` behind what was gathered, as associated RGBA.
fn under(
    mut ray: Gathered,
    hits: &[Hit],
    plain: impl Fn(&Hit) -> (DVec3, f64),
    stop: f64,
) -> [f32; 4] {
    for hit in hits {
        if ray.through <= stop {
            break;
        }
        let (color, opacity) = plain(hit);
        ray.under(color, opacity);
    }
    ray.rgba(0.0)
}
