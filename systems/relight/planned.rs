//! What is known of gel before any is made: how bright it may be, and the numbers that it will be kept in.

use hecs::{Entity, World};

use crate::components::{
    CastsShadow, Classify, Clip, Light, Material, Matte, Surface, TexelKind, Voxelize,
};
use crate::light::shading::{Reflectance, lamps};
use crate::light::strength::ProjectedBy;
use crate::light::unlit::{brightest_color, most_reflected};
use crate::polygon::face::FaceColors;
use crate::polygon::matted::is_matted;
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
    let is_matted = is_matted(world, volume.entity);
    let sure = stated == TexelKind::Auto
        && match volume.content {
            Content::Classified => {
                let brightest = brightest(world, volume.entity, is_matted);
                let stays = held.is_opaque() && !(is_matted && may_be_cut(world));
                stays && brightest.is_some_and(|most| most <= BRIGHT - ROUNDED)
            }
            Content::Painted if !is_matted => {
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

/// Whether a polygon that is scan-converted may take away of what is opaque.
fn may_be_cut(world: &World) -> bool {
    let mut query = world.query::<&Voxelize>();
    query.iter().any(|voxelize| matches!(voxelize.matte, Matte::In | Matte::Out))
}

/// What no channel of the colors of a classified volume is above, nor of polygons that are matted with it, all lights
/// together and whatever they fall on; `None` if that is not known beforehand.
fn brightest(world: &World, volume: Entity, is_matted: bool) -> Option<f32> {
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
    let mut how = Reflectance::from(&material);
    let lamps = lamps(world, &how);
    let mut color = brightest_color(classify, &material, tint);
    let mut polygons = world.query::<(&Surface, Option<&FaceColors>)>().with::<&Voxelize>();
    for (surface, own) in polygons.iter().filter(|_| is_matted) {
        let own = own.map_or(0.0, FaceColors::brightest);
        color = color.max(surface.color.0.max_element()).max(own);
        // Each part of what is reflected is no more than the most that any of them has of it.
        how.ambient = how.ambient.max(surface.ambient);
        how.diffuse = how.diffuse.max(surface.diffuse);
        how.specular = how.specular.max(surface.specular);
    }
    let lamps = lamps.plain.iter().chain(lamps.shadowed.iter().map(|(_, lamp)| lamp));
    let lights: f32 = lamps.map(|lamp| most_reflected(lamp, &how)).sum();
    Some(color * (how.ambient + lights))
}
