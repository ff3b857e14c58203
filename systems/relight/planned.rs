//! The numbers that gel will be kept in where that is left open, before any is made: what a plan counts by.

use glam::{DVec3, Vec3};
use hecs::World;

use crate::components::{CastsShadow, Classify, Clip, Light, Material, TexelKind, Voxelize};
use crate::light::shading::{Lamps, Reflectance, lamps};
use crate::light::strength::ProjectedBy;
use crate::polygon::may_hold::MayHold;
use crate::view::observer;
use crate::volume::gel::BRIGHT;
use crate::volume::grid::Painted;
use crate::volume::labels::Tint;
use crate::volume::painting::Painting;
use crate::volume::scene_volumes::{Content, SceneVolume};

/// What sums of rounded numbers may add to a bound.
const ROUNDED: f32 = 2e-6;

/// Normals along an edge of each side of the cube that all are looked at through.
const NORMALS: i32 = 64;

/// More lights than this are bounded by their sum, as if all fell on one normal.
const MOST_LIGHTS: usize = 32;

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
            Content::Classified => held.is_opaque() && brightest(world, volume) <= BRIGHT - ROUNDED,
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

/// The most that a channel of a volume's colours can be, all lights together.
fn brightest(world: &World, volume: &SceneVolume) -> f32 {
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
        return f32::INFINITY;
    }
    let mut found = world.query_one::<Stated<'_>>(volume.entity);
    let Ok((classify, material, tint)) = found.get() else { return f32::INFINITY };
    let material = material.cloned().unwrap_or_default();
    let how = Reflectance::from(&material);
    let ambient = if observer::is_cued(world) { 0.0 } else { how.ambient };
    let color = brightest_color(classify, &material, tint);
    let lamps = lamps(world, &how);
    // Where ambient light is kept apart it is within its own color.
    (color * (reflected(&lamps, &how) + Vec3::splat(ambient))).max_element()
}

/// The most of each channel that a volume states.
fn brightest_color(classify: &Classify, material: &Material, tint: Option<&Tint>) -> Vec3 {
    let Classify { iso, regions, transfer, materials, .. } = classify;
    let own = iso.iter().map(|contour| contour.color);
    let own = own.chain(regions.iter().map(|tissue| tissue.color));
    let own = own.chain(transfer.iter().map(|point| point.color));
    let own = own.chain(materials.iter().map(|material| material.color));
    let own = own.flatten().map(|color| color.0);
    let tints = tint.into_iter().flat_map(|tint| tint.colors.iter().map(|c| c.truncate()));
    own.chain(tints).fold(material.color.0, Vec3::max)
}

/// The most light that a white voxel reflects of all lamps, whatever its normal; of lamps that cast shadows each by itself.
fn reflected(lamps: &Lamps, how: &Reflectance) -> Vec3 {
    let alone = how.diffuse + how.specular;
    let all = |light: Vec3| light * alone;
    let shadowed: Vec3 = lamps.shadowed.iter().map(|(_, lamp)| all(lamp.light)).sum();
    let plain: Vec3 = lamps.plain.iter().map(|lamp| lamp.light).sum();
    if lamps.plain.len() > MOST_LIGHTS {
        return shadowed + all(plain);
    }
    let at = |normal: Vec3| -> Vec3 {
        lamps.plain.iter().map(|lamp| lamp.reflected(Vec3::ONE, normal, how)).sum()
    };
    let most = normals().map(at).fold(Vec3::ZERO, Vec3::max);
    // No normal is farther from one that was looked at than half a square's diagonal, and over a radian the diffuse part
    // changes by no more than k_d, and the n-th power of a cosine by no more than √n.
    let apart = std::f32::consts::SQRT_2 / NORMALS as f32;
    let slope = how.diffuse + how.specular * how.shininess.max(1.0).sqrt();
    shadowed + (most + plain * (slope * apart)).min(all(plain))
}

/// Normals in all directions, those of a grid on the sides of a cube.
fn normals() -> impl Iterator<Item = Vec3> {
    let place = |n: i32| f64::from(2 * n + 1) / f64::from(NORMALS) - 1.0;
    let side = move |axis: usize, sign: f64| {
        let at = move |(u, v): (i32, i32)| {
            let mut normal = [sign; 3];
            (normal[(axis + 1) % 3], normal[(axis + 2) % 3]) = (place(u), place(v));
            DVec3::from(normal).normalize().as_vec3()
        };
        (0..NORMALS).flat_map(|u| (0..NORMALS).map(move |v| (u, v))).map(at)
    };
    (0..3).flat_map(move |axis| [1.0, -1.0].into_iter().flat_map(move |sign| side(axis, sign)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::components::{Color, Toward};
    use crate::light::shading::Lamp;

    #[test]
    fn no_normal_reflects_more_than_the_bound_and_the_bound_is_near() {
        let how = |specular: f32, shininess: f32| Reflectance {
            ambient: 0.1,
            diffuse: 0.8,
            specular,
            shininess,
            two_sided: true,
        };
        let lamp = |toward: [f64; 3]| {
            let light =
                Light { toward: Toward::Direction(toward), strength: 0.7, color: Color::WHITE };
            Lamp::new(&light, DVec3::NEG_Y)
        };
        let lights = [[0.3, -1.0, 0.2], [1.0, 0.1, 0.0], [-0.2, -0.4, 1.0]];
        let lamps = Lamps { plain: lights.map(lamp).to_vec(), shadowed: Vec::new() };
        for how in [how(0.0, 1.0), how(0.3, 20.0)] {
            let bound = reflected(&lamps, &how).x;
            let mut most: f32 = 0.0;
            for i in 0..60_000 {
                // Evenly over the sphere, by the golden angle.
                let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 60_000.0;
                let turn = f64::from(i) * 2.399_963;
                let (sin, cos) = libm::sincos(turn);
                let normal = DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z;
                let reflect = |lamp: &Lamp| lamp.reflected(Vec3::ONE, normal.as_vec3(), &how).x;
                most = most.max(lamps.plain.iter().map(reflect).sum());
            }
            assert!(most <= bound && bound < 1.1 * most, "{most} {bound}");
        }
    }
}
