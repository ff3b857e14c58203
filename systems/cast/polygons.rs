//! Polygons as the rays of one view meet them: at which depths, and how they are shaded (algorithm §4).
//!
//! Each is sorted into the beams that may meet it; a ray meets those of its beam whose outlines hold it, in the order of
//! their depths.

use glam::{DVec3, Vec4};
use prefetch_index::prefetch_index;

use super::appearance::Appearance;
use super::beams::Beams;
use super::binned::{Near, Spread};
use super::cue::Cue;
use super::gathering::{Hit, Shaded};
use super::lanes::{LANES, Lanes, Packet, each};
use super::looks::{FEW, Look};
use super::projected::ProjectedFace;
use super::seen::SeenFaces;
use super::targets::{Crossed, Outlines};
use crate::components::Sampling;
use crate::light::strength::LightStrength;
use crate::view::camera::Camera;
use crate::view::samples::Layout;

/// Faces near a beam that are asked of memory before they are looked at.
const AHEAD: usize = 3;

/// Every polygon of a scene that rays of one view may meet.
pub struct Polygons<'a> {
    faces: SeenFaces,
    beams: Beams,
    looks: Vec<Look<'a>>,
    /// Depths no further apart than this are one, world units.
    slack: f64,
    cue: Option<Cue>,
    camera: &'a Camera,
    /// β of each light that casts a shadow, where something is in its way.
    strengths: &'a [Option<LightStrength>],
}

/// What the rays of a packet meet, ray after ray.
#[derive(Default)]
pub(crate) struct Met {
    found: Vec<(u8, Hit)>,
    hits: Vec<Hit>,
    /// For each ray where its own end.
    ends: [u32; LANES],
}

impl Met {
    /// All hits: those of a ray together, in the order of depths, ties in the order of the scene.
    pub fn hits(&self) -> &[Hit] {
        &self.hits
    }

    /// Which of the hits a ray has, `[first, end)`.
    pub fn of(&self, lane: usize) -> [u32; 2] {
        if self.hits.is_empty() {
            return [0; 2];
        }
        [lane.checked_sub(1).map_or(0, |before| self.ends[before]), self.ends[lane]]
    }

    /// Whether no ray meets anything.
    pub fn is_empty(&self) -> bool {
        self.hits.is_empty()
    }

    /// Puts what was found in the order of the rays.
    fn sort(&mut self) {
        let Self { found, hits, ends } = self;
        *ends = [0; LANES];
        for (lane, _) in &*found {
            ends[usize::from(*lane)] += 1;
        }
        let (mut next, mut sum) = ([0; LANES], 0);
        for lane in 0..LANES {
            next[lane] = sum;
            sum += ends[lane];
            ends[lane] = sum;
        }
        hits.clear();
        hits.resize(found.len(), Hit { depth: 0.0, face: 0, shown: u32::MAX });
        for (lane, hit) in found {
            let at = &mut next[usize::from(*lane)];
            hits[*at as usize] = *hit;
            *at += 1;
        }
    }
}

