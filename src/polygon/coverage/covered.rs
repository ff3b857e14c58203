//! The voxels that the faces of one entity cover: bricks near them, filled side by side, at a cost in proportion to the
//! area of the faces (paper §7), never to the volume.
//!
//! Faces of one surface add up at a voxel: the parts of the disc that they cover are summed (to at most the whole disc),
//! so that polygons which share an edge cover what the undivided polygon would. Faces turned away from each other by more
//! than 139° are two sides of something thin: a ray goes through both, so their optical depths add. Sheets that look the
//! same way within a ball's reach of each other count as one.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::ball::Ball;
use super::disc::disc_area;
use super::flat::{Flat, NearBrick, brick_place};
use super::sides::turned;
use crate::polygon::face::Face;
use crate::volume::bricks::{BrickPlace, Bricks, EDGE, VOXELS};
use crate::volume::voxel_colors::fill_alike;

/// Cosine between the normals of faces from which on they are two sides.
const OTHER_SIDE: f64 = -0.75;

/// What the faces of one entity cover of a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Covered {
    size: [usize; 3],
    counts: [usize; 3],
    /// For each brick of the grid, x fastest: one more than its place in `bricks`, or 0.
    table: Vec<u32>,
    bricks: Vec<Touched>,
}

/// A brick in which at least one voxel is covered.
#[derive(Debug, Clone, PartialEq)]
pub struct Touched {
    /// α_G of its voxels, as bricks keep them.
    pub opacity: Box<[f32; VOXELS]>,
    /// Whose it is.
    pub shares: Shares,
}

/// Which faces the covered voxels of a brick take their colour from.
#[derive(Debug, Clone, PartialEq)]
pub enum Shares {
    /// One face alone.
    One(usize),
    /// The voxel's place in the brick, a face, and its part of the voxel's colour: parts of a voxel sum to 1.
    Many(Vec<(u16, usize, f32)>),
}

/// One face near one brick.
type Pair = (NearBrick, usize);

/// What one face covers of one voxel's disc.
struct Part {
    voxel: u16,
    face: usize,
    of_disc: f64,
    height: f64,
}

impl Covered {
    /// Scan-converts `faces`, whose places in index space are `flats`, into a grid of `size` voxels.
    ///
    /// What lies outside the grid is not there. The result does not depend on the number of threads.
    #[must_use]
    pub fn new(faces: &[Face], flats: &[Flat], ball: &Ball, size: [usize; 3]) -> Self {
        let counts = size.map(|n| n.div_ceil(EDGE));
        let of_face = |(face, flat): (usize, &Flat)| -> Vec<Pair> {
            flat.bricks(ball.reach(), size).into_iter().map(|near| (near, face)).collect()
        };
        let mut pairs: Vec<Pair> = flats.par_iter().enumerate().flat_map_iter(of_face).collect();
        pairs.par_sort_unstable_by_key(|(near, face)| (near.zyx, *face));
        let turned = if flats.len() > 1 { turned(faces) } else { vec![false] };
        let filling = Filling { flats, turned, ball, size };
        let groups: Vec<&[Pair]> = pairs.chunk_by(|a, b| a.0.zyx == b.0.zyx).collect();
        let filled: Vec<_> = groups.par_iter().map(|group| filling.fill(group)).collect();
        let mut table = vec![0; counts.iter().product()];
        let mut bricks = Vec::new();
        for (group, touched) in groups.iter().zip(filled) {
            if let Some(touched) = touched {
                let [z, y, x] = group[0].0.zyx;
                bricks.push(touched);
                table[(z * counts[1] + y) * counts[0] + x] = bricks.len() as u32;
            }
        }
        Self { size, counts, table, bricks }
    }

    /// What is covered of a brick; `None` where nothing is.
    #[must_use]
    pub fn brick(&self, [x, y, z]: [usize; 3]) -> Option<&Touched> {
        let entry = self.table[(z * self.counts[1] + y) * self.counts[0] + x];
        (entry as usize).checked_sub(1).map(|at| &self.bricks[at])
    }

    /// α_G.
    #[must_use]
    pub fn opacity(&self) -> Bricks<f32> {
        self.in_touched(|touched, made| made.copy_from_slice(&touched.opacity[..]))
    }

    /// The colours of covered voxels, of the colours of the faces; 0 where nothing is covered.
    #[must_use]
    pub fn colors(&self, of_faces: &[Vec3]) -> Bricks<[f32; 3]> {
        self.in_touched(|touched, made| match &touched.shares {
            Shares::One(face) => fill_alike(of_faces[*face].to_array(), &touched.opacity, made),
            Shares::Many(shares) => {
                for &(voxel, face, part) in shares {
                    let made: &mut [f32; 3] = &mut made[usize::from(voxel)];
                    *made = (Vec3::from(*made) + of_faces[face] * part).to_array();
                }
            }
        })
    }

