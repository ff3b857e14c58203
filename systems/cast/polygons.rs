//! Polygons as the rays of one view meet them: at which depths, and how they are shaded (algorithm §4).
//!
//! Each is sorted into the beams that may meet it; a ray meets those of its beam whose outlines hold it, in the order of
//! their depths.

use glam::{DVec3, Vec4};

use super::appearance::Appearance;
use super::beams::Beams;
use super::cue::Cue;
use super::march::{Hit, Shaded};
use super::projected::ProjectedFace;
use super::targets::{Crossed, Outlines};
use crate::components::Sampling;
use crate::light::strength::LightStrength;
use crate::polygon::outline::edges;
use crate::view::camera::Camera;
use crate::view::samples::Layout;

/// Every polygon of a scene on one view, in the order of the scene, and for each beam those it may meet.
pub struct Polygons {
    faces: Vec<ProjectedFace>,
    /// For each beam: its part of `binned`.
    starts: Vec<u32>,
    binned: Vec<u32>,
    beams: Beams,
    /// Depths no further apart than this are one, world units.
    slack: f64,
    cue: Option<Cue>,
    camera: Camera,
    /// β of each light that casts a shadow, where something is in its way.
    strengths: Vec<Option<LightStrength>>,
}

impl Polygons {
    /// Sorts the polygons into beams. Depths closer than `slack` (world units) differ by rounding alone; `strengths` are
    /// those of the lights that the appearances call shadowed.
    pub fn new(
        faces: Vec<ProjectedFace>,
        beams: &Beams,
        slack: f64,
        camera: Camera,
        cue: Option<Cue>,
        strengths: Vec<Option<LightStrength>>,
    ) -> Self {
        let around = |face: &ProjectedFace| {
            let [low, high] = face.bounds();
            beams.around(low, high)
        };
        let mut starts = vec![0_u32; beams.counts[0] * beams.counts[1] + 1];
        let each = |[across, down]: [std::ops::Range<usize>; 2]| {
            let row = beams.counts[0];
            down.flat_map(move |y| across.clone().map(move |x| y * row + x))
        };
        faces.iter().flat_map(|face| each(around(face))).for_each(|beam| starts[beam + 1] += 1);
        for beam in 1..starts.len() {
            starts[beam] += starts[beam - 1];
        }
        let mut next = starts.clone();
        let mut binned = vec![0; starts[starts.len() - 1] as usize];
        for (number, face) in faces.iter().enumerate() {
            for beam in each(around(face)) {
                binned[next[beam] as usize] = number as u32;
                next[beam] += 1;
            }
        }
        Self { faces, starts, binned, beams: *beams, slack, cue, camera, strengths }
    }

    /// Whether there is no polygon.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Adds to `hits` what the ray at a position meets (counted from the middle of pixel (0, 0)), in the order of depths, ties
    /// in the order of the scene.
    pub fn meet(&self, position: [i64; 2], hits: &mut Vec<Hit>) {
        let (first, beam) = (hits.len(), self.beams.around_position(position));
        let window = Camera::window(position);
        let near = &self.binned[self.starts[beam] as usize..self.starts[beam + 1] as usize];
        for &number in near {
            let face = &self.faces[number as usize];
            if face.holds(window) {
                hits.push(Hit { depth: face.depth(window), face: number, value: 0.0 });
            }
        }
        let hits = &mut hits[first..];
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

    /// Whether nothing is seen through a hit.
    pub(crate) fn is_opaque(&self, hit: &Hit) -> bool {
        let appearance = self.faces[hit.face as usize].appearance();
        appearance.opacity >= 1.0 && appearance.texture.is_none()
    }

    /// Associated colour and opacity of a hit of the ray at a position, without texture and shadows.
    pub fn plain(&self, hit: &Hit, position: [i64; 2]) -> (DVec3, f64) {
        let appearance = self.faces[hit.face as usize].appearance();
        let world = || self.camera.ray(Camera::window(position)).at(hit.depth);
        let shadowed = |light| appearance.shadowed_at(light, world);
        let lights = 0..appearance.shadowed.len();
        let reflected = appearance.reflected_at(world) + lights.map(shadowed).sum::<DVec3>();
        ((appearance.ambient + reflected * self.fade(hit)) * appearance.opacity, appearance.opacity)
    }

    /// What the depth cue leaves of the light that is reflected at a hit.
    fn fade(&self, hit: &Hit) -> f64 {
        self.cue.map_or(1.0, |cue| cue.factor(hit.depth))
    }

    /// Shades a hit of the ray at a position, which stands for `step` positions.
    pub fn shade(&self, hit: &Hit, position: [i64; 2], step: usize) -> Shaded {
        let appearance = self.faces[hit.face as usize].appearance();
        let (plain_color, plain_opacity) = self.plain(hit, position);
        if appearance.texture.is_none() && self.strengths.iter().all(Option::is_none) {
            return Shaded {
                color: plain_color,
                opacity: plain_opacity,
                plain_color,
                plain_opacity,
            };
        }
        let ray = self.camera.ray(Camera::window(position));
        let world = ray.at(hit.depth);
        let shadowed = self.shadowed(appearance, world);
        let reflected = appearance.reflected_at(|| world);
        let lit = appearance.ambient + (reflected + shadowed) * self.fade(hit);
        let texel = appearance.texture.as_ref();
        let texel = texel.map_or(Vec4::ONE, |texture| texture.at(&ray, hit.depth, step));
        let texel = texel.as_dvec4();
        Shaded {
            color: lit * texel.truncate() * appearance.opacity,
            opacity: appearance.opacity * texel.w,
            plain_color,
            plain_opacity,
        }
    }

    /// What a face reflects at a world point of the lights that cast shadows: Σ c_i β_i (equation 4).
    fn shadowed(&self, appearance: &Appearance, world: DVec3) -> DVec3 {
        let beta = |light: usize| {
            let strength = self.strengths.get(light).and_then(Option::as_ref);
            let offset = appearance.shadow_offsets.get(light).copied().unwrap_or_default();
            strength.map_or(1.0, |strength| f64::from(strength.at(world + offset)))
        };
        let lights = 0..appearance.shadowed.len();
        lights.map(|light| appearance.shadowed_at(light, || world) * beta(light)).sum()
    }

    /// Where outlines ask for rays.
    pub fn crossed(&self, layout: &Layout, sampling: &Sampling) -> Crossed {
        let asked = sampling.outlines && !self.is_empty();
        // Regions down to two pixels' side are split where outlines cross them.
        let outlines = (asked && sampling.coarsest > 4).then(|| self.outlines(layout, 8, |_| true));
        let is_thin = ProjectedFace::is_thin;
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
        for outline in
            self.faces.iter().filter(|face| wanted(face)).flat_map(ProjectedFace::outlines)
        {
            for (p, q) in edges(outline) {
                let [p, q] = [p, q].map(|window| outlines.square(layout, window));
                outlines.mark(p, q);
            }
        }
        outlines
    }
}