impl<'a> Polygons<'a> {
    /// The faces that rays may meet. Depths closer than `slack` (world units) differ by rounding alone; `strengths` are those
    /// of the lights that the looks call shadowed.
    pub fn new(
        faces: SeenFaces,
        looks: Vec<Look<'a>>,
        beams: Beams,
        slack: f64,
        (camera, cue): (&'a Camera, Option<Cue>),
        strengths: &'a [Option<LightStrength>],
    ) -> Self {
        Self { faces, beams, looks, slack, cue, camera, strengths }
    }

    /// Whether rays meet no polygon.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Finds what the wanted rays of a packet meet.
    pub fn meet(&self, packet: &Packet, met: &mut Met) {
        met.found.clear();
        if self.is_empty() {
            return met.hits.clear();
        }
        let place = |lane: usize| self.beams.place(packet.position(lane));
        let mut left = packet.wanted;
        while left != 0 {
            let beam = self.beams.around(place(left.trailing_zeros() as usize));
            let is_here = |lane: &usize| self.beams.around(place(*lane)) == beam;
            let here = if is_here(&0) && is_here(&(LANES - 1)) && !packet.places.are_scattered() {
                left
            } else {
                each(left).filter(is_here).fold(0, |set, lane| set | 1 << lane)
            };
            left &= !here;
            self.meet_near(self.faces.near(beam), packet, here, &mut met.found);
        }
        if met.found.is_empty() {
            return met.hits.clear();
        }
        met.sort();
        let mut first = 0;
        for end in met.ends {
            self.order(&mut met.hits[first..end as usize]);
            first = end as usize;
        }
    }

    /// Finds what rays of one beam meet of the polygons near it.
    fn meet_near(&self, near: &[Near], packet: &Packet, here: Lanes, found: &mut Vec<(u8, Hit)>) {
        if near.is_empty() {
            return;
        }
        let spread = Spread::of(each(here), |lane| self.beams.place(packet.position(lane)));
        for (number, met) in near.iter().enumerate() {
            // Next to one another in a beam, faces are apart in memory, and each is met by few rays.
            let (part, ahead) = self.faces.part(near.get(number + AHEAD).unwrap_or(met).face);
            prefetch_index(part, ahead);
            let face = self.faces.get(met.face);
            for lane in each(spread.met(met)) {
                let window = Camera::window(packet.position(lane));
                if met.whole || face.holds(window) {
                    let depth = face.depth(window, self.camera);
                    found.push((lane as u8, Hit { depth, face: met.face, shown: u32::MAX }));
                }
            }
        }
    }

    /// Puts the hits of a ray in the order of their depths.
    fn order(&self, hits: &mut [Hit]) {
        if hits.len() < 2 {
            return;
        }
        hits.sort_unstable_by(|a, b| a.depth.total_cmp(&b.depth).then(a.face.cmp(&b.face)));
        // Coincident polygons have one plane but not one centre, so that their depths differ in the last bits.
        for tied in hits.chunk_by_mut(|a, b| b.depth - a.depth <= self.slack) {
            let depth = tied[0].depth;
            for hit in tied.iter_mut() {
                hit.depth = depth;
            }
            tied.sort_unstable_by_key(|hit| hit.face);
        }
    }

    /// How a face looks, by its number among those that rays may meet.
    #[inline]
    fn look<R>(&self, face: u32, to: impl FnOnce(&Appearance<'_>) -> R) -> R {
        let ProjectedFace { of: [entity, at], normal, .. } = *self.faces.get(face);
        self.looks[entity as usize].with((at as usize, normal), to)
    }

    /// Whether nothing is seen through a hit.
    pub(crate) fn is_opaque(&self, hit: &Hit) -> bool {
        self.look(hit.face, |face| face.opacity >= 1.0 && face.texture.is_none())
    }

    /// Associated colour and opacity of a hit of the ray at a position, without texture and shadows.
    pub fn plain(&self, hit: &Hit, position: [i64; 2]) -> (DVec3, f64) {
        self.look(hit.face, |appearance| self.plain_of(appearance, hit, position))
    }

    fn plain_of(&self, face: &Appearance<'_>, hit: &Hit, position: [i64; 2]) -> (DVec3, f64) {
        let world = || self.camera.ray(Camera::window(position)).at(hit.depth);
        let shadowed = |light| face.shadowed_at(light, world);
        let reflected = face.reflected_at(world) + (0..face.shadows()).map(shadowed).sum::<DVec3>();
        ((face.ambient + reflected * self.fade(hit)) * face.opacity, face.opacity)
    }

    /// What the depth cue leaves of the light that is reflected at a hit.
    fn fade(&self, hit: &Hit) -> f64 {
        self.cue.map_or(1.0, |cue| cue.factor(hit.depth))
    }

    /// Shades a hit of the ray at a position, which stands for `step` positions.
    pub fn shade(&self, hit: &Hit, position: [i64; 2], step: usize) -> Shaded {
        self.look(hit.face, |appearance| self.shade_of(appearance, hit, (position, step)))
    }

    fn shade_of(
        &self,
        face: &Appearance<'_>,
        hit: &Hit,
        (position, step): ([i64; 2], usize),
    ) -> Shaded {
        if face.texture.is_none() && self.strengths.iter().all(Option::is_none) {
            let (color, opacity) = self.plain_of(face, hit, position);
            return Shaded { color, opacity, plain_color: color, plain_opacity: opacity };
        }
        let ray = self.camera.ray(Camera::window(position));
        let world = ray.at(hit.depth);
        let (reflected, fade) = (face.reflected_at(|| world), self.fade(hit));
        // Of the lights that cast shadows: Σ c_i, and Σ c_i β_i (equation 4).
        let (mut unshadowed, mut shadowed) = (DVec3::ZERO, DVec3::ZERO);
        for light in 0..face.shadows() {
            let sent = face.shadowed_at(light, || world);
            unshadowed += sent;
            shadowed += sent * self.beta(face, light, world);
        }
        let lit = |shadowed: DVec3| face.ambient + (reflected + shadowed) * fade;
        let texel = face.texture.as_ref();
        let texel = texel.map_or(Vec4::ONE, |texture| texture.at(&ray, hit.depth, step));
        let texel = texel.as_dvec4();
        Shaded {
            color: lit(shadowed) * texel.truncate() * face.opacity,
            opacity: face.opacity * texel.w,
            plain_color: lit(unshadowed) * face.opacity,
            plain_opacity: face.opacity,
        }
    }

    /// β of a light that casts shadows, at a world point of a face.
    fn beta(&self, face: &Appearance<'_>, light: usize, world: DVec3) -> f64 {
        let strength = self.strengths.get(light).and_then(Option::as_ref);
        strength.map_or(1.0, |strength| f64::from(strength.at(world + face.shadow_offset(light))))
    }

    /// Where outlines ask for rays.
    pub fn crossed(&self, layout: &Layout, sampling: &Sampling) -> Crossed {
        let asked = sampling.outlines && !self.is_empty();
        // Regions down to two pixels' side are split where outlines cross them.
        let outlines = (asked && sampling.coarsest > 4).then(|| self.outlines(layout, 8, |_| true));
        let is_thin =
            |face: &ProjectedFace| self.looks[face.of[0] as usize].faces() <= FEW && face.is_thin();
        let thin = asked && sampling.finest < 4 && self.faces.iter().any(is_thin);
        Crossed { outlines, thin: thin.then(|| self.outlines(layout, 4, is_thin)), most: None }
    }

    /// Which squares of `side` positions the outlines of the `wanted` faces cross.
    fn outlines(
        &self,
        layout: &Layout,
        side: usize,
        wanted: impl Fn(&ProjectedFace) -> bool,
    ) -> Outlines {
        let mut outlines = Outlines::none(layout, side);
        for face in self.faces.iter().filter(|face| wanted(face)) {
            for (p, q) in face.outlines().edges() {
                let [p, q] = [p, q].map(|window| outlines.square(layout, window));
                outlines.mark(p, q);
            }
        }
        outlines
    }
}
