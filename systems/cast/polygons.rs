//! Polygons as the rays of one view meet them: at which depths, and how they are shaded (algorithm §4).
//!
//! Rays are parallel, so a polygon is projected to the picture once; a ray meets it where its window position lies in
//! the projected outline, at a depth that is affine in that position. Whether a position lies on this or that side of
//! an edge is computed from the edge's ends in one order, whichever polygon asks: an edge that two polygons share is
//! met exactly once. A polygon in the plane of the rays is missed.

use glam::{DVec2, DVec3, Vec3, Vec4};

use super::adaptive::{Aim, Outlines};
use super::beams::Beams;
use super::march::{Hit, Shaded};
use super::texture::Laid;
use super::volume::Cue;
use crate::components::Surface;
use crate::light::shading::{Lamps, Reflectance};
use crate::light::strength::LightStrength;
use crate::polygon::face::Face;
use crate::view::camera::Camera;
use crate::view::samples::{Layout, POSITIONS};

/// How far outside the bounding box of a polygon a ray is sure to miss it, pixels.
const OUTSIDE: f64 = 1e-6;

/// A polygon of the scene on one view.
pub struct Seen {
    /// The outlines in window coordinates, pixels; holes as the rest: a position inside an odd number of them is in.
    outlines: Vec<Vec<DVec2>>,
    low: DVec2,
    high: DVec2,
    /// Depth of window position (x, y): `depth.x x + depth.y y + depth.z`.
    depth: DVec3,
    look: Look,
}

/// How a polygon of one orientation and surface looks under the lights of a scene: constant over it, but for the cue,
/// textures and shadows.
pub struct Look {
    /// α_P.
    opacity: f64,
    /// c_P k_a.
    ambient: DVec3,
    /// What it reflects of the lights that cast no shadow.
    reflected: DVec3,
    /// What it reflects of each light that does, unshadowed.
    shadowed: Vec<DVec3>,
    /// For each of those lights, the way from a point of it to the one whose strength it gets; empty without strengths.
    ways: Vec<DVec3>,
    /// Its texture.
    laid: Option<Laid>,
}

impl Look {
    /// The look of a face of unit normal `normal`, with the texture that is laid on it; `ways` are those of
    /// [`ways`](super::receiving::ways).
    pub fn new(
        surface: &Surface,
        normal: DVec3,
        lamps: &Lamps,
        ways: Vec<DVec3>,
        laid: Option<Laid>,
    ) -> Self {
        let (how, normal): (Reflectance, Vec3) = (surface.into(), normal.as_vec3());
        let color = surface.color.0;
        let reflected =
            lamps.plain.iter().map(|lamp| lamp.reflected(color, normal, &how)).sum::<Vec3>();
        let shadowed = lamps.shadowed.iter();
        Self {
            opacity: f64::from(surface.opacity),
            ambient: (color * how.ambient).as_dvec3(),
            reflected: reflected.as_dvec3(),
            shadowed: shadowed
                .map(|(_, lamp)| lamp.reflected(color, normal, &how).as_dvec3())
                .collect(),
            ways,
            laid,
        }
    }
}

impl Seen {
    /// A face on a view; `None` if it is seen edge-on.
    pub fn new(face: &Face, camera: &Camera, look: Look) -> Option<Self> {
        let facing = face.normal.dot(camera.forward);
        if facing.abs() < 1e-9 {
            return None;
        }
        let project = |v: &DVec3| camera.project(*v).0;
        let outlines: Vec<Vec<DVec2>> =
            face.outlines.iter().map(|outline| outline.iter().map(project).collect()).collect();
        let corners = outlines.iter().flatten();
        let (low, high) = corners
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &v| {
                (low.min(v), high.max(v))
            });
        // Along the plane, a step of the window moves the depth by minus the normal's part along it.
        let across = |window: DVec2| {
            let world =
                camera.right * (window.x * camera.pixel) - camera.up * (window.y * camera.pixel);
            -face.normal.dot(world) / facing
        };
        // The box rejects and never decides: rounding there must not take from a polygon what its neighbour leaves to it.
        let (low, high) = (low - OUTSIDE, high + OUTSIDE);
        let (center, middle) = camera.project(face.center);
        let (dx, dy) = (across(DVec2::X), across(DVec2::Y));
        let depth = DVec3::new(dx, dy, middle - dx * center.x - dy * center.y);
        Some(Self { outlines, low, high, depth, look })
    }

    /// Whether a window position lies in the polygon: inside an odd number of outlines, borders to one side.
    fn holds(&self, at: DVec2) -> bool {
        if at.cmplt(self.low).any() || at.cmpgt(self.high).any() {
            return false;
        }
        let edges = self
            .outlines
            .iter()
            .flat_map(|outline| outline.iter().zip(outline.iter().skip(1).chain(outline.first())));
        edges.filter(|(p, q)| crosses(**p, **q, at)).count() % 2 == 1
    }

    fn depth(&self, at: DVec2) -> f64 {
        self.depth.dot(at.extend(1.0))
    }
}

/// Whether the edge from `p` to `q` passes to the right of `at`, its lower end counted and its upper end not; the same
/// for (q, p).
fn crosses(p: DVec2, q: DVec2, at: DVec2) -> bool {
    if (p.y <= at.y) == (q.y <= at.y) {
        return false;
    }
    let (low, high) = if p.y <= q.y { (p, q) } else { (q, p) };
    (high - low).perp_dot(at - low) > 0.0
}

