//! Where rays come into the inside of a surface, or out of it, other than through the surface itself: at a cut, and where the
//! grid ends. There what is above an isovalue is closed by a flat face.

use glam::{DMat3, DVec3, Vec3};

use super::crossing::{Stretch, index};
use crate::view::walk::Tile;
use crate::volume::clipping::Cut;

/// Halvings of a stretch that a cut crosses.
const HALVINGS: usize = 24;

/// A place on a stretch at which a ray comes into what there is of a volume, or out of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cap {
    /// The part of the stretch before it, 0..=1.
    pub part: f64,
    /// The unit vector out of what there is, world.
    pub normal: Vec3,
}

/// Where the ray of a tile enters a grid, and where it leaves it, if that is nearer to sample `k`, which is in the grid, than
/// the one before or after; what lies beyond the stretch of the sample counts as its end. `last` is the grid's last voxel, fixed
/// point, and `to_world` brings normals to the world.
pub fn at_border(
    tile: &Tile,
    (lane, k): (usize, i64),
    last: [i64; 3],
    to_world: &DMat3,
) -> [Option<Cap>; 2] {
    let here = tile.at_sample(lane, k);
    [(k - 1, -1.0), (k + 1, 1.0)].map(|(beside, way)| {
        let there = tile.at_sample(lane, beside);
        // Of the planes between, the one that is nearest to the sample.
        let mut nearest: Option<(f64, DVec3)> = None;
        for axis in 0..3 {
            let plane = there[axis].clamp(0, last[axis]);
            if plane == there[axis] {
                continue;
            }
            let part = (plane - here[axis]) as f64 / (there[axis] - here[axis]) as f64;
            if nearest.is_none_or(|(least, _)| part < least) {
                let out = if plane == 0 { -1.0 } else { 1.0 };
                nearest = Some((part, DVec3::AXES[axis] * out));
            }
        }
        nearest.map(|(part, out)| Cap {
            part: (0.5 + way * part).clamp(0.0, 1.0),
            normal: (*to_world * out).normalize_or_zero().as_vec3(),
        })
    })
}

/// Where a stretch crosses a cut, at most once in each half.
pub fn at_cut(cut: &Cut, stretch: &Stretch, world: impl Fn(DVec3) -> DVec3) -> [Option<Cap>; 2] {
    let place = |part: f64| world(index(stretch.at(part)));
    let at = |part: f64| cut.at(place(part));
    // No distance changes by more than the way.
    let half = place(0.0).distance(place(1.0)) / 2.0;
    if at(0.5).inside.abs() > half * (1.0 + 1e-6) {
        return [None; 2];
    }
    let inside = |part: f64| at(part).inside >= 0.0;
    [[0.0, 0.5], [0.5, 1.0]].map(|[mut a, mut b]| {
        let first = inside(a);
        if first == inside(b) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(a, b);
            *(if inside(middle) == first { &mut a } else { &mut b }) = middle;
        }
        // The end that is left of the two.
        let part = if first { a } else { b };
        Some(Cap { part, normal: at(part).normal.as_vec3() })
    })
}

/// The stretch of a ray from a sample to those beside it, as far as the grid ends between them; else the sample's own.
pub fn reached(tile: &Tile, (lane, k): (usize, i64), last: [i64; 3]) -> Stretch {
    let own = Stretch::of(tile, lane, k);
    let is_out = |place: [i64; 3]| (0..3).any(|axis| !(0..=last[axis]).contains(&place[axis]));
    let beside = [k - 1, k + 1].map(|k| tile.at_sample(lane, k));
    let [from, to] = own.ends();
    Stretch::between(
        if is_out(beside[0]) { beside[0] } else { from },
        if is_out(beside[1]) { beside[1] } else { to },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::components::Clip;
    use crate::view::walk::FRACTION_BITS;
    use crate::volume::grid::Grid;

    fn fixed(n: f64) -> i64 {
        (n * (1_i64 << FRACTION_BITS) as f64) as i64
    }

    /// One ray through the middle of a grid of 9³ voxels along x, `step` voxels from sample to sample, at `first` at sample 0.
    fn tile(first: f64, step: f64) -> Tile {
        let mut tile = Tile::default();
        for lane in 0..16 {
            for (axis, (at, step)) in [(first, step), (4.0, 0.0), (4.0, 0.0)].iter().enumerate() {
                tile.at[axis][lane] = fixed(*at);
                tile.step[axis][lane] = fixed(*step);
            }
        }
        tile
    }

    #[test]
    fn a_grid_ends_at_its_first_voxels_and_its_last() {
        let last = [fixed(8.0); 3];
        let caps = |first: f64, step: f64, k| {
            at_border(&tile(first, step), (0, k), last, &DMat3::IDENTITY)
        };
        let near = |cap: Option<Cap>, part: f64, normal: Vec3| {
            let cap = cap.unwrap();
            assert!((cap.part - part).abs() < 1e-6 && cap.normal == normal, "{cap:?}");
        };
        // Samples at −0.75, 0.25: the border is a quarter before the second one.
        near(caps(-0.75, 1.0, 1)[0], 0.25, Vec3::NEG_X);
        assert_eq!(caps(-0.75, 1.0, 1)[1], None);
        assert_eq!(caps(-0.75, 1.0, 2), [None; 2]);
        // At −0.25, 0.75: it is before the stretch of the second one.
        near(caps(-0.25, 1.0, 1)[0], 0.0, Vec3::NEG_X);
        near(caps(7.9, 1.0, 0)[1], 0.6, Vec3::X);
        near(caps(8.7, -1.0, 1)[0], 0.2, Vec3::X);
    }

    #[test]
    fn a_cut_is_found_where_it_is_with_the_normal_of_its_plane() {
        let grid = Grid::axis_aligned([9; 3], [1.0; 3], [0.0; 3]).unwrap();
        let cut = Cut::new(&Clip { planes: vec![[2.0, 0.0, 0.0, 6.5]], r#box: None }, &grid);
        let at = |k| at_cut(&cut, &Stretch::of(&tile(0.0, 1.0), 0, k), |index| index);
        assert_eq!([at(2), at(4)], [[None; 2]; 2]);
        let [None, Some(cap)] = at(3) else { panic!("{:?}", at(3)) };
        assert!((cap.part - 0.75).abs() < 1e-6 && cap.normal == Vec3::X, "{cap:?}");
    }
}
