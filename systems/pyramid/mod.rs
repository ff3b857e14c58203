//! `pyramid`: the pyramid of binary volumes that rays step over empty space with (paper §6): of gel, by its texels; of values,
//! by the ranges of the voxels around each cell.

use hecs::{Entity, World};

use crate::components::{Classify, Clip, Filter, Material, OpacityUnit, Skip, TexelKind};
use crate::error::Error;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::view::observer;
use crate::volume::classification::Classifier;
use crate::volume::clipping::Cut;
use crate::volume::coefficients::Coefficients;
use crate::volume::gel::{CELLS, Gel, GelBricks, Shown};
use crate::volume::grid::{Grid, Scalars};
use crate::volume::interest::Interest;
use crate::volume::pyramid::Pyramid;
use crate::volume::ranges::Ranges;
use crate::volume::scene_volumes::{Content, SceneVolume, stepped, with_content};
use crate::volume::seen::Seen;
use crate::with_texels;

/// Makes the [`Pyramid`] of every volume that is seen, where the view's sampling asks for it.
pub(crate) struct StackPyramid;

/// What a pyramid is of.
#[derive(PartialEq)]
enum Inputs {
    Gel(GelBricks),
    /// Gel of which that is known, in numbers of this kind.
    Layer(Shown, TexelKind),
    Values(Box<Values>),
}

#[derive(PartialEq)]
struct Values {
    /// What is interpolated: the volume's own, or a spline's coefficients.
    scalars: Scalars,
    ranges: Ranges,
    grid: Grid,
    classify: Classify,
    unit: OpacityUnit,
    clip: Option<Clip>,
    filter: Filter,
    /// Whether slabs are integrated.
    integrate: bool,
}

impl System for StackPyramid {
    type Product = Pyramid;
    const NAME: &'static str = "pyramid";
    const READS: &'static [ProductKey] =
        &[ProductKey::of::<Gel>(), ProductKey::of::<Ranges>(), ProductKey::of::<Coefficients>()];

    fn run(world: &World, out: &mut Outbox<'_, Pyramid>) -> Result<(), Error> {
        let sampling = observer::sampling(world);
        if sampling.skip != Skip::Pyramid {
            return Ok(());
        }
        let (values, watch) = (with_content(world, Content::Values), out.watch());
        for (entity, gel) in &mut world.query::<(Entity, &Gel)>() {
            if values.iter().all(|volume| volume.entity != entity) {
                // The ambient gel has the same opacities, so one pyramid serves both.
                let inputs = match &gel.shown {
                    Some(shown) => Inputs::Layer(shown.clone(), gel.lit.kind()),
                    None => Inputs::Gel(gel.lit.clone()),
                };
                out.derive(entity, inputs, |inputs| Ok(inputs.pyramid(watch)))?;
            }
        }
        for SceneVolume { entity, grid, unit, .. } in values {
            let made = world.get::<&Coefficients>(entity).ok();
            let mut query =
                world.query_one::<(&Scalars, &Ranges, &Classify, Option<&Clip>)>(entity);
            let Ok((scalars, ranges, classify, clip)) = query.get() else { continue };
            let values = Values {
                scalars: made.as_ref().map_or(scalars, |made| &made.values).clone(),
                ranges: made.as_ref().map_or(ranges, |made| &made.ranges).clone(),
                grid,
                classify: classify.clone(),
                unit: OpacityUnit(unit),
                clip: clip.cloned(),
                filter: sampling.filter,
                integrate: sampling.integrate,
            };
            out.derive(entity, Inputs::Values(Box::new(values)), |inputs| {
                let pyramid = inputs.pyramid(watch);
                watch.check()?;
                Ok(pyramid)
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        if observer::sampling(world).skip != Skip::Pyramid {
            return Plan::absent("`sampling.skip` is none");
        }
        let bytes = |v: &SceneVolume| {
            let bricks: u64 = v.size().iter().map(|n| n.div_ceil(CELLS) as u64).product();
            // Three bits a cell, a distance for each of eight blocks, and an entry in two tables.
            bricks.saturating_mul(3 * size_of::<[u64; CELLS]>() as u64 + 8 + 8)
        };
        let makes: Vec<_> = stepped(world).iter().map(|v| (v.entity, bytes(v))).collect();
        if makes.is_empty() {
            return Plan::absent("no volume is stated");
        }
        Plan::of_most(makes, "`sampling.skip` is the pyramid")
    }
}

impl Inputs {
    fn pyramid(&self, watch: &Watch) -> Pyramid {
        match self {
            Self::Layer(shown, _) => Pyramid::of_layer(Interest::clone(&shown.interest)),
            Self::Gel(gel) => with_texels!(gel, texels => Pyramid::of(texels)),
            Self::Values(values) => values.pyramid(watch),
        }
    }
}

impl Values {
    fn pyramid(&self, watch: &Watch) -> Pyramid {
        let Self { scalars, ranges, grid, classify, unit, clip, filter, integrate } = self;
        // What is seen does not depend on the material: a change of color makes no pyramid.
        let classifier = &Classifier::new(classify, &Material::default(), unit.0);
        let cut = clip.as_ref().map(|clip| Cut::new(clip, grid));
        let (cut, filter) = (cut.as_ref(), *filter);
        let around = classifier.looks_around(*integrate);
        Seen { scalars, ranges, grid, filter, classifier, cut, around }.pyramid(watch)
    }
}
