//! The opacities of a volume's voxels, brick by brick: classified, weakened where a clip cuts, and masked by labels.

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use crate::components::{Classify, Clip, Material};
use crate::volume::bricks::{self, BrickPlace, EDGE, VOXELS};
use crate::volume::buried::buried;
use crate::volume::classification::Classifier;
use crate::volume::clipping::{Cut, Left};
use crate::volume::gradients::Gradients;
use crate::volume::grid::{Grid, Scalar, Scalars};
use crate::volume::labels::Tint;
use crate::volume::ranges::Ranges;
use crate::with_scalars;

/// What makes the opacities of a volume of scalars.
#[derive(Debug)]
pub(crate) struct Opacities<'a> {
    scalars: &'a Scalars,
    grid: &'a Grid,
    classifier: Classifier,
    gradients: Gradients,
    cut: Option<Cut>,
    tint: Option<&'a Tint>,
    level: Level,
}

impl<'a> Opacities<'a> {
    /// Of `scalars` on `grid`, as they are stated to be classified per opacity unit of `unit` world units, and cut and masked.
    #[must_use]
    pub fn new(
        (scalars, grid): (&'a Scalars, &'a Grid),
        (classify, unit): (&Classify, f64),
        clip: Option<&Clip>,
        tint: Option<&'a Tint>,
    ) -> Self {
        // Opacity does not depend on the material, so that a change of colour classifies nothing again.
        // What has no thickness casts its shadow as one voxel has it.
        let mut stated = classify.clone();
        for contour in stated.iso.iter_mut().filter(|contour| contour.thickness_voxels == 0.0) {
            contour.thickness_voxels = 1.0;
        }
        let classifier = Classifier::new(&stated, &Material::default(), unit);
        let cut = clip.map(|clip| Cut::new(clip, grid));
        let (gradients, level) = (Gradients::new(grid), Level::new());
        Self { scalars, grid, classifier, gradients, cut, tint, level }
    }

    /// For each brick, x fastest, whether any of it may be seen, by the ranges of its scalars, by the cut, and by what it is
    /// [`buried`] in, where the observer `stays_outside`. Where this is denied, all is clear, or nothing comes to it.
    #[must_use]
    pub fn held(&self, ranges: &Ranges, stays_outside: bool) -> Vec<bool> {
        let (size, counts) = (self.grid.size, bricks::counts(self.grid.size));
        let [nx, ny, nz] = counts;
        let place = |at: usize| BrickPlace::new([at % nx, at / nx % ny, at / (nx * ny)], size);
        let all = || (0..nx * ny * nz).into_par_iter();
        let mut held: Vec<bool> = all().map(|at| self.may_hold(ranges, place(at))).collect();
        if stays_outside && self.may_bury(ranges) {
            let opaque: Vec<bool> = all().map(|at| self.is_opaque(ranges, place(at))).collect();
            let buried = buried(counts, &opaque);
            held.iter_mut().zip(buried).for_each(|(held, buried)| *held &= !buried);
        }
        held
    }

    /// Whether anything may be buried: something is opaque, and nothing is cut away, masked or a NaN.
    #[must_use]
    pub fn may_bury(&self, ranges: &Ranges) -> bool {
        let is_masked = self.tint.is_some_and(|tint| tint.factors.is_some());
        let is_whole = self.cut.is_none() && !is_masked && ranges.nan_voxels() == 0;
        is_whole && self.classifier.may_be_opaque()
    }

    /// Whether a whole brick is of voxels of opacity 1, before it is cut or masked.
    fn is_opaque(&self, ranges: &Ranges, place: BrickPlace) -> bool {
        let (range, steepest) = (ranges.around(place.brick), self.steepest(ranges, place));
        place.extent == [EDGE; 3] && self.classifier.is_opaque(range, steepest)
    }

    /// Whether any of a brick may be seen, by the ranges of its scalars and by the cut. Where this is denied, all is clear.
    fn may_hold(&self, ranges: &Ranges, place: BrickPlace) -> bool {
        let range = ranges.around(place.brick);
        self.classifier.may_show(range, self.steepest(ranges, place))
            && self.left(place) != Left::Nothing
    }

    /// No gradient in a brick is longer.
    fn steepest(&self, ranges: &Ranges, place: BrickPlace) -> f64 {
        self.gradients.at_most(ranges.around(place.brick).spread, place.first, place.extent)
    }

    /// Fills a brick, which comes zeroed, with α; whether any of it is seen.
    pub fn fill(&self, ranges: &Ranges, place: BrickPlace, brick: &mut [f32; VOXELS]) -> bool {
        let steepest = self.steepest(ranges, place);
        with_scalars!(self.scalars, values => {
            dispatch!(self.level, _simd => self.classify(values, (place, steepest), brick));
        });
        if let (Left::Part, Some(cut)) = (self.left(place), &self.cut) {
            for (at, voxel) in place.voxels() {
                if brick[at] > 0.0 {
                    brick[at] *= cut.factor(voxel);
                }
            }
        }
        if let Some(factors) = self.tint.and_then(|tint| tint.factors.as_ref()) {
            for (at, voxel) in place.voxels() {
                brick[at] *= factors[self.grid.offset(voxel)];
            }
        }
        brick.iter().any(|&alpha| alpha > 0.0)
    }

    fn left(&self, place: BrickPlace) -> Left {
        self.cut.as_ref().map_or(Left::Whole, |cut| cut.left(place.first, place.extent))
    }

    /// Fills a brick, which comes zeroed, with what is classified alone.
    #[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
    #[inline(always)]
    fn classify<T: Scalar>(
        &self,
        values: &[T],
        (place, steepest): (BrickPlace, f64),
        brick: &mut [f32; VOXELS],
    ) {
        let ([x, y, z], [n, rows, slices]) = (place.first, place.extent);
        for (dz, dy) in (0..slices).flat_map(|dz| (0..rows).map(move |dy| (dz, dy))) {
            let first = [x, y + dy, z + dz];
            // Behind the end of the grid as its last voxel, which is left out in the end.
            let own = &values[self.grid.offset(first)..][..n];
            let row: [f32; EDGE] = std::array::from_fn(|at| own[at.min(n - 1)].value());
            let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
            for value in row {
                low = if value < low { value } else { low };
                high = if value > high { value } else { high };
            }
            if self.classifier.show(&[low], &[high], &[steepest]) == [0] {
                continue;
            }
            let mut gradients = [[0.0; EDGE]; 3];
            if self.classifier.is_of_gradient() {
                gradients = self.gradients.side_by_side(values, first, n);
            }
            let alphas = self.classifier.opacities(&row, &gradients);
            brick[(dz * EDGE + dy) * EDGE..][..n].copy_from_slice(&alphas[..n]);
        }
    }
}