/// Every polygon of a scene on one view, in the order of the scene, and for each beam those it may meet.
pub struct Polygons {
    faces: Vec<Seen>,
    /// For each beam: its part of `binned`.
    starts: Vec<u32>,
    binned: Vec<u32>,
    /// Depths no further apart than this are one, world units.
    slack: f64,
    cue: Option<Cue>,
    camera: Camera,
    /// β of each light that casts a shadow, where something is in its way.
    strengths: Vec<Option<LightStrength>>,
}

impl Polygons {
    /// Sorts the polygons into beams. Depths closer than `slack` (world units) differ by rounding alone; `strengths` are
    /// those of the lights that the looks call shadowed.
    pub fn new(
        faces: Vec<Seen>,
        beams: &Beams,
        slack: f64,
        camera: Camera,
        cue: Option<Cue>,
        strengths: Vec<Option<LightStrength>>,
    ) -> Self {
        let around = |face: &Seen| beams.around(face.low, face.high);
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
        Self { faces, starts, binned, slack, cue, camera, strengths }
    }

    /// Whether there is no polygon.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Puts into `hits` what a ray of a beam meets, in the order of depths, ties in the order of the scene.
    pub fn meet(&self, beam: usize, window: DVec2, hits: &mut Vec<Hit>) {
        hits.clear();
        let near = &self.binned[self.starts[beam] as usize..self.starts[beam + 1] as usize];
        for &number in near {
            let face = &self.faces[number as usize];
            if face.holds(window) {
                hits.push(Hit { depth: face.depth(window), face: number });
            }
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

    /// Associated colour and opacity of a hit, without texture and shadows.
    pub fn plain(&self, hit: &Hit) -> (DVec3, f64) {
        let look = &self.faces[hit.face as usize].look;
        let reflected = look.reflected + look.shadowed.iter().sum::<DVec3>();
        ((look.ambient + reflected * self.fade(hit)) * look.opacity, look.opacity)
    }

    /// What the depth cue leaves of the light that is reflected at a hit.
    fn fade(&self, hit: &Hit) -> f64 {
        self.cue.map_or(1.0, |cue| cue.factor(hit.depth))
    }

    /// Shades a hit of the ray at `aim`.
    pub fn shade(&self, hit: &Hit, aim: Aim) -> Shaded {
        let look = &self.faces[hit.face as usize].look;
        let (plain_color, plain_opacity) = self.plain(hit);
        if look.laid.is_none() && self.strengths.iter().all(Option::is_none) {
            return Shaded {
                color: plain_color,
                opacity: plain_opacity,
                plain_color,
                plain_opacity,
            };
        }
        let world = self.camera.origin(aim.window) + self.camera.forward * hit.depth;
        let lit = look.ambient + (look.reflected + self.shadowed(look, world)) * self.fade(hit);
        let texel =
            look.laid.as_ref().map_or(Vec4::ONE, |laid| laid.at(world, aim.step)).as_dvec4();
        Shaded {
            color: lit * texel.truncate() * look.opacity,
            opacity: look.opacity * texel.w,
            plain_color,
            plain_opacity,
        }
    }

    /// What a face reflects at a world point of the lights that cast shadows: Σ c_i β_i (equation 4).
    fn shadowed(&self, look: &Look, world: DVec3) -> DVec3 {
        let beta = |light: usize| {
            let strength = self.strengths.get(light).and_then(Option::as_ref);
            let buffer = strength.and_then(|strength| strength.buffer.as_ref());
            let way = look.ways.get(light).copied().unwrap_or_default();
            buffer.map_or(1.0, |buffer| f64::from(buffer.at(world + way)))
        };
        look.shadowed.iter().enumerate().map(|(light, color)| *color * beta(light)).sum()
    }

    /// Which squares of `side` positions the outlines cross.
    pub fn outlines(&self, layout: &Layout, side: usize) -> Outlines {
        let [across, down] = layout.positions().map(|n| (n - 1).div_ceil(side));
        let mut outlines = Outlines { side, across, crossed: vec![false; across * down] };
        let square = |window: DVec2| {
            ((window - 0.5) * POSITIONS as f64 + layout.margin as f64) / side as f64
        };
        for outline in self.faces.iter().flat_map(|face| &face.outlines) {
            for (p, q) in outline.iter().zip(outline.iter().skip(1).chain(outline.first())) {
                mark(&mut outlines, down, square(*p), square(*q));
            }
        }
        outlines
    }
}

/// Marks every square that the edge from `p` to `q` (in squares) crosses, and its neighbours within a rounding error.
fn mark(outlines: &mut Outlines, down: usize, p: DVec2, q: DVec2) {
    const SLACK: f64 = 1e-6;
    let (low, high) = if p.y <= q.y { (p, q) } else { (q, p) };
    let rows = (low.y - SLACK).floor().max(0.0)..(high.y + SLACK).floor().min(down as f64 - 1.0);
    let slope = if high.y > low.y { (high.x - low.x) / (high.y - low.y) } else { 0.0 };
    let mut row = rows.start;
    while row <= rows.end {
        let (from, to) = if high.y > low.y {
            let at = |y: f64| low.x + (y.clamp(low.y, high.y) - low.y) * slope;
            (at(row), at(row + 1.0))
        } else {
            (low.x, high.x)
        };
        let first = (from.min(to) - SLACK).floor().max(0.0) as usize;
        let last = (from.max(to) + SLACK).floor().min(outlines.across as f64 - 1.0);
        if last >= 0.0 {
            for x in first..=last as usize {
                outlines.crossed[row as usize * outlines.across + x] = true;
            }
        }
        row += 1.0;
    }
}
