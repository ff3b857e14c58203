//! Labels of a segmentation as a smooth field of opacity and color: what voxels of labels become before they are classified.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3, Vec4};
use rayon::prelude::*;

use super::grid::{Grid, Scalar, Scalars};
use crate::components::{Color, TransferPoint};
use crate::shared::Shared;
use crate::with_scalars;

/// The opacity that is written as the greatest scalar.
const WHOLE: f32 = 255.0;

/// What labels do to the voxels of a volume that is classified. Equality is identity.
#[derive(Debug, Clone, PartialEq)]
pub struct Tint {
    /// Linear color of each voxel, and in `w` how much of its own color it replaces, 0..=1.
    pub colors: Shared<Vec4>,
    /// What the opacity of each voxel is multiplied by, 0..=1; `None`: nothing.
    pub factors: Option<Shared<f32>>,
    brightest: f32,
}

impl Tint {
    fn new(colors: Vec<Vec4>, factors: Option<Vec<f32>>) -> Self {
        let brightest = colors.par_iter().map(|color| color.truncate().max_element());
        let brightest = brightest.reduce(|| 0.0, f32::max);
        Self { colors: Shared::new(colors), factors: factors.map(Shared::new), brightest }
    }

    /// What no channel of its colors is above.
    #[must_use]
    pub(crate) fn brightest(&self) -> f32 {
        self.brightest
    }
}

/// How labels look: color (linear) and opacity.
#[derive(Debug, Clone, PartialEq)]
pub struct Looks {
    /// Those that have a look of their own.
    pub known: BTreeMap<u32, (Vec3, f32)>,
    /// Whether all others but 0 are opaque, in colors that are told apart; else they are clear.
    pub others: bool,
}

impl Looks {
    /// A label's color and opacity; `None` of one that is clear.
    fn of(&self, label: u32) -> Option<Vec4> {
        let other = || (self.others && label > 0).then(|| (distinct(label).0, 1.0));
        let (color, opacity) = self.known.get(&label).copied().or_else(other)?;
        Some(color.extend(opacity))
    }
}

/// A color for a label: hues a golden angle apart, none of them like its neighbours'.
#[must_use]
pub(crate) fn distinct(label: u32) -> Color {
    let turn = (f64::from(label) * 0.618_033_988_749_895).fract() as f32 * 6.0;
    let light = if label.is_multiple_of(2) { 0.92 } else { 0.75 };
    let channel = |shift: f32| {
        let place = (turn + shift) % 6.0;
        light * (1.0 - 0.65 * place.min(4.0 - place).clamp(0.0, 1.0))
    };
    Color::from_srgb([channel(5.0), channel(3.0), channel(1.0)])
}

/// The labels of `labels` (on `from`) at the voxels of `grid`: those that are nearest in the world, 0 where there is none.
#[must_use]
pub fn nearest(labels: &Scalars, from: &Grid, grid: &Grid) -> Vec<u32> {
    let whole = |value: f32| if value >= 0.5 { value.round() as u32 } else { 0 };
    if from == grid {
        return with_scalars!(labels, values => values.par_iter().map(|v| whole(v.value())).collect());
    }
    let to = from.world_to_index() * grid.index_to_world;
    let [nx, ny, _] = grid.size;
    let at = |offset: usize| {
        let voxel = [offset % nx, offset / nx % ny, offset / (nx * ny)].map(|n| n as f64);
        let index = to.transform_point3(DVec3::from(voxel)).round();
        let last = DVec3::from(from.size.map(|n| (n - 1) as f64));
        if !(index.cmpge(DVec3::ZERO).all() && index.cmple(last).all()) {
            return 0;
        }
        let offset = from.offset(index.to_array().map(|n| n as usize));
        with_scalars!(labels, values => whole(values[offset].value()))
    };
    (0..grid.voxels()).into_par_iter().map(at).collect()
}

/// Labels as a volume by themselves: scalars from 0 (clear) to 255 (opaque), what they are classified by, and colors.
#[must_use]
pub fn alone(
    labels: &[u32],
    size: [usize; 3],
    looks: &Looks,
    sigma: f32,
) -> (Scalars, Vec<TransferPoint>, Tint) {
    let paint = |label: &u32| {
        let look = looks.of(*label).unwrap_or(Vec4::ZERO);
        (look.truncate() * look.w).extend(look.w)
    };
    let mut field: Vec<Vec4> = labels.par_iter().map(paint).collect();
    smooth(&mut field, size, sigma);
    let scalars = field.par_iter().map(|v| v.w.clamp(0.0, 1.0) * WHOLE).collect::<Vec<f32>>();
    field.par_iter_mut().for_each(|voxel| {
        *voxel = if voxel.w > 0.0 { (voxel.truncate() / voxel.w).extend(1.0) } else { Vec4::ZERO };
    });
    let point = |opacity: f32| TransferPoint { value: opacity * WHOLE, opacity, color: None };
    let tint = Tint::new(field, None);
    (Scalars::F32(Shared::new(scalars)), vec![point(0.0), point(1.0)], tint)
}

