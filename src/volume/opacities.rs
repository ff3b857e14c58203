//! The opacities of a volume's voxels, brick by brick: classified, weakened where a clip cuts, and masked by labels.

use crate::components::{Classify, Clip, Material};
use crate::volume::bricks::{BrickPlace, EDGE, VOXELS};
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
        Self { scalars, grid, classifier, gradients: Gradients::new(grid), cut, tint }
    }

    /// Whether any of a brick may be seen, by the ranges of its scalars and by the cut. Where this is denied, all is clear.
    #[must_use]
    pub fn may_hold(&self, ranges: &Ranges, place: BrickPlace) -> bool {
        let range = ranges.around(place.brick);
        let steepest = self.gradients.at_most(range.spread, place.first, place.extent);
        self.classifier.may_show(range, steepest) && self.left(place) != Left::Nothing
    }

    /// Fills a brick, which comes zeroed, with α; whether any of it is seen.
    pub fn fill(&self, place: BrickPlace, brick: &mut [f32; VOXELS]) -> bool {
        with_scalars!(self.scalars, values => self.classify(values, place, brick));
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

    fn classify<T: Scalar>(&self, values: &[T], place: BrickPlace, brick: &mut [f32; VOXELS]) {
        let [nx, ny, _] = self.grid.size;
        let ([x, y, z], [n, rows, slices]) = (place.first, place.extent);
        // Without gradients, zeros: they are not looked at.
        let mut row = [[0.0; 3]; EDGE];
        for (dz, dy) in (0..slices).flat_map(|dz| (0..rows).map(move |dy| (dz, dy))) {
            if self.classifier.is_of_gradient() {
                self.gradients.row(values, [x, y + dy, z + dz], &mut row[..n]);
            }
            let values = &values[((z + dz) * ny + y + dy) * nx + x..][..n];
            let alphas = &mut brick[(dz * EDGE + dy) * EDGE..][..n];
            for ((alpha, value), gradient) in alphas.iter_mut().zip(values).zip(&row) {
                *alpha = self.classifier.opacity(value.value(), *gradient);
            }
        }
    }
}
