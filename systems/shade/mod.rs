//! `shade`: what every interesting voxel sends towards the observer, light by light (algorithm §3, Levoy 1988).

use glam::Vec3;
use hecs::{Entity, World};

use crate::components::{CastsShadow, Classify, Clip, Light, Material, OpacityUnit, Reconstruct};
use crate::error::Error;
use crate::light::shading::{Lamp, Lamps, Reflectance, lamps};
use crate::polygon::may_hold::MayHold;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::view::observer;
use crate::volume::bricks::{Bricks, EDGE};
use crate::volume::classification::Classifier;
use crate::volume::clipping::Cut;
use crate::volume::gradients::{Gradients, normal};
use crate::volume::grid::{Grid, Scalar, Scalars};
use crate::volume::labels::Tint;
use crate::volume::layer::{LitColors, Opacity};
use crate::volume::scene_volumes::{Content, with_content};
use crate::with_scalars;

/// Voxels under a cut that are shaded by its normal alone: those between which the opacity rises, and the next.
const CUT_DEEP: f64 = 1.5;

/// Makes the [`LitColors`] of every volume that is classified.
pub(crate) struct Shade;

#[derive(PartialEq)]
struct Inputs {
    scalars: Scalars,
    grid: Grid,
    opacity: Opacity,
    classify: Classify,
    material: Material,
    tint: Option<Tint>,
    unit: OpacityUnit,
    lamps: Lamps,
    clip: Option<Clip>,
    /// Whether ambient light is kept apart, for a depth cue.
    apart: bool,
}

impl System for Shade {
    type Product = LitColors;
    const NAME: &'static str = "shade";
    const READS: &'static [ProductKey] = &[ProductKey::of::<Opacity>()];

    fn run(world: &World, out: &mut Outbox<'_, LitColors>) -> Result<(), Error> {
        type Volume<'a> = (
            Entity,
            &'a Scalars,
            &'a Grid,
            &'a Opacity,
            &'a Classify,
            &'a OpacityUnit,
            Option<&'a Material>,
            Option<&'a Tint>,
            Option<&'a Clip>,
            Option<&'a Reconstruct>,
        );
        let watch = out.watch();
        let apart = observer::is_cued(world);
        for (entity, scalars, grid, opacity, classify, unit, material, tint, clip, reconstruct) in
            &mut world.query::<Volume>()
        {
            if reconstruct == Some(&Reconstruct::Values) {
                continue;
            }
            let material = material.cloned().unwrap_or_default();
            let inputs = Inputs {
                scalars: scalars.clone(),
                grid: *grid,
                opacity: opacity.clone(),
                classify: classify.clone(),
                unit: *unit,
                lamps: lamps(world, &Reflectance::from(&material)),
                material,
                tint: tint.cloned(),
                clip: clip.cloned(),
                apart,
            };
            out.derive(entity, inputs, |inputs| {
                let colors = inputs.shade(watch);
                watch.check()?;
                Ok(colors)
            })?;
        }
        Ok(())
    }

    fn plan(world: &World) -> Plan {
        let shadows = world.query::<(&Light, &CastsShadow)>().iter().count() as u64;
        let arrays = 1 + shadows + u64::from(observer::is_cued(world));
        let held: Vec<_> = with_content(world, Content::Classified)
            .iter()
            .map(|v| (v.entity, MayHold::of(world, v)))
            .collect();
        if held.is_empty() {
            return Plan::absent("no volume of scalars is classified at its voxels");
        }
        let most = |held: &MayHold| held.bytes::<[f32; 3]>().saturating_mul(arrays);
        let why = "a volume that is classified is shaded by the lights of the scene";
        Plan::of(&held, most, MayHold::seen, why)
    }
}

impl Inputs {
    fn shade(&self, watch: &Watch) -> LitColors {
        let classifier = Classifier::new(&self.classify, &self.material, self.unit.0);
        let how = Reflectance::from(&self.material);
        let colors = |lamps: &[&Lamp], ambient: f32| {
            self.per_voxel(&classifier, watch, |color, normal| {
                let reflected = lamps.iter().map(|lamp| lamp.reflected(color, normal, &how));
                color * ambient + reflected.sum::<Vec3>()
            })
        };
        let plain: Vec<_> = self.lamps.plain.iter().collect();
        LitColors {
            base: colors(&plain, if self.apart { 0.0 } else { how.ambient }),
            shadowed: self.lamps.shadowed.iter().map(|(_, lamp)| colors(&[lamp], 0.0)).collect(),
            ambient: self.apart.then(|| colors(&[], how.ambient)),
        }
    }

    /// `light(c_p, N)` at every interesting voxel; what is clear has no colour.
    fn per_voxel(
        &self,
        classifier: &Classifier,
        watch: &Watch,
        light: impl Fn(Vec3, Vec3) -> Vec3 + Sync + Send,
    ) -> Bricks<[f32; 3]> {
        let [nx, ny, _] = self.grid.size;
        let gradients = Gradients::new(&self.grid);
        let cut = self.clip.as_ref().map(|clip| Cut::new(clip, &self.grid));
        let sections = |normal: Vec3, voxel: [usize; 3]| {
            let section = cut.as_ref().map(|cut| cut.under(voxel));
            section.map_or(normal, |section| section.turned(normal, CUT_DEEP))
        };
        with_scalars!(&self.scalars, values => self.opacity.voxels.map(|place, alpha, made| {
            if watch.check().is_err() {
                return;
            }
            let ([x, y, z], n) = (place.first, place.extent[0]);
            let mut slopes = [[0.0; 3]; EDGE];
            for (row, alpha) in alpha.chunks_exact(EDGE).enumerate() {
                if alpha.iter().all(|alpha| *alpha <= 0.0) {
                    continue;
                }
                let [y, z] = [y + row % EDGE, z + row / EDGE];
                gradients.row(values, [x, y, z], &mut slopes[..n]);
                let first = (z * ny + y) * nx + x;
                let values = &values[first..][..n];
                let made = made[row * EDGE..][..n].iter_mut().zip(alpha);
                for (at, ((made, _), (value, slope))) in made
                    .zip(values.iter().zip(&slopes))
                    .enumerate()
                    .filter(|(_, ((_, alpha), _))| **alpha > 0.0)
                {
                    let mut color = classifier.color(value.value(), *slope);
                    if let Some(tint) = &self.tint {
                        let tint = tint.colors[first + at];
                        color = color.lerp(tint.truncate(), tint.w);
                    }
                    let normal = sections(normal(*slope), [x + at, y, z]);
                    *made = light(color, normal).to_array();
                }
            }
        }))
    }
}
