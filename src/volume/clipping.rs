//! A cut through a volume: opacity falls from whole to none over one voxel, so that a cut face shows no stairs.

use glam::{DAffine3, DVec3, Vec3};

use crate::components::Clip;
use crate::volume::grid::Grid;

/// A stated [`Clip`] over the voxels of a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    clip: Clip,
    index_to_world: DAffine3,
    /// The most over which the opacity falls: the largest spacing, world units.
    widest: f64,
    /// No voxel is longer than this along any unit vector, world units.
    longest: f64,
    /// The stated planes.
    planes: Vec<CutFace>,
    /// The sides of the box.
    sides: Vec<CutFace>,
}

/// How far inside what is left a voxel lies by one plane or side, world units: `inside − along · index`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CutFace {
    inside: f64,
    along: DVec3,
}

impl CutFace {
    /// That of the plane at `place` along a unit vector out of what is left.
    fn new(normal: DVec3, place: f64, index_to_world: &DAffine3) -> Self {
        let inside = place - normal.dot(index_to_world.translation);
        Self { inside, along: index_to_world.matrix3.transpose() * normal }
    }

    /// The least of a block of voxels, by its first and last.
    #[inline]
    fn least(&self, first: DVec3, last: DVec3) -> f64 {
        let most = (self.along * first).max(self.along * last);
        self.inside - (most.x + most.y + most.z)
    }
}

/// How a point lies to the part of a cut that is nearest to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// How far inside what is left it lies, world units; below 0 where it is cut away.
    pub inside: f64,
    /// The unit vector out of what is left; zero where nothing is cut.
    pub normal: DVec3,
    /// How long a voxel is along that vector, world units.
    width: f64,
}

impl Section {
    /// That of a point which no cut is near.
    pub(crate) const NONE: Self = Self { inside: f64::INFINITY, normal: DVec3::ZERO, width: 1.0 };

    /// The part of a slab around the point that is left, 0..=1; `way` is the ray's way through the slab, world units. The cut
    /// counts as steep where it is met flatly: it is never spread over more than a voxel.
    #[must_use]
    pub fn left(&self, way: DVec3) -> f64 {
        let spread = way.dot(self.normal).abs().min(self.width);
        if spread > 0.0 {
            (self.inside / spread + 0.5).clamp(0.0, 1.0)
        } else {
            f64::from(u8::from(self.inside >= 0.0))
        }
    }

    /// A normal turned to that of the cut in the layer under it: by the cut's alone as deep as `deep` voxels, by its own
    /// alone from a voxel deeper on.
    #[must_use]
    pub fn turned(&self, normal: Vec3, deep: f64) -> Vec3 {
        let part = (deep + 1.0 - self.inside / self.width).clamp(0.0, 1.0);
        if part == 0.0 {
            return normal;
        }
        normal.lerp(self.normal.as_vec3(), part as f32).normalize_or_zero()
    }
}

/// How much of a block of voxels a cut leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Left {
    /// All of it, as it was.
    Whole,
    /// Ask each voxel.
    Part,
    /// Nothing.
    Nothing,
}

