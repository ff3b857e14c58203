//! What is known of gel before any is made: how bright it may be, and the numbers that it will be kept in.

use hecs::{Entity, World};

use crate::components::{CastsShadow, Classify, Clip, Light, Material, TexelKind, Voxelize};
use crate::light::shading::{Lamp, Reflectance, lamps};
use crate::light::strength::ProjectedBy;
use crate::polygon::may_hold::MayHold;
use crate::volume::gel::BRIGHT;
use crate::volume::grid::Painted;
use crate::volume::labels::Tint;
use crate::volume::painting::Painting;
use crate::volume::scene_volumes::{Content, SceneVolume};

/// What sums of rounded numbers may add to a bound.
const ROUNDED: f32 = 2e-6;

/// In how many bits the gel of a volume will be kept at most: 16 only if nothing can make it 32.
pub(crate) fn planned(
    world: &World,
    volume: &SceneVolume,
    held: &MayHold,
    stated: TexelKind,
) -> TexelKind {
    let matted = world.query::<&Voxelize>().iter().next().is_some();
    let sure = stated == TexelKind::Auto
        && !matted
        && match volume.content {
            Content::Classified => {
                let brightest = brightest(world, volume.entity);
                held.is_opaque() && brightest.is_some_and(|most| most <= BRIGHT - ROUNDED)
            }
            Content::Painted => {
                let mut found = world.query_one::<(&Painted, Option<&Clip>)>(volume.entity);
                found.get().is_ok_and(|(painted, clip)| {
                    Painting::new(painted, &volume.grid, clip).suited() == TexelKind::U16
                })
            }
            _ => false,
        };
    match stated {
        TexelKind::Auto if sure => TexelKind::U16,
        TexelKind::Auto => TexelKind::F32,
        stated => stated,
    }
}

/// What no channel of the colors of a classified volume is above, all lights together and whatever they fall on; `None` if that
/// is not known beforehand.
pub(super) fn brightest(world: &World, volume: Entity) -> Option<f32> {
    type Stated<'a> = (&'a Classify, Option<&'a Material>, Option<&'a Tint>);
    // What a slide lets through, or a falloff below 1, may be brighter than the light.
    let mut shadows = world.query::<(&CastsShadow, Option<&ProjectedBy>)>().with::<&Light>();
    let is_bright = |slide: &ProjectedBy| {
        slide.picture.pixels.as_flattened().iter().any(|channel| *channel > 1.0)
    };
    if shadows
        .iter()
        .any(|(shadow, slide)| shadow.k1 < 1.0 || shadow.k2 < 0.0 || slide.is_some_and(is_bright))
    {
        return None;
    }
    let mut found = world.query_one::<Stated<'_>>(volume);
    let (classify, material, tint) = found.get().ok()?;
    let material = material.cloned().unwrap_or_default();
    let how = Reflectance::from(&material);
    let lamps = lamps(world, &how);
    let lamps = lamps.plain.iter().chain(lamps.shadowed.iter().map(|(_, lamp)| lamp));
    let light = |lamp: &Lamp| lamp.light.max_element() * (how.diffuse + how.specular);
    Some(brightest_color(classify, &material, tint) * (how.ambient + lamps.map(light).sum::<f32>()))
}

/// The greatest channel that a volume states.
fn brightest_color(classify: &Classify, material: &Material, tint: Option<&Tint>) -> f32 {
    let Classify { iso, regions, transfer, materials, .. } = classify;
    let own = iso.iter().map(|contour| contour.color);
    let own = own.chain(regions.iter().map(|tissue| tissue.color));
    let own = own.chain(transfer.iter().map(|point| point.color));
    let own = own.chain(materials.iter().map(|material| material.color));
    let own = own.flatten().map(|color| color.0.max_element());
    let tints = tint.into_iter().flat_map(|tint| tint.colors.iter());
    let tints = tints.map(|color| color.truncate().max_element());
    own.chain(tints).fold(material.color.0.max_element(), f32::max)
}
