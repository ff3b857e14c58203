//! Volumes that are classified and not yet lit: all that the light from their voxels depends on, but for shadows.

use std::sync::Arc;

use hecs::{Entity, World};

use super::shading::{Lamp, Lamps, Reflectance, lamps};
use crate::components::{Classify, Clip, Material, OpacityUnit, Reconstruct};
use crate::view::observer;
use crate::volume::grid::{Grid, Scalars};
use crate::volume::labels::Tint;
use crate::volume::layer::Opacity;

/// A volume that is classified at its voxels, and the lights of the scene.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Unlit {
    pub scalars: Scalars,
    pub grid: Grid,
    pub opacity: Opacity,
    pub classify: Classify,
    pub material: Material,
    pub tint: Option<Tint>,
    pub unit: OpacityUnit,
    pub lamps: Lamps,
    pub clip: Option<Clip>,
    /// Whether ambient light is kept apart, for a depth cue.
    pub apart: bool,
}

impl Unlit {
    /// All that are classified so far.
    #[must_use]
    pub fn all(world: &World) -> Vec<(Entity, Arc<Self>)> {
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
        let apart = observer::is_cued(world);
        let mut all = Vec::new();
        for (entity, scalars, grid, opacity, classify, unit, material, tint, clip, reconstruct) in
            &mut world.query::<Volume>()
        {
            if reconstruct == Some(&Reconstruct::Values) {
                continue;
            }
            let material = material.cloned().unwrap_or_default();
            let unlit = Self {
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
            all.push((entity, Arc::new(unlit)));
        }
        all
    }
}

/// What no channel of the color of a voxel is above, before any light falls on it.
#[must_use]
pub(crate) fn brightest_color(
    classify: &Classify,
    material: &Material,
    tint: Option<&Tint>,
) -> f32 {
    let Classify { iso, regions, transfer, materials, .. } = classify;
    let own = iso.iter().map(|contour| contour.color);
    let own = own.chain(regions.iter().map(|tissue| tissue.color));
    let own = own.chain(transfer.iter().map(|point| point.color));
    let own = own.chain(materials.iter().map(|material| material.color));
    let own = own.flatten().map(|color| color.0.max_element());
    own.chain(tint.map(Tint::brightest)).fold(material.color.0.max_element(), f32::max)
}

/// The most that a surface sends of a light towards the observer, for each part of its color.
#[must_use]
pub(crate) fn most_reflected(lamp: &Lamp, how: &Reflectance) -> f32 {
    lamp.light.max_element() * (how.diffuse + how.specular)
}
