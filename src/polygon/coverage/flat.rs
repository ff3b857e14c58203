//! A polygon in index space: its plane, its outlines in the plane, and the bricks that the ball reaches it from.

use glam::{DVec2, DVec3};

use super::disc::clearance;
use crate::polygon::face::Face;
use crate::volume::bricks::{BrickPlace, EDGE};
use crate::volume::grid::Grid;

/// The largest disc that the ball is cut in, voxels.
const WIDEST: f64 = 1.0;

/// A planar polygon in voxel units. An affine keeps it planar; its normal is that of its plane in index space.
#[derive(Debug, Clone, PartialEq)]
pub struct Flat {
    /// Unit normal of the plane in index space, to the side of the face's own normal.
    pub normal: DVec3,
    /// A point of the plane.
    pub origin: DVec3,
    /// World units from the plane to a parallel one a voxel away, along the world normal: the spacing for a plane
    /// perpendicular to an axis.
    pub layer: f64,
    /// The part of its surface's opacity that it has, 0..=1: a disc that it covers counts as covered in that part.
    opacity: f64,
    right: DVec3,
    up: DVec3,
    outlines: Vec<Vec<DVec2>>,
    low: DVec3,
    high: DVec3,
}

/// A brick that a polygon is near.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct NearBrick {
    /// The brick, counted in bricks: z, y, x, so that they sort as bricks are stored.
    pub zyx: [usize; 3],
    /// Whether every disc in the brick lies wholly inside the polygon.
    pub whole: bool,
}

impl Flat {
    /// `face` as the voxels of `grid` see it; `None` if it is so far from the grid that its place is no number.
    #[must_use]
    pub fn new(face: &Face, grid: &Grid) -> Option<Self> {
        let to_index = grid.world_to_index();
        let covector = grid.index_to_world.matrix3.transpose() * face.normal;
        let layer = covector.length();
        let normal = covector / layer;
        let origin = to_index.transform_point3(face.center);
        let (right, up) = normal.any_orthonormal_pair();
        let points: Vec<Vec<DVec3>> = face
            .outlines
            .iter()
            .map(|outline| outline.iter().map(|&v| to_index.transform_point3(v)).collect())
            .collect();
        let place = |&v: &DVec3| DVec2::new(right.dot(v - origin), up.dot(v - origin));
        let outlines = points.iter().map(|o| o.iter().map(place).collect()).collect();
        let all = || points.iter().flatten().copied();
        let low = all().fold(origin, DVec3::min);
        let high = all().fold(origin, DVec3::max);
        // Squares of coordinates are taken further on.
        let far = low.abs().max(high.abs()).max_element();
        let sound = far < 1e100 && layer.is_normal() && normal.is_finite();
        sound.then_some(Self {
            normal,
            origin,
            layer,
            opacity: 1.0,
            right,
            up,
            outlines,
            low,
            high,
        })
    }

    /// The same with that part of its surface's opacity, 0..=1.
    #[must_use]
    pub(crate) fn seen_through(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// The part of its surface's opacity that it has, 0..=1.
    #[must_use]
    pub(super) fn opacity(&self) -> f64 {
        self.opacity
    }

    /// Signed distance of a point from the plane, voxels.
    #[must_use]
    #[inline]
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.origin)
    }

    /// Where a point lies in the plane, in the coordinates of [`Flat::outlines`].
    #[must_use]
    #[inline]
    pub fn place(&self, point: DVec3) -> DVec2 {
        let from = point - self.origin;
        DVec2::new(self.right.dot(from), self.up.dot(from))
    }

    /// The outline and the holes in the plane, voxels.
    #[must_use]
    pub fn outlines(&self) -> &[Vec<DVec2>] {
        &self.outlines
    }

    /// The voxels of a grid of `size` that may be within `reach` of the polygon: first and one past the last on each
    /// axis; `None` if there is none.
    #[must_use]
    pub fn bounds(&self, reach: f64, size: [usize; 3]) -> Option<[[usize; 2]; 3]> {
        let mut bounds = [[0; 2]; 3];
        for axis in 0..3 {
            let last = (size[axis] - 1) as f64;
            let (low, high) = ((self.low[axis] - reach).ceil(), (self.high[axis] + reach).floor());
            if low > last || high < 0.0 || low > high {
                return None;
            }
            bounds[axis] = [low.max(0.0) as usize, high.min(last) as usize + 1];
        }
        Some(bounds)
    }

    /// The bricks of a grid of `size` voxels in which a ball of `reach` may touch the polygon, in order.
    ///
    /// Columns of bricks along the axis nearest to the normal are looked at, never the whole grid.
    #[must_use]
    pub fn bricks(&self, reach: f64, size: [usize; 3]) -> Vec<NearBrick> {
        let Some(bounds) = self.bounds(reach, size) else { return Vec::new() };
        let along = self.normal.abs().max_position();
        let (u, v) = ((along + 1) % 3, (along + 2) % 3);
        let [bricks_u, bricks_v] =
            [u, v].map(|axis| bounds[axis][0] / EDGE..bounds[axis][1].div_ceil(EDGE));
        let mut near = Vec::new();
        for brick_v in bricks_v {
            for brick_u in bricks_u.clone() {
                let mut brick = [0; 3];
                (brick[u], brick[v]) = (brick_u, brick_v);
                for level in self.levels(brick, along, reach, bounds[along]) {
                    brick[along] = level;
                    near.extend(self.near(brick, reach, size));
                }
            }
        }
        near.sort_unstable();
        near
    }

    /// Which bricks of a column along axis `along` the plane passes through or near.
    fn levels(
        &self,
        brick: [usize; 3],
        along: usize,
        reach: f64,
        bounds: [usize; 2],
    ) -> std::ops::Range<usize> {
        let half = (EDGE - 1) as f64 / 2.0;
        let mut middle = DVec3::from(brick.map(|b| (b * EDGE) as f64 + half));
        middle[along] = 0.0;
        // The plane over the column's middle, and how far it rises to its sides.
        let steep = self.normal[along];
        let at = -self.height(middle) / steep;
        let sides = self.normal.abs().element_sum() - steep.abs();
        let rise = (sides * half + reach) / steep.abs();
        let low = (at - rise).max(bounds[0] as f64).ceil();
        let high = (at + rise).min((bounds[1] - 1) as f64).floor();
        if low > high { 0..0 } else { low as usize / EDGE..high as usize / EDGE + 1 }
    }

    /// Whether a brick is near, by the sphere around its voxels.
    fn near(&self, brick: [usize; 3], reach: f64, size: [usize; 3]) -> Option<NearBrick> {
        let BrickPlace { first, extent, .. } = brick_place(brick, size);
        let [first, extent] = [first, extent].map(|n| DVec3::from(n.map(|n| n as f64)));
        let half = (extent - 1.0) / 2.0;
        let middle = first + half;
        if self.height(middle).abs() > self.normal.abs().dot(half) + reach {
            return None;
        }
        let (distance, inside) = clearance(self.place(middle), &self.outlines);
        let clear = distance > half.length() + WIDEST;
        let zyx = [brick[2], brick[1], brick[0]];
        (inside || !clear).then_some(NearBrick { zyx, whole: inside && clear })
    }
}

/// Brick `brick` of a grid of `size` voxels.
pub(super) fn brick_place(brick: [usize; 3], size: [usize; 3]) -> BrickPlace {
    let first = brick.map(|b| b * EDGE);
    BrickPlace {
        brick,
        first,
        extent: std::array::from_fn(|axis| EDGE.min(size[axis] - first[axis])),
    }
}
