//! `classify`: the opacity of every voxel from its scalar and gradient (algorithm §2), weakened where a clip cuts.

use std::sync::atomic::{AtomicU64, Ordering};

use hecs::{Entity, World};

use crate::components::{self, Clip, Material, OpacityUnit};
use crate::error::Error;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::volume::bricks::{self, Bricks, EDGE, Place, VOXELS};
use crate::volume::classification::Classifier;
use crate::volume::clipping::{Cut, Left};
use crate::volume::grid::{Grid, Scalar, Scalars};
use crate::volume::layer::{Gradient, Opacity};
use crate::volume::scene_volumes::{Content, SceneVolume, with_content};
use crate::with_scalars;

/// Makes the [`Opacity`] of every volume that states how it is classified.
pub struct Classify;

#[derive(PartialEq)]
struct Inputs {
    scalars: Scalars,
    gradient: Gradient,
    grid: Grid,
    classify: components::Classify,
    unit: OpacityUnit,
    clip: Option<Clip>,
}

impl System for Classify {
    type Product = Opacity;
    const NAME: &'static str = "classify";
    const READS: &'static [ProductKey] = &[ProductKey::of::<Gradient>()];

    fn run(world: &World, out: &mut Outbox<'_, Opacity>) -> Result<(), Error> {
        type Volume<'a> = (
            Entity,
            &'a Scalars,
            &'a Gradient,
            &'a Grid,
            &'a components::Classify,
            &'a OpacityUnit,
            Option<&'a Clip>,
        );
        let watch = out.watch();
        for (entity, scalars, gradient, grid, classify, unit, clip) in &mut world.query::<Volume>()
        {
            let inputs = Inputs {
                scalars: scalars.clone(),
                gradient: gradient.clone(),
                grid: *grid,
                classify: classify.clone(),
                unit: *unit,
                clip: clip.cloned(),
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
        let bytes = |v: &SceneVolume| (v.entity, bricks::most_bytes::<f32>(v.size()));
        let makes: Vec<_> = with_content(world, Content::Classified).iter().map(bytes).collect();
        if makes.is_empty() {
            return Plan::absent("no volume of scalars states `classify`");
        }
        Plan { makes, why: "`classify` states which scalars are seen" }
    }
}

impl Inputs {
    fn classify<T: Scalar>(&self, values: &[T], watch: &Watch) -> Opacity {
        let size = self.grid.size;
        // Opacity does not depend on the material, so that a change of colour classifies nothing again.
        let classifier = Classifier::new(&self.classify, &Material::default(), self.unit.0);
        let cut = self.clip.as_ref().map(|clip| Cut::new(clip, &self.grid));
        let nan_voxels = AtomicU64::new(0);
        let voxels = Bricks::make(size, |place, brick| {
            if watch.check().is_err() {
                return false;
            }
            let left = cut.as_ref().map_or(Left::Whole, |cut| cut.left(place.first, place.extent));
            let nan = self.fill(values, &classifier, place, brick);
            if nan > 0 {
                nan_voxels.fetch_add(nan, Ordering::Relaxed);
            }
            match (left, &cut) {
                (Left::Nothing, _) => return false,
                (Left::Part, Some(cut)) => clip_brick(cut, place, brick),
                _ => {}
            }
            brick.iter().any(|&alpha| alpha > 0.0)
        });
        Opacity { voxels, nan_voxels: nan_voxels.into_inner() }
    }

    /// Fills a brick with opacities; how many of its voxels hold a NaN.
    fn fill<T: Scalar>(
        &self,
        values: &[T],
        classifier: &Classifier,
        place: Place,
        brick: &mut [f32; VOXELS],
    ) -> u64 {
        let [x, y, z] = place.first;
        let mut nan = 0;
        for (dz, dy) in
            (0..place.extent[2]).flat_map(|dz| (0..place.extent[1]).map(move |dy| (dz, dy)))
        {
            let (offset, n) = (self.grid.offset([x, y + dy, z + dz]), place.extent[0]);
            let (values, gradients) = (&values[offset..][..n], &self.gradient.0[offset..][..n]);
            let row = &mut brick[(dz * EDGE + dy) * EDGE..][..n];
            for ((alpha, value), gradient) in row.iter_mut().zip(values).zip(gradients) {
                let value = value.value();
                nan += u64::from(value.is_nan());
                *alpha = classifier.opacity(value, *gradient);
            }
        }
        nan
    }
}

fn clip_brick(cut: &Cut, place: Place, brick: &mut [f32; VOXELS]) {
    for (at, voxel) in place.voxels() {
        if brick[at] > 0.0 {
            brick[at] *= cut.factor(voxel);
        }
    }
}
