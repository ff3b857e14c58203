//! `classify`: the opacity of every voxel from its scalar and gradient (algorithm §2), weakened where a clip cuts.

use hecs::{Entity, World};

use crate::components::{self, Clip, Material, OpacityUnit};
use crate::error::Error;
use crate::polygon::may_hold::MayHold;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::volume::bricks::{BrickPlace, Bricks, EDGE, VOXELS};
use crate::volume::classification::Classifier;
use crate::volume::clipping::{Cut, Left};
use crate::volume::gradients::Gradients;
use crate::volume::grid::{Grid, Scalar, Scalars};
use crate::volume::labels::Tint;
use crate::volume::layer::Opacity;
use crate::volume::ranges::Ranges;
use crate::volume::scene_volumes::{SceneVolume, with_opacities};
use crate::with_scalars;

/// Makes the [`Opacity`] of every volume that states how it is classified.
pub struct ClassifyVoxels;

#[derive(PartialEq)]
struct Inputs {
    scalars: Scalars,
    ranges: Ranges,
    grid: Grid,
    classify: components::Classify,
    unit: OpacityUnit,
    clip: Option<Clip>,
    tint: Option<Tint>,
}

impl System for ClassifyVoxels {
    type Product = Opacity;
    const NAME: &'static str = "classify";
    const READS: &'static [ProductKey] = &[ProductKey::of::<Ranges>()];

    fn run(world: &World, out: &mut Outbox<'_, Opacity>) -> Result<(), Error> {
        type Volume<'a> = (
            Entity,
            &'a Scalars,
            &'a Ranges,
            &'a Grid,
            &'a components::Classify,
            &'a OpacityUnit,
            Option<&'a Clip>,
            Option<&'a Tint>,
        );
        let watch = out.watch();
        let asked: Vec<_> = with_opacities(world).into_iter().map(|volume| volume.entity).collect();
        for (entity, scalars, ranges, grid, classify, unit, clip, tint) in
            &mut world.query::<Volume>()
        {
            if !asked.contains(&entity) {
                continue;
            }
            let inputs = Inputs {
                scalars: scalars.clone(),
                ranges: ranges.clone(),
                grid: *grid,
                classify: classify.clone(),
                unit: *unit,
                clip: clip.cloned(),
                tint: tint.cloned(),
            };
            out.derive(entity, inputs, |inputs| {
                let opacity =
                    with_scalars!(&inputs.scalars, values => inputs.classify(values, watch));
                watch.check()?;
                Ok(opacity)
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let bytes = |v: &SceneVolume| (v.entity, MayHold::of(world, v).bytes::<f32>());
        let makes: Vec<_> = with_opacities(world).iter().map(bytes).collect();
        if makes.is_empty() {
            return Plan::absent(
                "no volume of scalars is classified at its voxels, and no light asks for their opacities",
            );
        }
        Plan { makes, why: "`classify` states which scalars are seen" }
    }
}

impl Inputs {
    fn classify<T: Scalar>(&self, values: &[T], watch: &Watch) -> Opacity {
        let size = self.grid.size;
        // Opacity does not depend on the material, so that a change of colour classifies nothing again.
        // What has no thickness casts its shadow as one voxel has it.
        let mut stated = self.classify.clone();
        for contour in stated.iso.iter_mut().filter(|contour| contour.thickness_voxels == 0.0) {
            contour.thickness_voxels = 1.0;
        }
        let classifier = Classifier::new(&stated, &Material::default(), self.unit.0);
        let cut = self.clip.as_ref().map(|clip| Cut::new(clip, &self.grid));
        let gradients = Gradients::new(&self.grid);
        let left = |place: BrickPlace| {
            cut.as_ref().map_or(Left::Whole, |cut| cut.left(place.first, place.extent))
        };
        let may_hold = |place: BrickPlace| {
            let range = self.ranges.around(place.brick);
            let steepest = gradients.at_most(range.spread, place.first, place.extent);
            classifier.may_show(range, steepest) && left(place) != Left::Nothing
        };
        let voxels = Bricks::make_where(size, may_hold, |place, brick| {
            if watch.check().is_err() {
                return false;
            }
            fill(values, size, &gradients, &classifier, place, brick);
            if let (Left::Part, Some(cut)) = (left(place), &cut) {
                clip_brick(cut, place, brick);
            }
            if let Some(factors) = self.tint.as_ref().and_then(|tint| tint.factors.as_ref()) {
                mask_brick(factors, &self.grid, place, brick);
            }
            brick.iter().any(|&alpha| alpha > 0.0)
        });
        Opacity { voxels, nan_voxels: self.ranges.nan_voxels() }
    }
}

/// Fills a brick with opacities.
fn fill<T: Scalar>(
    values: &[T],
    [nx, ny, _]: [usize; 3],
    gradients: &Gradients,
    classifier: &Classifier,
    place: BrickPlace,
    brick: &mut [f32; VOXELS],
) {
    let ([x, y, z], [n, rows, slices]) = (place.first, place.extent);
    // Without gradients, zeros: they are not looked at.
    let mut row = [[0.0; 3]; EDGE];
    for (dz, dy) in (0..slices).flat_map(|dz| (0..rows).map(move |dy| (dz, dy))) {
        if classifier.is_of_gradient() {
            gradients.row(values, [x, y + dy, z + dz], &mut row[..n]);
        }
        let values = &values[((z + dz) * ny + y + dy) * nx + x..][..n];
        let alphas = &mut brick[(dz * EDGE + dy) * EDGE..][..n];
        for ((alpha, value), gradient) in alphas.iter_mut().zip(values).zip(&row) {
            *alpha = classifier.opacity(value.value(), *gradient);
        }
    }
}

fn mask_brick(factors: &[f32], grid: &Grid, place: BrickPlace, brick: &mut [f32; VOXELS]) {
    for (at, voxel) in place.voxels() {
        brick[at] *= factors[grid.offset(voxel)];
    }
}

fn clip_brick(cut: &Cut, place: BrickPlace, brick: &mut [f32; VOXELS]) {
    for (at, voxel) in place.voxels() {
        if brick[at] > 0.0 {
            brick[at] *= cut.factor(voxel);
        }
    }
}