/// Labels as mask and tint of another volume; where there is none, its opacity is multiplied by `outside`.
#[must_use]
pub fn over(labels: &[u32], size: [usize; 3], looks: &Looks, sigma: f32, outside: f32) -> Tint {
    // Colors weigh as much as what is seen of them: nothing of what is outside bleeds into what is masked.
    let paint = |label: &u32| {
        let look = looks.of(*label).unwrap_or(Vec4::ZERO);
        (look.truncate() * look.w).extend(look.w)
    };
    let factor = |label: &u32| looks.of(*label).map_or(outside, |look| look.w);
    let mut colors: Vec<Vec4> = labels.par_iter().map(paint).collect();
    let mut factors: Vec<f32> = labels.par_iter().map(factor).collect();
    smooth(&mut colors, size, sigma);
    smooth(&mut factors, size, sigma);
    colors.par_iter_mut().zip(&factors).filter(|(color, _)| color.w > 0.0).for_each(
        |(color, factor)| {
            let part = if *factor > 0.0 { (color.w / factor).min(1.0) } else { 1.0 };
            *color = (color.truncate() / color.w).extend(part);
        },
    );
    factors.par_iter_mut().for_each(|factor| *factor = factor.clamp(0.0, 1.0));
    Tint::new(colors, Some(factors))
}

/// What a field is smoothed by: a number or several.
trait Smoothed:
    Copy + Send + Sync + std::ops::Mul<f32, Output = Self> + std::ops::Add<Output = Self>
{
}

impl Smoothed for f32 {}
impl Smoothed for Vec4 {}

/// A Gaussian of standard deviation `sigma` voxels, along one axis after the other; voxels at the border are repeated beyond.
fn smooth<V: Smoothed>(field: &mut Vec<V>, size: [usize; 3], sigma: f32) {
    if !(sigma > 0.0 && sigma.is_finite()) {
        return;
    }
    let reach = (3.0 * sigma).ceil() as i64;
    let weights: Vec<f32> =
        (-reach..=reach).map(|n| (-((n as f32 / sigma).powi(2)) / 2.0).exp()).collect();
    let sum: f32 = weights.iter().sum();
    let [nx, ny, _] = size;
    for (axis, stride) in [1, nx, nx * ny].into_iter().enumerate() {
        let last = size[axis] as i64 - 1;
        let source = std::mem::take(field);
        let mean = |at: usize| {
            let place = (at / stride % size[axis]) as i64;
            let value = |n: i64| {
                let moved = (place + n).clamp(0, last) - place;
                source[(at as i64 + moved * stride as i64) as usize]
            };
            let first = value(-reach) * (weights[0] / sum);
            (1 - reach..=reach)
                .fold(first, |mean, n| mean + value(n) * (weights[(n + reach) as usize] / sum))
        };
        *field = (0..source.len()).into_par_iter().map(mean).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn looks() -> Looks {
        let known = [(1, (Vec3::X, 1.0)), (2, (Vec3::Y, 0.5))];
        Looks { known: BTreeMap::from(known), others: false }
    }

    /// Labels 0, 1 and 2 in slabs of four along x.
    fn slabs() -> Vec<u32> {
        (0..12 * 6 * 6).map(|at| (at % 12 / 4) as u32).collect()
    }

    #[test]
    fn a_boundary_is_smooth_and_what_is_far_from_it_has_its_labels_look() {
        let (scalars, transfer, tint) = alone(&slabs(), [12, 6, 6], &looks(), 0.5);
        let row: Vec<f32> = (0..12).map(|x| scalars.value(x + 12 * 14)).collect();
        assert!(row[0] == 0.0 && (row[11] - 127.5).abs() < 1e-3, "{row:?}");
        assert!((row[5] - 255.0).abs() < 0.5, "{row:?}");
        assert!(row[3] > 10.0 && row[4] < 245.0 && (row[3] + row[4] - 255.0).abs() < 0.5);
        assert!(row.windows(2).take(5).all(|pair| pair[0] <= pair[1]));
        assert_eq!(transfer.last().unwrap().opacity, 1.0);
        // A color is the label's also where it fades: no black bleeds in.
        assert!(tint.colors[3 + 12 * 14].truncate().abs_diff_eq(Vec3::X, 1e-5));
        assert!(tint.colors[11 + 12 * 14].truncate().abs_diff_eq(Vec3::Y, 1e-5));
    }

    #[test]
    fn a_mask_multiplies_and_leaves_what_is_outside_as_much_as_is_stated() {
        let tint = over(&slabs(), [12, 6, 6], &looks(), 0.0, 0.25);
        let factors = tint.factors.unwrap();
        assert_eq!([0, 5, 9].map(|x| factors[x]), [0.25, 1.0, 0.5]);
        assert_eq!([0, 5, 9].map(|x| tint.colors[x].w), [0.0, 1.0, 1.0]);
    }

    #[test]
    fn labels_are_looked_up_where_they_are_in_the_world() {
        let from = Grid::axis_aligned([12, 6, 6], [1.0; 3], [0.0; 3]).unwrap();
        let labels = Scalars::U8(Shared::new(slabs().iter().map(|&n| n as u8).collect()));
        let finer = Grid::axis_aligned([8, 2, 2], [-0.5, 1.0, 1.0], [6.3, 2.0, 2.0]).unwrap();
        // 6.3, 5.8, 5.3, …, 2.8.
        assert_eq!(nearest(&labels, &from, &finer)[..8], [1, 1, 1, 1, 1, 1, 0, 0].map(|n| n));
        assert_eq!(nearest(&labels, &from, &from), slabs());
        let away = Grid::axis_aligned([2; 3], [1.0; 3], [50.0; 3]).unwrap();
        assert_eq!(nearest(&labels, &from, &away), [0; 8]);
    }

    #[test]
    fn labels_next_to_each_other_have_colors_that_are_told_apart() {
        for label in 1..200 {
            let [a, b] = [label, label + 1].map(|n| Vec3::from(distinct(n).to_srgb()));
            assert!(a.distance(b) > 0.25 && a.min_element() >= 0.0 && a.max_element() <= 1.0);
        }
        let looks = Looks { known: BTreeMap::new(), others: true };
        assert!(looks.of(0).is_none() && looks.of(7).is_some_and(|look| look.w == 1.0));
    }
}