impl Cut {
    /// The cut that `clip` makes in a volume on `grid`.
    #[must_use]
    pub fn new(clip: &Clip, grid: &Grid) -> Self {
        let widest = grid.spacing().max_element();
        let m = grid.index_to_world.matrix3;
        // The largest sum of a row is at least the largest stretch, and of axes at right angles it is.
        let squares = m.transpose() * m;
        let rows =
            [squares.x_axis, squares.y_axis, squares.z_axis].map(|row| row.abs().element_sum());
        let longest = rows.into_iter().fold(0.0, f64::max).sqrt();
        let plane = |&[a, b, c, d]: &[f64; 4]| {
            let normal = DVec3::new(a, b, c);
            CutFace::new(normal / normal.length(), d / normal.length(), &grid.index_to_world)
        };
        let sides = clip.r#box.iter().flat_map(|&[p, q]| {
            let (low, high) = (DVec3::from(p).min(q.into()), DVec3::from(p).max(q.into()));
            (0..3).flat_map(move |axis| {
                let across = DVec3::AXES[axis];
                [(across, low[axis]), (-across, -high[axis])]
            })
        });
        Self {
            clip: clip.clone(),
            index_to_world: grid.index_to_world,
            widest,
            longest,
            planes: clip.planes.iter().map(plane).collect(),
            sides: sides
                .map(|(normal, place)| CutFace::new(normal, place, &grid.index_to_world))
                .collect(),
        }
    }

    /// What is left of the `extent` voxels from `first` on; `Part` where a bounding sphere cannot tell.
    #[must_use]
    pub fn left(&self, first: [usize; 3], extent: [usize; 3]) -> Left {
        let [least, most] = self.depths(first, extent);
        if least >= self.widest / 2.0 {
            Left::Whole
        } else if most <= -self.widest / 2.0 {
            Left::Nothing
        } else {
            Left::Part
        }
    }

    /// Whether all of a block of voxels lies deeper under the cut than `deep` voxels, so that nothing which happens in the layer
    /// above does there.
    #[must_use]
    pub fn is_deeper(&self, first: [usize; 3], extent: [usize; 3], deep: f64) -> bool {
        self.depths(first, extent)[0] > deep * self.widest * (1.0 + 1e-9)
    }

    /// Whether the block of voxels from one to another lies so deep under the cut that nowhere in it a [section](Self::at)
    /// [takes anything](Section::left) from a slab or [turns](Section::turned) a normal, which it does as deep as `deep` voxels
    /// and one more.
    #[must_use]
    #[inline]
    pub fn is_whole(&self, [first, last]: [[usize; 3]; 2], deep: f64) -> bool {
        let (first, last) = (first.map(|n| n as f64).into(), last.map(|n| n as f64).into());
        // A little deeper, for what is rounded on the way.
        let enough = (deep + 1.0) * self.longest * (1.0 + 1e-6);
        let mut inside = self.sides.is_empty();
        for side in &self.sides {
            inside |= side.least(first, last) > enough;
        }
        for plane in &self.planes {
            inside &= plane.least(first, last) > enough;
        }
        inside
    }

    /// Between which depths under the cut a block of voxels lies, by a sphere around it.
    fn depths(&self, first: [usize; 3], extent: [usize; 3]) -> [f64; 2] {
        let half = DVec3::from(extent.map(|n| n.saturating_sub(1) as f64 / 2.0));
        let middle = DVec3::from(first.map(|n| n as f64)) + half;
        let m = self.index_to_world.matrix3;
        let radius =
            m.x_axis.length() * half.x + m.y_axis.length() * half.y + m.z_axis.length() * half.z;
        let inside = self.clip.distance(self.index_to_world.transform_point3(middle));
        [inside - radius, inside + radius]
    }

    /// How a world point lies to the cut.
    #[must_use]
    pub fn at(&self, world: DVec3) -> Section {
        let (inside, normal) = self.clip.nearest(world);
        Section { inside, normal, width: self.voxel(normal) }
    }

    /// How a voxel lies to the cut.
    #[must_use]
    pub fn under(&self, voxel: [usize; 3]) -> Section {
        let voxel = DVec3::from(voxel.map(|n| n as f64));
        self.at(self.index_to_world.transform_point3(voxel))
    }

    /// What the opacity of a voxel is multiplied by, 0..=1: 1/2 on the cut itself.
    #[must_use]
    pub fn factor(&self, voxel: [usize; 3]) -> f32 {
        let voxel = DVec3::from(voxel.map(|n| n as f64));
        let faces = self.clip.faces(self.index_to_world.transform_point3(voxel));
        // No distance is a NaN: a plane or box that is one cuts nothing.
        let ramps = faces.map(|(inside, normal)| inside / self.voxel(normal) + 0.5);
        ramps.fold(1.0, f64::min).max(0.0) as f32
    }

    /// How long a voxel is along a unit vector, world units: in voxels that are not cubes, a cut nearly along the slices
    /// falls over a whole slice.
    fn voxel(&self, normal: DVec3) -> f64 {
        (self.index_to_world.matrix3.transpose() * normal).length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        Grid::axis_aligned([20, 10, 10], [1.0, 2.0, -3.0], [5.0, 0.0, 0.0]).unwrap()
    }

    #[test]
    fn opacity_falls_from_whole_to_none_over_one_voxel_along_the_normal() {
        let plane = |d: f64| Clip { planes: vec![[2.0, 0.0, 0.0, 2.0 * d]], r#box: None };
        let factors = |d: f64| [9, 10, 11].map(|x| Cut::new(&plane(d), &grid()).factor([x, 3, 4]));
        assert_eq!(factors(15.0), [1.0, 0.5, 0.0]);
        assert_eq!(factors(15.25), [1.0, 0.75, 0.0]);
        assert_eq!(factors(15.5), [1.0, 1.0, 0.0]);
        let slices = Clip { planes: vec![[0.0, 0.0, -1.0, 12.0]], r#box: None };
        let along = [3, 4, 5].map(|z| Cut::new(&slices, &grid()).factor([2, 2, z]));
        assert_eq!(along, [1.0, 0.5, 0.0], "a slice is three thick");
    }

    #[test]
    fn a_cut_a_few_degrees_off_thick_slices_does_not_ripple() {
        let grid = Grid::axis_aligned([64, 4, 32], [1.0, 1.0, 5.0], [0.0; 3]).unwrap();
        let slope = 5.0_f64.to_radians().tan();
        let cut = Cut::new(&Clip { planes: vec![[-slope, 0.0, 1.0, 60.3]], r#box: None }, &grid);
        // How high the cut stands at x is what is left of its column.
        let height =
            |x: usize| (0..32).map(|z| 5.0 * f64::from(cut.factor([x, 1, z]))).sum::<f64>();
        let off = |x: usize| height(x) - height(0) - slope * x as f64;
        let ripple =
            (0..64).map(off).fold([0.0_f64; 2], |[low, high], off| [low.min(off), high.max(off)]);
        assert!(ripple[1] - ripple[0] < 0.1, "{ripple:?}");
    }

    #[test]
    fn a_section_tells_the_way_out_and_what_is_left_of_a_slab() {
        let clip = Clip {
            planes: vec![[0.0, 0.0, 2.0, -4.0]],
            r#box: Some([[9.0, -50.0, -50.0], [90.0, 50.0, 50.0]]),
        };
        let cut = Cut::new(&clip, &grid());
        let under = cut.at(DVec3::new(5.0, 1.0, -2.25));
        assert_eq!((under.inside, under.normal), (0.25, DVec3::Z));
        assert_eq!(under.left(DVec3::new(0.0, 3.0, -0.5)), 1.0);
        assert_eq!(under.left(DVec3::new(0.0, 0.0, -1.0)), 0.75);
        assert_eq!(under.left(DVec3::X), 1.0);
        assert_eq!(under.turned(Vec3::X, 0.5), Vec3::Z);
        assert_eq!(cut.at(DVec3::new(8.5, 0.0, -9.0)).normal, DVec3::X);
        assert_eq!(cut.at(DVec3::new(2.0, 0.0, -9.0)).turned(Vec3::X, 0.5), Vec3::X);
        let beyond = cut.at(DVec3::new(10.0, 0.0, -9.0));
        assert_eq!((beyond.inside, beyond.left(DVec3::X)), (-1.0, 0.0));
    }

    #[test]
    fn what_is_said_of_a_block_is_true_of_each_of_its_voxels() {
        let clip = Clip {
            planes: vec![[1.0, 1.0, 0.0, 25.0]],
            r#box: Some([[0.0, 0.0, -12.0], [9.5, 8.0, 0.0]]),
        };
        let cut = Cut::new(&clip, &grid());
        let (mut seen, mut whole) = ([0; 3], 0);
        for (x, y, z) in (0..720).map(|i| (i % 18, i / 18 % 8, i / 144 * 2)) {
            let left = cut.left([x, y, z], [2; 3]);
            seen[left as usize] += 1;
            for at in 0..8 {
                let factor = cut.factor([x + (at & 1), y + (at >> 1 & 1), z + (at >> 2)]);
                match left {
                    Left::Whole => assert_eq!(factor, 1.0),
                    Left::Nothing => assert_eq!(factor, 0.0),
                    Left::Part => assert!((0.0..=1.0).contains(&factor)),
                }
            }
            if cut.is_whole([[x, y, z], [x + 1, y + 1, z + 1]], 0.5) {
                for at in 0..8 {
                    let section = cut.under([x + (at & 1), y + (at >> 1 & 1), z + (at >> 2)]);
                    assert_eq!(section.left(DVec3::splat(9.0)), 1.0);
                    assert_eq!(section.turned(Vec3::X, 0.5), Vec3::X);
                }
                whole += 1;
            }
        }
        assert!((50..600).contains(&whole), "{whole}");
        assert!(seen.iter().all(|&n| n > 0), "{seen:?}");
    }
}
