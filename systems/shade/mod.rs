//! `shade`: what every interesting voxel sends towards the observer, light by light (algorithm §3, Levoy 1988).

use fearless_simd::{Level, dispatch};
use glam::Vec4;
use hecs::{Entity, World};

use crate::components::{CastsShadow, Classify, Clip, Light, Material, OpacityUnit, Reconstruct};
use crate::error::Error;
use crate::light::shading::{Lamp, Lamps, Reflectance, lamps};
use crate::light::side_by_side::{self, Lighting, Vectors};
use crate::polygon::may_hold::MayHold;
use crate::schedule::{Outbox, Plan, ProductKey, System, Watch};
use crate::view::observer;
use crate::volume::bricks::{BrickPlace, Bricks, EDGE, VOXELS};
use crate::volume::classification::Classifier;
use crate::volume::clipping::Cut;
use crate::volume::gradients::Gradients;
use crate::volume::grid::{Grid, Scalar, Scalars};
use crate::volume::labels::Tint;
use crate::volume::layer::{LitColors, Opacity};
use crate::volume::scene_volumes::{Content, with_content};
use crate::with_scalars;

/// Voxels under a cut that are shaded by its normal alone: those between which the opacity rises, and the next.
const CUT_DEEP: f64 = 1.5;

/// A vector at every voxel of a row.
type Row = Vectors<EDGE>;

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
            self.per_voxel(&classifier, watch, &Lighting { ambient, lamps, how })
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
        lighting: &Lighting<'_>,
    ) -> Bricks<[f32; 3]> {
        let level = Level::new();
        let shading = Shading {
            inputs: self,
            classifier,
            gradients: Gradients::new(&self.grid),
            cut: self.clip.as_ref().map(|clip| Cut::new(clip, &self.grid)),
        };
        with_scalars!(&self.scalars, values => self.opacity.voxels.map(|place, alpha, made| {
            if watch.check().is_ok() {
                dispatch!(level, _simd => shading.brick(values, (place, alpha), made, lighting));
            }
        }))
    }
}

/// What a brick is shaded by.
struct Shading<'a> {
    inputs: &'a Inputs,
    classifier: &'a Classifier,
    gradients: Gradients,
    cut: Option<Cut>,
}

#[allow(clippy::inline_always, reason = "compiled anew within each instruction set")]
impl Shading<'_> {
    /// Fills the colors of a brick, which come zeroed.
    #[inline(always)]
    fn brick<T: Scalar>(
        &self,
        values: &[T],
        (place, alpha): (BrickPlace, &[f32; VOXELS]),
        made: &mut [[f32; 3]; VOXELS],
        lighting: &Lighting<'_>,
    ) {
        let ([x, y, z], n) = (place.first, place.extent[0]);
        // From a voxel under that layer on no normal is turned.
        let shallow = |cut: &&Cut| !cut.is_deeper(place.first, place.extent, CUT_DEEP + 1.0);
        let cut = self.cut.as_ref().filter(shallow);
        let rows = alpha.as_chunks::<EDGE>().0.iter().zip(made.as_chunks_mut::<EDGE>().0);
        for (row, (alpha, made)) in rows.enumerate() {
            if alpha.iter().all(|alpha| *alpha <= 0.0) {
                continue;
            }
            let first = [x, y + row % EDGE, z + row / EDGE];
            let gradients = self.gradients.side_by_side(values, first, n);
            let mut normals = side_by_side::normals(&gradients);
            if let Some(cut) = cut {
                for at in 0..n {
                    let section = cut.under([x + at, first[1], first[2]]);
                    let normal = section.turned(side_by_side::one(&normals, at), CUT_DEEP);
                    side_by_side::set(&mut normals, at, normal);
                }
            }
            let from = self.inputs.grid.offset(first);
            let colors = self.colors(&values[from..][..n], &gradients, from);
            let lit = lighting.sent(&colors, &normals);
            for (at, (made, alpha)) in made.iter_mut().zip(alpha).enumerate() {
                if *alpha > 0.0 {
                    *made = side_by_side::one(&lit, at).to_array();
                }
            }
        }
    }

    /// c_p of the voxels of a row, tinted; `from` is the place of its first one.
    #[inline(always)]
    fn colors<T: Scalar>(&self, values: &[T], gradients: &Row, from: usize) -> Row {
        let tint = self.inputs.tint.as_ref();
        if let (Some(color), None) = (self.classifier.only_color(), tint) {
            return side_by_side::all(color);
        }
        let mut colors = [[0.0; EDGE]; 3];
        for (at, value) in values.iter().enumerate() {
            let gradient = side_by_side::one(gradients, at).to_array();
            let color = self.classifier.color(value.value(), gradient);
            let tint = tint.map_or(Vec4::ZERO, |tint| tint.colors[from + at]);
            let tinted = if tint.w == 0.0 { color } else { color.lerp(tint.truncate(), tint.w) };
            side_by_side::set(&mut colors, at, tinted);
        }
        colors
    }
}