    /// What is made of the bricks that are touched, and of no other: a plane touches one brick of thirty.
    fn in_touched<T: Copy + Default + Send + Sync>(
        &self,
        make: impl Fn(&Touched, &mut [T; VOXELS]) + Send + Sync,
    ) -> Bricks<T> {
        let is_touched = |place: BrickPlace| self.brick(place.brick).is_some();
        Bricks::make_where(self.size, is_touched, |place, made| {
            self.brick(place.brick).is_some_and(|touched| {
                make(touched, made);
                true
            })
        })
    }
}

/// What all bricks are filled with.
struct Filling<'a> {
    flats: &'a [Flat],
    turned: Vec<bool>,
    ball: &'a Ball,
    size: [usize; 3],
}

impl Filling<'_> {
    fn fill(&self, group: &[Pair]) -> Option<Touched> {
        let mut opacity = Box::new([0.0; VOXELS]);
        let shares = if let [(near, face)] = group {
            self.fill_one(*near, *face, &mut opacity);
            Shares::One(*face)
        } else {
            Shares::Many(self.fill_many(group, &mut opacity))
        };
        opacity.iter().any(|&alpha| alpha > 0.0).then_some(Touched { opacity, shares })
    }

    fn fill_one(&self, near: NearBrick, face: usize, opacity: &mut [f32; VOXELS]) {
        let layer = self.flats[face].layer;
        let whole = self.ball.filled(1.0, layer);
        self.visit(near, face, |at, part, height| {
            let filled = if part == 1.0 { whole } else { self.ball.filled(part, layer) };
            opacity[at] = filled.opacity(height) as f32;
        });
    }

    fn fill_many(&self, group: &[Pair], opacity: &mut [f32; VOXELS]) -> Vec<(u16, usize, f32)> {
        let mut parts = Vec::new();
        for &(near, face) in group {
            self.visit(near, face, |at, part, height| {
                parts.push(Part { voxel: at as u16, face, of_disc: part, height });
            });
        }
        parts.sort_by_key(|part| part.voxel);
        let mut shares = Vec::with_capacity(parts.len());
        for parts in parts.chunk_by(|a, b| a.voxel == b.voxel) {
            let weight = |part: &Part| part.of_disc * self.ball.weight(part.height);
            let sum: f64 = parts.iter().map(weight).sum();
            let alpha = self.add_up(parts) as f32;
            if alpha > 0.0 && sum > 0.0 {
                opacity[usize::from(parts[0].voxel)] = alpha;
                shares.extend(parts.iter().map(|p| (p.voxel, p.face, (weight(p) / sum) as f32)));
            }
        }
        shares
    }

    /// α_G of a voxel that several faces cover a part of.
    fn add_up(&self, parts: &[Part]) -> f64 {
        let normal = |part: &Part| {
            let normal = self.flats[part.face].normal;
            if self.turned[part.face] { -normal } else { normal }
        };
        let toward = normal(&parts[0]);
        // The part, and its means of squared height and of thickness. With squares, the printed form sums exactly.
        let mut sides = [DVec3::ZERO; 2];
        for part in parts {
            let side = usize::from(normal(part).dot(toward) < OTHER_SIDE);
            let square = part.height * part.height;
            sides[side] += part.of_disc * DVec3::new(1.0, square, self.flats[part.face].layer);
        }
        let through: f64 = sides
            .iter()
            .filter(|side| side.x > 0.0)
            .map(|s| 1.0 - self.ball.opacity(s.x, (s.y / s.x).sqrt(), s.z / s.x))
            .product();
        1.0 - through
    }

    /// Calls `covers` with the place in the brick, the part of the disc (of what is seen through, as much of it as is opaque) and the
    /// height of every voxel that is covered.
    fn visit(&self, near: NearBrick, face: usize, mut covers: impl FnMut(usize, f64, f64)) {
        let (flat, reach) = (&self.flats[face], self.ball.reach());
        let [z, y, x] = near.zyx;
        let BrickPlace { first, extent, .. } = brick_place([x, y, z], self.size);
        let Some(bounds) = flat.bounds(reach, self.size) else { return };
        let range = |axis: usize| {
            let (from, to) = (first[axis], first[axis] + extent[axis]);
            from.max(bounds[axis][0])..to.min(bounds[axis][1])
        };
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let point = DVec3::new(x as f64, y as f64, z as f64);
                    let height = flat.height(point);
                    if height.abs() < reach {
                        let part = if near.whole { 1.0 } else { self.part(flat, point, height) };
                        let part = part * flat.opacity();
                        if part > 0.0 {
                            let at = ((z % EDGE) * EDGE + y % EDGE) * EDGE + x % EDGE;
                            covers(at, part, height);
                        }
                    }
                }
            }
        }
    }

    /// The part of the disc around a voxel that a polygon covers.
    fn part(&self, flat: &Flat, point: DVec3, height: f64) -> f64 {
        let radius = self.ball.radius(height);
        disc_area(flat.place(point), radius, flat.outlines()) / (PI * radius * radius)
    }
}
